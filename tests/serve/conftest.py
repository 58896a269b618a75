"""One server for all tests of serving, as the program starts it, and a player without a browser."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
import zlib
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any, NamedTuple
from urllib.parse import urlsplit

import pytest

from tests.own_scene import COMMAND, HANG

#: The program, with runs that may take long: on a busy machine they do.
PATIENT = COMMAND[-1].replace(
    "import sys;", f"import sys; from sandbox.serve import processes; processes.RUN = {HANG};"
)

pytest.importorskip("starlette", reason="serving is tested with the extra serve")


class Served(NamedTuple):
    """A server that runs, where it is, and a function that ends it and returns its exit code."""

    url: str
    teacher: str
    port: int
    pid: int
    stop: Callable[[], int]


@contextmanager
def serving(*args: str, cwd: Any = None, port: int = 0, state: Any = os.devnull) -> Iterator[Served]:
    """A server of its own process, by default on any port of the loopback and where nothing can be kept."""
    command = [*COMMAND[:-1], PATIENT, "serve", *args, "--port", str(port), "--json"]
    env = os.environ | {"XDG_STATE_HOME": str(state)}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=cwd, env=env)
    said = process.stdout.readline()

    def stop() -> int:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        return process.wait(HANG)

    try:
        address = json.loads(said or "{}") or pytest.fail(process.stderr.read())
        yield Served(address["url"], address["teacher"], address["port"], process.pid, stop)
    finally:
        stop()
        process.stdout.close()
        process.stderr.close()


@pytest.fixture(scope="session")
def server() -> Iterator[Served]:
    with serving("basketball", "golf", "billiards", "free-throw", "--jobs", "1") as server:
        yield server


@pytest.fixture
def served(server: Served) -> Iterator[Served]:
    """The server, where everybody chooses a scene: whatever a test did as teacher, passed or failed, ends with it."""
    yield server
    teacher = Client(server.teacher)
    teacher.say(do="lead", source="")
    teacher.say(do="freeze", on=False)
    while True:
        lead = teacher.hear("room")["lead"]
        if not lead["source"] and not lead["frozen"]:
            break
    teacher.close()


class Client:
    """A player's browser without a window: says what it is told to, and hears the answers."""

    def __init__(self, url: str, **hello: Any):
        from websockets.sync.client import connect

        place = urlsplit(url)
        address, origin = f"ws://{place.netloc}{place.path}talk", f"http://{place.netloc}"
        self._until_closed = ExitStack()
        self.socket = self._until_closed.enter_context(connect(address, origin=origin, proxy=None, max_size=None))
        self.n = 0
        self.say(do="hello", **hello)

    def say(self, **message: Any) -> None:
        self.socket.send(json.dumps(message))

    def ask(self, do: str, changes: dict[str, Any] | None = None, **more: Any) -> int:
        self.n += 1
        self.say(do=do, n=self.n, changes=changes or {}, **more)
        return self.n

    def hear(self, kind: str, within: float = HANG, **wanted: Any) -> dict[str, Any]:
        """The next message of a kind, with these entries."""
        end = time.monotonic() + within
        while True:
            found = self.next(end - time.monotonic())
            if found["is"] == kind and all(found[key] == value for key, value in wanted.items()):
                return found

    def next(self, within: float) -> dict[str, Any]:
        data = self.socket.recv(timeout=max(0.0, within))
        return json.loads(zlib.decompress(data) if isinstance(data, bytes) else data)

    def close(self) -> None:
        self._until_closed.close()


@pytest.fixture
def player(served: Served) -> Iterator[Callable[..., Client]]:
    """Makes players, by default of basketball, or the teacher."""
    made: list[Client] = []

    def enter(teacher: bool = False, url: str = "", **hello: Any) -> Client:
        if not teacher and "session" not in hello:
            hello.setdefault("source", "basketball")
        made.append(Client(url or (served.teacher if teacher else served.url), **hello))
        return made[-1]

    yield enter
    for client in made:
        client.close()


def memory(pid: int) -> int:
    """Resident memory of a process in bytes."""
    with open(f"/proc/{pid}/statm") as file:  # noqa: PTH123
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
