"""Balls and bodies, and their paths, as a picture shows them: looks and turns, places in px, trails, marks."""

from __future__ import annotations

from functools import cached_property
from math import ceil, dist, inf
from typing import Any

import numpy as np
import pygame

from sandbox.engine.model.ball import Body
from sandbox.engine.model.surface import Circle, Segment, Surface
from sandbox.engine.paths.run import Run
from sandbox.picture.ball import Flat, Look, Orientation, Silhouette, mark_radius, turned
from sandbox.picture.camera import Camera
from sandbox.picture.marks import Ghost, draw_trace, is_under
from sandbox.picture.options import P, SceneOptions
from sandbox.picture.painter import Painter, Point
from sandbox.picture.palette import Colour, palette
from sandbox.picture.path import FINEST, DrawnPath, ImpactMark, apart, slow_motion
from sandbox.picture.sheet import Sheet
from sandbox.picture.vectors import Vectors
from sandbox.sport.amounts import round_number_above
from sandbox.sport.facts import cached_per_run
from sandbox.text import with_article

_RIM = palette("trace")["rim"]

#: In frames the ball is at least so much larger than it has to be to be seen.
_LARGER = 1.3
#: A ball that is larger by less than this factor is not said to be.
NOT_WORTH_NOTING = 1.05
#: Only the hardest is marked of impacts that are nearer to each other than this, in px on 720 rows.
_APART = 20
#: At most so many balls are drawn along a path, or along that part of it that matters.
_BALLS = 14
#: Radius of a bead on the path: at most so much of that of the balls there, and so many px on 720 rows.
_BEAD, _LARGEST_BEAD = 0.5, 3.0
#: Width of a string, px on 720 rows.
_STRING = 1.5
#: Half the least width of a surface, px on 720 rows.
THINNEST = 1.5
#: The faint trace of a surface that moves on a poster: poses, s between them, and how opaque the latest is.
_SWEEP, _SWEEP_EVERY, _SWEEP_OPACITY = 5, 0.05, 0.25


def draw_shape(
    painter: Painter, camera: Camera, shape: Segment | Circle, colour: Colour, unit: float, opacity: float = 1.0
) -> None:
    """Draw a surface as a line or a disc; ``unit`` is that of the picture."""
    thick = max(shape.radius * camera.scale, THINNEST * unit)
    near = pygame.FRect(painter.surface.get_rect()).inflate(100, 100)
    if isinstance(shape, Circle):
        painter.disc(camera.pixel(*shape.center), thick, colour, opacity)
    elif seen := near.clipline(camera.pixel(*shape.a), camera.pixel(*shape.b)):
        painter.line(seen, 2 * thick, colour, opacity)


@cached_per_run
def _known_orientations(run: Run, parameters: Any) -> dict[tuple[str, bytes], Orientation]:
    """Those of a run that were followed so far, by ball and first orientation: the same for each picture of it."""
    return {}


class BallDrawing(SceneOptions[P]):
    """Draws all that moves in a run."""

    ghosts: list[Ghost]  # other runs
    trace: np.ndarray  # the path of the ball that is played where it was drawn last, in px, shape (n, 2)

    # Which

    @property
    def thing(self) -> str:
        """The name of what is played, for notes."""
        return self.THING or ("body" if isinstance(self.looks[self.ball], Flat) else "ball")

    @property
    def things(self) -> str:
        """Several of them."""
        return "bodies" if self.thing == "body" else f"{self.thing}s"

    @cached_property
    def caught(self) -> dict[str, float]:
        """The time at which each ball is caught, in s; inf for one that is not."""
        caught = {event.ball: event.t for event in self.run.events if event.kind == "caught"}
        return {name: caught.get(name, inf) for name in self.balls}

    def present(self, t: float) -> list[str]:
        """The balls that are seen at time t in s: those not caught, and the one that is played, where it was."""
        return [name for name in self.balls if t < self.caught[name] or name == self.ball]

    @cached_property
    def paths(self) -> dict[str, DrawnPath]:
        """The path of each ball that is drawn."""
        return {name: DrawnPath(self.run, name, self.story_end) for name in self.balls}

    @property
    def path(self) -> DrawnPath:
        """The path of the ball that is played."""
        return self.paths[self.ball]

    @cached_property
    def vectors(self) -> Vectors:
        """Velocity and forces of the ball that is played."""
        return Vectors(self.run, self.ball)

    @cached_property
    def slow_motion(self) -> int:
        """The factor by which animations are slower."""
        return slow_motion(self.run, self.ball)

    # How

    @cached_property
    def looks(self) -> dict[str, Look]:
        """The look of everything that moves: balls as they look, bodies as their outline in that colour."""
        looks = {name: self.look_of(name) for name in self.balls}
        for body in (ball for ball in self.run.setup.balls if isinstance(ball, Body) and ball.name in looks):
            if not isinstance(looks[body.name], Silhouette):
                rim = [(x / body.radius, y / body.radius) for x, y in body.outline.rim(1e-3 * body.radius)]
                looks[body.name] = Flat(looks[body.name].colour, rim)
        return looks

    def thickness(self, name: str) -> float:
        """The thickness of a ball's path, as a share of that of one alone."""
        return 1.0 if name == self.ball and not isinstance(self.looks[name], Flat) else self.OTHER_WIDTH

    def turn(self, name: str, t: float) -> np.ndarray:
        """The matrix by which a ball is turned at time t in s: where it rolls, about level axes, too."""
        t = min(t, self.caught[name])
        if not self.rolls(name):
            return turned((0.0, 0.0, self.run.angle(name, t))) @ self.initial_turn(name)
        return self._orientations[name].at(t)

    @cached_property
    def _orientations(self) -> dict[str, Orientation]:
        """The orientations of the balls that roll on a plane."""
        run, known = self.run, _known_orientations(self.run, self.parameters)

        def orientation(name: str) -> Orientation:
            start, path = self.initial_turn(name), run.arcs[name]
            key = name, start.tobytes()

            def spin(t: float) -> tuple[float, float, float]:
                about_z, *rolling = path.at(t).spins(t)
                x, y = rolling or (0.0, 0.0)
                return x, y, about_z

            if key not in known:
                known[key] = Orientation(spin, [*(arc.t0 for arc in path), path[-1].t1], start)
            return known[key]

        return {name: orientation(name) for name in self.balls}

    def draw_ball(self, painter: Painter, camera: Camera, name: str, t: float, at: Point, radius: float) -> None:
        """A ball at time t in s; a lone one that is drawn larger than it is has a ring around it that says so."""
        larger = len(self.balls) == 1 and radius > NOT_WORTH_NOTING * self.radii[name] * camera.scale
        self.looks[name].draw(painter, at, radius, self.turn(name, t), self.unit, larger)

    @property
    def least_in_frames(self) -> float:
        """The least radius of a ball in a frame, in px."""
        return self._least(in_frame=True)

    def _least(self, in_frame: bool) -> float:
        """The least radius of a ball in px: of one alone, larger in frames."""
        return self.min_radius * (_LARGER if in_frame and len(self.balls) == 1 else 1.0)

    # Where

    def spots(self, camera: Camera, points: np.ndarray, radius: float, name: str = "") -> np.ndarray:
        """The places in px of balls of ``radius`` px at points in m, both of shape (n, 2): of the ball of this name, or
        of the one that is played."""
        return camera.pixels(self._hung(name or self.ball, points))

    def _hung(self, name: str, points: np.ndarray) -> np.ndarray:
        """Points of a ball, raised where it hangs on a string, which does not stretch: swings are simulated as small
        ones, along a level."""
        if name not in (tied := dict(self.strings)):
            return points
        x, y = tied[name]
        length, aside = y - points[:, 1], points[:, 0] - x
        return np.column_stack([points[:, 0], y - np.sqrt(np.maximum(0.0, length**2 - aside**2))])

    def shadow(self, painter: Painter, camera: Camera, name: str, t: float, at: Point, radius: float) -> None:
        """Draw the shadow of a ball at time t in s that is drawn at ``at`` with ``radius`` (px)."""

    def kept_clear(self, camera: Camera, t: float) -> list[pygame.Rect]:
        """The balls at time t in s, holes, and what is aimed at, in px: nothing may lie over them."""
        corners = [(*camera.pixel(box.left, box.top), *camera.pixel(box.right, box.bottom)) for box in self.aims]
        aims = [pygame.Rect(round(a), round(b), ceil(c - a) + 1, ceil(d - b) + 1) for a, b, c, d in corners]
        traps = [trap for trap in self.run.setup.traps if trap.end is None]
        holes = [(camera.pixel(*trap.center), trap.radius * camera.scale) for trap in traps]
        round_ones = [*self._ball_places(camera, t).values(), *holes]
        squares = [pygame.Rect(round(x - r), round(y - r), ceil(2 * r), ceil(2 * r)) for (x, y), r in round_ones]
        return [*squares, *aims]

    def _ball_places(self, camera: Camera, t: float, in_frame: bool = False) -> dict[str, tuple[Point, float]]:
        """The place and radius, in px, of each ball that is seen at time t in s."""
        placed, least = {}, self._least(in_frame)
        for name in self.present(t):
            radius = max(self.radii[name] * camera.scale, least)
            x, y = self.spots(camera, np.array([self.position_of(name, t)]), radius, name)[0]
            placed[name] = (float(x), float(y)), radius
        return placed

    def last(self, camera: Camera) -> tuple[Point, float]:
        """The last place of the ball that is played, and the radius to which it hides what is behind it, in px."""
        at, radius = self._ball_places(camera, self.story_end)[self.ball]
        return at, radius * self.looks[self.ball].solid

    def place_balls(self, painter: Painter, camera: Camera, t: float) -> None:
        """All that are there at time t in s, over their shadows."""
        placed = self._ball_places(camera, t)
        for draw in (self.shadow, self.draw_ball):
            for name, spot in placed.items():
                draw(painter, camera, name, t, *spot)

    # Paths

    def traced(self, camera: Camera, points: np.ndarray, name: str = "") -> np.ndarray:
        """The path of a ball, or of the one that is played, in px, in as many points as can be told apart."""
        traced = self.spots(camera, points, 0.0, name)
        return traced[apart(traced, FINEST)]

    def _traces(self, sheet: Sheet, camera: Camera) -> None:
        """All paths, other runs' below; that of the ball that is played is kept as ``trace``, in px."""
        traces = {name: self.traced(camera, path.points, name) for name, path in self.paths.items()}
        self.trace = traces.pop(self.ball)
        for ghost in self.ghosts:
            ghost.draw(sheet, self.traced(camera, ghost.points))
        for name, points in traces.items():
            draw_trace(sheet, points, self.colour_of(name), self.thickness(name))
        draw_trace(sheet, self.trace, self.colour_of(self.ball), self.thickness(self.ball))

    def strobe(self, sheet: Sheet, camera: Camera) -> list[str]:
        """A lone ball at even times, a bead in its place where balls would overlap; what to note of that."""
        if len(self.balls) > 1:
            return []
        painter = sheet.painter
        every = round_number_above(max(self.strobe_end, 0.01) / _BALLS)
        moments = [i * every for i in range(max(1, ceil(self.story_end / every - 1e-9)))]
        radius, look = max(self.radius * camera.scale, mark_radius(self.rows)), self.looks[self.ball]
        states = np.array([self.position_of(self.ball, t) for t in [*moments, self.story_end]])
        *places, end = self.spots(camera, states, radius)
        over = self.last(camera)
        bead, last, crowded = min(_BEAD * radius, max(2.0, _LARGEST_BEAD * self.unit)), None, False
        for t, at in zip(moments, places, strict=True):
            near = [2.2 * radius > dist(at, other) for other in ([end] if last is None else [end, last])]
            if t > 0 and any(near):
                painter.disc(at, bead + max(0.7, 0.8 * self.unit), _RIM, 0.8)
                painter.disc(at, bead, look.colour)
                crowded |= not is_under(at, over, self.unit)
            else:
                look.draw(painter, at, radius, self.turn(self.ball, t), self.unit)
                last = at
        return [
            f"{with_article(self.thing)} every {every:g} s",
            *([f"a bead where {self.things} would overlap"] if crowded else []),
        ]

    def impacts(self, camera: Camera) -> list[ImpactMark]:
        """The impacts that are marked."""
        marked: list[ImpactMark] = []
        for mark in sorted(self.path.marks(), key=lambda mark: -mark.hardness):
            near = (dist(mark.at, other.at) * camera.scale < _APART * self.unit for other in marked)
            least = max(self.MIN_IMPACT, self.MIN_IMPACT_SHARE * [*marked, mark][0].hardness)
            if mark.hardness >= least and not any(near):
                marked.append(mark)
        return sorted(marked, key=lambda mark: mark.t)

    def _strings(self, painter: Painter, camera: Camera, t: float) -> None:
        """Draw the strings of balls that hang."""
        for name, (x, y) in self.strings:
            hung = self.spots(camera, np.array([self.run.state(name, t)[:2]]), 0.0, name)[0]
            painter.line([camera.pixel(x, y), hung], _STRING * self.unit, self.STRING_COLOUR)

    @cached_property
    def driven(self) -> list[Surface]:
        """The surfaces that move."""
        return [surface for surface in self.run.setup.surfaces if surface.motion is not None]

    def draw_driven(self, painter: Painter, camera: Camera, t: float, opacity: float = 1.0) -> None:
        """Draw the surfaces that move where they are at time t in s."""
        for surface in self.driven:
            draw_shape(painter, camera, surface.at(t).shape, self.DRIVEN, self.unit, opacity)

    def _sweep(self, painter: Painter, camera: Camera) -> None:
        """Draw the surfaces that move as the poster has them, over a faint trace of where they were just before."""
        for i in range(_SWEEP, 0, -1):
            before = self.driven_moment - i * _SWEEP_EVERY
            if before >= 0.0:
                self.draw_driven(painter, camera, before, _SWEEP_OPACITY * (1.0 - i / (_SWEEP + 1)))
        self.draw_driven(painter, camera, self.driven_moment)

    def _trails(self, sheet: Sheet, camera: Camera, t: float) -> None:
        """Draw where the balls have been: a thin line, and a thick one of late; and where those of other runs are. All
        under the headline."""
        painter = sheet.painter
        sheet.surface.set_clip(pygame.Rect((0, sheet.top_row), self.size).clip(self.opening))
        for ghost in self.ghosts:
            ghost.draw_in_frame(sheet, self.traced(camera, ghost.points), self.spots(camera, ghost.at(t), 0.0)[0])
        for name, (moments, places) in self._tracks.items():
            if t <= self.story_end:
                been = np.vstack([places[: np.searchsorted(moments, t)], self.run.state(name, t)[:2]])
                painter.thread(self.spots(camera, been, 0.0, name), self.unit, self.faint_of(name))
            self.trail(painter, camera, name, t)
        sheet.surface.set_clip(None)

    def trail(self, painter: Painter, camera: Camera, name: str, t: float) -> None:
        """Draw where a ball has been of late, at time t in s."""
        path = self.paths[name]
        first, last = np.searchsorted(path.samples[:, 0], (t - self.TRAIL, t))
        late = self.spots(camera, np.vstack([path.points[first:last], self.run.state(name, t)[:2]]), 0.0, name)
        if np.ptp(late, axis=0).max() > 2:
            width = 1.1 * max(self.radii[name] * camera.scale, self.min_radius)
            painter.fading(late[apart(late, 3.0)], width, self.colour_of(name), 0.9)

    @cached_property
    def _tracks(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Times (s) and places (m) along each ball's path that can be told apart where frames begin."""
        camera, found = self.closest, {}
        for name, path in self.paths.items():
            some = apart(camera.pixels(path.points), 4.0)
            found[name] = path.samples[some, 0], path.points[some]
        return found

    # Cameras

    @property
    def camera(self) -> Camera:
        """The poster's camera."""
        raise NotImplementedError
