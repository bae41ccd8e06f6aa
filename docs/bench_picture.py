"""Picture of the bench for docs/howto/bench.md: ``python docs/bench_picture.py``.

Needs the extra `bench` and Chromium. A blade is bent as a hand would, the page is opened without a
window, and what it shows is kept.
"""

from __future__ import annotations

import base64
import json
import subprocess
import tempfile
import threading
import time
import urllib.request
from pathlib import Path
from typing import Any

import numpy as np
from websockets.sync.client import connect

import propmdao as pm
from propmdao.analysis.request import Request
from propmdao.commands.designs.bench.server import address, bound_socket, new_key, server_of
from propmdao.commands.designs.bench.workbench import Workbench

PICTURE = Path(__file__).parent / "figures" / "bench.png"
AT = (1.905, -45.0)
BENT = {"chord 4": 25, "chord 5": 20, "twist 4": -20, "twist 5": -30, "sweep 5": 16, "sweep 4": 5}


def picture(told: Path) -> bytes:
    """Picture of the page of a browser, by the port that it tells, once its numbers are there."""
    while not (told.exists() and "\n" in told.read_text()):
        time.sleep(0.1)
    port = told.read_text().splitlines()[0]
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list") as answer:
        (page,) = (page for page in json.load(answer) if page["type"] == "page")

    with connect(page["webSocketDebuggerUrl"], max_size=None) as socket:

        def call(method: str, **parameters: Any) -> dict[str, Any]:
            socket.send(json.dumps({"id": 1, "method": method, "params": parameters}))
            return json.loads(socket.recv())["result"]

        state = "document.getElementById('state')?.textContent"
        while call("Runtime.evaluate", expression=state)["result"].get("value") != "Up to date":
            time.sleep(0.1)
        time.sleep(1.0)  # for the figures
        return base64.b64decode(call("Page.captureScreenshot")["data"])


def main() -> None:
    """Bend the blade, take the picture."""
    propeller = pm.load_propeller("apcsf_11x4.7")
    asked = Request.of(thrust=2.0, broadband=True, observers=pm.arc(AT[0], np.array(AT[1:])))
    bench = Workbench(propeller, asked.completed(propeller), AT, None)
    said = []
    bench.connect(said.append)
    steps = said[0]["steps"] | BENT
    bench.receive({"kind": "set", "number": 1, "held": "thrust", "steps": steps})
    bench.wait(600.0)
    opened, key = bound_socket(0), new_key()
    server = server_of(bench, opened, key)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [opened]})
    thread.start()
    with tempfile.TemporaryDirectory() as profile:
        browser = subprocess.Popen(
            [
                "chromium", "--headless=new", "--no-sandbox", "--window-size=1400,1000",
                f"--user-data-dir={profile}", "--remote-debugging-port=0", address(opened, key),
            ],
            stderr=subprocess.DEVNULL,
        )  # fmt: skip
        PICTURE.write_bytes(picture(Path(profile) / "DevToolsActivePort"))
        browser.terminate()
        browser.wait()
    server.should_exit = True
    thread.join()
    bench.close()


if __name__ == "__main__":
    main()
