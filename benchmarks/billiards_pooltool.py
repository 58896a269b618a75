"""The same billiard shots beside pooltool 0.6.0: where the balls end, and how long a nine-ball break takes.

Run ``python benchmarks/billiards_pooltool.py --pooltool /tmp/pooltool/bin/python [--json F] [--repeats N]``.

pooltool asks for pins that cannot be met beside each other, so it lives in a virtual environment of its own, with the
same Python as ours::

    python3 -m venv /tmp/pooltool
    /tmp/pooltool/bin/pip install panda3d==1.10.15 "numba<0.62" panda3d-gltf panda3d-simplepbr scipy attrs cattrs \\
        msgpack msgpack-numpy pyyaml click pillow h5py h11 "rich<15" numpy-quaternion
    /tmp/pooltool/bin/pip install --no-deps pooltool-billiards==0.6.0

This program asks it, in a process that stays, for one shot at a time and takes turns with it, so that a slow moment of
the machine hits both. Both get the same balls, cloth, positions, and velocity and spin just after the stroke, and
friction between balls by speed (Alciatore). Where they differ:

- Friction of two balls: its impulse is mu times the normal impulse, (1 + e) v / 2 for each kg. pooltool takes mu times
  the speed at which they part, e v: 2.5 % less at e = 0.95. The column "at e = 1" shows what is left without that.
- Cuts: pooltool moves two balls to 0.001 mm apart before they push, which turns the line of their centres a little.
- Cushions: pooltool's default is a nose above the ball's centre, which gives, after Stronge: it holds the ball down,
  takes up more of its roll and springs back along itself. Ours meets the ball at its centre, with restitution and
  friction.
- Balls that meet at one instant: pooltool takes them one by one, we all at once.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass, replace
from math import cos, hypot, radians, sin
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

R = 0.028575  # m
CLEAR, TABLE = (20.0, 10.0), (2.54, 1.27)  # m; the first is so large that no ball reaches a cushion


@dataclass(frozen=True)
class Shot:
    """Balls in m, from the table's centre; the cue ball's stroke; and what may make the two differ."""

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
    """Stop, draw, follow, cuts and rails; the break comes last."""
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
    """The cue ball comes along x and meets the other, at the cut angle, in the origin."""
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
            "ball.friction_law": "speed",
            "ball.restitution": shot.restitution,
        },
    )
    return scene.build()


def our_answer(setup: Any) -> dict[str, Any]:
    """What pooltool's process answers, of ours."""
    from sandbox.engine import simulate
    from sandbox.engine.accuracy import resolve

    started = perf_counter()
    run = simulate(setup, resolve("balanced"))
    seconds = perf_counter() - started
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

    def __init__(self, python: Path) -> None:
        self._home = tempfile.TemporaryDirectory()  # it writes its configuration into the user's home
        self._process = subprocess.Popen(
            [python, __file__, "--peer"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "HOME": self._home.name, "XDG_CONFIG_HOME": self._home.name},
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
        assert self._process.stdout is not None
        cue = next(ball for ball in setup.balls if ball.name == "cue")
        motion = {"velocity": cue.velocity, "spin": cue.spin, "rolling_spin": cue.rolling_spin}
        places = {ball.name: ball.position for ball in setup.balls}
        self._process.stdin.write(json.dumps(asdict(shot) | motion | {"balls": places}) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        if not line:
            raise SystemExit("pooltool's process ended; its error stands above")
        return json.loads(line)


def be_peer() -> None:
    """Answer shots, a line of JSON each; with pooltool's interpreter."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever pooltool prints goes to stderr
    import pooltool

    for line in sys.stdin:
        answers.write(json.dumps(_pooltool_answer(pooltool, json.loads(line))) + "\n")
        answers.flush()


def _pooltool_answer(pooltool: Any, shot: dict[str, Any]) -> dict[str, Any]:
    """Its table stands upright: our x is its y, our y is its x backwards."""
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
    started = perf_counter()
    pooltool.simulate(system, inplace=True)
    seconds = perf_counter() - started
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


def compare(peer: Peer) -> list[dict[str, Any]]:
    """Each shot by both: where the balls end, and how far apart that is."""
    rows = []
    for shot in shots():
        mine, theirs, apart = _both(peer, shot)
        _, _, elastic = _both(peer, replace(shot, restitution=1.0))
        rows.append(
            {"shot": shot.name, "why": shot.why, "apart_m": apart, "apart_at_1_m": elastic}
            | {"ours": mine, "pooltool": theirs}
        )
    return rows


def _both(peer: Peer, shot: Shot) -> tuple[dict[str, Any], dict[str, Any], dict[str, float]]:
    """Our answer, pooltool's, and how far apart in m each ball ends."""
    setup = our_setup(shot)
    mine, theirs = our_answer(setup), peer.answer(shot, setup)
    ends = theirs["ends"]
    return mine, theirs, {name: hypot(x - ends[name][0], y - ends[name][1]) for name, (x, y) in mine["ends"].items()}


def race(peer: Peer, repeats: int) -> dict[str, Any]:
    """The nine-ball break, in turns: median seconds."""
    shot = rack()
    setup = our_setup(shot)
    first = our_answer(setup), peer.answer(shot, setup)
    turns = [(our_answer(setup)["seconds"], peer.answer(shot, setup)["seconds"]) for _ in range(repeats)]
    return {
        "ours_s": median(mine for mine, _ in turns),
        "pooltool_s": median(theirs for _, theirs in turns),
        "first": first,
    }


def report(rows: list[dict[str, Any]], timing: dict[str, Any], first_shot: float) -> str:
    """All of it, for people."""
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
    lines += ["", "nine-ball break at 8 m/s, strike to rest, warm, in turns:"]
    for who, answer, seconds in zip(
        ("ours, balanced", "pooltool 0.6.0"), timing["first"], (timing["ours_s"], timing["pooltool_s"]), strict=True
    ):
        potted = ", ".join(answer["potted"]) or "none"
        lines.append(
            f"  {who}  {1e3 * seconds:6.1f} ms   {answer['impacts']} impacts, {answer['lasts']:.1f} s, potted {potted}"
        )
    lines += [
        f"  pooltool takes {timing['pooltool_s'] / timing['ours_s']:.1f} times as long; "
        f"its first shot took {first_shot:.1f} s (it compiles, once for an installation)",
        "  Ends are not compared: each impact multiplies a difference by ten or so, and cushions and jaws differ.",
    ]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pooltool", type=Path, help="the Python that has pooltool")
    parser.add_argument("--repeats", type=int, default=25)
    parser.add_argument("--json", type=Path, help="write all of it here")
    parser.add_argument("--peer", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.peer:
        be_peer()
        return
    if arguments.pooltool is None:
        parser.error("--pooltool: which Python has pooltool? The head of this file says how to make one")
    with Peer(arguments.pooltool) as peer:
        stop = shots()[0]
        first_shot = peer.answer(stop, our_setup(stop))["seconds"]
        rows = compare(peer)
        timing = race(peer, arguments.repeats)
    sys.stdout.write(report(rows, timing, first_shot) + "\n")
    if arguments.json:
        arguments.json.write_text(json.dumps({"shots": rows, "break": timing, "first_shot_s": first_shot}, indent=1))


if __name__ == "__main__":
    main()
