"""The server itself: its address, and its life until Ctrl-C."""

from __future__ import annotations

import asyncio
import os
import socket
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import uvicorn

from sandbox.errors import RequestError
from sandbox.files import reason
from sandbox.scene.discovery import docstring, folder_of, listings_of
from sandbox.serve import calls
from sandbox.serve.app import app_of
from sandbox.serve.limits import CONNECTIONS, MESSAGE, PLAYERS
from sandbox.serve.processes import JobProcesses
from sandbox.serve.protocols import Asking, Talking
from sandbox.serve.room import Listed, Room
from sandbox.serve.tokens import tokens
from sandbox.tasks import find_task, is_task
from sandbox.tasks.file import read_task_file
from sandbox.tasks.games import FOLDER, game_names
from sandbox.tasks.sports import Sport, sports
from sandbox.text import title_of

_LOOPBACK, _ALL = "127.0.0.1", "0.0.0.0"
#: The port that is taken if it is free and no other is asked for, so that addresses stay the same.
_PORT = 8765
#: At the end open connections are given so long, in s.
_GRACE = 1
#: Scenes that every process imports before the first player comes.
_WARMED = 4


class Address(NamedTuple):
    """The server's addresses: that for players, and that for the teacher."""

    url: str
    teacher: str
    port: int
    shared: bool


def _scenes_of(names: Sequence[str]) -> dict[str, Listed]:
    """All that may be played, by the names that list it: of the scenes named, by default of all installed ones
    in the order of their tiles, each with its tasks, games and presets. Raises RequestError. No scene is imported for
    this."""
    known = {sport.name: sport for sport in sports() if not sport.own}
    found: dict[str, Listed] = {}
    for name in names or known:
        if is_task(name):
            sport = find_task(name).parent.parent.name
            found.setdefault(name, _task(name, sport if sport in known else ""))
            continue
        listed = listings_of(name)
        exact = [each for each in listed if each.name == name]
        if not exact:  # a file
            found[name] = Listed(name, listed[0].about)
        elif "/" in name and folder_of(name) is not None:
            found[name] = Listed(name, exact[0].about, "preset")  # which comes alone
        else:
            found |= {each.name: Listed(each.name, each.about, "scene", name) for each in exact}
            if name in known:
                found |= _played_in(known[name])
            presets = (each for each in listed if each.name != name)
            found |= {each.name: Listed(each.name, each.about, "preset", name) for each in presets}
    return found


def _task(name: str, sport: str = "") -> Listed:
    """A task, by its name or file."""
    file = read_task_file(find_task(name))
    return Listed(name, file.goal, "task", sport, title_of(Path(name).stem))


def _played_in(sport: Sport) -> dict[str, Listed]:
    """The tasks of an installed sport, the easiest first, and its games for two."""
    files = sorted(sport.files, key=lambda file: (read_task_file(file).level, file.stem))
    found = {file.stem: _task(file.stem, sport.name) for file in files}
    for game in game_names(sport.folder):
        about = docstring(sport.folder / FOLDER / f"{game.replace('-', '_')}.py")
        found[f"{sport.name}/{FOLDER}/{game}"] = Listed(sport.name, about, "game", sport.name, title_of(game), game)
    return found


@dataclass(frozen=True)
class Options:
    """Options of serving: ``jobs`` is the number of processes that compute, None for the usual; ``fresh`` makes new
    addresses."""

    port: int | None = None
    share: bool = False
    units: str = "si"
    jobs: int | None = None
    fresh: bool = False


def serve(names: Sequence[str], options: Options, ready: Callable[[Address], None]) -> None:
    """Serve these scenes until a signal comes; ``ready`` is called once players can come. Raises RequestError if the
    scenes or the port cannot be used."""
    scenes = _scenes_of(names)
    listener = _listening(options.port, options.share)
    try:
        asyncio.run(_serve(scenes, listener, options, ready))
    finally:
        listener.close()


async def _serve(
    scenes: dict[str, Listed], listener: socket.socket, options: Options, ready: Callable[[Address], None]
) -> None:
    share = options.share
    own = tokens(options.fresh)
    port = listener.getsockname()[1]
    host = _own_address() if share else _LOOPBACK
    hosts = {f"{name}:{port}" for name in (_LOOPBACK, "localhost", host, *([socket.gethostname()] if share else []))}
    sources = dict.fromkeys(each.source for each in list(scenes.values())[:_WARMED] if each.kind != "task")
    processes = JobProcesses(options.jobs, calls.warmed, list(sources))
    try:
        await _checked(processes, scenes)
        room = Room(scenes, processes, options.units)
        config = uvicorn.Config(
            app_of(room, own, hosts), log_config=None, log_level="error", access_log=False, lifespan="off",
            http=Asking, ws=Talking,
            ws_max_size=MESSAGE, ws_max_queue=8, ws_per_message_deflate=False, limit_concurrency=CONNECTIONS,
            timeout_graceful_shutdown=_GRACE, h11_max_incomplete_event_size=MESSAGE, server_header=False,
            proxy_headers=False,
        )  # fmt: skip
        server = uvicorn.Server(config)
        base = f"http://{host}:{port}"
        ready(Address(f"{base}/{own.play}/", f"{base}/{own.teach}/", port, share))
        await server.serve(sockets=[listener])
        raise KeyboardInterrupt  # only a signal ends it, whether or not this process was started to ignore that
    finally:
        processes.close()


async def _checked(processes: JobProcesses, scenes: dict[str, Listed]) -> None:
    """Raise RequestError if the first scene cannot be loaded, before players come."""
    first = next(iter(scenes.values()))
    reply = await processes.compute("first", "", "described", calls.described, first.source, first.kind == "task")
    if reply is not None and "error" in reply:
        raise RequestError(reply["error"])


def _listening(port: int | None, share: bool) -> socket.socket:
    """A socket that listens on the port, by default on PORT or, where that is taken, on any. Raises RequestError."""
    ports = [port] if port is not None else [_PORT, 0]
    for number in ports:
        listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        if os.name == "posix":  # elsewhere it lets two programs have one port
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((_ALL if share else _LOOPBACK, number))
            listener.listen(4 * PLAYERS)
            return listener
        except OSError as error:
            listener.close()
            if number == ports[-1]:
                raise RequestError(f"--port {number}: {reason(error)}") from None
    raise AssertionError


def _own_address() -> str:
    """This machine's address in the network; nothing is sent to find it out."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # reserved for documentation: only the route is looked up
            return str(probe.getsockname()[0])
        except OSError:
            return _LOOPBACK
