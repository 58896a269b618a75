"""Soak test: some minutes of hard use, in which every outcome must be correct or a named error.

Run ``python benchmarks/soak.py [--seed N] [--minutes M] [--scenes N] [--kills N] [--page F.md]``. The same seed gives
the same cases, each of which can be repeated alone: ``--only scenes:123``. Parts:

- scenes: the built-in scenes with random parameters, and scene files with changed bytes
- setups: balls, surfaces and forces with numbers from 1e-320 to 1e300
- bodies: random outlines and a ball, thrown at each other, a floor and a wall: none gains energy, or gets through
- faulty: user scenes with mistakes, in run, sweep and aim
- replays: recorded shots with changed bytes, and forged ones with a correct checksum
- kills: sweeps ended by SIGKILL or another signal at any moment, with damaged files, or two at once into one file;
  then finished by the same command, and compared byte by byte with an undisturbed sweep

A case ends in a class; those that are neither a good run nor a named error are listed with their details, and the
script exits with 1. ``--page`` writes the table into a page, between its markers.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from functools import cache
from math import cos, sin, tau
from pathlib import Path
from threading import Thread
from typing import Any

from page import filled

import sandbox
from sandbox import parameters as declared
from sandbox import resources
from sandbox.cli import main as program
from sandbox.cli.new import new_scene
from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball, Body, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Ellipse, Polygon, Shape, box, capsule
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from sandbox.errors import RequestError, RunError
from sandbox.physics.forces import Gravity
from sandbox.scene import listings
from sandbox.scene.scene_run import SceneRun
from sandbox.window import replay
from sandbox.window.history import Changes
from sandbox.window.shots import Shot
from sandbox.workers import Processes, WorkerLost, cores

#: Processor time in s after which a case counts as endless; by the clock, this many times as long.
LONGEST, BY_THE_CLOCK = 30.0, 6

#: Cases per call to a process.
AT_ONCE = {"scenes": 20, "setups": 40, "bodies": 40, "faulty": 4, "replays": 40}

#: Number of cases of the other parts, as fractions of the fuzzed scenes.
SHARES = {"scenes": 1.0, "setups": 0.15, "bodies": 0.1, "faulty": 0.03, "replays": 0.06}

REFUSED, FAILED = "request refused", "run failed by name"
SAME, ONE_OF_TWO = "finished, the same bytes", "one wrote, the other was refused"

#: Classes that pass; all others fail.
GOOD = ("ran", REFUSED, FAILED, "read", SAME, ONE_OF_TWO)

#: A traceback line from this program after start-up; earlier ones are from Python's own start.
OURS = re.compile(r'File "[^"]*/sandbox/(?!__init__|__main__|cli/__init__)')

Outcome = tuple[str, str]  # class, and details of one that is not good


class Wrong(Exception):
    """A case that ended neither well nor in a named error: its class, and details."""


class TooLong(BaseException):
    """The case took too long."""


# ---------------------------------------------------------------------------------------------------------------------
# Fuzzed scenes
# ---------------------------------------------------------------------------------------------------------------------

NONSENSE: list[Any] = [
    None, True, "", "12 m", "1e400 m", "nan", float("nan"), float("inf"), -1, 10**400, 1e300, 1e-320, [], [1],
    [1, 2, 3], {}, {"a": 1}, {5: 1}, "none", "\x1b[31m", "=1+1", "a" * 300, [[]], {"model": "constant"}, b"x", 1j,
]  # fmt: skip


@cache
def scenes_and_presets() -> list[str]:
    return [found.name for found in listings()]


def fuzzed_scene(draw: random.Random) -> str:
    name = draw.choice(scenes_and_presets())
    if draw.random() < 0.3:
        return scrambled_file(draw, name)
    known = [p for p in declared.walk(sandbox.load(name).parameters) if not p.key.startswith("accuracy.")]
    some = draw.sample(known, draw.choice((1, 2, 3, 6, len(known))))
    changes = {parameter.key: any_value(draw, parameter) for parameter in some}
    if draw.random() < 0.15:
        keys = [*(p.key for p in known), "nothing", "air", "air.wind[0]", "a.b[9].c"]
        changes[draw.choice(keys)] = draw.choice(NONSENSE)
    changes.setdefault("accuracy.level", draw.choice(("fast", "fast", "balanced")))
    if draw.random() < 0.1:
        changes |= {"accuracy.method": "plain", "accuracy.step": draw.choice((1 / 60, 1 / 240))}
    return looked_at(sandbox.simulate(sandbox.load(name, changes)), changes)


def any_value(draw: random.Random, parameter: Any) -> Any:
    """A value that the declaration of a parameter allows, or its current one."""
    value, low, high = parameter.value, parameter.low, parameter.high

    def number() -> float:
        special = [x for x in (low, high, 0.0, 1e-9, 1.0) if low <= x <= high]
        near = value if isinstance(value, float) else 0.5 * (low + high)
        kinds = draw.choice(special), draw.uniform(low, high), min(max(near * draw.uniform(0.5, 1.5), low), high)
        return float(draw.choice(kinds))

    if parameter.choices:
        return draw.choice(parameter.choices)
    if isinstance(value, bool):
        return draw.random() < 0.5
    if low is None or high is None:
        return value
    if isinstance(value, tuple | list):
        return [number() if isinstance(part, float) else part for part in value]
    return number()


def scrambled_file(draw: random.Random, name: str) -> str:
    """A scene file with some bytes changed, removed or added."""
    scene = name.partition("/")[0]
    folder = resources.folder("scenes") / scene
    file = draw.choice([*folder.glob("*.toml"), *folder.glob("presets/*.toml")])
    text = bytearray(file.read_bytes())
    for _ in range(draw.choice((1, 1, 2, 5, 30))):
        place = draw.randrange(len(text))
        part = draw.choice((b"\0", b"\xff", b'"', b"[", b"=", b"9", b"-", b"\n", b"1e999", b"nan", b"\x1b[2J"))
        text[place : place + draw.choice((0, 1, 1, 40))] = part
    if b"scene" not in text:
        text = bytearray(f'scene = "{scene}"\n'.encode()) + text
    with tempfile.TemporaryDirectory() as place_of_it:
        path = Path(place_of_it) / "shot.toml"
        path.write_bytes(bytes(text))
        return looked_at(sandbox.simulate(sandbox.load(path, {"accuracy.level": "fast"})), file.name)


def looked_at(run: Any, about: object) -> str:
    """Return "ran" if all numbers of a run, and of its result if it is of a scene, are finite; else raise Wrong."""
    result = run.result if isinstance(run, SceneRun) else None
    states = [(arc.start, arc.state(arc.t1)) for arcs in run.arcs.values() for arc in arcs]
    try:
        json.dumps([result, run.duration, states], allow_nan=False, default=str)
    except ValueError:
        raise Wrong("not finite", repr(about)) from None
    return "ran"


# ---------------------------------------------------------------------------------------------------------------------
# Setups
# ---------------------------------------------------------------------------------------------------------------------


def extreme_setup(draw: random.Random) -> str:
    def size(usual: float) -> float:
        return draw.choice((usual, usual, usual, usual * 10 ** draw.uniform(-9, 9), 10 ** draw.uniform(-320, 300)))

    def signed(usual: float) -> float:
        return draw.choice((-1.0, 1.0, 1.0, 0.0)) * size(usual)

    mass, angle, far = size(0.1), draw.uniform(-1.5, 1.5), size(100.0)
    ball = Ball(
        "ball", mass, size(0.03), (signed(1.0), size(2.0)), (signed(10.0), signed(10.0)), signed(100.0),
        forces=(Gravity(size(9.81), mass),),
    )  # fmt: skip
    floor = Segment((-far * cos(angle), -far * sin(angle)), (far * cos(angle), far * sin(angle)))
    surface = Surface("floor", floor, draw.random(), friction=draw.choice((0.0, 0.4, 1e300)))
    balls = [ball]
    if draw.random() < 0.4:
        balls.append(Ball("other", size(0.1), size(0.03), (signed(1.0), signed(1.0)), (signed(1.0), 0.0)))
    method = draw.choice(({}, {}, {}, {"method": "plain", "step": draw.choice((1e-3, 1 / 60))}))
    accuracy = resolve(level=draw.choice(("fast", "balanced")), **method)
    return looked_at(simulate(Setup(tuple(balls), (surface,), draw.choice((0.5, 2.0, 2.0))), accuracy), "a setup")


# ---------------------------------------------------------------------------------------------------------------------
# Bodies
# ---------------------------------------------------------------------------------------------------------------------


def outline(draw: random.Random) -> Shape:
    size, slim, rounding = draw.uniform(0.2, 0.7), draw.uniform(0.1, 0.9), draw.choice((0.0, 0.1))
    turns = [tau * (corner + draw.uniform(0.0, 0.8)) / 5 for corner in range(5)]
    polygon = Polygon([(size * cos(turn), size * sin(turn)) for turn in turns], rounding)
    return draw.choice((polygon, Ellipse(size, slim * size), capsule(2.0 * size, slim * size), box(size, slim * size)))


def thrown_bodies(draw: random.Random) -> str:
    gravity, restitution = draw.choice((0.0, 9.81)), draw.choice((0.0, 0.3, 0.7, 1.0))
    bounce = Bounce(restitution, draw.choice((0.0, 0.1, 0.5, 1.5)))
    balls: list[Ball] = []
    for number in range(draw.choice((2, 3))):
        x, mass = 1.8 * (number - 1), draw.uniform(0.2, 5.0)
        start: dict[str, Any] = {
            "position": (x, draw.uniform(1.2, 2.0)),
            "velocity": (-x * draw.uniform(0.0, 4.0), draw.uniform(-3.0, 3.0)),
            "spin": draw.uniform(-25.0, 25.0),
            "forces": (Gravity(gravity, mass),),
        }
        if number == 1 and draw.random() < 0.3:
            balls.append(Ball("1", mass, 0.2, **start))
        else:
            balls.append(Body(f"{number}", mass=mass, shape=outline(draw), **start))
    sides = {"floor": Segment((-50.0, 0.0), (50.0, 0.0)), "wall": Segment((-4.0, 0.0), (-4.0, 50.0))}
    surfaces = [Surface(name, side, bounce.restitution, bounce.friction) for name, side in sides.items()]
    run = simulate(Setup(balls, surfaces, 3.0, between_balls=ConstantBounce(bounce)), resolve(level="balanced"))

    def energy(t: float) -> float:
        states = [(ball, run.state(ball.name, t)) for ball in balls]
        return sum(kinetic(ball, state) + ball.mass * gravity * state[1] for ball, state in states)

    moments = [0.05 * step for step in range(61) if 0.05 * step <= run.duration]
    gained = max(map(energy, moments)) / energy(0.0) - 1.0
    if gained > 1e-5:
        raise Wrong("gained energy", f"{gained:.2g} of it")
    places = [(ball.name, t, *run.state(ball.name, t)[:2]) for ball in balls for t in moments]
    if through := [place for place in places if place[2] < -4.0 or place[3] < 0.0]:
        raise Wrong("went through a surface", f"{through[0]}")
    return looked_at(run, "bodies")


# ---------------------------------------------------------------------------------------------------------------------
# Scenes with mistakes
# ---------------------------------------------------------------------------------------------------------------------

#: What a force, a law, ``until``, a fact, the verdict or ``build`` does wrongly.
FORCES = (
    "return None", "return 1.0", "return (1.0,)", "return (1j, 0.0)", "return (10**400, 0.0)", "return 'a', 'b'",
    "return (float('nan'), 0.0)", "return (float('inf'), 0.0)", "raise ValueError('\\x1b[31mred')",
    "import sys; sys.exit(0)", "raise GeneratorExit",
    "raise SystemExit", "import numpy; return numpy.ones((2, 1))", "return self(t, position, velocity, spin)", "1 / 0",
    "raise KeyboardInterrupt", "raise type('Odd', (Exception,), {})('two\\nlines')", "return 1e308 * velocity[0], 0.0",
    "import sandbox; return sandbox.nothing", "return 0.0, -1e9 * position[1]", "assert False",
)  # fmt: skip
FACTS = (
    "return 1j", "return float('nan')", "return run", "x = []; x.append(x); return x", "return {5: 1}", "1 / 0",
    "import sys; sys.exit(3)", "return '\\x1b[2J\\nx'", "return 10**400", "return b'x'", "return run.nothing",
    "return ...",
)  # fmt: skip
VERDICTS = ("return None", "return 5", "return '\\x1b]0;x\\x07'", "1 / 0", "return 'a' * 10000")
BUILDS = (
    "return None", "1 / 0", "import sys; sys.exit(0)", "return Setup((), ())", "parameters.launch.nothing",
    "return Setup((Ball('a', 1, 1, (0, 0)), Ball('a', 1, 1, (9, 9))), ())",
    "return Setup((Ball('a', 1, 1, (0, 0, 0)),), ())", "return Setup((Ball(5, 1, 1, (0, 0)),), ())",
    "return Setup((Ball('a', -1, 1, (0, 0)),), ())", "return Setup((Ball('a', 1, 1, ('x', 0)),), ())",
    "return Setup((Ball('a', 1, 1, (0, 0)),), (), duration=float('nan'))",
    "return Setup((Ball('a', 1, 1, (0, 9)),), (), until=lambda: True)",
    "return Setup((Ball('a', 1, 1, (0, 9)),), (Surface('f', Segment((-9, 0), (9, 0)), 1, 1, law=lambda *a: None),))",
    "return Setup((Ball('a', 1, 1, (0, 9)),), (Surface('f', Segment((-9, 0), (9, 0)), 2.5, 0.5),))",
    "return Setup((Ball('a', 1, 1, (0, 9)),), (Surface('f', Segment((9, 0), (9, 0)), 0.5, 0.5),))",
)  # fmt: skip
#: Changes of the file itself: text to find, and its replacement.
TEXTS = (
    ("def build", "def bild"), ("class Parameters(Flight)", "class Parameters"), ("FACTS", "FACT"),
    ("import", "import\0"),
    ("def build(parameters: Parameters)", "def build()"), ("from __future__", "from __past__"), ("launch", "lunch"),
    ("(Flight)", "(SceneParameters)"), ("quantity(10.0", "quantity(None"), ('"m/s"', '"mm/s"'),
    ("quantity(", "quantity(*"), ("CONTROLS = Controls(", "CONTROLS = dict("), ("return", "return return"),
    ("0", "\xff"),
)  # fmt: skip


def faulty_scene(draw: random.Random) -> str:
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "mine"
        new_scene(folder)
        file = folder / "scene.py"
        text = file.read_text("utf-8")
        kind = draw.choice(("force", "force", "fact", "verdict", "build", "text"))
        if kind == "text":
            old, mistake = draw.choice(TEXTS)
            text = text.replace(old, mistake, draw.choice((1, -1)))
        else:
            mistake = draw.choice({"force": FORCES, "fact": FACTS, "verdict": VERDICTS, "build": BUILDS}[kind])
            when = draw.choice(("", "if t > 0.05:\n            "))
            text = {
                "force": lambda: after(text, r"    def __call__\(self, t[^\n]*\n", f"        {when}{mistake}\n"),
                "fact": lambda: (
                    f"{text}\n\ndef _mistake(run, parameters):\n    {mistake}\n\n\n"
                    "FACTS = (*FACTS, Fact('mistake', 'mistake', '', _mistake))\n"
                ),
                "verdict": lambda: f"{text}\n\ndef verdict(run, parameters):\n    {mistake}\n",
                "build": lambda: after(text, r"def build\([^\n]*\n", f"    {mistake}\n"),
            }[kind]()
        file.write_bytes(text.encode("latin-1" if "\xff" in text else "utf-8", "replace"))
        command, *more = draw.choice(
            (
                ["run"],
                ["run", "--json"],
                ["run", "--set", "accuracy.method=plain"],
                ["run", "--check"],
                ["sweep", "--over", "launch.speed=5:9:3", "--jobs", "1", "--out", f"{place}/x.csv"],
                ["aim", "--vary", "launch.angle=40:70", "--target", "hit=true"],
            )
        )
        return called([command, str(folder), *more], f"{kind}: {mistake!r}: {command} {' '.join(more)}")


def after(text: str, pattern: str, added: str) -> str:
    """Insert ``added`` below the first line that matches ``pattern``."""
    found = re.search(pattern, text)
    assert found, pattern
    return text[: found.end()] + added + text[found.end() :]


def called(command: list[str], about: str) -> str:
    """Run the program in this process and check its output."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = program(command)
    errors = err.getvalue()
    if any(ord(mark) < 32 and mark not in "\n\t\r" for mark in out.getvalue() + errors):
        raise Wrong("control characters", about)
    if code == 0:
        return "ran"
    if code == 130 and "KeyboardInterrupt" in about:
        return FAILED
    first = errors.partition("\n")[0]
    if code not in (1, 2) or not first.startswith("error: "):
        raise Wrong(f"exit {code} without an error line", f"{about}: {errors[-500:]}")
    if "Traceback" in errors and "your scene failed" not in first:
        raise Wrong("a traceback of our own", f"{about}: {errors[-500:]}")
    return REFUSED if code == 2 else FAILED


# ---------------------------------------------------------------------------------------------------------------------
# Replays
# ---------------------------------------------------------------------------------------------------------------------


@cache
def recorded() -> list[bytes]:
    """Replays of some shots."""
    found = []
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / f"x{replay.SUFFIX}"
        for name in ("golf/putt", "basketball", "billiards"):
            scene = sandbox.load(name)
            replay.save(Shot(scene, sandbox.simulate(scene), Changes(name, {})), path)
            found.append(path.read_bytes())
    return found


def forged_replay(draw: random.Random) -> str:
    content = bytearray(draw.choice(recorded()))
    if draw.random() < 0.4:
        for _ in range(draw.choice((1, 1, 3, 50))):
            content[draw.randrange(len(content))] = draw.randrange(256)
        del content[draw.choice((len(content), len(content), draw.randrange(len(content)))) :]
    else:
        record = json.loads(content)
        for _ in range(draw.choice((1, 1, 2, 6))):
            forge(draw, record["body"])
        record["check"] = replay.checksum(record["body"])
        content = bytearray(json.dumps(record).encode())
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / f"shot{replay.SUFFIX}"
        path.write_bytes(content)
        (Path(place) / "scene.py").write_text("raise SystemExit('code of the replay ran')\n")
        shot = replay.read(path)
        shot.run.state(shot.ball, 0.5 * shot.run.duration)
        return "read"


def forge(draw: random.Random, node: Any) -> None:
    """Change one thing, somewhere in the tree."""
    while keys := list(node) if isinstance(node, dict) else list(range(len(node))):
        key = draw.choice(keys)
        below = node[key]
        if isinstance(below, dict | list) and draw.random() < 0.8:
            node = below
            continue
        values = [None, True, -1, 0, 1e308, "", "x", [], {}, [1, 2], "../scene", "/etc/passwd", "\x1b[2J", 10**30]
        if isinstance(below, int | float):
            values += [below * 1.5, -below, below + 1]
        if draw.random() < 0.2:
            del node[key]
        else:
            node[key] = draw.choice(values)
        return


# ---------------------------------------------------------------------------------------------------------------------
# Sweeps that are killed
# ---------------------------------------------------------------------------------------------------------------------

#: A scene of two balls whose runs take a few ms each. The first points and some others fail: their rows have an error,
#: and the first row that has more makes all rows be written again.
SLOW = '''"""A drop."""

import time

from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.parameters import SceneParameters, quantity
from sandbox.physics.forces import Gravity


class Parameters(SceneParameters):
    """A drop."""

    height: float = quantity(2.0, "m", 0.1, 100, "height")
    pause: float = quantity(2.0, "ms", 0, 1000, "time that it takes to build")


def build(parameters):
    time.sleep(0.001 * parameters.pause)
    if parameters.height < 1.05 or 1.5 < parameters.height < 1.51:
        raise ValueError("not there")
    ball = Ball("ball", 0.1, 0.03, (0.0, parameters.height), forces=(Gravity(9.81, 0.1),))
    floor = Surface("floor", Segment((-9, 0), (9, 0)), 0.5, 0.5)
    return Setup((ball, Ball("other", 0.1, 0.03, (5.0, 5.0))), (floor,), 0.4)
'''

#: Signals that end a sweep, and the exit codes of the program that they may lead to; 0 if it was done.
SIGNALS = {
    signal.SIGKILL: (0, -signal.SIGKILL),
    **{by: (0, 130, -by) for by in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)},
}


def started(command: list[str]) -> subprocess.Popen[str]:
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)


class Kills:
    """Sweeps that are interrupted again and again until each is complete."""

    def __init__(self, seed: int, kills: int, deadline: float, note: Callable[[str, Outcome], None]) -> None:
        self.seed, self.kills, self.deadline, self.note = seed, kills, deadline, note
        self.done = 0
        self._expected: dict[int, bytes] = {}

    @property
    def is_over(self) -> bool:
        return self.done >= self.kills or time.monotonic() > self.deadline

    def run(self) -> None:
        with tempfile.TemporaryDirectory() as place:
            (folder := Path(place) / "slow").mkdir()
            (folder / "scene.py").write_text(SLOW)
            number = 0
            while not self.is_over:
                (here := Path(place) / f"{number}").mkdir()
                draw = random.Random(f"{self.seed}:kills:{number}")
                outcome, details = judged(lambda: self.one(draw, folder, here))  # noqa: B023 (called at once)
                self.note("kills", (outcome, f"case {number}: {details}" if details else ""))
                number += 1

    def one(self, draw: random.Random, folder: Path, here: Path) -> str:
        points, jobs, out = draw.choice((150, 400)), draw.choice((1, 2)), here / "rows.csv"
        over = ["--over", f"height=1:2:{points}", "--set", "accuracy.level=fast"]
        command = [sys.executable, "-m", "sandbox", "sweep", str(folder), *over, "--jobs", str(jobs), "--out"]
        if points not in self._expected:
            finished([*command, str(out)])
            self._expected[points] = out.read_bytes()
            out.unlink()
        command.append(str(out))
        story: list[str] = []
        try:
            while not self.is_over and draw.random() > 0.08:
                if draw.random() < 0.06:
                    self.two_at_once(command)
                    break
                by = draw.choice([signal.SIGKILL, *SIGNALS])
                end(command, by, draw.choice((draw.uniform(0.0, 0.4), draw.uniform(0.3, 1.2))))
                self.done += 1
                story.append(by.name)
                if out.exists() and not (here / "rows.csv.resume").exists():  # it was already done
                    break
                if out.exists() and draw.random() < 0.1:
                    damage(draw, out)
                    story.append("damaged")
            finished(command)
        except Wrong as wrong:
            if "damaged" in story and "its first line is not what" in str(wrong):
                return REFUSED
            raise Wrong(wrong.args[0], f"{story}: {wrong.args[1]}") from None
        if out.read_bytes() != self._expected[points]:
            raise Wrong("finished, other bytes", repr(story))
        left = {path.name for path in here.iterdir()} - {"rows.csv", "rows.csv~", ".rows.csv.complete"}
        if any(not name.endswith(".part") for name in left):  # from a rewrite that was killed
            raise Wrong("files were left", repr(sorted(left)))
        shutil.rmtree(here)
        return SAME

    def two_at_once(self, command: list[str]) -> None:
        both = [started(command) for _ in range(2)]
        errors = [process.communicate(timeout=120)[1] for process in both]
        codes = sorted(process.returncode for process in both)
        refused = sum("another sweep is writing to this file" in text for text in errors)
        if (codes, refused) not in (([0, 2], 1), ([0, 0], 0)):  # the second: one was done before the other started
            raise Wrong(f"two at once: exits {codes}", repr(errors)[-600:])
        self.note("kills", (ONE_OF_TWO if refused else SAME, ""))


def finished(command: list[str]) -> None:
    """Run a command to its end."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    if done.returncode or "Traceback" in done.stderr:
        raise Wrong(f"exit {done.returncode}", done.stderr[-500:])


def end(command: list[str], by: signal.Signals, moment: float) -> None:
    """Start the sweep, end it after ``moment`` s, and see that nothing of it is left."""
    process = started(command)
    time.sleep(moment)
    whole = by is signal.SIGINT and moment > 0.2
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, by) if whole else process.send_signal(by)
    about = f"{by.name} after {moment:.2f} s"
    try:
        _, errors = process.communicate(timeout=30)
        if "leaked" in errors or OURS.search(errors):
            raise Wrong("a traceback of our own", f"{about}: {errors[-600:]}")
        if process.returncode not in (*SIGNALS[by], 1 if "Traceback" in errors else 0):  # 1: by Python, at its start
            raise Wrong(f"exit {process.returncode}", f"{about}: {errors[-600:]}")
        for _ in range(100):
            os.killpg(process.pid, 0)
            time.sleep(0.05)
        raise Wrong("processes were left", about)
    except subprocess.TimeoutExpired:
        raise Wrong("does not end", about) from None
    except (ProcessLookupError, PermissionError):
        pass  # as it should be
    finally:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)


def damage(draw: random.Random, file: Path) -> None:
    """Damage some of the written file."""
    content = bytearray(file.read_bytes())
    if not content:
        return
    place = draw.randrange(len(content))
    start = content.rfind(b"\n", 0, place) + 1
    end = content.find(b"\n", place) + 1 or len(content)
    kind = draw.choice(("cut", "line", "nul", "quote", "crlf", "twice"))
    if kind == "cut":
        del content[place:]
    elif kind == "line":
        del content[start:end]
    elif kind == "nul":
        content[start:end] = bytes(end - start)
    elif kind == "quote":
        content[start:start] = b'"'
    elif kind == "crlf":
        content[end - 1 : end] = b"\r\n"
    else:
        content[end:end] = content[start:end]
    file.write_bytes(content)


# ---------------------------------------------------------------------------------------------------------------------
# Main program
# ---------------------------------------------------------------------------------------------------------------------

CASES: dict[str, Callable[[random.Random], str]] = {
    "scenes": fuzzed_scene,
    "setups": extreme_setup,
    "bodies": thrown_bodies,
    "faulty": faulty_scene,
    "replays": forged_replay,
}


def cases(part: str, seed: int, first: int, last: int) -> list[Outcome]:
    """Some cases of a part, in any process; each depends only on the seed and its number."""
    found = []
    for number in range(first, last):
        outcome, details = alone(part, seed, number)
        found.append((outcome, f"--only {part}:{number}: {details}" if outcome not in GOOD else ""))
    return found


def alone(part: str, seed: int, number: int) -> Outcome:
    """One case, in limited time."""

    def too_long(*_: object) -> None:
        raise TooLong

    signal.signal(signal.SIGPROF, too_long)
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    try:
        return judged(lambda: CASES[part](random.Random(f"{seed}:{part}:{number}")))
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def judged(case: Callable[[], str]) -> Outcome:
    """The class of a case, and its details if it went wrong."""
    try:
        return case(), ""
    except (RequestError, RunError) as error:
        text = str(error)
        if not text.strip() or len(text.splitlines()) > 4 or "Traceback" in text:
            return "an error without a message", repr(text[:500])
        return REFUSED if isinstance(error, RequestError) else FAILED, ""
    except Wrong as wrong:
        return wrong.args[0], wrong.args[1]
    except TooLong:
        return f"longer than {LONGEST:g} s", traceback.format_exc()[-700:]
    except BaseException:
        return "a raw exception", traceback.format_exc()[-1500:]


def soak(seed: int, minutes: float, scenes: int, kills: int) -> tuple[dict[str, Counter[str]], bool, float]:
    """Counts by part and class, whether all is well, and the total time in s."""
    begun, counts = time.monotonic(), defaultdict[str, Counter[str]](Counter)
    deadline = begun + 60.0 * minutes

    def note(part: str, outcome: Outcome) -> None:
        counts[part][outcome[0]] += 1
        if outcome[0] not in GOOD:
            say(f"{part}: {outcome[0]}: {outcome[1]}")

    killing = Kills(seed, kills, deadline, note)
    thread = Thread(target=killing.run)
    thread.start()
    pool = Processes(cores())
    for part, first, last, call in submitted(pool, seed, scenes, deadline):
        where = f"--only {part}:{first} to {last - 1}"
        try:
            found = call.result(timeout=BY_THE_CLOCK * LONGEST * pool.width)
        except TimeoutError:
            pool.kill()
            found = [("does not end", where)]
        except WorkerLost as error:
            found = [("the process died", f"{where}: {error}")]
        for outcome in found:
            note(part, outcome)
    pool.close(abandon=False)
    thread.join()
    well = all(outcome in GOOD for part in counts.values() for outcome in part)
    counts["kills"]["(ended by a signal)"] = killing.done
    return counts, well, time.monotonic() - begun


def submitted(pool: Processes, seed: int, scenes: int, deadline: float) -> Iterator[tuple[str, int, int, Any]]:
    """Calls for all cases, two for each process at a time, until the deadline: part, first and last case, the call."""
    queue = [
        (part, first, min(first + AT_ONCE[part], round(share * scenes)))
        for part, share in SHARES.items()
        for first in range(0, round(share * scenes), AT_ONCE[part])
    ]
    random.Random(seed).shuffle(queue)  # so that an interrupted run has some of each part
    waiting: list[tuple[str, int, int, Any]] = []
    while True:
        while queue and len(waiting) < 2 * pool.width and time.monotonic() < deadline:
            part, first, last = queue.pop()
            waiting.append((part, first, last, pool.submit(cases, part, seed, first, last)))
        if not waiting:
            return
        yield waiting.pop(0)


def say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def as_table(counts: dict[str, Counter[str]], seconds: float, seed: int) -> list[str]:
    """Markdown."""
    lines = ["| part | class | cases |", "|---|---|---:|"]
    for part in [*CASES, "kills"]:
        lines += [f"| {part} | {outcome} | {count:,} |" for outcome, count in counts[part].most_common()]
    total = sum(count for part in counts.values() for outcome, count in part.items() if not outcome.startswith("("))
    return [*lines, "", f"{total:,} cases in {seconds / 60:.1f} minutes on {cores()} cores, seed {seed}."]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--only", metavar="PART:N", help="one case, with its traceback")
    parser.add_argument("--page", type=Path, help="write the table into this page")
    asked = parser.parse_args()
    if asked.only:
        part, number = asked.only.split(":")
        outcome = alone(part, asked.seed, int(number))
        say(" ".join(outcome))
        return outcome[0] not in GOOD
    counts, well, seconds = soak(asked.seed, asked.minutes, asked.scenes, asked.kills)
    table = as_table(counts, seconds, asked.seed)
    say("\n".join(table))
    if asked.page is not None:
        asked.page.write_text(filled(asked.page.read_text("utf-8"), "soak", table), "utf-8")
    return not well


if __name__ == "__main__":
    sys.exit(main())
