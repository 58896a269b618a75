"""How many can aim at once: headless players over WebSocket, against one server, on this machine's loopback.

``python benchmarks/serve.py``: 30 players, each of whom changes the aim 4 times a second in golf, basketball and
soccer, as the page does: it asks for one path at a time, and then for the newest. A change counts as answered when the
path of it, or of a newer one, is there. Then the same while four of them break a rack again and again; one quiet player
in golf, alone and beside six who ask for paths that take many seconds; and the memory of the server and its processes
over ``--shots`` shots. On a busy machine only the processor time of a path says much, and the quiet player's wait
compared with that alone. Load and time are bounded, three minutes as it stands: ``--players N``, ``--rate PER_SECOND``,
``--seconds S``, ``--shots N``, ``--only SCENE`` or ``--only quiet``.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import subprocess
import sys
import time
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import click
import numpy as np
from websockets.asyncio.client import ClientConnection, connect

SCENES = {"golf": ("launch.angle", 8.0, 20.0), "basketball": ("launch.angle", 45.0, 60.0),
          "soccer": ("launch.angle", 12.0, 25.0)}  # fmt: skip
BREAK, BREAKERS = ("billiards/nine-ball-break", "cue.speed", 7.0, 9.0), 4
#: A ball as light as a balloon in a storm: each path takes many seconds.
SLOW, SLOWER = ("golf", *SCENES["golf"], {"ball.radius": 0.19, "air.wind[0]": -100.0, "air.wind[1]": -14.0}), 6
SHOT = "throws"  # the cheapest
PROMISED = 0.1  # s
PATIENCE = 20.0  # s, for answers to the last changes; what has none by then never had one


@dataclass
class Player:
    """A page without a window."""

    socket: ClientConnection
    source: str
    key: str
    low: float
    high: float
    fixed: dict[str, float] = field(default_factory=dict)  # changes besides
    delays: list[float] = field(default_factory=list)  # s, of each change
    sizes: list[int] = field(default_factory=list)  # bytes of a path
    waiting: list[float] = field(default_factory=list)  # s, when the changes were made that are not answered
    asked: list[float] = field(default_factory=list)  # those that the question under way covers
    n: int = 0

    async def change(self, rate: float, until: float, draw: random.Random) -> None:
        """Change the aim so often, at random times, until a time."""
        while (now := time.monotonic()) < until:
            self.waiting.append(now)
            await self.ask(draw)
            await asyncio.sleep(draw.expovariate(rate))

    async def ask(self, draw: random.Random) -> None:
        if self.asked or not self.waiting:
            return
        self.asked, self.waiting = self.waiting, []
        self.n += 1
        changes = {**self.fixed, self.key: round(draw.uniform(self.low, self.high), 2)}
        await self.socket.send(json.dumps({"do": "path", "n": self.n, "changes": changes}))

    async def hear(self, draw: random.Random) -> None:
        """Read answers, to the end of the connection."""
        async for data in self.socket:
            message = json.loads(zlib.decompress(data) if isinstance(data, bytes) else data)
            if message["is"] in ("path", "error") and message["n"] == self.n and self.asked:
                now = time.monotonic()
                self.delays += [now - asked for asked in self.asked]
                self.sizes.append(len(data))
                self.asked = []
                await self.ask(draw)


async def entered(
    url: str, source: str, key: str, low: float, high: float, fixed: dict[str, float] | None = None
) -> Player:
    place = urlsplit(url)
    address, origin = f"ws://{place.netloc}{place.path}talk", f"http://{place.netloc}"
    socket = await connect(address, origin=origin, proxy=None, max_size=None)
    await socket.send(json.dumps({"do": "hello", "source": source}))
    await socket.send(json.dumps({"do": "path", "n": 0, "changes": {}}))
    async for data in socket:  # until what computes for this player is there
        if isinstance(data, bytes):
            break
    return Player(socket, source, key, low, high, fixed or {})


async def aiming(
    url: str, players: int, rate: float, seconds: float, scene: str, others: Sequence[tuple[Any, ...]] = ()
) -> list[Player]:
    """So many players who aim, besides the ``others``."""
    draw = random.Random(1)
    there = [await entered(url, *kind) for kind in [*others, *[(scene, *SCENES[scene])] * players]]
    reading = [asyncio.create_task(player.hear(draw)) for player in there]
    until = time.monotonic() + seconds
    await asyncio.gather(*(player.change(rate, until, draw) for player in there))
    while (
        any(player.asked or player.waiting for player in there[len(others) :]) and time.monotonic() < until + PATIENCE
    ):
        await asyncio.sleep(0.05)
    for player in there:
        player.delays += [inf] * len([*player.asked, *player.waiting])
        await player.socket.close()
    await asyncio.gather(*reading, return_exceptions=True)
    return there[len(others) :]


def row(what: str, players: list[Player], cpu: float | None) -> str:
    """Return a row of the table: how long players waited; ``cpu`` is the processor time of the server and its
    processes in s, None where others had a part of it."""
    delays = np.array([delay for player in players for delay in player.delays])
    kilobytes = np.mean([size for player in players for size in player.sizes]) / 1e3
    within = 100 * np.mean(delays <= PROMISED)
    quantiles = " | ".join(f"{1e3 * np.quantile(delays, share):.0f} ms" for share in (0.5, 0.95, 0.99))
    each = "–" if cpu is None else f"{1e3 * cpu / sum(len(player.sizes) for player in players):.1f} ms"
    return f"| {what} | {len(delays)} | {within:.1f} % | {quantiles} | {kilobytes:.1f} kB | {each} |"


async def shooting(url: str, shots: int, pids: list[int]) -> list[tuple[int, float]]:
    """Shots one after the other by eight players, and the memory in MB of the server's processes on the way."""
    seen, left, players = [(0, memory(pids))], shots, 8
    marks = {shots * share // 5 for share in range(1, 6)}

    async def shoot() -> None:
        nonlocal left
        player = await entered(url, SHOT, "launch.angle", 30.0, 50.0)
        n = 0
        while left > 0:
            left -= 1
            n += 1
            await player.socket.send(json.dumps({"do": "shoot", "n": n, "changes": {"launch.angle": 30 + n % 20}}))
            async for data in player.socket:
                if isinstance(data, bytes) and json.loads(zlib.decompress(data))["is"] == "shot":
                    break
            if shots - left in marks:
                marks.discard(shots - left)
                seen.append((shots - left, memory(pids)))
        await player.socket.close()

    await asyncio.gather(*(shoot() for _ in range(players)))
    return seen


def memory(pids: list[int]) -> float:
    """Resident memory of processes in MB."""
    pages = sum(int(Path(f"/proc/{pid}/statm").read_text().split()[1]) for pid in pids)
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def processes(pid: int) -> list[int]:
    """A process and those that it has started, as the system numbers them."""
    children = [each.read_text().split() for each in Path(f"/proc/{pid}/task").glob("*/children")]
    return [pid, *(int(child) for each in children for child in each)]


def processor_time(pids: list[int]) -> float:
    """In s, so far."""
    times = (Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13] for pid in pids)
    return sum(int(user) + int(system) for user, system in times) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--players", type=int, default=30)
    parser.add_argument("--rate", type=float, default=4.0)
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--shots", type=int, default=1000)
    parser.add_argument("--only", choices=[*SCENES, "quiet"])
    asked = parser.parse_args()
    sources = [asked.only] if asked.only in SCENES else list(SCENES)
    command = [sys.executable, "-m", "sandbox", "serve", *sources, BREAK[0], SHOT, "--port", "0", "--json"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert server.stdout is not None
        url = json.loads(server.stdout.readline())["url"]
        for scene in sources:  # its processes import what they need
            asyncio.run(aiming(url, 8, asked.rate, 3.0, scene))
        click.echo(f"{asked.players} players, {asked.rate:g} changes a second each, {os.cpu_count()} cores, "
              f"load {os.getloadavg()[0]:.1f} before\n")  # fmt: skip
        click.echo("| | changes | within 100 ms | half | 95 of 100 | 99 of 100 | a path | its processor time |")
        click.echo("|---|---|---|---|---|---|---|---|")
        cases: list[tuple[str, int, str, list[Any]]] = []  # what, players, scene, others
        if asked.only != "quiet":
            cases = [(scene, asked.players, scene, []) for scene in sources]
            if asked.players > BREAKERS:
                breaking = f"{sources[-1]}, while {BREAKERS} break"
                cases.append((breaking, asked.players - BREAKERS, sources[-1], [BREAK] * BREAKERS))
        if "golf" in sources:
            cases.append(("golf, one player", 1, "golf", []))
            cases.append((f"golf, one beside {SLOWER} slow", 1, "golf", [SLOW] * SLOWER))
        for what, count, scene, others in cases:
            pids = processes(server.pid)
            before = processor_time(pids)
            players = asyncio.run(aiming(url, count, asked.rate, asked.seconds, scene, others))
            click.echo(row(what, players, None if others else processor_time(pids) - before))
        if asked.shots:
            seen = asyncio.run(shooting(url, asked.shots, processes(server.pid)))
            click.echo(f"\nmemory: {', '.join(f'{used:.0f} MB after {count:,} shots' for count, used in seen)}")
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main()
