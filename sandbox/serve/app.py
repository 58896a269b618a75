"""Pages and WebSockets: who may come in, and what a browser may do with what it gets."""

from __future__ import annotations

import asyncio
import csv
import hmac
import io
from collections.abc import Collection
from contextlib import suppress
from pathlib import Path
from string import Template
from typing import NamedTuple

from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket

from sandbox import resources
from sandbox.serve.connection import REFUSED, Connection
from sandbox.serve.room import Room
from sandbox.text import csv_text

HERE = Path(__file__).parent
PAGES = resources.PACKAGE / "page"
#: The scripts of each page, in order.
SCRIPTS = {
    "play.js": (*(PAGES / name for name in ("page.js", "paths.js", "player.js")),
                *(HERE / name for name in ("wire.js", "aim.js", "settings.js", "play.js"))),
    "teach.js": (*(PAGES / name for name in ("page.js", "paths.js", "player.js")),
                 *(HERE / name for name in ("wire.js", "aim.js", "settings.js", "teach.js"))),
}  # fmt: skip
FONTS = {"regular.ttf": "NotoSans-Regular.ttf", "bold.ttf": "NotoSans-Bold.ttf"}
#: Nothing from elsewhere, no script or style in the page itself, in no frame.
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; font-src 'self'; img-src data:; "
    "connect-src 'self' ws://$host; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Tokens(NamedTuple):
    """What must be in the address: of players and of the teacher."""

    players: str
    teacher: str


def app_of(room: Room, tokens: Tokens, hosts: Collection[str]) -> ASGIApp:
    """The application. Only requests to ``hosts``, such as ``127.0.0.1:8765``, are answered."""
    files = _files()

    def is_known(request: Request | WebSocket) -> str | None:
        """Which of the two tokens the address has."""
        given = request.path_params["token"].encode()
        return next(
            (kind for kind, token in tokens._asdict().items() if hmac.compare_digest(given, token.encode())), None
        )

    async def page(request: Request) -> Response:
        kind = is_known(request)
        if kind is None:
            return _nothing()
        return Response(files["play.html" if kind == "players" else "teach.html"][0], media_type="text/html")

    async def file(request: Request) -> Response:
        kind, name = is_known(request), request.path_params["name"]
        if kind == "teacher" and name == "shots.csv":
            return Response(_csv(room), media_type="text/csv; charset=utf-8",
                            headers={"Content-Disposition": 'attachment; filename="shots.csv"'})  # fmt: skip
        if kind is None or name not in files or name.endswith(".html"):
            return _nothing()
        content, media = files[name]
        return Response(content, media_type=media)

    async def talk(socket: WebSocket) -> None:
        kind = is_known(socket)
        origin, host = socket.headers.get("origin", ""), socket.headers.get("host", "")
        if kind is None or origin != f"http://{host}":
            await socket.close(REFUSED)
            return
        await socket.accept()
        connection = Connection(socket)
        writing = asyncio.create_task(connection.write())
        try:
            await (room.teach(connection) if kind == "teacher" else room.play(connection))
        finally:
            connection.is_open = False
            writing.cancel()
            with suppress(asyncio.CancelledError):
                await writing

    routes = [
        WebSocketRoute("/{token}/talk", talk),
        Route("/{token}/", page, methods=["GET"]),
        Route("/{token}/{name}", file, methods=["GET"]),
    ]
    return _Guard(Starlette(routes=routes), frozenset(hosts))


class _Guard:
    """Answers only requests to the known hosts, so that no other site's name can lead here; and sets the headers."""

    def __init__(self, app: ASGIApp, hosts: Collection[str]) -> None:
        self.app, self.hosts = app, hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        host = Headers(scope=scope).get("host", "")
        if host not in self.hosts:
            if scope["type"] == "websocket":
                await receive()
                await send({"type": "websocket.close", "code": REFUSED})
            else:
                await _nothing()(scope, receive, send)
            return

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                policy = Template(POLICY).substitute(host=host)
                more = {**HEADERS, "Content-Security-Policy": policy}
                message["headers"] = [
                    *message["headers"],
                    *((name.lower().encode(), value.encode()) for name, value in more.items()),
                ]
            await send(message)

        await self.app(scope, receive, with_headers)


def _nothing() -> Response:
    return PlainTextResponse("There is nothing here. The whole address is needed, with its token.\n", 404)


def _files() -> dict[str, tuple[bytes, str]]:
    """All files that are ever sent, by name, with their types: no path of a request reaches the disk."""
    found = {name: (b"\n".join(map(Path.read_bytes, parts)), "text/javascript") for name, parts in SCRIPTS.items()}
    style = (PAGES / "page.css").read_bytes() + (HERE / "serve.css").read_bytes()
    found |= {
        name: ((resources.folder("assets") / "fonts" / font).read_bytes(), "font/ttf") for name, font in FONTS.items()
    }
    found |= {name: ((HERE / name).read_bytes(), "text/html") for name in ("play.html", "teach.html")}
    return found | {"serve.css": (style, "text/css")}


def _csv(room: Room) -> str:
    """The teacher's table; what people wrote is never taken for a formula."""
    out = io.StringIO()
    head, rows = room.table()
    writer = csv.writer(out)
    writer.writerow(head)
    writer.writerows([[csv_text(cell) if isinstance(cell, str) else cell for cell in row] for row in rows])
    return out.getvalue()
