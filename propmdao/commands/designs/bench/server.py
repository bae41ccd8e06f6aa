"""The bench's page, served to the browser of this machine alone."""

from __future__ import annotations

import asyncio
import contextlib
import json
import secrets
import socket
import threading
import webbrowser
from importlib.resources import files
from typing import Any

import uvicorn
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from propmdao.commands.designs.bench.workbench import Message, Workbench
from propmdao.runtime.output_files import reason_of

HOST = "127.0.0.1"
# Nothing is loaded from anywhere else, and nobody else's script runs.
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src data:;"
    " connect-src 'self' {socket}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_KINDS = {".html": "text/html", ".js": "text/javascript", ".css": "text/css"}
_OWN = ("propmdao.commands.designs.bench", "web")
#: Files of the page, with the package and the folder that they are in; reports have one style, too.
_FILES = dict.fromkeys(("bench.html", "bench.css", "bench.js", "drawing.js"), _OWN) | {
    "page.css": ("propmdao.figures.pages", "templates")
}
_OTHER_WINDOW = 4000  # status of a connection that another one takes the place of
_LONGEST_MESSAGE = 65536  # bytes


def bound_socket(port: int) -> socket.socket:
    """Open a port of this machine, which no other machine reaches.

    Parameters
    ----------
    port : int
        Number of the port; 0 for any that is free.

    Returns
    -------
    socket.socket
        The open socket.

    Raises
    ------
    ValueError
        If the port is taken or not allowed.
    """
    opened = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        opened.bind((HOST, port))
    except OSError as error:
        opened.close()
        raise ValueError(f"--port {port} cannot be opened: {reason_of(error)}") from error
    return opened


def address(opened: socket.socket, key: str) -> str:
    """Address of the page, with the key that others on this machine do not know."""
    return f"http://{HOST}:{opened.getsockname()[1]}/{key}/"


def new_key() -> str:
    """Key of a page, which nobody guesses."""
    return secrets.token_urlsafe(16)


def serve(bench: Workbench, opened: socket.socket, key: str, opens_browser: bool) -> None:
    """Serve the page until somebody interrupts.

    Parameters
    ----------
    bench : Workbench
        The bench.
    opened : socket.socket
        Socket of `bound_socket`.
    key : str
        Key of the page.
    opens_browser : bool
        Whether a browser is told to open the page.
    """
    server = server_of(bench, opened, key)
    bench.begin()
    if opens_browser:  # the socket listens already: whoever asks early waits
        opened.listen()
        threading.Thread(target=webbrowser.open, args=[address(opened, key)], daemon=True).start()
    with contextlib.suppress(KeyboardInterrupt):  # how a bench ends
        server.run(sockets=[opened])
    bench.close()


def server_of(bench: Workbench, opened: socket.socket, key: str) -> uvicorn.Server:
    """Make the server of a page.

    Parameters
    ----------
    bench, opened, key
        The same as those of `serve`.

    Returns
    -------
    uvicorn.Server
        Server, to run on the socket.
    """
    pages = _Pages(bench, opened.getsockname()[1])
    routes = [
        Route("/", pages.file),
        Route("/sound/{name}", pages.sound),
        Route("/design.toml", pages.design),
        WebSocketRoute("/messages", pages.messages),
        Route("/{name}", pages.file),
    ]
    # A name that leads here from elsewhere is not ours: no other site reads the page.
    hosts = Middleware(TrustedHostMiddleware, allowed_hosts=[HOST, "localhost"])
    config = uvicorn.Config(
        Starlette(routes=[Mount(f"/{key}", routes=routes)], middleware=[hosts]),
        log_level="warning",
        lifespan="off",
        ws="websockets-sansio",
        ws_max_size=_LONGEST_MESSAGE,
        timeout_graceful_shutdown=1,
    )
    return uvicorn.Server(config)


class _Pages:
    """What is served of a bench."""

    def __init__(self, bench: Workbench, port: int) -> None:
        self._bench = bench
        self._origins = [f"http://{host}:{port}" for host in (HOST, "localhost")]
        sockets = " ".join(origin.replace("http", "ws") for origin in self._origins)
        self._headers = {
            "Content-Security-Policy": _POLICY.format(socket=sockets),
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
            "Cache-Control": "no-store",
        }
        self._open: WebSocket | None = None

    async def file(self, request: Request) -> Response:
        """A file of the page."""
        name = request.path_params.get("name", "bench.html")
        if name not in _FILES:
            return self._refused("there is no such page", 404)
        package, folder = _FILES[name]
        content = (files(package) / folder / name).read_text(encoding="utf-8")
        kind = _KINDS[name[name.rindex(".") :]]
        return Response(content, headers=self._headers, media_type=kind)

    async def sound(self, request: Request) -> Response:
        """Sound of one of the blades."""
        try:
            content, scale = await run_in_threadpool(self._bench.sound, request.path_params["name"])
        except ValueError as error:
            return self._refused(str(error), 409)
        headers = {**self._headers, "X-Full-Scale": f"{scale:.9g}"}
        return Response(content, headers=headers, media_type="audio/flac")

    async def design(self, request: Request) -> Response:
        """Propeller file of the design, to be kept."""
        try:
            text = self._bench.text()
        except ValueError as error:
            return self._refused(str(error), 409)
        attached = {"Content-Disposition": 'attachment; filename="bent.toml"'}
        return PlainTextResponse(text, headers={**self._headers, **attached})

    def _refused(self, reason: str, status: int) -> Response:
        return PlainTextResponse(reason, status, headers=self._headers)

    async def messages(self, connection: WebSocket) -> None:
        """Messages of the one page that is open, and to it."""
        if connection.headers.get("origin") not in self._origins:
            await connection.close()
            return
        await connection.accept()
        before, self._open = self._open, connection
        if before is not None:
            with contextlib.suppress(RuntimeError):  # it is closed already
                await before.close(_OTHER_WINDOW)
        waiting: asyncio.Queue[Message] = asyncio.Queue()
        loop = asyncio.get_running_loop()

        def tell(message: Message) -> None:
            with contextlib.suppress(RuntimeError):  # the server has ended
                loop.call_soon_threadsafe(waiting.put_nowait, message)

        self._bench.connect(tell)
        sending = asyncio.create_task(_send(connection, waiting))
        try:
            while True:
                self._bench.receive(_read(await connection.receive_text()))
        except WebSocketDisconnect:
            pass
        finally:
            sending.cancel()
            if self._open is connection:
                self._open = None


async def _send(connection: WebSocket, waiting: asyncio.Queue[Message]) -> None:
    """Send messages as they come."""
    with contextlib.suppress(WebSocketDisconnect, RuntimeError):
        while True:
            await connection.send_text(json.dumps(await waiting.get(), allow_nan=False))


def _read(text: str) -> dict[str, Any]:
    """A message; what is none is one of no kind."""
    try:
        message = json.loads(text)
    except ValueError:
        message = None
    return message if isinstance(message, dict) else {}
