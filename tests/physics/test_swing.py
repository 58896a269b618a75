"""What a face does to a ball, from what the impact conserves."""

from __future__ import annotations

import pytest

from sandbox.physics.swing import RUBBER, apparent_restitution, gripping, struck

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
