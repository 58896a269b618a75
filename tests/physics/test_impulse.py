"""Club on ball: the closed form, and the same collision in pymunk."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, inf, radians, sin

import pymunk
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sandbox.physics.impulse import Launch, club_on_ball

BALL, RADIUS = 0.04593, 0.021335  # kg, m

#: Textbook clubs: mass in kg and loft in deg.
CLUBS = {"driver": (0.200, 11), "3-wood": (0.208, 15), "3-iron": (0.239, 21), "5-iron": (0.253, 27)}
CLUBS |= {"7-iron": (0.267, 35), "9-iron": (0.281, 43)}


def strike(
    speed: float,
    loft: float,
    club_mass: float,
    ball_mass: float,
    radius: float,
    restitution: float,
    attack: float = 0.0,
    friction: float = 1.0,
) -> Launch:
    """The same collision as a contact of two bodies in pymunk: the face is a straight piece, leaning back by the loft,
    on a body that cannot rotate."""
    nx, ny = cos(loft), sin(loft)
    space = pymunk.Space()
    space.iterations = 10
    space.collision_slop = radius  # no position correction: the overlap is part of the method
    ball = pymunk.Body(ball_mass, 0.4 * ball_mass * radius * radius)
    disc = pymunk.Circle(ball, radius)
    disc.elasticity = disc.friction = 1.0  # pymunk multiplies the two shapes' values: the face has the pair's
    head = pymunk.Body(club_mass, inf)
    head.position = (-radius * (1.0 - 1e-6) * nx, -radius * (1.0 - 1e-6) * ny)
    head.velocity = (speed * cos(attack), speed * sin(attack))
    face = pymunk.Segment(head, (-radius * ny, radius * nx), (radius * ny, -radius * nx), 0.0)
    face.elasticity = restitution
    face.friction = friction
    space.add(ball, disc, head, face)
    space.step(1e-15)
    return Launch(*ball.velocity, ball.angular_velocity)


@settings(max_examples=200)
@given(
    speed=st.floats(0.0, 150.0),
    loft=st.floats(0.0, 80.0),
    attack=st.floats(-9.0, 45.0),
    mass=st.floats(0.01, 10.0),
    restitution=st.floats(0.0, 1.0),
    friction=st.floats(0.0, 2.0),
)
def test_pymunk_gives_the_closed_form_everywhere(
    speed: float, loft: float, attack: float, mass: float, restitution: float, friction: float
):
    """Faces that slip and attack from any side too."""
    club = (speed, radians(loft), mass, BALL, RADIUS, restitution, radians(attack), friction)
    assert strike(*club) == pytest.approx(club_on_ball(*club), rel=1e-6, abs=1e-6)


@given(
    loft=st.floats(0.0, 80.0),
    attack=st.floats(-9.0, 45.0),
    mass=st.floats(0.05, 10.0),
    restitution=st.floats(0.0, 1.0),
    friction=st.floats(0.0, 2.0),
)
def test_momentum_angular_momentum_and_energy(
    loft: float, attack: float, mass: float, restitution: float, friction: float
):
    """The head loses the momentum that the ball gains; about the point of contact the ball has no angular momentum,
    before or after; no energy comes from nowhere."""
    speed, loft, attack = 50.0, radians(loft), radians(attack)
    vx, vy, spin = club_on_ball(speed, loft, mass, BALL, RADIUS, restitution, attack, friction)
    head = speed * cos(attack) - BALL * vx / mass, speed * sin(attack) - BALL * vy / mass
    separation = (vx - head[0]) * cos(loft) + (vy - head[1]) * sin(loft)
    assert separation == pytest.approx(restitution * speed * cos(loft - attack), abs=1e-9)
    along = vx * sin(loft) - vy * cos(loft)
    inertia = 0.4 * BALL * RADIUS**2
    assert inertia * spin == pytest.approx(BALL * RADIUS * along, abs=1e-12)
    after = 0.5 * mass * hypot(*head) ** 2 + 0.5 * BALL * hypot(vx, vy) ** 2 + 0.5 * inertia * spin**2
    assert after <= 0.5 * mass * speed**2 * (1.0 + 1e-12)


def test_a_gripping_face_ends_without_slip():
    """Where it touches, the ball moves as the face does."""
    speed, loft, mass = 50.0, radians(30.0), 0.25
    vx, vy, spin = club_on_ball(speed, loft, mass, BALL, RADIUS, 0.8)
    head = speed - BALL * vx / mass, -BALL * vy / mass
    of_head = head[0] * sin(loft) - head[1] * cos(loft)
    of_ball = vx * sin(loft) - vy * cos(loft) + RADIUS * spin
    assert of_ball == pytest.approx(of_head)


def test_smash_factor_of_a_driver():
    """A head of 0.200 kg at the limit of restitution, 0.83, hits the ball to 1.49 of its speed (published)."""
    assert club_on_ball(1.0, 0.0, 0.2, BALL, RADIUS, 0.83).vx == pytest.approx(1.488, abs=5e-4)


@pytest.mark.parametrize("name", CLUBS)
def test_the_textbook_differs_by_what_the_docstring_says(name: str):
    """Textbook: v_t = (2/7) V sin L M / (M + m), w = (5/7) V sin L / r."""
    mass, loft = CLUBS[name][0], radians(CLUBS[name][1])
    vx, vy, spin = club_on_ball(50.0, loft, mass, BALL, RADIUS, 0.78)
    along = vx * sin(loft) - vy * cos(loft)
    textbook = (2.0 / 7.0) * 50.0 * sin(loft) * mass / (mass + BALL)
    assert -0.14 < textbook / along - 1.0 < -0.09
    assert 0.04 < (5.0 / 7.0) * 50.0 * sin(loft) / RADIUS / spin - 1.0 < 0.07


@pytest.mark.parametrize(("loft", "needed"), [(10.5, 0.04), (38.0, 0.15), (60.0, 0.32)])
def test_the_friction_that_a_gripping_face_needs(loft: float, needed: float):
    club = (40.0, radians(loft), 0.2, BALL, RADIUS, 0.8, 0.0)
    gripping = club_on_ball(*club)
    assert club_on_ball(*club, needed + 0.01) == gripping
    assert club_on_ball(*club, needed - 0.01).spin < gripping.spin


def test_a_smooth_face_gives_no_spin_and_launches_along_its_normal():
    vx, vy, spin = club_on_ball(40.0, radians(30.0), 0.25, BALL, RADIUS, 0.8, friction=0.0)
    assert spin == 0.0
    assert degrees(atan2(vy, vx)) == pytest.approx(30.0)


def test_a_face_that_moves_away_is_refused():
    with pytest.raises(ValueError, match="moves away"):
        club_on_ball(40.0, radians(80.0), 0.2, BALL, RADIUS, 0.8, radians(-20.0))
