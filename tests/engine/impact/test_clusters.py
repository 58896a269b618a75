"""Balls that meet while they are pressed together, against closed forms, publications and symmetries."""

from __future__ import annotations

from math import cos, hypot, radians, sin, sqrt

import numpy as np
import pytest

import sandbox
from sandbox.engine.impact.cluster_parts import ClusterBall, Link
from sandbox.engine.impact.clusters import Cluster, Unresolved
from sandbox.engine.ledger import ledger
from sandbox.engine.model.surface import ELASTIC, Bounce
from sandbox.physics.hertz import contact_time
from sandbox.physics.throw import friction_by_speed
from tests.engine.contact_law import by_contact_law

MASS, RADIUS, STIFFNESS = 0.170097, 0.028575, 5.262e8  # of pool balls: kg, m, N/m^1.5
STEP = 0.025


def ball(x, y, vx=0.0, vy=0.0, spin=(0.0, 0.0, 0.0), mass=MASS):
    return ClusterBall(mass, RADIUS, 0.4 * mass * RADIUS**2, (x, y), (vx, vy), spin)


def passage(*how, step=STEP, **more):
    """Through a cluster."""
    return cluster(*how, **more).pass_through(step)


def cluster(bodies, restitution=1.0, friction=0.0, reach=3e-3, stiffness=STIFFNESS):
    """One in which all balls with gaps below ``reach`` (m) are linked."""
    law = friction if callable(friction) else lambda slip: friction

    def bounce(approach, slip):
        return Bounce(restitution, law(slip))

    links = [
        Link(i, j, stiffness, restitution, bounce)
        for i, one in enumerate(bodies)
        for j, other in enumerate(bodies[:i])
        if hypot(one.position[0] - other.position[0], one.position[1] - other.position[1]) < 2 * RADIUS + reach
    ]
    return Cluster(bodies, links)


def chain(count, gap=0.0, speed=1.0):
    """Balls in a row; the first, at ``speed``, touches the second, and there are gaps between the others."""
    return [ball(i * 2 * RADIUS + max(0, i - 1) * gap, 0.0, 0.0 if i else speed) for i in range(count)]


def rack(speed, gap):
    """Nine balls in a diamond, and a cue ball that touches the first."""
    apart = 2 * RADIUS + gap
    spots = [
        (row * apart * sqrt(3) / 2, (i - (count - 1) / 2) * apart)
        for row, count in enumerate((1, 2, 3, 2, 1))
        for i in range(count)
    ]
    return [ball(-2 * RADIUS, 0.0, speed), *(ball(x, y) for x, y in spots)]


def energy(velocity, spin, bodies):
    turning = sum(0.5 * body.inertia * float(w @ w) for body, w in zip(bodies, spin, strict=True))
    return turning + sum(0.5 * body.mass * float(v @ v) for body, v in zip(bodies, velocity, strict=True))


@pytest.mark.parametrize("restitution", [1.0, 0.95, 0.7, 0.3])
def test_a_pair_has_its_restitution(restitution):
    outcome = passage(chain(2), restitution)
    assert outcome.velocity[1, 0] - outcome.velocity[0, 0] == pytest.approx(restitution, abs=1e-6)
    assert outcome.approach[0] == 1.0


def test_a_pair_touches_for_hertz_s_time():
    assert passage(chain(2)).times[-1] == pytest.approx(contact_time(MASS / 2, STIFFNESS, 1.0), rel=1e-3)


def test_three_equal_balls_in_a_row():
    """-0.071, 0.076 and 0.995 of the blow (Alciatore, TP B.29)."""
    assert passage(chain(3)).velocity[:, 0] == pytest.approx([-0.071, 0.076, 0.995], abs=6e-4)


def test_two_frozen_balls_leave_alike():
    """A ball against two frozen ones, along their common tangent: they differ by nothing (Cross 2016: 3 % measured)."""
    bodies = [ball(0.0, 0.0, 1.0), ball(RADIUS * sqrt(3), RADIUS), ball(RADIUS * sqrt(3), -RADIUS)]
    outcome = passage(bodies, 0.95)
    assert outcome.velocity[1] == pytest.approx(outcome.velocity[2] * [1, -1], abs=1e-9)


def test_a_wide_gap_gives_the_pairs_one_after_another():
    """0, 0 and 1 for equal balls without loss, as the gap grows; nothing in between jumps."""
    last = [passage(chain(3, gap)).velocity[2, 0] for gap in (0.0, 1e-6, 1e-5, 3e-5, 1e-4)]
    assert last == sorted(last)
    assert last[-1] == pytest.approx(1.0, abs=1e-5)


@pytest.mark.parametrize(("friction", "roll"), [(0.05, 0.0), (0.05, 20.0), (0.8, 0.0), (0.8, 20.0)])
def test_friction_of_a_pair_is_coulomb_s(friction, roll):
    """A pair that slides passes on mu times the normal impulse, one that grips ends without slip."""
    cut = radians(40.0)
    bodies = [ball(0.0, 0.0, 1.0, spin=(0.0, roll, 0.0)), ball(2 * RADIUS * cos(cut), 2 * RADIUS * sin(cut))]
    outcome = passage(bodies, 0.95, friction)
    along = outcome.velocity[1] @ [cos(cut), sin(cut)]
    across = outcome.velocity[1] @ [-sin(cut), cos(cut)]
    if friction < 0.1:
        slip = hypot(sin(cut), RADIUS * roll * cos(cut))  # the part of friction in the plane
        assert -across / along == pytest.approx(friction * sin(cut) / slip, rel=0.06)  # normal and slip turn a little
    else:
        ux, uy = outcome.velocity[0] - outcome.velocity[1]
        slip = ux * sin(cut) - uy * cos(cut) - RADIUS * (outcome.spin[0, 0] + outcome.spin[1, 0])
        assert slip == pytest.approx(0.0, abs=2e-2)  # of where they met


def test_friction_may_depend_on_the_slip_in_any_way():
    """None at rest and none from 1 m/s on, but some between."""
    bodies = [ball(0.0, 0.0, 1.0), ball(2 * RADIUS * cos(0.7), 2 * RADIUS * sin(0.7))]
    between = passage(bodies, 0.95, lambda slip: 0.05 if 0.1 < slip < 0.9 else 0.0)
    assert between.spin[1] == pytest.approx(passage(bodies, 0.95, 0.05).spin[1])
    assert abs(between.spin[1, 0]) > 1.0


APART = 2 * RADIUS
TRIANGLE = [ball(row * APART * sqrt(3) / 2, (place - row / 2) * APART) for row in range(4) for place in range(row + 1)]


@pytest.mark.parametrize(
    ("others", "angle", "spin", "restitution", "friction"),
    [
        ([ball(0.0, 0.0), ball(APART, 0.0)], 30.0, (0.0, 0.0, 0.0), 0.5, 0.3),
        ([ball(place * APART, 0.0) for place in range(3)], 20.0, (0.0, 60.0, 0.0), 0.9, 0.1),
        (TRIANGLE[:3], 20.0, (0.0, 280.0, 50.0), 0.95, 0.05),
        (TRIANGLE[:6], 15.0, (0.0, 0.0, 0.0), 0.5, 0.3),
        (rack(8.0, 1e-5)[1:], 5.0, (0.0, 100.0, 0.0), 0.9, 0.05),
        ([ball(0.0, 0.0), ball(APART, 0.0)], 28.0, (0.0, 280.0, 80.0), 0.95, friction_by_speed),
    ],
)
def test_clusters_with_friction_leave_as_another_integrator_says(others, angle, spin, restitution, friction):
    """Frozen combinations, chains, triangles and a break, struck obliquely: to 0.1 % of the blow at ``balanced``."""
    speed, way = 8.0, radians(angle)
    bodies = [ball(-APART * cos(way), -APART * sin(way), speed, spin=spin), *others]
    outcome = passage(bodies, restitution, friction, step=0.07)
    mu = np.vectorize(friction, otypes=[float]) if callable(friction) else friction
    expected = by_contact_law(bodies, outcome.times[-1:], STIFFNESS, restitution, mu, 1e-3 * speed, 1e-5)[-1]
    assert np.abs(outcome.velocity - expected[:, 2:4]).max() < 1e-3 * speed


def test_friction_converges():
    """As the square of the step, though links of this triangle begin to slide, reverse and hold."""
    bodies = [ball(-APART * cos(0.1), -APART * sin(0.1), 8.0, spin=(0.0, 280.0, 0.0)), *TRIANGLE[:3]]
    rough, fine, finest = (passage(bodies, 0.95, 0.5, step=step).velocity for step in (0.07, 0.0175, 0.005))
    assert np.abs(rough - finest).max() < 1e-3 * 8.0
    assert np.abs(fine - finest).max() < 1e-4 * 8.0


@pytest.mark.parametrize(("restitution", "friction"), [(1.0, 0.0), (0.95, 0.05), (0.9, 0.6)])
def test_a_rack_keeps_momentum_gains_no_energy_and_mirrors(restitution, friction):
    bodies = rack(8.0, 1e-5)
    outcome = passage(bodies, restitution, friction)
    assert outcome.velocity.sum(axis=0) == pytest.approx([8.0, 0.0], abs=1e-9)
    assert energy(outcome.velocity, outcome.spin, bodies) <= 0.5 * MASS * 8.0**2 * (1 + 1e-14)
    mirrored = outcome.velocity[[0, 1, 3, 2, 6, 5, 4, 8, 7, 9]] * [1, -1]
    assert mirrored == pytest.approx(outcome.velocity, abs=8e-9)


def test_the_order_of_the_balls_does_not_matter():
    bodies = rack(8.0, 1e-5)
    order = np.random.default_rng(1).permutation(len(bodies))
    one = passage(bodies, 0.95, 0.05).velocity
    other = passage([bodies[i] for i in order], 0.95, 0.05).velocity
    assert other == pytest.approx(one[order], abs=1e-9)


def test_turned_by_any_angle_it_is_the_same():
    turn = 0.7
    c, s = cos(turn), sin(turn)
    bodies = rack(5.0, 1e-5)
    turned = [
        body._replace(
            position=(c * body.position[0] - s * body.position[1], s * body.position[0] + c * body.position[1]),
            velocity=(c * body.velocity[0] - s * body.velocity[1], s * body.velocity[0] + c * body.velocity[1]),
        )
        for body in bodies
    ]
    one, other = (passage(each, 0.95, 0.05).velocity for each in (bodies, turned))
    assert other == pytest.approx(one @ np.array([[c, s], [-s, c]]), abs=1e-9)


def test_a_ball_on_a_ball_on_the_floor():
    """A light ball on a heavy one, both falling at 1 m/s onto a hard floor: almost three times as fast upward."""
    heavy, light = ball(0.0, RADIUS, 0.0, -1.0, mass=1.0), ball(0.0, 3 * RADIUS + 1e-3, 0.0, -1.0, mass=1e-4)
    links = [
        Link(0, None, STIFFNESS, 1.0, ELASTIC, wall=lambda x, y: (y - RADIUS, 0.0, 1.0, 0.0)),
        Link(1, 0, STIFFNESS, 1.0, ELASTIC),
    ]
    outcome = Cluster([heavy, light], links).pass_through(0.1)
    assert outcome.velocity[1, 1] == pytest.approx(3.0, rel=1e-2)
    assert outcome.velocity[0, 1] == pytest.approx(1.0, rel=1e-3)


def test_what_stays_pressed_is_an_error():
    pressed = [body._replace(acceleration=(0.0, -9.81)) for body in (ball(0.0, RADIUS, 0.0, -1e-3),)]
    floor = Link(0, None, STIFFNESS, 0.1, ELASTIC, wall=lambda x, y: (y - RADIUS, 0.0, 1.0, 0.0))
    with pytest.raises(Unresolved, match="do not separate"):
        Cluster(pressed, [floor]).pass_through(0.5)


@pytest.mark.parametrize("restitution", [0.0, 0.1])
def test_balls_that_hardly_bounce_go_through_their_contact(restitution):
    """A break of them, which stay together for long, ends in as many contacts as any other."""
    run = sandbox.simulate(sandbox.load("billiards", {"ball.restitution": restitution}))
    assert run.ended == "rest"
    assert 1 <= run.numerics.clusters < 10
    assert abs(ledger(run).residue) < 1e-9


@pytest.mark.parametrize(
    ("speed", "angle", "english"),
    [
        (3.0, -92.25006174645455, -0.21837248667408093),  # rounding leaves two of the row 1e-17 m too close, at rest
        (12.0, -123.89969905899652, -0.3213740023291254),  # the cue ball comes to one it could not reach
    ],
)
def test_a_frozen_row_struck_across_parts_at_once(monkeypatch, speed, angle, english):
    """Each contact ends, and is gone through a few times at most."""
    through, passages = Cluster.pass_through, []

    def counted(self, step, negligible):
        passages.append(step)
        assert len(passages) < 100
        return through(self, step, negligible)

    monkeypatch.setattr(Cluster, "pass_through", counted)
    monkeypatch.setattr(Unresolved, "__init__", lambda self, text: pytest.fail(text))
    apart, way = 2 * 0.028575, radians(angle)
    row = [{"name": f"{i}", "x": apart * i * cos(way), "y": apart * i * sin(way)} for i in range(5)]
    changed = {
        "balls": [{"name": "cue", "x": -0.3, "y": 0.0}, *row],
        "cue": {"speed": speed, "angle": 0.0, "english": english},
        "table.kind": "carom",
        "contact.model": "hertz",
    }
    run = sandbox.simulate(sandbox.load("billiards", changed))
    assert run.numerics.clusters <= len(passages) < 5 * run.numerics.clusters
    assert ledger(run).end < 1e-12


def test_balls_that_the_cloth_presses_together_get_impulses(monkeypatch):
    """Two that creep on each other off a dead cushion: no contact is gone through that has no end."""
    monkeypatch.setattr(Unresolved, "__init__", lambda self, text: pytest.fail(text))
    changed = {"contact": {"model": "hertz", "stiffness": 1e8}, "cushion": {"model": "vertical", "restitution": 0.0}}
    scene = sandbox.load("billiards", {**changed, "cue": {"speed": 1.0, "follow": 0.045857955150968355}})
    assert ledger(sandbox.simulate(scene)).end < 1e-12


def test_a_step_that_is_far_too_long_is_halved():
    assert passage(chain(3), step=1.5).velocity[:, 0] == pytest.approx(passage(chain(3)).velocity[:, 0], abs=1e-2)


def test_energy_correction_keeps_the_motion_of_the_whole():
    """Coarse steps without loss: the energy stays what it was, and the momentum."""
    bodies = rack(8.0, 1e-5)
    outcome = passage(bodies, step=0.1)
    assert outcome.velocity.sum(axis=0) == pytest.approx([8.0, 0.0], abs=1e-9)
    had = 0.5 * MASS * 8.0**2
    assert energy(outcome.velocity, outcome.spin, bodies) == pytest.approx(had, rel=1e-3)
    assert energy(outcome.velocity, outcome.spin, bodies) <= had * (1 + 1e-14)


def test_energy_correction_spares_balls_not_touched():
    """A chain and a fast ball that passes it: its momentum stays, and theirs."""
    bodies = [*chain(3), ball(0.0, 1.0, 20.0)]
    links = [Link(i + 1, i, STIFFNESS, 1.0, ELASTIC) for i in range(3)]
    outcome = Cluster(bodies, links).pass_through(0.1)
    assert outcome.velocity[3].tolist() == [20.0, 0.0]
    assert outcome.velocity[:3, 0].sum() == pytest.approx(1.0, abs=1e-12)


def test_an_overlap_at_the_start_stores_no_energy():
    """Two that enter 0.1 mm deep, as after another contact: they separate with the energy they came with."""
    bodies = [ball(0.0, 0.0, 0.1), ball(2 * RADIUS - 1e-4, 0.0)]
    outcome = passage(bodies)
    assert energy(outcome.velocity, outcome.spin, bodies) == pytest.approx(0.5 * MASS * 0.1**2, rel=1e-6)
