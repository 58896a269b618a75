"""A body that moves and turns in the plane of the picture. Its state has the angle as a sixth component."""

from __future__ import annotations

from math import atan2

from sandbox.engine.contact.manifold import fixed_outline, resting_points
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.contact.turning_touch import OutlineOnArc, first_touch
from sandbox.engine.model.ball import outline_of
from sandbox.engine.model.tolerances import TOUCHING_GAP
from sandbox.engine.motion.body_point_contact import body_point_contact
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.paths.arc import Arc


class MovingBody(MovingBall):
    """A body: its path, and when it touches what stands still."""

    def find_sustained_contact(self, t: float, height: float) -> None:
        """Find the sustained contact after a touch: at one point of a straight side, left no faster than for a
        bounce of ``height`` (m). What is touched at more points, or elsewhere, is left to the heap."""
        self.contact = None
        slips, self._slips = self._slips, False
        applied = self.applied(t, self.state)
        found = resting_points(self.ball, self.obstacles_at(t), self.state, TOUCHING_GAP, applied, height)
        if len(found) == 1:
            self.contact = body_point_contact(self.ball, self.state, *found[0], applied, slips)
        if self.contact is not None:
            self.state = self.contact.projected_onto_surface(self.ball, self.state)

    def first_touch(self, obstacle: Obstacle, arc: Arc) -> float | None:
        """The time in s at which the body starts to touch on this arc, or None.

        ``obstacle`` is prepared for a ball around the body: nothing touches the body before it touches that.
        """
        start = arc.t0
        if obstacle in self.traps or obstacle.moves:
            return super().first_touch(obstacle, arc)
        if obstacle.near(*arc.start[:2]).gap > 0.0:
            u = obstacle.first_touch(arc)
            if u is None:
                return None
            start += u * (arc.t1 - arc.t0)
        near = obstacle.near(*arc.position(start))
        one, other = OutlineOnArc(outline_of(self.ball), arc), fixed_outline(obstacle.shape)
        return first_touch(one, other, start, arc.t1, self._accuracy.skin, atan2(near.ny, near.nx))
