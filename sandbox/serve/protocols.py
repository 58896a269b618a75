"""Bounds on what comes before a whole message: silent connections, pings, messages that never end."""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.frames import Frame

from sandbox.serve.connection import Bucket
from sandbox.serve.limits import HELLO, PARTS, PINGS


class Asking(H11Protocol):
    """A connection over which no whole request has come after HELLO s is closed: a few hundred silent ones would
    otherwise keep everybody out."""

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self.loop.call_later(HELLO, self._close_if_silent)

    def _close_if_silent(self) -> None:
        if self.scope is None and not self.transport.is_closing():
            self.transport.close()


class Talking(WebSocketsSansIOProtocol):
    """A WebSocket that is ended if it sends many pings, whose answers it need not read, or a message in many parts:
    both would be kept in memory."""

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        self._pings = Bucket(PINGS, 10 * PINGS)

    def handle_ping(self) -> None:
        if self._pings.take():
            super().handle_ping()
        else:
            self.transport.abort()

    def handle_cont(self, event: Frame) -> None:
        if len(self.frames) < PARTS:
            super().handle_cont(event)
        else:
            self.transport.abort()

    def send_receive_event_to_app(self) -> None:
        """Pass on a message; one that is no text ends the connection, without a word on the terminal."""
        try:
            if self.curr_msg_data_type == "text":
                b"".join(self.frames).decode()
        except UnicodeDecodeError:
            self.conn.send_close(1007)
            self.handle_parser_exception()
        else:
            super().send_receive_event_to_app()
