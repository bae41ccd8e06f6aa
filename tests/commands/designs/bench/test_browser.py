"""The bench in a browser: drag, see the numbers change, undo, hear, save."""

from __future__ import annotations

import base64
import contextlib
import json
import os
import shutil
import subprocess
import threading
import time
import urllib.request
from pathlib import Path

import pytest

pytest.importorskip("starlette")
pytest.importorskip("uvicorn")
pytest.importorskip("websockets")

from websockets.sync.client import connect

import propmdao as pm
from propmdao.commands.designs.bench.server import address, bound_socket, new_key, server_of

# Chromium's advice to who reads a canvas, as this test does.
HARMLESS = "Canvas2D: Multiple readback operations"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
# Whether there is a picture on a canvas: thousands of its dots have a colour.
DRAWN = (
    "(c) => c.width && c.getContext('2d').getImageData(0, 0, c.width, c.height).data"
    ".filter((v, k) => k % 4 === 3 && v > 0).length > 2000"
)
PATIENCE = 120.0  # s


class Tab:
    """A page of a browser, by the protocol of its developer tools."""

    def __init__(self, socket) -> None:
        self._socket = socket
        self._sent = 0
        self.said: list[str] = []
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method, **parameters):
        self._sent += 1
        self._socket.send(json.dumps({"id": self._sent, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.recv(PATIENCE))
            if answer.get("id") == self._sent:
                assert "error" not in answer, answer
                return answer["result"]
            self._note(answer)

    def _note(self, event):
        what, told = event["method"], event["params"]
        if what == "Runtime.exceptionThrown":
            self.said.append(json.dumps(told["exceptionDetails"])[:500])
        elif what == "Runtime.consoleAPICalled" and told["type"] in ("error", "warning"):
            self.said.append(json.dumps(told["args"])[:500])
        elif what == "Log.entryAdded" and told["entry"]["level"] in ("error", "warning"):
            self.said.append(f"{told['entry']['text']} {told['entry'].get('url', '')}")

    def get(self, script):
        """Value of an expression."""
        asked = {"expression": script, "returnByValue": True, "awaitPromise": True}
        answer = self.call("Runtime.evaluate", **asked)
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    def until(self, script):
        """Wait until an expression is true."""
        end = time.monotonic() + PATIENCE
        while not (value := self.get(script)):
            assert time.monotonic() < end, f"{script}; {self.get('document.body.innerText')}"
            time.sleep(0.02)
        return value

    def settled(self):
        self.until("document.getElementById('state')?.textContent === 'Up to date'")

    def text(self, key, column=2):
        return self.get(f"document.querySelector(`tr[data-key='{key}']`).cells[{column}].innerText")

    def place(self, selector):
        """Middle of an element and its width, after it has been scrolled to and lies still."""
        self.get(f"document.querySelector(`{selector}`).scrollIntoView({{block: 'center'}})")
        places = [None]
        while len(places) < 2 or places[-1] != places[-2]:
            time.sleep(0.05)
            box = self.get(
                "(({x, y, width, height}) => [x, y, width, height])"
                f"(document.querySelector(`{selector}`).getBoundingClientRect())"
            )
            places.append((box[0] + 0.5 * box[2], box[1] + 0.5 * box[3], box[2]))
        x, y, width = places[-1]
        at_place = f"document.elementFromPoint({x}, {y}) === document.querySelector(`{selector}`)"
        assert self.get(at_place), selector
        return x, y, width

    def mouse(self, kind, x, y):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1,
                  clickCount=1)  # fmt: skip

    def click(self, selector):
        x, y, _ = self.place(selector)
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y)

    def key(self, name, modifiers=0):
        for kind in ("rawKeyDown", "keyUp"):
            code = {"ArrowRight": 39, "z": 90}[name]
            self.call("Input.dispatchKeyEvent", type=kind, key=name, modifiers=modifiers,
                      windowsVirtualKeyCode=code)  # fmt: skip

    def picture(self, file: Path):
        shot = self.call("Page.captureScreenshot", captureBeyondViewport=True)
        file.write_bytes(base64.b64decode(shot["data"]))

    def size(self, width, height, mobile=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=mobile)  # fmt: skip


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    """Port of the developer tools of a browser that runs."""
    found = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip(f"none of {', '.join(BROWSERS)} is installed: the bench is not opened")
    profile = tmp_path_factory.mktemp("profile")
    run = subprocess.Popen(
        [
            found, "--headless=new", "--no-sandbox", "--mute-audio", f"--user-data-dir={profile}",
            "--autoplay-policy=no-user-gesture-required", "--remote-debugging-port=0",
            "--window-size=1400,1000", "about:blank",
        ],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    told, end = profile / "DevToolsActivePort", time.monotonic() + PATIENCE
    while not (told.exists() and "\n" in told.read_text()):
        assert run.poll() is None and time.monotonic() < end
        time.sleep(0.05)
    yield int(told.read_text().splitlines()[0])
    run.terminate()
    run.wait(10.0)


@pytest.fixture
def tab(browser, fast_bench):
    """The page of a bench in a tab."""
    bench = fast_bench
    opened, key = bound_socket(0), new_key()
    server = server_of(bench, opened, key)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [opened]}, daemon=True)
    thread.start()
    where = f"http://127.0.0.1:{browser}/json/new?{address(opened, key)}"
    with urllib.request.urlopen(urllib.request.Request(where, method="PUT")) as answer:
        made = json.load(answer)
    with connect(made["webSocketDebuggerUrl"], max_size=None) as socket:
        tab = Tab(socket)
        tab.settled()
        yield tab
    with contextlib.suppress(OSError):
        urllib.request.urlopen(f"http://127.0.0.1:{browser}/json/close/{made['id']}").close()
    server.should_exit = True
    thread.join(10.0)
    opened.close()


@pytest.mark.slow
def test_drag_see_hear_undo_and_save(tab, tmp_path):
    for canvas in range(8):
        tab.until(f"({DRAWN})(document.querySelectorAll('canvas')[{canvas}])")
    described = float(tab.text("thrust", 1))
    assert tab.text("thrust") == tab.text("thrust", 1)

    # Drag the third slider of the blade angle to the right, and see the thrust on the way.
    tab.click(".tabs button[data-group='twist']")
    x, y, width = tab.place("input[data-name='twist 3']")
    tab.mouse("mousePressed", x, y)
    for k in range(1, 11):
        tab.mouse("mouseMoved", x + 0.01 * k * width, y)
    tab.until(f"parseFloat(document.querySelector(`tr[data-key='thrust']`).cells[2].innerText)"
              f" > {described + 0.05}")  # fmt: skip
    assert tab.get("document.getElementById('undo').disabled")  # the drag goes on
    tab.mouse("mouseReleased", x + 0.1 * width, y)
    tab.settled()
    tab.until("!document.getElementById('undo').disabled")
    dragged = tab.text("thrust")
    assert float(dragged) > described and tab.text("thrust", 1) == f"{described:.4f}"
    assert float(tab.text("at oaspl_total_dba")) > float(tab.text("at oaspl_total_dba", 1))
    followed = tab.get("document.querySelector(`input[data-name='thrust']`).ariaValueText")
    assert followed == f"{dragged} N"
    shown = tab.get("document.querySelector(`input[data-name='twist 3']`).ariaValueText")
    assert shown.startswith("+") and shown.endswith(" deg")

    # By keys, and back again.
    tab.get("document.querySelector(`input[data-name='twist 3']`).focus()")
    tab.key("ArrowRight")
    tab.until(f"document.querySelector(`tr[data-key='thrust']`).cells[2].innerText !== '{dragged}'")
    tab.settled()
    tab.key("z", modifiers=2)
    tab.until(f"document.querySelector(`tr[data-key='thrust']`).cells[2].innerText === '{dragged}'")
    tab.settled()

    for name in ("bent", "described"):
        tab.click(f"#hear-{name}")
        tab.until(f"document.getElementById('hear-{name}').dataset.heard > 0")
        assert tab.get(f"document.getElementById('hear-{name}').ariaPressed") == "true"
    tab.click("#hear-described")
    tab.click("#save")
    tab.until("document.getElementById('state').textContent.startsWith('Saved in')")
    saved = pm.load_propeller(tmp_path / "saved.toml")
    assert saved.beta_deg.max() != pm.load_propeller("apcsf_11x4.7").beta_deg.max()
    tab.click("#reset")
    tab.until(f"document.querySelector(`tr[data-key='thrust']`).cells[2].innerText"
              f" === '{described:.4f}'")  # fmt: skip

    # What is no blade is one line, and the numbers that were good are grey.
    for name, steps in (("diameter", 50), ("rpm", 80)):
        tab.get(f"((i) => {{ i.value = {steps}; i.dispatchEvent(new Event('change')); }})("
                f"document.querySelector(`input[data-name='{name}']`))")  # fmt: skip
    tab.until("!document.getElementById('trouble').hidden")
    said = tab.get("document.getElementById('trouble').innerText")
    assert "relative tip Mach number must be below 1" in said and "\n" not in said
    assert tab.get("document.querySelectorAll('#table tr.old').length") > 5
    keep_pictures(tab)
    assert [line for line in tab.said if HARMLESS not in line] == []


@pytest.mark.slow
@pytest.mark.parametrize("width", [390, 800, 1400])
def test_nothing_is_wider_than_the_screen(tab, width):
    tab.size(width, 844, mobile=width < 500)
    time.sleep(0.3)
    assert tab.get("document.documentElement.scrollWidth") <= width
    wide = tab.get(
        "[...document.querySelectorAll('button, input, output, td, th, dd, .label')]"
        f".filter((e) => e.getBoundingClientRect().right > {width} + 1).map((e) => e.outerHTML)"
    )
    assert wide == []


def keep_pictures(tab):
    """Pictures of the page for who wants to look at it: the folder PROPMDAO_PICTURES."""
    folder = os.environ.get("PROPMDAO_PICTURES")
    if folder:
        for name, size in {"desktop": (1400, 1000), "phone": (390, 844)}.items():
            tab.size(*size, mobile=name == "phone")
            time.sleep(0.5)
            tab.picture(Path(folder) / f"{name}.png")
