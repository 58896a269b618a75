"""Pages and WebSockets: who may come in, and what a browser may do with what it gets."""

from __future__ import annotations

import asyncio
import csv
import hmac
import io
import re
from collections.abc import Collection, Mapping
from contextlib import suppress
from pathlib import Path
from string import Template

from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket

from sandbox import resources
from sandbox.page import templates
from sandbox.serve.choosing import choosing_page, tile_name, tiles_of
from sandbox.serve.connection import REFUSED, Bucket, Connection
from sandbox.serve.limits import ADDRESSES, REQUEST_BURST, REQUESTS
from sandbox.serve.room import Listed, Room
from sandbox.serve.tokens import Tokens
from sandbox.text import csv_text

_HERE = Path(__file__).parent
#: The scripts of each page after those of the player, in order; a page has the name of the last.
_SCRIPTS = {
    "play": ("wire.js", "settings.js", "charts.js", "aim.js", "play.js"),
    "teach": ("wire.js", "settings.js", "charts.js", "teach.js"),
}
_TITLES = {"play": "sports sandbox", "teach": "sports sandbox: the teacher's page"}
_AGAIN = '<button id="again" type="button" title="aim again (Escape)">Aim again</button>\n'
_FONTS = {"regular.ttf": "NotoSans-Regular.ttf", "bold.ttf": "NotoSans-Bold.ttf"}
#: Nothing from elsewhere, no script or style in the page itself, in no frame.
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; font-src 'self'; img-src 'self' data:; "
    "connect-src 'self' ws://$host; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


def app_of(room: Room, tokens: Tokens, hosts: Collection[str]) -> ASGIApp:
    """The application. Only requests to ``hosts``, such as ``127.0.0.1:8765``, are answered."""
    site = _Site(room, tokens)
    routes = [
        WebSocketRoute("/{token}/talk", site.talk),
        Route("/{token}/", site.page, methods=["GET"]),
        Route("/{token}/{name}", site.file, methods=["GET"]),
    ]
    return _Guard(Starlette(routes=routes), frozenset(hosts))


class _Site:
    """The pages, their files and the WebSocket of one room, for those who have a token."""

    def __init__(self, room: Room, tokens: Tokens) -> None:
        self.room, self.tokens, self.files = room, tokens, _files(room.scenes)

    def kind_of(self, request: Request | WebSocket) -> str | None:
        """Return the page whose token the address has; None if it has neither."""
        given, known = request.path_params["token"].encode(), self.tokens._asdict()
        return next((kind for kind, token in known.items() if hmac.compare_digest(given, token.encode())), None)

    def sent(self, name: str) -> Response:
        content, media = self.files[name]
        return Response(content, media_type=media)

    async def page(self, request: Request) -> Response:
        """The page of players or of the teacher."""
        kind = self.kind_of(request)
        return _nothing() if kind is None else self.sent(f"{kind}.html")

    async def file(self, request: Request) -> Response:
        """A script, a style or a font; for the teacher the table of shots."""
        kind, name = self.kind_of(request), request.path_params["name"]
        if kind == "teach" and name == "shots.csv":
            return Response(_csv(self.room), media_type="text/csv; charset=utf-8",
                            headers={"Content-Disposition": 'attachment; filename="shots.csv"'})  # fmt: skip
        shot = re.fullmatch(r"shot-(\d{1,9})\.webp", name)
        if kind == "teach" and shot is not None:
            picture = await self.room.small_picture(int(shot[1]))
            return Response(status_code=204) if picture is None else Response(picture, media_type="image/webp")
        if kind is None or name not in self.files or name.endswith(".html"):
            return _nothing()
        return self.sent(name)

    async def talk(self, socket: WebSocket) -> None:
        """Follow the connection of a player or the teacher to its end."""
        kind = self.kind_of(socket)
        origin, host = socket.headers.get("origin", ""), socket.headers.get("host", "")
        if kind is None or origin != f"http://{host}":
            await socket.close(REFUSED)
            return
        await socket.accept()
        connection = Connection(socket)
        writing = asyncio.create_task(connection.write())
        try:
            await (self.room.teach(connection) if kind == "teach" else self.room.play(connection))
        finally:
            connection.is_open = False
            writing.cancel()
            with suppress(asyncio.CancelledError):
                await writing


class _Guard:
    """Answers only requests to the known hosts, so that no other site's name can lead here, and of one address at no
    more than a rate; and sets the headers."""

    def __init__(self, app: ASGIApp, hosts: Collection[str]) -> None:
        self.app, self.hosts = app, hosts
        self.rates: dict[str, Bucket] = {}  # by address, the latest last

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        host = Headers(scope=scope).get("host", "")
        refused = None if self._may((scope.get("client") or ("",))[0]) else _too_many()
        if host not in self.hosts:
            refused = _nothing()
        if refused is not None:
            if scope["type"] == "websocket":
                await receive()
                await send({"type": "websocket.close", "code": REFUSED})
            else:
                await refused(scope, receive, send)
            return

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                policy = Template(_POLICY).substitute(host=host)
                more = {**_HEADERS, "Content-Security-Policy": policy}
                message["headers"] = [
                    *message["headers"],
                    *((name.lower().encode(), value.encode()) for name, value in more.items()),
                ]
            await send(message)

        await self.app(scope, receive, with_headers)

    def _may(self, address: str) -> bool:
        """True if a request of this address may be answered now."""
        rate = self.rates.pop(address) if address in self.rates else Bucket(REQUESTS, REQUEST_BURST)
        self.rates[address] = rate
        while len(self.rates) > ADDRESSES:
            del self.rates[next(iter(self.rates))]
        return rate.take()


def _too_many() -> Response:
    headers = {"Retry-After": "5", "Connection": "close"}
    return PlainTextResponse(f"Too many requests: more than {REQUESTS:g} a second.\n", 429, headers)


def _nothing() -> Response:
    return PlainTextResponse("There is nothing here. The whole address is needed, with its token.\n", 404)


def _files(scenes: Mapping[str, Listed]) -> dict[str, tuple[bytes, str]]:
    """All files that are ever sent, by name, with their types: no path of a request reaches the disk."""
    scripts = {
        f"{page}.js": "\n".join([*map(templates.source, templates.PLAYER), *map(_source, names)])
        for page, names in _SCRIPTS.items()
    }
    fonts = {name: (resources.folder("assets") / "fonts" / font).read_bytes() for name, font in _FONTS.items()}
    style = templates.source("page.css") + _source("serve.css")
    tiles = tiles_of(scenes)
    return {
        **{f"{page}.html": (_page(page, scenes).encode(), "text/html") for page in _SCRIPTS},
        **{name: (script.encode(), "text/javascript") for name, script in scripts.items()},
        **{name: (font, "font/ttf") for name, font in fonts.items()},
        **{tile_name(sport): (picture, "image/jpeg") for sport, picture in tiles.items()},
        "serve.css": (style.encode(), "text/css"),
    }


def _page(page: str, scenes: Mapping[str, Listed]) -> str:
    """The page of players or of the teacher."""
    choosing = choosing_page(scenes) if page == "play" else ""
    content = templates.with_player(_source(f"{page}.html"), _AGAIN, choosing=choosing)
    return templates.framed(
        _TITLES[page],
        Template(_source("head.html")).substitute(script=f"{page}.js"),
        Template(_source("main.html")).substitute(page=page, content=content),
    )


def _source(name: str) -> str:
    return (_HERE / name).read_text("utf-8")


def _csv(room: Room) -> str:
    """The teacher's table; what people wrote is never taken for a formula."""
    out = io.StringIO()
    head, rows = room.table()
    writer = csv.writer(out)
    writer.writerow(head)
    writer.writerows([[csv_text(cell) if isinstance(cell, str) else cell for cell in row] for row in rows])
    return out.getvalue()
