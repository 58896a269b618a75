"""Attacks on the server, of a bounded number: it refuses them in a line or closes the connection, and plays on."""

from __future__ import annotations

import asyncio
import json
import re
import socket
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any
from urllib.parse import urlsplit

import pytest
import uvicorn
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from sandbox.serve import app, connection, limits, messages, room
from sandbox.serve.connection import Connection
from sandbox.serve.protocols import Talking
from sandbox.serve.tokens import Tokens
from tests.own_scene import HANG
from tests.serve.conftest import Client, Served, memory


def fetched(url: str, **headers: str) -> tuple[int, Any, bytes]:
    """Status, headers and content that a request gets."""
    try:
        with urllib.request.urlopen(urllib.request.Request(url, headers=headers)) as found:
            return found.status, found.headers, found.read()
    except urllib.error.HTTPError as error:
        return error.code, error.headers, error.read()


def handshake(host: str, path: str) -> bytes:
    """The request for a WebSocket, as it is sent."""
    headers = {"Host": host, "Upgrade": "websocket", "Connection": "Upgrade", "Origin": f"http://{host}",
               "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==", "Sec-WebSocket-Version": "13"}  # fmt: skip
    lines = [f"GET {path}talk HTTP/1.1", *(f"{name}: {value}" for name, value in headers.items())]
    return "\r\n".join([*lines, "", ""]).encode()


def reason_for_closing(client: Client) -> Any:
    """The code and the reason with which the server closes a connection."""
    while True:
        try:
            client.next(HANG)
        except ConnectionClosed as closed:
            return closed.rcvd


def plays_on(client: Client) -> None:
    """A player is still answered."""
    assert client.hear("path", n=client.ask("path"))["run"]["verdict"]


# Who may come in ----------------------------------------------------------------------------------------------------


def test_only_the_whole_address_leads_in(served: Served):
    base = f"http://127.0.0.1:{served.port}"
    assert fetched(served.url)[0] == fetched(served.teacher)[0] == 200
    for path in ("/", "/x/", served.url[len(base) : -2] + "/", "/x/talk", "/x/play.js", "/x/shots.csv", "/%2e%2e/"):
        assert fetched(base + path)[0] == 404, path
    for name in ("shots.csv", "play.html", "../serve/app.py", "%2e%2e%2fapp.py", "app.py", "..%5capp.py"):
        assert fetched(served.url + name)[0] == 404, name
    assert fetched(served.url + "play.js")[0] == fetched(served.teacher + "shots.csv")[0] == 200


def test_other_hosts_and_sites_are_refused(served: Served):
    assert fetched(served.url, Host=f"evil.example:{served.port}")[0] == 404
    place = urlsplit(served.url)
    for origin in ("http://evil.example", f"http://localhost:{served.port}", "null", None):
        with (
            pytest.raises(InvalidStatus) as refused,
            connect(f"ws://{place.netloc}{place.path}talk", origin=origin, proxy=None),
        ):
            pass
        assert refused.value.response.status_code == 403
    address = f"ws://{place.netloc}/{'x' * 12}/talk"
    with pytest.raises(InvalidStatus), connect(address, origin=f"http://{place.netloc}", proxy=None):
        pass


def test_pages_allow_no_script_of_others(served: Served):
    for url in (served.url, served.teacher):
        _, headers, page = fetched(url)
        policy = headers["Content-Security-Policy"]
        assert "default-src 'none'; script-src 'self'; style-src 'self'" in policy
        assert "unsafe" not in policy
        assert (headers["X-Content-Type-Options"], headers["Referrer-Policy"]) == ("nosniff", "no-referrer")
        assert not re.search(rb"<script(?! src=)|<style|\bon\w+=|\bstyle=|javascript:", page)
    scripts = b"".join(content for content, kind in app._files({}).values() if kind == "text/javascript")
    assert not re.search(rb"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function", scripts)


# What may be said ---------------------------------------------------------------------------------------------------

MALFORMED = [
    "", "x", "{", "[]", "null", '"hello"', "[" * 5000, '{"do":' * 2000, "\0", '{"do":"hello"}',
    '{"do":"lead","source":"golf"}',
    '{"do":"path"}', '{"do":"path","n":-1,"changes":{}}', '{"do":"path","n":1,"changes":{"launch.speed":NaN}}',
    '{"do":"path","n":1,"changes":{"launch.speed":1e999}}', '{"do":"path","n":1,"changes":[]}',
    '{"do":"path","n":1,"changes":{},"more":1}', '{"do":"path","n":1,"changes":{"launch.speed":{"x":1}}}',
    '{"do":"path","n":1,"changes":{},"room":[0,1e9]}', '{"do":"present","n":1,"number":1}',
    '{"do":"path","n":1,"changes":{"air.wind":[1,2]}}', '{"do":"path","n":true,"changes":{}}',
    json.dumps({"do": "name", "name": "x" * 5000}),
    json.dumps({"do": "path", "n": 1, "changes": {f"k{i}": 1 for i in range(201)}}),
]  # fmt: skip


def test_malformed_messages_are_refused(player):
    with pytest.raises(Exception, match="message refused"):
        messages.read("x")
    for text in MALFORMED:
        if text != '{"do":"hello"}':
            with pytest.raises(messages.RequestError):
                messages.read(text)
    client = player()
    client.hear("scene")
    client.socket.send(b"\xff\xfe")
    assert "only text" in client.hear("error")["text"]
    for text in MALFORMED:
        client.socket.send(text)
    assert "refused" in client.hear("error")["text"]
    plays_on(client)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"launch.speed": 1e6}, "launch.speed: must be a number from 0 to "),
        ({"launch.speed": "7 m/s"}, "launch.speed: must be a number from 0 to "),
        ({"launch.speed": True}, "launch.speed: must be a number from 0 to "),
        ({"<script>alert(1)</script>": 1}, "<script>alert(1)</script>: cannot be changed here"),
        ({"accuracy.step": 1e-6}, "accuracy.step: cannot be changed here"),
        ({"ball.drag.model": "<img src=x onerror=alert(1)>"}, "ball.drag.model: cannot be changed here"),
        ({"accuracy.level": "__import__('os')"}, "accuracy.level: choose from fast, balanced, precise"),
        ({"net.slows": 1.0}, "net.slows: choose from False, True"),
    ],
)
def test_only_parameters_within_bounds_are_taken(player, changes: dict[str, Any], expected: str):
    client = player()
    client.hear("scene")
    client.ask("path", changes)
    assert client.hear("error")["text"].startswith(expected)
    plays_on(client)


def test_only_scenes_that_are_served_are_played(player):
    client = player(source="../../etc/passwd")
    assert "not played here" in client.hear("error")["text"]
    assert client.hear("scene")["source"] == "basketball"
    for source in ("soccer", "/etc/passwd", "golf/../soccer"):  # of more a player is not told at once
        client.say(do="play", source=source)
        assert "not played here" in client.hear("error")["text"]


def test_names_are_one_short_line():
    assert messages.named("  <b>Ann\nx\x1b[31m " + "é" * 30) == "<b>Ann x[31m ééééééé"
    for name in ("a" * 100, "\u202e" * 5 + "x", "a\nb\tc", "\0\1\2", "  "):
        shown = messages.named(name)
        assert len(shown) <= limits.NAME
        assert shown.isprintable()


def test_a_message_that_is_too_long_ends_the_connection(player):
    client, other = player(), player()
    client.socket.send("x" * (limits.MESSAGE + 1))
    assert reason_for_closing(client).code == 1009  # message too big, says RFC 6455
    plays_on(other)


@contextmanager
def opened(served: Served, request: bytes) -> Iterator[socket.socket]:
    """A connection after its handshake: what comes before that is not read."""
    with socket.create_connection(("127.0.0.1", served.port), HANG) as line:
        line.sendall(request)
        answer = b""
        while b"\r\n\r\n" not in answer:
            answer += line.recv(1)
        assert b" 101 " in answer
        yield line


def sent(line: socket.socket, data: bytes) -> int:
    """How much of the data is taken: none of it once the connection is closed."""
    try:
        line.sendall(data)
    except OSError:
        return 0
    return len(data)


@pytest.mark.parametrize("frame", [b"\x89\xfd\0\0\0\0" + b"x" * 125, b"\x00\x80\0\0\0\0"], ids=["pings", "parts"])
def test_frames_that_are_no_messages_cost_no_memory(served: Served, player, frame: bytes):
    """Pings whose answers are not read, and a message of empty parts that never ends: 60 MB of them."""
    place, other = urlsplit(served.url), player()
    before = memory(served.pid)
    with opened(served, handshake(place.netloc, place.path)) as line:
        line.sendall(b"\x01\x80\0\0\0\0" if frame[0] == 0 else frame)
        assert sum(sent(line, frame * (60_000 // len(frame))) for _ in range(1000)) < 30e6  # it is closed before
    assert memory(served.pid) - before < 5e6
    plays_on(other)


def test_frames_that_break_the_protocol_end_the_connection(served: Served, player):
    """No mask, reserved bits, a length that never comes, half a request, no request at all."""
    place, other = urlsplit(served.url), player()
    request = handshake(place.netloc, place.path)
    for attack in (b"\x00" * 5000, b"GET / HTTP/1.1\r\nX: " + b"x" * 40_000):
        with socket.create_connection(("127.0.0.1", served.port), 10) as line:
            line.sendall(attack)
            line.shutdown(socket.SHUT_WR)
            while line.recv(4096):  # until it is closed
                pass
    for frames, code in (
        (b"\x81\x05hello", 1002),  # without a mask
        (b"\xff\x80\0\0\0\0", 1002),
        (b"\x83\x80\0\0\0\0", 1002),
        (b"\x81\x82\0\0\0\0\xff\xff", 1007),  # no text
        (b"\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 1009),  # 8 EiB are announced
    ):
        with opened(served, request) as line:
            line.sendall(frames)
            said = line.recv(4096)
            assert (said[0], int.from_bytes(said[2:4], "big")) == (0x88, code)
    plays_on(other)


def test_a_flood_is_bounded(served: Served, player):
    """Twenty times the rate: some are not read, the connection is closed in the end, others play on."""
    other, client = player(), player()
    client.hear("scene")
    before = memory(served.pid)
    text = json.dumps({"do": "path", "n": 1, "changes": {}})
    with suppress(ConnectionClosed):
        for _ in range(3 * limits.FLOOD):
            client.socket.send(text)
    closed = reason_for_closing(client)
    assert closed.code == connection.REFUSED
    assert "messages a second" in closed.reason
    plays_on(other)
    assert memory(served.pid) - before < 20e6


def test_requests_of_one_address_are_answered_at_a_rate(monkeypatch: pytest.MonkeyPatch):
    """Those of others are answered meanwhile; and not more addresses are remembered than that."""
    monkeypatch.setattr(app, "REQUEST_BURST", 3)
    monkeypatch.setattr(app, "REQUESTS", 1e-9)
    monkeypatch.setattr(app, "ADDRESSES", 5)
    guard = app._Guard(app.PlainTextResponse("page"), ["here"])
    answered: list[int] = []

    async def send(message: Any) -> None:
        if "status" in message:
            answered.append(message["status"])

    async def ask(address: str) -> int:
        headers = [(b"host", b"here")]
        await guard({"type": "http", "method": "GET", "headers": headers, "client": (address, 1)}, None, send)  # type: ignore[arg-type]
        return answered[-1]

    assert [asyncio.run(ask("one")) for _ in range(5)] == [200, 200, 200, 429, 429]
    assert asyncio.run(ask("two")) == 200
    for number in range(20):
        asyncio.run(ask(str(number)))
    assert len(guard.rates) == 5


def test_a_client_that_never_reads_is_disconnected(monkeypatch: pytest.MonkeyPatch):
    """Over a real connection: as much as the system's buffers take is sent, the newest of each kind waits, then it is
    over."""
    monkeypatch.setattr(connection, "UNREAD", 0.3)
    kept: list[int] = []
    over = asyncio.Event()

    class Talkative:
        scenes: dict[str, Any] = {}

        async def play(self, there: Connection) -> None:
            while there.is_open:
                for kind in 20 * ("room", "path"):
                    there.send(kind, b"x" * 500_000)
                kept.append(len(there._waiting))
                await asyncio.sleep(0.01)
            over.set()

    async def play() -> None:
        with socket.socket() as listener:
            listener.bind(("127.0.0.1", 0))
            listener.listen()
            host = f"127.0.0.1:{listener.getsockname()[1]}"
            made = app.app_of(Talkative(), Tokens("players", "teacher"), [host])  # type: ignore[arg-type]
            server = uvicorn.Server(uvicorn.Config(made, log_config=None, lifespan="off", ws=Talking))
            serving = asyncio.create_task(server.serve(sockets=[listener]))
            reader, writer = await asyncio.open_connection(*host.split(":"), limit=1024)
            writer.write(handshake(host, "/players/"))
            await asyncio.wait_for(over.wait(), HANG)
            writer.close()
            server.should_exit = True
            await serving

    asyncio.run(play())
    assert max(kept) <= 2


def test_a_full_room_says_so():
    made = room.Room({"drop": room.Listed("drop", "")}, None, "si")  # type: ignore[arg-type]
    for number in range(limits.PLAYERS):
        made.players[str(number)] = room.Player(number, str(number), "", "drop", {}, connection=object())  # type: ignore[arg-type]
    closed = []

    class Late:
        async def close(self, code: int, reason: str) -> None:
            closed.append(reason)

    assert asyncio.run(made._enter(Late(), messages.Hello(do="hello"))) is None  # type: ignore[arg-type]
    assert closed == [f"the room is full: {limits.PLAYERS} players"]
