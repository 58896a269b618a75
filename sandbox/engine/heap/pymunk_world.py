"""A pymunk Space of real shapes: the surfaces of a setup and the discs of its balls, with callbacks that may raise."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import pymunk

from sandbox.engine.contact.manifold import fixed_outline
from sandbox.engine.model.ball import Ball, outline_of
from sandbox.engine.model.shapes import Ellipse, Polygon, Vector
from sandbox.engine.model.surface import Surface

_BALL, _SURFACE = 1, 2

#: By how much corners are rounded, as a share of the margin.
_ROUNDED = 1e-2

#: Finds surfaces only.
_ONLY_SURFACES = pymunk.ShapeFilter(mask=_SURFACE)


class PymunkWorld:
    """The Space. All shapes are wider by ``margin`` (m), and overlaps up to ``slop`` (m) are left. Surfaces that do not
    move have the ``outline`` of each; by default its own."""

    def __init__(
        self,
        surfaces: Sequence[Surface],
        iterations: int,
        slop: float,
        margin: float = 0.0,
        space: pymunk.Space | None = None,
        outline: Callable[[Surface], Polygon] = lambda surface: fixed_outline(surface.shape).shape.as_polygon(),
    ) -> None:
        self.space = pymunk.Space() if space is None else space
        self.space.iterations = iterations
        self.space.collision_slop = slop
        self.surface_of: dict[pymunk.Shape, int] = {}  # index into the surfaces
        self._margin = margin
        self._raised: BaseException | None = None
        for place, surface in enumerate(surfaces):
            if surface.motion is not None:
                continue  # what moves is met in impacts only
            self.add_surface(place, surface, self.space.static_body, outline(surface))

    def add_surface(self, place: int, surface: Surface, body: pymunk.Body, outline: Polygon) -> None:
        """Add one of the surfaces as a shape of a body."""
        shape = self._shape(body, outline, _SURFACE)
        shape.elasticity, shape.friction = surface.restitution, surface.friction
        self.surface_of[shape] = place
        self.space.add(shape)

    def add(self, ball: Ball) -> tuple[pymunk.Body, pymunk.Shape]:
        """Add a ball or body; pymunk multiplies its elasticity and friction, 1, by the surface's."""
        body = pymunk.Body(ball.mass, ball.inertia)
        # cores that touch exactly, as those of boxes at rest would, have any normal for Chipmunk
        shape = self._shape(body, outline_of(ball).as_polygon().rounded(_ROUNDED * self._margin), _BALL)
        shape.elasticity = shape.friction = 1.0
        self.space.add(body, shape)
        return body, shape

    def _shape(self, body: pymunk.Body, outline: Polygon, kind: int) -> pymunk.Shape:
        corners, radius = outline.corners, outline.radius + self._margin
        shape: pymunk.Shape
        if len(corners) > 2:
            shape = pymunk.Poly(body, corners, radius=radius)
        elif len(corners) == 2:
            shape = pymunk.Segment(body, corners[0], corners[1], radius)
        else:
            shape = pymunk.Circle(body, radius, corners[0])
        shape.collision_type, shape.filter = kind, pymunk.ShapeFilter(categories=kind)
        return shape

    def on_contact(self, meet: Callable[[pymunk.Arbiter], None], part: Callable[[pymunk.Arbiter], None]) -> None:
        """Call these before and after Chipmunk solves a contact; the first shape is always a ball's."""
        before, after = (self.guarded(lambda arbiter, space, data, call=call: call(arbiter)) for call in (meet, part))
        for other in (_SURFACE, _BALL):
            self.space.on_collision(_BALL, other, pre_solve=before, post_solve=after)

    def guarded(self, callback: Callable[..., None]) -> Any:
        """The callback, storing what it raises until after the step: cffi would print and swallow it."""

        def call(*arguments: Any) -> None:
            if self._raised is None:
                try:
                    callback(*arguments)
                except BaseException as error:
                    self._raised = error

        return call

    def forget(self, shapes: Iterable[pymunk.Shape]) -> None:
        """Forget the impulses of these shapes' contacts. Chipmunk begins a step with those of the one before, scaled to
        its length, but counts them in full: after a step of another length it would not undo what is too much."""
        for shape in shapes:
            self.space.remove(shape)
            self.space.add(shape)

    def passed(self, start: Vector, end: Vector) -> int | None:
        """Return the index of the surface that a point goes through on its straight way, or None."""
        met = self.space.segment_query_first(start, end, 0.0, _ONLY_SURFACES)
        return None if met is None else self.surface_of[met.shape]

    def step(self, h: float) -> None:
        """Step by h s. Raises what a callback has raised."""
        self.space.step(h)
        self.raise_stored()

    def raise_stored(self) -> None:
        """Raise what a callback has raised."""
        if self._raised is not None:
            raise self._raised


def speeds_at(
    one: pymunk.Body, other: pymunk.Body | None, normal: Vector, met: Sequence[pymunk.ContactPoint]
) -> tuple[float, float]:
    """Speed of approach in m/s where two bodies, or one and what is fixed, meet, of two points the faster, and the
    speed along there."""
    nx, ny = normal
    found = []
    for at in met:
        (vx, vy), (ux, uy) = one.velocity_at_world_point(at.point_a), (0.0, 0.0)
        if other is not None:
            ux, uy = other.velocity_at_world_point(at.point_b)
        found.append(((vx - ux) * nx + (vy - uy) * ny, (vy - uy) * nx - (vx - ux) * ny))
    return max(found)


def rolls(ball: Ball, met: Sequence[pymunk.ContactPoint]) -> bool:
    """True if it touches with a curved side, at these points."""
    if not ball.rotates:
        return True
    outline = outline_of(ball)
    return isinstance(outline, Ellipse) or (outline.radius > 0.0 and len(met) == 1)
