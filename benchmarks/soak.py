"""Soak test: some minutes of hard use, in which every outcome must be correct or a named error.

Run ``python benchmarks/soak.py [--seed N] [--minutes M] [--scenes N] [--kills N] [--page F.md]``. The same seed gives
the same cases, each of which can be repeated alone: ``--only scenes:123``. Parts:

- scenes: the built-in scenes with random parameters, and scene files with changed bytes
- setups: balls, surfaces and forces with numbers from 1e-320 to 1e300
- faulty: user scenes with mistakes, in run, sweep and aim
- replays: recorded shots with changed bytes, and forged ones with a correct checksum
- kills: sweeps ended by SIGKILL, SIGTERM or Ctrl-C at any moment, with damaged files, or two at once into one file;
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
from math import cos, isfinite, sin
from pathlib import Path
from threading import Thread
from typing import Any

from sandbox.workers import Processes, WorkerLost, cores

#: Processor time in s after which a case counts as endless; by the clock, this many times as long.
LONGEST, BY_THE_CLOCK = 30.0, 6

#: Cases per call to a process.
AT_ONCE = {"scenes": 20, "setups": 40, "faulty": 4, "replays": 40}

#: Number of cases of the other parts, as fractions of the fuzzed scenes.
SHARES = {"setups": 0.15, "faulty": 0.03, "replays": 0.06}

#: Classes that pass; all others fail.
GOOD = (
    "ran",
    "request refused",
    "run failed by name",
    "read",
    "finished, the same bytes",
    "one wrote, the other was refused",
)

#: A traceback line from this program after start-up; earlier ones are from Python's own start.
OURS = re.compile(r'File "[^"]*/sandbox/(?!__init__|__main__|cli/__init__)')

PROGRAM = [sys.executable, "-m", "sandbox"]

Outcome = tuple[str, str]  # class, and details of one that is not good


def say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


class TooLong(BaseException):
    """The case took too long."""


# ---------------------------------------------------------------------------------------------------------------------
# Fuzzed scenes
# ---------------------------------------------------------------------------------------------------------------------

NONSENSE: list[Any] = [
    None, True, "", "12 m", "1e400 m", "nan", float("nan"), float("inf"), -1, 10**400, 1e300, 1e-320, [], [1],
    [1, 2, 3],
    {}, {"a": 1}, {5: 1}, "none", "\x1b[31m", "=1+1", "a" * 300, [[]], {"model": "constant"}, b"x", 1j,
]  # fmt: skip


def fuzzed_scene(draw: random.Random) -> Outcome:
    import sandbox
    from sandbox import parameters as declared

    name = draw.choice(scenes_and_presets())
    if draw.random() < 0.4:
        return scrambled_file(draw, name)
    known = [p for p in declared.walk(sandbox.load(name).parameters) if not p.key.startswith("accuracy.")]
    changes: dict[str, Any] = {}
    for parameter in draw.sample(known, draw.choice((1, 2, 3, 6, len(known)))):
        changes[parameter.key] = any_value(draw, parameter)
    if draw.random() < 0.15:
        changes[draw.choice([*(p.key for p in known), "nothing", "air", "air.wind[0]", "a.b[9].c"])] = draw.choice(
            NONSENSE
        )
    changes.setdefault("accuracy.level", draw.choice(("fast", "fast", "balanced")))
    if draw.random() < 0.1:
        changes |= {"accuracy.method": "plain", "accuracy.step": draw.choice((1 / 60, 1 / 240))}
    return run_and_look(lambda: sandbox.load(name, changes), changes)


@cache
def scenes_and_presets() -> list[str]:
    from sandbox.scene import listings

    return [found.name for found in listings()]


def any_value(draw: random.Random, parameter: Any) -> Any:
    """A value that the declaration of a parameter allows, or its current one."""
    if parameter.choices:
        return draw.choice(parameter.choices)
    if isinstance(parameter.value, bool):
        return draw.random() < 0.5
    if parameter.low is None or parameter.high is None:
        return parameter.value

    def number() -> float:
        low, high = parameter.low, parameter.high
        special = [x for x in (low, high, 0.0, 1e-9, 1.0) if low <= x <= high]
        near = parameter.value if isinstance(parameter.value, float) else 0.5 * (low + high)
        kinds = [draw.choice(special), draw.uniform(low, high), min(max(near * draw.uniform(0.5, 1.5), low), high)]
        return float(draw.choice(kinds))

    if isinstance(parameter.value, tuple | list):
        return [number() if isinstance(part, float) else part for part in parameter.value]
    return number()


def scrambled_file(draw: random.Random, name: str) -> Outcome:
    """A scene file with some bytes changed, removed or added."""
    import sandbox
    from sandbox import resources

    folder = resources.folder("scenes") / name.partition("/")[0]
    file = draw.choice([*folder.glob("*.toml"), *folder.glob("presets/*.toml")])
    text = bytearray(file.read_bytes())
    for _ in range(draw.choice((1, 1, 2, 5, 30))):
        place = draw.randrange(len(text))
        part = bytes(draw.choice((b"\0", b"\xff", b'"', b"[", b"=", b"9", b"-", b"\n", b"1e999", b"nan", b"\x1b[2J")))
        text[place : place + draw.choice((0, 1, 1, 40))] = part
    if b"scene" not in text:
        text = bytearray(f'scene = "{name.partition("/")[0]}"\n'.encode()) + text
    with tempfile.TemporaryDirectory() as place_of_it:
        path = Path(place_of_it) / "shot.toml"
        path.write_bytes(bytes(text))
        return run_and_look(lambda: sandbox.load(path, {"accuracy.level": "fast"}), file.name)


def run_and_look(load: Callable[[], Any], about: object) -> Outcome:
    import sandbox
    from sandbox.errors import RequestError, RunError

    try:
        run = sandbox.simulate(load())
    except RequestError as error:
        return named("request refused", error)
    except RunError as error:
        return named("run failed by name", error)
    json.dumps(run.result, default=str)
    return looked_at(run, about)


def looked_at(run: Any, about: object) -> Outcome:
    """Whether all numbers of a run are finite."""
    values: list[Any] = [run.result, run.duration]
    for arcs in run.arcs.values():
        values += [arc.start for arc in arcs]
        values += [arc.state(arc.t1) for arc in arcs[-1:]]
    return ("ran", "") if all(isfinite(x) for x in numbers(values)) else ("not finite", repr(about))


def numbers(value: Any) -> Iterator[float]:
    for part in (
        list(value.values()) if isinstance(value, dict) else value if isinstance(value, list | tuple) else [value]
    ):
        if isinstance(part, dict | list | tuple):
            yield from numbers(part)
        elif isinstance(part, float):
            yield part


def named(outcome: str, error: Exception) -> Outcome:
    """Check that a named error is one or a few lines of text."""
    text = str(error)
    if not text.strip() or len(text.splitlines()) > 4 or "Traceback" in text:
        return "an error without a message", repr(text[:500])
    return outcome, ""


# ---------------------------------------------------------------------------------------------------------------------
# Setups
# ---------------------------------------------------------------------------------------------------------------------


def extreme_setup(draw: random.Random) -> Outcome:
    from sandbox.engine import simulate
    from sandbox.engine.accuracy import resolve
    from sandbox.engine.setup import Ball, Segment, Setup, Surface
    from sandbox.errors import RequestError, RunError
    from sandbox.physics.forces import Gravity

    def size(usual: float) -> float:
        return draw.choice((usual, usual, usual, usual * 10 ** draw.uniform(-9, 9), 10 ** draw.uniform(-320, 300)))

    def signed(usual: float) -> float:
        return draw.choice((-1.0, 1.0, 1.0, 0.0)) * size(usual)

    mass, angle = size(0.1), draw.uniform(-1.5, 1.5)
    try:
        ball = Ball(
            "ball", mass, size(0.03), (signed(1.0), size(2.0)), (signed(10.0), signed(10.0)), signed(100.0),
            forces=(Gravity(mass, size(9.81)),),
        )  # fmt: skip
        far = size(100.0)
        floor = Segment((-far * cos(angle), -far * sin(angle)), (far * cos(angle), far * sin(angle)))
        surfaces = (Surface("floor", floor, draw.random(), friction=draw.choice((0.0, 0.4, 1e300))),)
        balls = [ball]
        if draw.random() < 0.4:
            balls.append(Ball("other", size(0.1), size(0.03), (signed(1.0), signed(1.0)), (signed(1.0), 0.0)))
        method = draw.choice(({}, {}, {}, {"method": "plain", "step": draw.choice((1e-3, 1 / 60))}))
        accuracy = resolve(level=draw.choice(("fast", "balanced")), **method)
        run = simulate(Setup(tuple(balls), surfaces, duration=draw.choice((0.5, 2.0, 2.0))), accuracy)
    except RequestError as error:
        return named("request refused", error)
    except RunError as error:
        return named("run failed by name", error)
    return looked_at(run, "a setup")


# ---------------------------------------------------------------------------------------------------------------------
# Scenes with mistakes
# ---------------------------------------------------------------------------------------------------------------------

#: What a force, a law, ``until``, a fact, the verdict or ``build`` does wrongly.
FORCES = (
    "return None", "return 1.0", "return (1.0,)", "return (1j, 0.0)", "return (10**400, 0.0)", "return 'a', 'b'",
    "return (float('nan'), 0.0)", "return (float('inf'), 0.0)", "raise ValueError('\\x1b[31mred')",
    "import sys; sys.exit(0)",
    "raise SystemExit", "import numpy; return numpy.ones((2, 1))", "return self(t, position, velocity, spin)", "1 / 0",
    "raise KeyboardInterrupt", "raise type('Odd', (Exception,), {})('two\\nlines')", "return 1e308 * velocity[0], 0.0",
    "import sandbox; return sandbox.nothing", "return 0.0, -1e9 * position[1]", "assert False",
)  # fmt: skip
FACTS = (
    "return 1j", "return float('nan')", "return run", "x = []; x.append(x); return x", "return {5: 1}", "1 / 0",
    "import sys; sys.exit(3)", "return '\\x1b[2J\\nx'", "return 10**400", "return b'x'", "return run.nothing",
    "return ...",
)  # fmt: skip
VERDICTS = (
    "return None",
    "return 5",
    "return '\\x1b]0;x\\x07'",
    "1 / 0",
    "return 'a' * 10000",
    "import os; os.close(1)",
)
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
    ("def build", "def bild"), ("class Parameters(Group)", "class Parameters"), ("FACTS", "FACT"),
    ("import", "import\0"),
    ("def build(parameters: Parameters)", "def build()"), ("from __future__", "from __past__"), ("launch", "lunch"),
    ("    accuracy: Accuracy", "    other: Accuracy"), ("quantity(10.0", "quantity(None"), ('"m/s"', '"mm/s"'),
    ("quantity(", "quantity(*"), ("CONTROLS = Controls(", "CONTROLS = dict("), ("return", "return return"),
    ("0", "\xff"),
)  # fmt: skip


def faulty_scene(draw: random.Random) -> Outcome:
    from sandbox.new import new_scene

    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "mine"
        new_scene(folder)
        file = folder / "scene.py"
        text = file.read_text("utf-8")
        kind = draw.choice(("force", "force", "fact", "verdict", "build", "text"))
        if kind == "force":
            mistake = draw.choice(FORCES)
            when = draw.choice(("", "if t > 0.05:\n            "))
            text = after(text, r"    def __call__\(self, t[^\n]*\n", f"        {when}{mistake}\n")
        elif kind == "fact":
            mistake = draw.choice(FACTS)
            text = f"{text}\n\ndef _mistake(run, parameters):\n    {mistake}\n\n\n"
            text += "FACTS = (*FACTS, Fact('mistake', 'mistake', '', _mistake))\n"
        elif kind == "verdict":
            mistake = draw.choice(VERDICTS[:-1])
            text += f"\n\ndef verdict(run, parameters):\n    {mistake}\n"
        elif kind == "build":
            mistake = draw.choice(BUILDS)
            text = after(text, r"def build\([^\n]*\n", f"    {mistake}\n")
        else:
            old, mistake = draw.choice(TEXTS)
            text = text.replace(old, mistake, draw.choice((1, -1)))
        file.write_bytes(text.encode("latin-1" if "\xff" in text else "utf-8", "replace"))
        command = draw.choice(
            (
                ["run", str(folder)],
                ["run", str(folder), "--json"],
                ["run", str(folder), "--set", "accuracy.method=plain"],
                ["run", str(folder), "--check"],
                ["sweep", str(folder), "--over", "launch.speed=5:9:3", "--jobs", "1", "--out", f"{place}/x.csv"],
                ["aim", str(folder), "--vary", "launch.angle=40:70", "--target", "hit=true"],
            )
        )
        return called(command, f"{kind}: {mistake!r}: {command[0]} {' '.join(command[2:])}")


def after(text: str, pattern: str, added: str) -> str:
    """Insert ``added`` below the docstring of the first function that matches ``pattern``."""
    found = re.search(pattern, text)
    assert found, pattern
    return text[: found.end()] + added + text[found.end() :]


def called(command: list[str], about: str) -> Outcome:
    """Run the program in this process and check its output."""
    from sandbox.cli import main

    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(command)
    said = err.getvalue()
    if any(ord(mark) < 32 and mark not in "\n\t\r" for mark in out.getvalue() + said):
        return "control characters", about
    if code == 0:
        return "ran", ""
    if code == 130 and "KeyboardInterrupt" in about:
        return "run failed by name", ""
    lines = said.splitlines()
    if code not in (1, 2) or not lines or not lines[0].startswith("error: "):
        return f"exit {code} without an error line", f"{about}: {said[-500:]}"
    if "Traceback" in said and "your scene failed" not in lines[0]:
        return "a traceback of our own", f"{about}: {said[-500:]}"
    return ("request refused" if code == 2 else "run failed by name"), ""


# ---------------------------------------------------------------------------------------------------------------------
# Replays
# ---------------------------------------------------------------------------------------------------------------------

_recorded: list[bytes] = []


def forged_replay(draw: random.Random) -> Outcome:
    from sandbox.errors import RequestError, RunError
    from sandbox.window import replay

    if not _recorded:
        record_some()
    content = draw.choice(_recorded)
    if draw.random() < 0.4:
        changed = bytearray(content)
        for _ in range(draw.choice((1, 1, 3, 50))):
            changed[draw.randrange(len(changed))] = draw.randrange(256)
        content = bytes(changed[: draw.choice((len(changed), len(changed), draw.randrange(len(changed))))])
    else:
        record = json.loads(content)
        for _ in range(draw.choice((1, 1, 2, 6))):
            forge(draw, record["body"])
        record["check"] = replay._sum(record["body"])
        content = json.dumps(record).encode()
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / f"shot{replay.SUFFIX}"
        path.write_bytes(content)
        (Path(place) / "scene.py").write_text("raise SystemExit('code of the replay ran')\n")
        try:
            session, shot = replay.read(path)
        except RequestError as error:
            return named("request refused", error)
        except RunError as error:
            return named("run failed by name", error)
        shot.run.state(shot.ball, 0.5 * shot.run.duration)
        assert session.scene is not None
        return "read", ""


def record_some() -> None:
    from sandbox.scene import load, simulate
    from sandbox.window import replay
    from sandbox.window.shot import Shot

    for name in ("golf/putt", "basketball", "billiards"):
        scene = load(name)
        with tempfile.TemporaryDirectory() as place:
            path = Path(place) / f"x{replay.SUFFIX}"
            replay.save(Shot(scene, simulate(scene), {}, name), path)
            _recorded.append(path.read_bytes())


def forge(draw: random.Random, node: Any) -> None:
    """Change one thing, somewhere in the tree."""
    while True:
        keys = list(node) if isinstance(node, dict) else list(range(len(node)))
        if not keys:
            return
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

#: A scene of one ball whose runs take a few ms each; one point raises, which is a row like others.
SLOW = '''"""A drop."""

import time

from sandbox.engine.setup import Ball, Segment, Setup, Surface
from sandbox.parameters import Accuracy, Group, group, quantity
from sandbox.physics.forces import Gravity


class Parameters(Group):
    """A drop."""

    height: float = quantity(2.0, "m", 0.1, 100, "height")
    pause: float = quantity(2.0, "ms", 0, 1000, "time that it takes to build")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


def build(parameters):
    time.sleep(0.001 * parameters.pause)
    if 1.5 < parameters.height < 1.51:
        raise ValueError("not there")
    ball = Ball("ball", 0.1, 0.03, (0.0, parameters.height), forces=(Gravity(0.1, 9.81),))
    floor = Surface("floor", Segment((-9, 0), (9, 0)), 0.5, 0.5)
    return Setup((ball, Ball("other", 0.1, 0.03, (5.0, 5.0))), (floor,), 0.4)
'''


class Kills:
    """Sweeps that are interrupted again and again until each is complete."""

    def __init__(self, seed: int, kills: int, deadline: float, note: Callable[[str, Outcome], None]) -> None:
        self.seed, self.kills, self.deadline, self.note = seed, kills, deadline, note
        self.done = 0

    def run(self) -> None:
        with tempfile.TemporaryDirectory() as place:
            folder = Path(place) / "slow"
            folder.mkdir()
            (folder / "scene.py").write_text(SLOW)
            number = 0
            while self.done < self.kills and time.monotonic() < self.deadline:
                draw = random.Random(f"{self.seed}:kills:{number}")
                try:
                    outcome = self.one(draw, folder, Path(place) / f"{number}")
                except Exception:
                    outcome = "the soak itself failed", traceback.format_exc()
                self.note("kills", (outcome[0], f"case {number}: {outcome[1]}" if outcome[1] else ""))
                number += 1

    def one(self, draw: random.Random, folder: Path, place: Path) -> Outcome:
        place.mkdir()
        points, jobs = draw.choice((150, 400)), draw.choice((1, 2))
        over = ["--over", f"height=1:2:{points}", "--set", "accuracy.level=fast"]
        expected, out = place / "expected.csv", place / "rows.csv"
        command = [*PROGRAM, "sweep", str(folder), *over, "--jobs", str(jobs), "--out", str(out)]
        good = subprocess.run([*command[:-1], str(expected)], capture_output=True, text=True, timeout=120)
        if good.returncode:
            return f"exit {good.returncode}", good.stderr[-500:]
        story: list[str] = []
        for _ in range(60):
            if self.done >= self.kills or time.monotonic() > self.deadline or draw.random() < 0.08:
                break
            if draw.random() < 0.06:
                problem = self.two_at_once(command, place)
                if problem is not None:
                    return problem
                break
            by = draw.choice((signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT))
            problem = self.kill(command, by, draw.choice((draw.uniform(0.0, 0.4), draw.uniform(0.3, 1.2))))
            if problem is not None:
                return problem
            self.done += 1
            story.append(by.name)
            if not out.exists():
                continue
            if not (place / "rows.csv.resume").exists():  # it was already done
                break
            if draw.random() < 0.1:
                damage(draw, out)
                story.append("damaged")
        last = subprocess.run(command, capture_output=True, text=True, timeout=120)
        if last.returncode == 2 and "damaged" in story and "its first line is not what" in last.stderr:
            return "request refused", ""
        if last.returncode or "Traceback" in last.stderr:
            return f"exit {last.returncode}", f"{story}: {last.stderr[-500:]}"
        if out.read_bytes() != expected.read_bytes():
            return "finished, other bytes", repr(story)
        left = {path.name for path in place.iterdir()} - {"expected.csv", "rows.csv", "rows.csv~"}
        if {name for name in left if not name.endswith(".part")}:  # from a rewrite that was killed
            return "files were left", repr(sorted(left))
        shutil.rmtree(place)
        return "finished, the same bytes", ""

    def kill(self, command: list[str], by: signal.Signals, after: float) -> Outcome | None:
        """Start the sweep and end it; None if that worked as expected."""
        process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
        )
        time.sleep(after)
        whole = by is signal.SIGINT and after > 0.2
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, by) if whole else process.send_signal(by)
        try:
            _, said = process.communicate(timeout=30)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return "does not end", f"{by.name} after {after:.2f} s"
        if "leaked" in said or OURS.search(said):
            return "a traceback of our own", f"{by.name} after {after:.2f} s: {said[-600:]}"
        for _ in range(100):
            try:
                os.killpg(process.pid, 0)
            except (ProcessLookupError, PermissionError):
                return None
            time.sleep(0.05)
        os.killpg(process.pid, signal.SIGKILL)
        return "processes were left", f"{by.name} after {after:.2f} s"

    def two_at_once(self, command: list[str], place: Path) -> Outcome | None:
        both = [subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for _ in range(2)]
        said = [process.communicate(timeout=120)[1] for process in both]
        codes = sorted(process.returncode for process in both)
        refused = [text for text in said if "another sweep is writing to this file" in text]
        if codes == [0, 2] and len(refused) == 1:
            self.note("kills", ("one wrote, the other was refused", ""))
        elif codes == [0, 0]:  # the first was done before the second started
            self.note("kills", ("finished, the same bytes", ""))
        else:
            return f"two at once: exits {codes}", repr(said)[-600:]
        return None


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
    file.write_bytes(bytes(content))


# ---------------------------------------------------------------------------------------------------------------------
# Main program
# ---------------------------------------------------------------------------------------------------------------------

CASES: dict[str, Callable[[random.Random], Outcome]] = {
    "scenes": fuzzed_scene,
    "setups": extreme_setup,
    "faulty": faulty_scene,
    "replays": forged_replay,
}


def cases(part: str, seed: int, first: int, last: int) -> list[Outcome]:
    """Some cases of a part, in any process; each depends only on the seed and its number."""
    found = []
    for number in range(first, last):
        outcome, details = alone(part, random.Random(f"{seed}:{part}:{number}"))
        found.append((outcome, f"--only {part}:{number}: {details}" if outcome not in GOOD else ""))
    return found


def alone(part: str, draw: random.Random) -> Outcome:
    def too_long(*_: object) -> None:
        raise TooLong

    signal.signal(signal.SIGPROF, too_long)
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    try:
        return CASES[part](draw)
    except TooLong:
        return f"longer than {LONGEST:g} s", traceback.format_exc()[-700:]
    except (Exception, SystemExit, KeyboardInterrupt):
        return "a raw exception", traceback.format_exc()[-1500:]
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def soak(seed: int, minutes: float, scenes: int, kills: int) -> tuple[dict[str, Counter[str]], list[str], float]:
    """Counts by part and class, the failures, and the total time in s."""
    begun, counts, wrong = time.monotonic(), defaultdict[str, Counter[str]](Counter), list[str]()
    deadline = begun + 60.0 * minutes

    def note(part: str, outcome: Outcome) -> None:
        counts[part][outcome[0]] += 1
        if outcome[0] not in GOOD:
            wrong.append(f"{part}: {outcome[0]}: {outcome[1]}")
            say(wrong[-1])

    killing = Kills(seed, kills, deadline, note)
    thread = Thread(target=killing.run)
    thread.start()
    pool = Processes(cores())
    sizes = {"scenes": scenes, **{part: round(share * scenes) for part, share in SHARES.items()}}
    queue = [
        (part, first, min(first + AT_ONCE[part], size))
        for part, size in sizes.items()
        for first in range(0, size, AT_ONCE[part])
    ]
    random.Random(seed).shuffle(queue)  # so that an interrupted run has some of each part
    waiting: list[tuple[str, int, int, Any]] = []
    while queue or waiting:
        while queue and len(waiting) < 2 * pool.width and time.monotonic() < deadline:
            part, first, last = queue.pop()
            waiting.append((part, first, last, pool.submit(cases, part, seed, first, last)))
        if not waiting:
            break
        part, first, last, call = waiting.pop(0)
        try:
            found = call.result(timeout=BY_THE_CLOCK * LONGEST * pool.width)
        except TimeoutError:
            pool.kill()
            found = [("does not end", f"--only {part}:{first} to {last - 1}")]
        except WorkerLost as error:
            found = [("the process died", f"--only {part}:{first} to {last - 1}: {error}")]
        for outcome in found:
            note(part, outcome)
    pool.close(abandon=False)
    thread.join()
    counts["kills"]["(ended by a signal)"] = killing.done
    return counts, wrong, time.monotonic() - begun


def as_table(counts: dict[str, Counter[str]], seconds: float, seed: int) -> list[str]:
    """Markdown."""
    lines = ["| part | class | cases |", "|---|---|---:|"]
    for part in [*CASES, "kills"]:
        for outcome, count in sorted(counts[part].items(), key=lambda item: -item[1]):
            lines.append(f"| {part} | {outcome} | {count:,} |")
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
        outcome = CASES[part](random.Random(f"{asked.seed}:{part}:{number}"))
        say(" ".join(outcome))
        return outcome[0] not in GOOD
    counts, wrong, seconds = soak(asked.seed, asked.minutes, asked.scenes, asked.kills)
    table = as_table(counts, seconds, asked.seed)
    say("\n".join(table))
    if asked.page is not None:
        begin, end = "<!-- soak -->\n", "<!-- end -->\n"
        text = asked.page.read_text("utf-8")
        head, _, rest = text.partition(begin)
        _, _, tail = rest.partition(end)
        asked.page.write_text(f"{head}{begin}{chr(10).join(table)}\n{end}{tail}", "utf-8")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
