"""The same scene gives the same run to the last bit: in one process, in another, and after a reset."""

import hashlib
import struct
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from tests.engine import shots

ROOT = Path(__file__).parents[2]
QUANTITIES = ("x", "y", "vx", "vy", "spin")


def runs(**how):
    return [simulate(shots.setup(*shot, 2.5), resolve(**how)) for shot in shots.seeded(6)]


def first_difference(one, other):
    """Where two runs part: "arc 3 at t = 0.93 s, ball, vx: 1.0 and 1.1", or None."""
    for ball in one.arcs:
        for number, (a, b) in enumerate(zip(one.arcs[ball], other.arcs[ball], strict=False)):
            for quantity, x, y in zip(("t", *QUANTITIES), (a.t0, *a.start), (b.t0, *b.start), strict=True):
                if struct.pack("d", x) != struct.pack("d", y):
                    return f"arc {number} at t = {a.t0} s, {ball}, {quantity}: {x!r} and {y!r}"
        if len(one.arcs[ball]) != len(other.arcs[ball]):
            return f"{ball}: {len(one.arcs[ball])} and {len(other.arcs[ball])} arcs"
    return None


def digest():
    """A hash of every arc of every run."""
    whole = hashlib.sha256()
    for run in runs():
        for arc in run.arcs["ball"]:
            whole.update(struct.pack("6d", arc.t0, *arc.start))
    return whole.hexdigest()


@pytest.mark.parametrize("how", [{}, {"level": "precise"}, {"method": "plain", "step": 2e-3}], ids=str)
def test_two_runs_in_one_process_are_bit_equal(how):
    for one, other in zip(runs(**how), runs(**how), strict=True):
        assert first_difference(one, other) is None


def test_threads_do_not_disturb_each_other():
    """They share what pymunk computes impulses in only within a thread."""
    before = digest()
    with ThreadPoolExecutor(4) as pool:
        assert {future.result() for future in [pool.submit(digest) for _ in range(12)]} == {before}


def test_another_process_gives_the_same_bits():
    command = [sys.executable, "-c", "from tests.engine.test_determinism import digest; print(digest())"]
    there = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert there.stdout.strip() == digest()


def test_a_difference_is_named():
    one, other = runs()[0], runs()[0]
    arc = other.arcs["ball"][2]
    arc.start = (*arc.start[:2], arc.start[2] + 1e-15, *arc.start[3:])
    assert first_difference(one, other).startswith(f"arc 2 at t = {arc.t0} s, ball, vx:")
