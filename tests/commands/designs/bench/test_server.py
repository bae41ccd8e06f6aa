"""The server of the bench: for one page of this machine, and nobody else; no physics behind it."""

from __future__ import annotations

import http.client
import json
import threading
import time

import pytest

pytest.importorskip("starlette")
pytest.importorskip("uvicorn")
pytest.importorskip("websockets")

from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from propmdao.commands.designs.bench.server import address, bound_socket, new_key, server_of


class Stub:
    """In place of a bench."""

    def __init__(self) -> None:
        self.received = []

    def connect(self, tell):
        self.tell = tell
        tell({"kind": "start"})

    def receive(self, message):
        self.received.append(message)
        self.tell({"kind": "heard", "number": message.get("number")})

    def sound(self, name):
        if name != "bent":
            raise ValueError("nothing to be heard")
        return b"fLaC", 0.125

    def text(self):
        return 'name = "bent"\n'


@pytest.fixture(scope="module")
def served():
    """The stub, the port and the key of a server that runs."""
    bench, opened, key = Stub(), bound_socket(0), new_key()
    server = server_of(bench, opened, key)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [opened]}, daemon=True)
    thread.start()
    while not server.started:
        assert thread.is_alive()
        time.sleep(0.01)
    yield bench, opened.getsockname()[1], key
    server.should_exit = True
    thread.join(10.0)
    opened.close()


def get(served, path, host=None):
    _, port, key = served
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10.0)
    connection.request("GET", path.format(key=key), headers={"Host": host or f"127.0.0.1:{port}"})
    answer = connection.getresponse()
    return answer, answer.read()


def connected(served, origin=None):
    _, port, key = served
    origin = origin or f"http://127.0.0.1:{port}"
    return connect(f"ws://127.0.0.1:{port}/{key}/messages", origin=origin)


def test_it_listens_to_this_machine_alone_and_says_where():
    with bound_socket(0) as opened:
        host, port = opened.getsockname()
        assert host == "127.0.0.1"
        assert address(opened, "abc") == f"http://127.0.0.1:{port}/abc/"
        opened.listen()
        with pytest.raises(ValueError, match=rf"--port {port} cannot be opened: .*in use"):
            bound_socket(port)
    assert len({new_key() for _ in range(10)}) == 10 and len(new_key()) >= 20


@pytest.mark.parametrize(
    ("name", "kind"),
    [("", "text/html"), ("bench.js", "text/javascript"), ("bench.css", "text/css"),
     ("page.css", "text/css"), ("drawing.js", "text/javascript")],
)  # fmt: skip
def test_files_of_the_page_load_nothing_from_elsewhere(served, name, kind):
    answer, content = get(served, "/{key}/" + name)
    assert answer.status == 200 and answer.headers["Content-Type"].startswith(kind)
    assert len(content) > 1000
    policy = answer.headers["Content-Security-Policy"]
    assert policy.startswith("default-src 'none'") and "script-src 'self';" in policy
    if name == "":
        assert b"http://" not in content and b"https://" not in content


def test_nobody_else_gets_anything(served):
    assert get(served, "/")[0].status == 404
    assert get(served, "/wrong/")[0].status == 404
    assert get(served, "/{key}/../../server.py")[0].status == 404
    assert get(served, "/{key}/server.py")[0].status == 404
    # A name of somebody else's that leads to this machine.
    assert get(served, "/{key}/", host="evil.example")[0].status == 400
    with pytest.raises(InvalidStatus):
        connected(served, origin="http://evil.example")


def test_sounds_and_files_are_handed_on(served):
    answer, content = get(served, "/{key}/sound/bent")
    assert content == b"fLaC" and answer.headers["X-Full-Scale"] == "0.125"
    answer, content = get(served, "/{key}/sound/x")
    assert answer.status == 409 and content == b"nothing to be heard"
    answer, content = get(served, "/{key}/design.toml")
    assert content == b'name = "bent"\n' and "attachment" in answer.headers["Content-Disposition"]


def test_messages_go_both_ways_and_the_later_window_takes_over(served):
    bench = served[0]
    with connected(served) as first:
        assert json.loads(first.recv(10.0)) == {"kind": "start"}
        first.send(json.dumps({"kind": "drag", "number": 3}))
        assert json.loads(first.recv(10.0)) == {"kind": "heard", "number": 3}
        for nothing in ("no json", "[1]"):
            first.send(nothing)
            assert json.loads(first.recv(10.0)) == {"kind": "heard", "number": None}
        assert bench.received[-2:] == [{}, {}]
        with connected(served) as second:
            assert json.loads(second.recv(10.0)) == {"kind": "start"}
            with pytest.raises(ConnectionClosed) as closed:
                first.recv(10.0)
            assert closed.value.rcvd.code == 4000
            second.send(json.dumps({"kind": "drag", "number": 4}))
            assert json.loads(second.recv(10.0))["number"] == 4
