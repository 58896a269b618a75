"""What a face does to a ball, from what the impact conserves."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import pytest

import sandbox
from sandbox import Ball, Bounce, Moving, Segment, Setup, Sliding, Surface, Turning
from sandbox.physics.swing import RUBBER, STRINGS, Rebound, apparent_restitution, gripping, struck

FACES = {(e, k): (gripping(0.5, e, k), 0.5, e, k) for e in (0.0, 0.3, 1.0) for k in (2 / 5, 0.6)}
FACES["rubber"] = RUBBER, 0.917 - 20.0 * 0.0217, 2.5 * 0.681 - 1.0, 2 / 3


@pytest.mark.parametrize("name", FACES)
def test_a_face_that_grips_returns_a_share_of_the_slip(name):
    """Kept: v + k r w, the angular momentum about the point of contact; and v - r w there becomes -e_t times that."""
    face, restitution, tangential, factor = FACES[name]
    r, speed, spin = 0.0366, 7.0, -150.0
    (out, after), turning = struck(face, (0.0, 0.0), 0.0, (-20.0, speed), spin, r)
    assert out == pytest.approx(20.0 * restitution)
    assert after + factor * r * turning == pytest.approx(speed + factor * r * spin, rel=1e-12)
    assert after - r * turning == pytest.approx(-tangential * (speed - r * spin), rel=1e-12, abs=1e-12)


def test_a_bat_struck_at_its_centre_is_a_two_body_collision():
    """A ball m on a bat M at rest leaves with (e M - m) / (M + m) of its speed; farther out with less."""
    m, bat, e = 0.145, 0.88, 0.5
    assert apparent_restitution(e, m, bat, 0.05, 0.0) == pytest.approx((e * bat - m) / (bat + m), rel=1e-12)
    assert apparent_restitution(e, m, bat, 0.05, 0.1) < apparent_restitution(e, m, bat, 0.05, 0.05)


@dataclass(frozen=True)
class Held:
    """The law of a face that grips, held as a rebound says."""

    rebound: Rebound
    tangential: float

    def __call__(self, normal_speed: float, slip: float) -> Bounce:
        restitution = self.rebound.normal - self.rebound.softer * normal_speed
        return Bounce(restitution, friction=100.0, tangential=self.tangential)


@pytest.mark.parametrize("turns", [False, True], ids=["pushed", "swung"])
@pytest.mark.parametrize("name", FACES)
def test_a_face_that_moves_strikes_as_the_formula_says(name, turns: bool):
    """A surface that slides, or that turns about a handle 0.8 m below, meets the ball in time, and strikes it as the
    formula does with the velocity of the point that is struck."""
    rebound, _, tangential, factor = FACES[name]
    r, velocity, spin, tilt = 0.0366, (-9.0, -2.0), -150.0, 0.1
    nx, ny = cos(tilt), sin(tilt)
    ends = (-0.1 * ny, 0.1 * nx), (0.1 * ny, -0.1 * nx)
    motion = Turning((0.0, -0.8), rate=-20.0, start=0.02) if turns else Sliding((15.0, 5.0), start=0.02)
    face = Surface("bat", Segment(*ends), 0.5, 0.0, law=Held(rebound, tangential))
    start = r * nx - 0.02 * velocity[0], r * ny - 0.02 * velocity[1]  # at 0.02 s it touches the middle of the face
    ball = Ball("ball", 0.145, r, start, velocity, spin, inertia_factor=factor)
    run = sandbox.simulate(Setup([ball], [Moving(face, motion)], duration=0.05))
    hit = run.events[0]
    assert hit.t == pytest.approx(0.02, abs=1e-9)
    pushed = (20.0 * 0.8, 0.0) if turns else (15.0, 5.0)
    after, turning = struck(rebound, pushed, tilt, velocity, spin, r)
    state = run.state("ball", hit.t)
    assert [*state[2:4]] == pytest.approx([*after], abs=1e-6)
    assert state.spin == pytest.approx(turning, abs=1e-4)


def test_strings_are_no_such_face():
    """Fitted to films, they give the ball angular momentum about the point of contact: a face that grips does not."""
    kept = [
        (STRINGS.slide + 0.55 * STRINGS.kick) - 1.0,  # of a ball that moves along, without spin
        (STRINGS.lift + 0.55 * STRINGS.turn) - 0.55,  # of one that spins
    ]
    assert kept == pytest.approx([-0.031, -0.030], abs=1e-3)
