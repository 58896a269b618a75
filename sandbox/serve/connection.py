"""One browser: its messages come at a limited rate, and it gets the newest of each kind, so that one that does not read
costs no memory."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from time import monotonic
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from sandbox.files import json_text
from sandbox.serve.limits import BURST, FLOOD, RATE, TOLD, UNREAD

#: Codes with which a connection is closed, as the standard of WebSockets has them.
REFUSED, LATER = 1008, 1013


class Bucket:
    """Lets through so many a second, and so many at once."""

    def __init__(self, rate: float, burst: float) -> None:
        self.rate, self.burst, self.left, self.last = rate, burst, burst, monotonic()

    def take(self) -> bool:
        """True if one more may pass now."""
        now = monotonic()
        self.left = min(self.burst, self.left + self.rate * (now - self.last))
        self.last = now
        if self.left < 1.0:
            return False
        self.left -= 1.0
        return True


class Connection:
    """A WebSocket that was accepted. ``send`` never waits."""

    def __init__(self, socket: WebSocket) -> None:
        self._socket = socket
        self._waiting: dict[str, str | bytes] = {}  # the newest of each kind
        self._news = asyncio.Event()
        self._rate, self._told = Bucket(RATE, BURST), Bucket(TOLD, 2 * TOLD)
        self._dropped = 0
        self.is_open = True

    def send(self, kind: str, message: bytes | Mapping[str, Any]) -> None:
        """Send a message, in place of an unsent one of its kind: packed, or as a table."""
        if self.is_open:
            text = message if isinstance(message, bytes) else json_text({"is": kind, **message})
            self._waiting.pop(kind, None)
            self._waiting[kind] = text
            self._news.set()

    def tell(self, line: str, n: int | None = None) -> None:
        """Tell the player that something was refused, in a line."""
        if self._told.take():
            self.send("error", {"text": line, "n": n})

    async def receive(self, within: float | None = None) -> str | None:
        """The next message that came at no more than the rate; None at the end of the connection, which is closed if
        none comes ``within`` s."""
        while self.is_open:
            try:
                message = await asyncio.wait_for(self._socket.receive(), within)
            except TimeoutError:
                await self.close(REFUSED, "no hello came")
                break
            except (WebSocketDisconnect, RuntimeError):
                break
            if message["type"] == "websocket.disconnect":
                break
            text = message.get("text")
            if self._rate.take():
                self._dropped = 0 if self._rate.left > BURST / 2 else self._dropped
                if text is not None:
                    return str(text)
                self.tell("message refused: only text is read")
                continue
            self._dropped += 1
            self.tell(f"more than {RATE:g} messages a second: some were not read")
            if self._dropped > FLOOD:
                await self.close(REFUSED, f"more than {RATE:g} messages a second, for too long")
        self.is_open = False
        self._news.set()
        return None

    async def write(self) -> None:
        """Send what is waiting, until the end of the connection."""
        while True:
            await self._news.wait()
            if not self.is_open:
                return
            self._news.clear()
            while self._waiting and self.is_open:
                kind = next(iter(self._waiting))
                message = self._waiting.pop(kind)
                try:
                    if isinstance(message, bytes):
                        await asyncio.wait_for(self._socket.send_bytes(message), UNREAD)
                    else:
                        await asyncio.wait_for(self._socket.send_text(message), UNREAD)
                except TimeoutError:
                    await self.close(LATER, f"nothing was read for {UNREAD:g} s")
                except (WebSocketDisconnect, RuntimeError, OSError):
                    self.is_open = False

    async def close(self, code: int, reason: str) -> None:
        """Close the connection, even to a browser that does not read."""
        self.is_open = False
        self._news.set()
        with suppress(TimeoutError, RuntimeError, OSError, WebSocketDisconnect):
            await asyncio.wait_for(self._socket.close(code, reason), 1.0)
