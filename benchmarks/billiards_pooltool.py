"""The same billiard shots here and in pooltool 0.6.0: final positions, and the time of a break and a cut shot.

Run ``python benchmarks/billiards_pooltool.py --pooltool .venv/pooltool/bin/python [--json F] [--repeats N] [--cold]
[--quick]``.

pooltool's pinned dependencies conflict with each other, so it has its own virtual environment, with the same Python as
ours: ``make .venv/pooltool/ready`` creates it.

This program runs it in a persistent process, one shot at a time and alternating with ours, so that other load affects
both. Both get the same balls, cloth and positions, the same velocity and spin just after the stroke, and
speed-dependent friction between balls (Alciatore). They differ in:

- Friction of two balls: its impulse is mu times the normal impulse, (1 + e) v / 2 per kg. pooltool uses mu times the
  speed of separation, e v: 2.5 % less at e = 0.95. The column "at e = 1" shows the difference without this effect.
- Cuts: pooltool moves two balls to 0.001 mm apart before the impulse, which turns the line of centres slightly.
- Cushions: pooltool's default is a compliant nose above the ball's centre, after Stronge: it holds the ball down,
  absorbs more of its roll and is elastic along its surface. Ours touches the ball at its centre, with restitution and
  friction.
- Simultaneous impacts: pooltool resolves them one by one, ours all at once.

Times are processor times, medians of interleaved repeats. The limit is the cost of resolving the impacts with pymunk:
one bare step of a Space with two touching balls for each of our impacts. The motion between them, which has closed
forms, is counted as free.

Cold is a new process whose first shot is the break: import and first shot. pooltool compiles its functions once per
installation and caches them; ``--cold`` also measures that with an empty cache, which takes most of a minute.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass, replace
from math import cos, hypot, radians, sin
from pathlib import Path
from statistics import median
from time import thread_time
from timeit import timeit
from typing import Any

R = 0.028575  # m
NAMES = {"ours": "ours, balanced", "pooltool": "pooltool 0.6.0"}
CLEAR, TABLE = (20.0, 10.0), (2.54, 1.27)  # m; the first is so large that no ball reaches a cushion


@dataclass(frozen=True)
class Shot:
    """Balls in m, from the table's centre; the cue ball's stroke; and the cause of differences."""

    name: str
    balls: dict[str, tuple[float, float]]
    speed: float  # m/s
    angle: float = 0.0  # deg
    follow: float = 0.0  # radii
    english: float = 0.0  # radii
    table: tuple[float, float] = CLEAR
    pockets: bool = False
    restitution: float = 0.95  # of ball and ball
    why: str = "friction of two balls"


def shots() -> list[Shot]:
    """Stop, draw, follow, cuts and rails; the break is last."""
    straight = {"cue": (-8.6, 0.0), "1": (-8.0, 0.0)}
    found = [
        Shot("stop", straight, 2.5, follow=-0.196),
        Shot("draw", straight, 2.5, follow=-0.45),
        Shot("follow", straight, 1.0, follow=0.4),
        Shot("stun, right english", straight, 1.5, follow=-0.2, english=0.3),
    ]
    found += [Shot(f"cut {cut:g} deg, rolling", _cut(cut), 1.0, follow=0.4) for cut in (15.0, 30.0, 45.0, 60.0)]
    found.append(Shot("cut 30 deg, draw", _cut(30.0), 2.0, follow=-0.4))
    nose = "cushion"
    found += [
        Shot("rail head-on, rolling", {"cue": (0.8, 0.1)}, 1.0, follow=0.4, table=TABLE, why=nose),
        Shot("rail head-on, sliding", {"cue": (1.1, 0.1)}, 1.0, table=TABLE, why=nose),
        Shot("rail head-on, english", {"cue": (0.8, 0.1)}, 1.0, english=0.3, table=TABLE, why=nose),
        Shot("rail at 45 deg, rolling", {"cue": (0.9, -0.3)}, 1.0, angle=45.0, follow=0.4, table=TABLE, why=nose),
    ]
    return found


def _cut(degrees: float) -> dict[str, tuple[float, float]]:
    """The cue ball moves along x and hits the other ball, at the cut angle, at the origin."""
    return {"cue": (-0.6, 0.0), "1": (2.0 * R * cos(radians(degrees)), 2.0 * R * sin(radians(degrees)))}


def rack() -> Shot:
    """A nine-ball break at 8 m/s, from the rack of our scene."""
    import sandbox

    balls = {ball.name: ball.position for ball in sandbox.load("billiards", {"rack": "nine-ball"}).build().balls}
    return Shot("nine-ball break", balls | {"cue": (-0.635, 0.2)}, 8.0, angle=-8.938, table=TABLE, pockets=True)


# ----------------------------------------------------------------------------------------------------------------- ours


def our_setup(shot: Shot) -> Any:
    """Our setup of a shot."""
    import sandbox

    scene = sandbox.load(
        "billiards",
        {
            "rack": "none",
            "balls": [{"name": name, "x": x, "y": y} for name, (x, y) in shot.balls.items()],
            "table.kind": "9-ft" if shot.pockets else "carom",
            "table.length": shot.table[0],
            "table.width": shot.table[1],
            "cue.speed": shot.speed,
            "cue.angle": shot.angle,
            "cue.follow": shot.follow,
            "cue.english": shot.english,
            "ball.restitution": shot.restitution,
        },
    )
    return scene.build()


def our_answer(setup: Any) -> dict[str, Any]:
    """Our result, in the format of pooltool's process."""
    from sandbox.engine import simulate
    from sandbox.engine.model.accuracy import resolve

    started = thread_time()
    run = simulate(setup, resolve("balanced"))
    seconds = thread_time() - started
    off = next((e.t for e in run.events if e.kind == "impact" and e.partner.endswith("cushion")), None)
    return {
        "seconds": seconds,
        "ends": {b.name: run.state(b.name, run.duration)[:2] for b in setup.balls if run.caught_at(b.name) is None},
        "potted": [event.ball for event in run.events if event.kind == "caught"],
        "impacts": run.numerics.impacts,
        "lasts": run.duration,
        "off_cushion": None if off is None else [*run.state("cue", off)[2:5], *run.rolling_spin("cue", off)],
    }


# ------------------------------------------------------------------------------------------------------------- pooltool


class Peer:
    """pooltool in a process of its own, one shot at a time."""

    def __init__(self, python: Path, compiled: bool = True) -> None:
        """``compiled``: use its compilation cache."""
        self._home = tempfile.TemporaryDirectory()  # it writes its configuration to the user's home
        places = {"HOME": self._home.name, "XDG_CONFIG_HOME": self._home.name}
        self._process = subprocess.Popen(
            [python, __file__, "--peer"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | places | ({} if compiled else {"NUMBA_CACHE_DIR": self._home.name}),
        )

    def __enter__(self) -> Peer:
        return self

    def __exit__(self, *exception: object) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()
        self._home.cleanup()

    def answer(self, shot: Shot, setup: Any) -> dict[str, Any]:
        """The shot from the state of our ``setup``."""
        assert self._process.stdin is not None
        cue = next(ball for ball in setup.balls if ball.name == "cue")
        motion = {"velocity": cue.velocity, "spin": cue.spin, "rolling_spin": cue.rolling_spin}
        places = {ball.name: ball.position for ball in setup.balls}
        self._process.stdin.write(json.dumps(asdict(shot) | motion | {"balls": places}) + "\n")
        self._process.stdin.flush()
        return self._next_reply()

    def import_seconds(self) -> float:
        """Seconds of its import, the first thing it reports."""
        return self._next_reply()["seconds"]

    def _next_reply(self) -> dict[str, Any]:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise SystemExit("pooltool's process ended; see its error above")
        return json.loads(line)


def be_peer() -> None:
    """Serve shots, a line of JSON each; runs in pooltool's interpreter."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # everything pooltool prints goes to stderr
    started = thread_time()
    import pooltool

    answers.write(json.dumps({"seconds": thread_time() - started}) + "\n")
    answers.flush()
    for line in sys.stdin:
        answers.write(json.dumps(_pooltool_answer(pooltool, json.loads(line))) + "\n")
        answers.flush()


def _pooltool_answer(pooltool: Any, shot: dict[str, Any]) -> dict[str, Any]:
    """A shot by pooltool. Its table is rotated: our x is its y, our y is its -x."""
    import numpy as np

    length, width = shot["table"]
    specs = pooltool.objects.PocketTableSpecs if shot["pockets"] else pooltool.objects.BilliardTableSpecs
    table = pooltool.Table.from_table_specs(specs(l=length, w=width))
    balls = {
        name: pooltool.Ball.create(name, xy=(0.5 * width - y, 0.5 * length + x), R=R, e_b=shot["restitution"])
        for name, (x, y) in shot["balls"].items()
    }
    (vx, vy), (wx, wy) = shot["velocity"], shot["rolling_spin"]
    cue = balls["cue"].state
    cue.rvw[1] = (-vy, vx, 0.0)
    cue.rvw[2] = (-wy, wx, shot["spin"])
    cue.s = pooltool.constants.sliding
    system = pooltool.System(cue=pooltool.Cue(cue_ball_id="cue"), table=table, balls=balls)
    started = thread_time()
    pooltool.simulate(system, inplace=True)
    seconds = thread_time() - started
    pocketed = [event.ids[0] for event in system.events if event.event_type == pooltool.EventType.BALL_POCKET]
    kinds = [str(event.event_type) for event in system.events]
    cushion = next((event for event in system.events if "cushion" in str(event.event_type)), None)
    off = None
    if cushion is not None:
        after = next(agent.final.state.rvw for agent in cushion.agents if agent.id in balls)
        off = [after[1][1], -after[1][0], after[2][2], after[2][1], -after[2][0]]
    ends = {n: ball.state.rvw[0] for n, ball in balls.items() if n not in pocketed}
    return {
        "seconds": seconds,
        "ends": {n: (float(at[1] - 0.5 * length), float(0.5 * width - at[0])) for n, at in ends.items()},
        "potted": pocketed,
        "impacts": sum("ball_ball" in kind or "cushion" in kind for kind in kinds),
        "lasts": float(system.t),
        "off_cushion": None if off is None else [float(np.round(v, 12)) for v in off],
    }


# --------------------------------------------------------------------------------------------------------------- report


def compare(peer: Peer, chosen: list[Shot]) -> list[dict[str, Any]]:
    """Each shot by both: final positions, and their distance."""
    rows = []
    for shot in chosen:
        mine, theirs, apart = _both(peer, shot)
        _, _, elastic = _both(peer, replace(shot, restitution=1.0))
        rows.append(
            {"shot": shot.name, "why": shot.why, "apart_m": apart, "apart_at_1_m": elastic}
            | {"ours": mine, "pooltool": theirs}
        )
    return rows


def _both(peer: Peer, shot: Shot) -> tuple[dict[str, Any], dict[str, Any], dict[str, float]]:
    """Our result, pooltool's, and the distance in m of each ball's final positions."""
    setup = our_setup(shot)
    mine, theirs = our_answer(setup), peer.answer(shot, setup)
    ends = theirs["ends"]
    return mine, theirs, {name: hypot(x - ends[name][0], y - ends[name][1]) for name, (x, y) in mine["ends"].items()}


def race(peer: Peer, repeats: int) -> list[dict[str, Any]]:
    """The break and a cut shot, interleaved: median seconds."""
    rows = []
    cost = seconds_of_an_impact()
    for shot in (rack(), next(shot for shot in shots() if shot.name == "cut 30 deg, rolling")):
        setup = our_setup(shot)
        ours, theirs = our_answer(setup), peer.answer(shot, setup)
        turns = [(our_answer(setup)["seconds"], peer.answer(shot, setup)["seconds"]) for _ in range(repeats)]
        ours |= {"seconds": median(mine for mine, _ in turns)}
        theirs |= {"seconds": median(other for _, other in turns)}
        limit = ours["impacts"] * cost
        for answer in (ours, theirs):
            answer["over_limit"] = answer["seconds"] / limit
        rows.append({"shot": shot.name, "limit_s": limit, "ours": ours, "pooltool": theirs})
    return rows


def seconds_of_an_impact() -> float:
    """One bare pymunk step of two balls that touch."""
    import pymunk

    space = pymunk.Space()
    for x in (-R, R):
        body = pymunk.Body(0.17, 0.4 * 0.17 * R * R)
        body.position = x, 0.0
        body.velocity = -x, 0.0
        space.add(body, pymunk.Circle(body, R))
    return min(timeit(lambda: space.step(1e-9), number=2_000) / 2_000 for _ in range(5))


def cold(python: Path, compiled: bool) -> dict[str, float]:
    """Seconds of pooltool's import and of the break, the first thing that a process computes."""
    shot = rack()
    with Peer(python, compiled) as peer:
        return {"import_s": peer.import_seconds(), "first_s": peer.answer(shot, our_setup(shot))["seconds"]}


def ours_cold() -> dict[str, float]:
    """The same for ours, in a new process."""
    return json.loads(subprocess.run([sys.executable, __file__, "--begin"], stdout=subprocess.PIPE, check=True).stdout)


def begin() -> None:
    """Entry point of that process."""
    started = thread_time()
    import sandbox.engine.simulation  # noqa: F401

    setup = our_setup(rack())
    imported = thread_time() - started
    sys.stdout.write(json.dumps({"import_s": imported, "first_s": our_answer(setup)["seconds"]}))


def report(rows: list[dict[str, Any]], races: list[dict[str, Any]], colds: dict[str, dict[str, float]]) -> None:
    from measured import say, show

    lines = [f"{'shot':<24} {'':<4}{'ours end':^16} {'pooltool':^16} {'apart':>10} {'at e = 1':>12}  differs by"]
    for row in rows:
        title = row["shot"]
        why = row["why"] if max(row["apart_m"].values()) > 2e-6 else "nothing"
        for name, (x, y) in row["ours"]["ends"].items():
            u, v = row["pooltool"]["ends"][name]
            apart, elastic = 1e3 * row["apart_m"][name], 1e3 * row["apart_at_1_m"][name]
            ends = f"{name:<4}({x:6.3f},{y:6.3f}) ({u:6.3f},{v:6.3f})"
            lines.append(f"{title:<24} {ends} {apart:7.3f} mm {elastic:9.6f} mm  {why}")
            title = why = ""
        for who in ("ours", "pooltool"):
            if row[who]["off_cushion"] is not None:
                vx, vy, wz, wx, wy = row[who]["off_cushion"]
                spin = f"({R * wx:.3f}, {R * wy:.3f}, {R * wz:.3f})"
                lines.append(f"{'':<24}   off the cushion, {who + ':':<9} v ({vx:.3f}, {vy:.3f}), r w {spin} m/s")
    say(*lines)
    answers = []
    for race in races:
        for who in ("ours", "pooltool"):
            summary = {"shot": race["shot"], "who": NAMES[who], "potted": ", ".join(race[who]["potted"]) or "none"}
            answers.append(race[who] | summary)
        answers.append({"shot": race["shot"], "who": "limit", "seconds": race["limit_s"], "over_limit": 1})
    columns = {
        "shot": "{shot}",
        "": "{who}",
        "time": "{seconds:.3f ms}",
        "over limit": "{over_limit:,.0f}",
        "impacts": "{impacts:,}",
        "lasts": "{lasts:.1f} s",
        "potted": "{potted}",
    }
    show("strike to rest, warm", answers, columns)
    begun = [{"who": who} | found for who, found in colds.items()]
    show("cold, the break", begun, {"": "{who}", "import": "{import_s:.2f} s", "first shot": "{first_s:.2f} s"})
    say("Where the balls of the break end is not compared: each impact multiplies a difference by about ten.")


def main() -> None:
    if sys.argv[1:] in (["--peer"], ["--begin"]):
        be_peer() if sys.argv[1] == "--peer" else begin()
        return
    from measured import command_line, keep

    options: dict[str, dict[str, Any]] = {
        "--pooltool": {"type": Path, "required": True, "help": "the Python that has pooltool, as told above"},
        "--cold": {"action": "store_true", "help": "also measure pooltool's compilation"},
    }
    arguments = command_line(__doc__, repeats=25, options=options)
    with Peer(arguments.pooltool) as peer:
        peer.import_seconds()
        rows = compare(peer, shots()[:1] if arguments.quick else shots())
        races = race(peer, arguments.repeats)
    colds = {"ours": ours_cold(), "pooltool 0.6.0": cold(arguments.pooltool, compiled=True)}
    if arguments.cold:
        colds["pooltool 0.6.0, with compilation"] = cold(arguments.pooltool, compiled=False)
    report(rows, races, colds)
    keep(arguments.json, {"shots": rows, "races": races, "cold": colds})


if __name__ == "__main__":
    main()
