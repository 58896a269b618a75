"""What the pictures of all scenes share: poster, frames, other runs, balls, marks, headline and card.

A scene's ``Picture`` is a :class:`~sandbox.picture.side.SideView` or a view from above that says what its place looks
like, and adds the one or two drawings that are the sport's own. Whatever may differ is a constant or a method in the
section "What a scene may say"; everything else is the same for all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, wraps
from math import atan2, ceil, degrees, dist, hypot, pi
from typing import Any, ClassVar, Generic, NamedTuple, TypeVar

import numpy as np
import pygame

from sandbox.engine.run import Run
from sandbox.engine.setup import Body, Segment
from sandbox.errors import RequestError, RunError
from sandbox.parameters import Group
from sandbox.picture.ball import SMALLEST, Flat, Look, Silhouette, Turning, least_radius, mark_radius, seams, turned
from sandbox.picture.camera import Camera
from sandbox.picture.marks import Ghost, draw_trace, is_under, mark_impacts
from sandbox.picture.painter import Painter, Point, blank
from sandbox.picture.palette import Colour, palette
from sandbox.picture.path import FINEST, Mark, Path, apart
from sandbox.picture.sheet import Entry, Sheet
from sandbox.picture.vectors import Vectors
from sandbox.sport.amounts import amount, metres, nice, signed, times
from sandbox.text import shortened
from sandbox.tracebacks import is_ours

CARD, PLAIN = palette("card"), palette("plain")
TRACES, RIM = palette("trace")["colours"], palette("trace")["rim"]

#: Surfaces are around a path that reach no farther beyond it than it is long, or than so many radii of the ball.
NEAR = 12.0
#: In frames the ball is at least so much larger than it has to be to be seen.
LARGER = 1.3
#: A run that is shorter, in s, is told in ms.
INSTANT = 0.1
#: A ball that is larger by less than this factor is not said to be.
UNSAID = 1.05
#: Of impacts that are nearer to each other than this, in px on 720 rows, the hardest is marked.
APART = 20
#: At most so many balls are drawn along a path, or along that part of it that matters.
BALLS = 14
#: Radius of a bead on the path: at most so much of that of the balls there, and so many px on 720 rows.
BEAD, LARGEST_BEAD = 0.5, 3.0

#: Width of a string, px on 720 rows.
STRING = 1.5

P = TypeVar("P", bound=Group)


def _function(member: Any) -> Any:
    """Of a method, property or cached property."""
    return getattr(member, "fget", None) or getattr(member, "func", member)


def _returning(needed: str, how: Callable[..., Any]) -> Callable[..., Any]:
    """The function, which raises RunError where it returns None, or no surface where one is needed."""

    @wraps(how)
    def checked(*arguments: Any, **named: Any) -> Any:
        value = how(*arguments, **named)
        if value is None or (needed == "pygame.Surface" and not isinstance(value, pygame.Surface)):
            file = f"{how.__code__.co_filename}, line {how.__code__.co_firstlineno}"
            raise RunError(f"{file}: {how.__qualname__} must return a {needed}, and returned {shortened(repr(value))}")
        return value

    return checked


class Heading(NamedTuple):
    """What is said above a poster: the headline, the notes under it, and the room for them in px."""

    text: str
    notes: list[str]
    room: float


class View(Generic[P]):
    """One run of a scene at ``size`` px: whole, as a poster, or as it is at a time t.

    ``ghosts`` are other runs of the scene by what they are called, drawn pale behind this one.
    """

    # What a scene may say

    #: How the ball looks, and what it is called: "" for a ball, or a body where it is a ``Body``.
    LOOK: ClassVar[Look] = Look(PLAIN["ball"], seams(PLAIN["marks"]))
    THING: ClassVar[str] = ""
    #: What must be said of the result wherever it is shown, such as that nothing measured stands behind it.
    CAVEAT: ClassVar[str] = ""
    #: Colours of the path, of the thin line of it that stays behind in frames (None: the same), and of other runs.
    TRACE: ClassVar[Colour] = TRACES[0]
    FAINT: ClassVar[Colour | None] = None
    EARLIER: ClassVar[Sequence[Colour]] = TRACES[1:]
    #: What a spin below and one above zero is called.
    SPINS: ClassVar[tuple[str, str]] = ("topspin", "backspin")
    #: s of path that the trail behind the ball shows.
    TRAIL: ClassVar[float] = 0.5
    #: The balls along the path are spread over at least this share of it.
    LEAST_SPAN: ClassVar[float] = 0.25
    #: Impacts are marked that are at least so hard, in m/s, and as a share of the hardest.
    LEAST_IMPACT: ClassVar[float] = 0.3
    SOFT: ClassVar[float] = 0.03
    #: The paths of balls besides the one that is played, and those of bodies, which may be thin, are so much as thick.
    OTHERS: ClassVar[float] = 0.6

    #: What is stretched where a camera stretches one.
    STRETCHED: ClassVar[str] = "heights"
    #: The colour of strings.
    STRING: ClassVar[Colour] = CARD["quiet"]
    #: Whether text stands on dark ground, where the scene does not decide by the shot.
    ON_DARK: ClassVar[bool] = True
    #: Whether all runs stand on the same ground, so that one cannot be moved up or down to lie over another.
    ONE_GROUND: ClassVar[bool] = False

    @property
    def on_dark(self) -> bool:
        """Whether text stands on dark ground."""
        return self.ON_DARK

    @property
    def ball(self) -> str:
        """The ball that is played: its path is the picture's."""
        return self.run.setup.balls[0].name

    @property
    def balls(self) -> list[str]:
        """All that are drawn as balls."""
        return [ball.name for ball in self.run.setup.balls]

    @property
    def least(self) -> float:
        """The least radius of a ball in px: several may lie close together, and are not drawn so large as one alone."""
        return least_radius(self.rows) if len(self.balls) == 1 else SMALLEST / 2

    @cached_property
    def told(self) -> float:
        """When the story is told, in s: the path ends there, and the verdict is in."""
        return self.run.duration

    @cached_property
    def span(self) -> float:
        """The time in s over which the balls along the path are spread: until the first touch, unless that is soon."""
        touches = (event.t for event in self.run.events if self.ball in (event.ball, event.partner))
        return max(min(next(touches, self.told), self.told), self.LEAST_SPAN * self.told)

    @property
    def moment(self) -> float:
        """The time in s at which the poster shows what moves besides the balls."""
        return 0.0

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        """The point in m that runs have in common when they are compared, and what it is."""
        return (0.0, 0.0), "the start"

    @property
    def thing(self) -> str:
        """What the ball that is played is called."""
        return self.THING or ("body" if isinstance(self.looks[self.ball], Flat) else "ball")

    @property
    def things(self) -> str:
        """Several of them."""
        return "bodies" if self.thing == "body" else f"{self.thing}s"

    def progress(self, t: float) -> tuple[str, str]:
        """Headline and note of a frame at time t in s, before the verdict is in."""
        return self.clock(t), ""

    def clock(self, t: float) -> str:
        """A time in s, in ms where all is over in an instant."""
        return f"{1e3 * t:.2f} ms" if self.run.duration < INSTANT else f"{t:.2f} s"

    def live(self, t: float) -> list[Entry]:
        """What a frame's card says at time t in s; a ball that was caught does nothing any more."""
        speed, way, spin = self.moving(self.ball, t)
        does = [speed, way, *self.vectors.entries(t), spin]
        if self.ball not in self.present(t):
            does = [(label, "–") for label, *_ in does]
        return [("time", self.clock(t)), *self.position(t), *does]

    def moving(self, name: str, t: float) -> list[Entry]:
        """Speed, direction and spin of a ball at time t in s."""
        _, _, vx, vy, spin = self.run.state(name, t)
        speed = hypot(vx, vy)
        way = self.heading_text(degrees(atan2(vy, vx))) if speed > 0.01 else "–"
        turning = "side spin" if self.rolls(name) else "spin"
        return [("speed", amount(speed, "m/s")), ("direction", way), (turning, self.spin_text(spin))]

    def heading_text(self, angle: float) -> str:
        """A direction in deg, counter-clockwise from straight ahead, for people."""
        return signed(f"{angle:.0f}") + "°"

    def spin_text(self, spin: float) -> str:
        """A spin in rad/s for people."""
        rpm, (below, above) = spin * 30 / pi, self.SPINS
        return f"{abs(rpm):.0f} rpm {above if rpm > 0.0 else below}" if abs(rpm) >= 0.5 else "none"

    def position(self, t: float) -> list[Entry]:
        """Of the ball, for the frame's card."""
        x, y, *_ = self.run.state(self.ball, t)
        return [("x", metres(x)), ("y", metres(y))]

    def remarks(self, camera: Camera) -> list[str]:
        """What of the place is not drawn as it is, or not seen."""
        return []

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """What stands still, all of it behind the ball."""

    @property
    def strings(self) -> Sequence[tuple[str, tuple[float, float]]]:
        """The balls that hang on a string, each with the point in m where that is tied."""
        return ()

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """What moves behind the ball, at time t in s."""

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        """What hides the ball, at time t in s."""

    def landmarks(self, sheet: Sheet, camera: Camera) -> None:
        """What the place is labelled with, whatever the shot."""

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """What only this sport draws on its poster."""

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect | None:
        """Draw a small picture in the upper right corner, at time t in s or on the poster; where it is."""
        return None

    # What a view from the side and one from above say

    @property
    def camera(self) -> Camera:
        """The poster's camera."""
        raise NotImplementedError

    def view(self, t: float) -> Camera:
        """The camera of ``frame(t)``."""
        return self.camera

    @property
    def card_row(self) -> float:
        """Where the card begins, in px from the top."""
        return self.sheet.card_row(len(self.ghosts))

    def spots(self, camera: Camera, points: np.ndarray, radius: float) -> np.ndarray:
        """Where in px balls of ``radius`` px are drawn for points in m, both of shape (n, 2)."""
        return camera.pixels(points)

    def shadow(self, painter: Painter, camera: Camera, name: str, t: float, at: Point, radius: float) -> None:
        """Of a ball at time t in s that is drawn at ``at`` with ``radius`` (px)."""

    def scale(self, sheet: Sheet, camera: Camera) -> None:
        """A ruler or a scale bar."""

    def dimensions(self, sheet: Sheet, camera: Camera) -> None:
        """The lengths that the run came to, on its poster."""

    # The same for all

    def __init_subclass__(cls) -> None:
        """Where a user's own picture overrides what has a value, a forgotten ``return`` is told."""
        super().__init_subclass__()
        for name, member in list(vars(cls).items()):
            how, inherited = _function(member), _function(getattr(super(cls, cls), name, None))
            needed = str(getattr(inherited, "__annotations__", {}).get("return"))
            if hasattr(how, "__code__") and not is_ours(how.__code__.co_filename) and "None" not in needed:
                returning: Any = _returning(needed, how)
                if how is not member:  # a property
                    returning = type(member)(returning)
                    getattr(returning, "__set_name__", lambda *_: None)(cls, name)
                setattr(cls, name, returning)

    def __init__(
        self, run: Run, parameters: P, size: tuple[int, int] = (1280, 720), ghosts: Mapping[str, Run] | None = None
    ) -> None:
        self.run, self.parameters, self.size = run, parameters, size
        self.sheet = Sheet(size, self.on_dark)  # the one drawn last
        self.unit, self.rows = self.sheet.unit, self.sheet.rows
        self.radii = {ball.name: ball.radius for ball in run.setup.balls}  # m
        self.radius = self.radii[self.ball]
        self.ghosts = [self._ghost(i, *other) for i, other in enumerate((ghosts or {}).items())]
        self.ahead = 0.0  # s; until then paths are shown that balls are still to go
        self._standing: tuple[Camera, pygame.Surface] | None = None

    def _ghost(self, i: int, label: str, run: Run) -> Ghost:
        """Another run of the same scene, laid over this one where its ``datum`` says.

        Raises RequestError where it cannot be: from the side, all share one ground.
        """
        other = type(self)(run, run.scene.parameters, self.size)
        ((x, y), what), ((there_x, there_y), _) = self.datum, other.datum
        if self.ONE_GROUND and there_y != y:
            raise RequestError(f"{label}: {what} is at {there_y:g} m, and here at {y:g} m: these cannot be compared")
        return Ghost(label, other, self.EARLIER[i % len(self.EARLIER)], (x - there_x, y - there_y))

    @cached_property
    def paths(self) -> dict[str, Path]:
        """Of each ball that is drawn."""
        return {name: Path(self.run, name, self.told) for name in self.balls}

    @property
    def path(self) -> Path:
        """Of the ball that is played."""
        return self.paths[self.ball]

    @property
    def wind(self) -> tuple[float, float]:
        """In m/s, along and up; none for a scene without air."""
        wind: tuple[float, float] = getattr(getattr(self.parameters, "air", None), "wind", (0.0, 0.0))
        return wind

    @cached_property
    def vectors(self) -> Vectors:
        """Velocity and forces of the ball that is played."""
        return Vectors(self.run, self.ball)

    @cached_property
    def points(self) -> np.ndarray:
        """All places in m that must be seen: of every path, and of the other runs'; shape (n, 2)."""
        own = [path.points for path in self.paths.values()]
        return np.concatenate([*own, *(ghost.points for ghost in self.ghosts)])

    @cached_property
    def surroundings(self) -> np.ndarray:
        """Lower left and upper right corner in m of all that must be seen and of the surfaces around it: all of those
        that do not reach far beyond, of others the place next to its middle; shape (2, 2)."""
        radius = max(self.radii.values())
        low, high = self.points.min(axis=0) - radius, self.points.max(axis=0) + radius
        reach, middle = max(NEAR * radius, *(high - low)), (low + high) / 2
        for shape in (surface.shape for surface in self.run.setup.surfaces):
            a, b = map(np.array, (shape.a, shape.b) if isinstance(shape, Segment) else (shape.center, shape.center))
            next_to = a + np.clip((middle - a) @ (b - a) / max((b - a) @ (b - a), 1e-99), 0.0, 1.0) * (b - a)
            for seen in (np.array([np.minimum(a, b) - shape.radius, np.maximum(a, b) + shape.radius]), next_to[None]):
                if np.all(seen > low - reach) and np.all(seen < high + reach):
                    low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
        return np.array([low, high])

    def stage(self) -> pygame.Surface:
        """The place alone, as the poster's camera sees it."""
        return self._still(self.camera).copy()

    def draw_balls(self, painter: Painter, camera: Camera, t: float, ahead: float = 0.0) -> None:
        """All that moves, at time t in s, on the stage that the camera sees; paths in a lens until ``ahead`` in s."""
        self.ahead = ahead
        self.behind(painter, camera, t)
        self._strings(painter, camera, t)
        self.place_balls(painter, camera, t)
        self.before(painter, camera, t)

    def measure(self, sheet: Sheet, camera: Camera) -> None:
        """What the place is measured by: ruler or scale bar, and the labels that hold for any shot."""
        self.scale(sheet, camera)
        self.landmarks(sheet, camera)

    def notes(self, camera: Camera) -> list[str]:
        """What is not drawn as it is."""
        return [*self._stretched(camera), *self.remarks(camera), *self._larger(camera), *self._caveat]

    def poster(self) -> pygame.Surface:
        """The whole run in one picture."""
        for _ in self.layers():
            pass
        sheet = self.sheet
        sheet.headline(*self.heading)
        rows = [(ghost.light, ghost.run.scene.rows(ghost.run)) for ghost in self.ghosts]
        sheet.columns(self.card_row, self.run.scene.rows(self.run), rows)
        for ghost in self.ghosts:
            ghost.name(sheet, self.traced(self.camera, ghost.points), self.trace)
        return sheet.surface

    def layers(self) -> Iterator[str]:
        """Draw the poster on ``sheet``, from the lowest layer to the highest; the name of each is said when it is
        drawn. Then all is there but text, and ``heading`` is known."""
        camera = self.camera
        sheet = self.sheet = Sheet(self.size, self.on_dark, self._still(camera).copy())
        painter = sheet.painter
        placed = self._placed(camera, self.told)
        self.behind(painter, camera, self.moment)
        yield "place"
        self._strings(painter, camera, self.told)
        for name, spot in placed.items():
            self.shadow(painter, camera, name, self.told, *spot)
        self._traces(sheet, camera)
        yield "paths"
        every = self.strobe(sheet, camera)
        yield "along"
        for name, spot in placed.items():
            self.draw_ball(painter, camera, name, self.told, *spot)
        yield "balls"
        self.before(painter, camera, self.moment)
        self.dimensions(sheet, camera)
        self.measure(sheet, camera)
        self.annotate(sheet, camera)
        mark_impacts(sheet, camera, self.impacts(camera), self.last(camera))
        room = self._room(sheet, camera, None)
        yield "over"
        notes = [*(ghost.note for ghost in self.ghosts), *self.aligned, *every[:1], *self.notes(camera), *every[1:]]
        self.heading = Heading(self.run.scene.verdict(self.run), notes, room)

    def frame(self, t: float) -> pygame.Surface:
        """The scene at time t in s."""
        t = min(max(t, 0.0), self.run.duration)
        camera = self.view(t)
        sheet = self.sheet = Sheet(self.size, self.on_dark, self._still(camera).copy())
        painter = sheet.painter
        placed = self._placed(camera, t, in_frame=True)
        self.behind(painter, camera, t)
        self._strings(painter, camera, t)
        for name, spot in placed.items():
            self.shadow(painter, camera, name, t, *spot)
        self._trails(sheet, camera, t)
        if self.ball in placed:
            self.vectors.draw(sheet, *placed[self.ball], t)
        for name, spot in placed.items():
            self.draw_ball(painter, camera, name, t, *spot)
        self.before(painter, camera, t)
        self.scale(sheet, camera)
        room = self._room(sheet, camera, t)
        headline, note = (self.run.scene.verdict(self.run), "") if t >= self.told else self.progress(t)
        compared = [f"compared with {ghost.label}" for ghost in self.ghosts]
        larger = self._larger(camera, in_frame=True)
        notes = [note, *compared, *self.aligned, *self._stretched(camera), *self._caveat, *larger]
        sheet.headline(headline, [note for note in notes if note], room)
        rows = [(ghost.light, ghost.view.live(min(t, ghost.run.duration))) for ghost in self.ghosts]
        sheet.columns(self.card_row, self.live(t), rows)
        return sheet.surface

    # Parts of poster and frame

    @property
    def aligned(self) -> list[str]:
        """To note where the other runs were moved to lie over this one."""
        return [f"aligned at {self.datum[1]}"] if any(any(ghost.shift) for ghost in self.ghosts) else []

    @property
    def _caveat(self) -> list[str]:
        return [self.CAVEAT] if self.CAVEAT else []

    def _stretched(self, camera: Camera) -> list[str]:
        """To note how much larger heights are drawn than lengths."""
        return [f"{self.STRETCHED} drawn {camera.stretch:g} times as large as lengths"] if camera.stretch != 1 else []

    def _larger(self, camera: Camera, in_frame: bool = False) -> list[str]:
        """To note how many times their size balls are drawn; in frames, whose camera may move, that they are larger."""
        alone, radius = len(self.balls) == 1, self.radius
        if in_frame:  # which need not be true of all
            radius = min(self.radii[name] for name in self.balls)
        factor = self._least(in_frame) / (radius * camera.scale)
        whose, are = ("its", "it is") if alone else ("their", "they are")
        how = f"larger than {are}" if in_frame else f"{times(factor)} {whose} size"
        return [f"{self.thing if alone else self.things} drawn {how}"] if factor > UNSAID else []

    def _least(self, in_frame: bool) -> float:
        """The least radius of a ball in px: of one alone, larger in frames."""
        return self.least * (LARGER if in_frame and len(self.balls) == 1 else 1.0)

    def look_of(self, name: str) -> Look:
        """How a ball looks."""
        return self.LOOK

    @cached_property
    def looks(self) -> dict[str, Look]:
        """How all that moves is drawn: balls as they look, bodies as their outline in that colour."""
        looks = {name: self.look_of(name) for name in self.balls}
        for body in (ball for ball in self.run.setup.balls if isinstance(ball, Body) and ball.name in looks):
            if not isinstance(looks[body.name], Silhouette):
                rim = [(x / body.radius, y / body.radius) for x, y in body.outline.rim(1e-3 * body.radius)]
                looks[body.name] = Flat(looks[body.name].colour, rim)
        return looks

    def colour_of(self, name: str) -> Colour:
        """Of the path of a ball, or of anything else that moves."""
        others = [ball.name for ball in self.run.setup.balls if ball.name != self.ball]
        return self.TRACE if name == self.ball else self.EARLIER[others.index(name) % len(self.EARLIER)]

    def thickness(self, name: str) -> float:
        """Of the path of a ball, as a share of that of one alone."""
        return 1.0 if name == self.ball and not isinstance(self.looks[name], Flat) else self.OTHERS

    def faint_of(self, name: str) -> Colour:
        """Of the thin line that stays where a ball has been, in frames."""
        return self.FAINT if self.FAINT and name == self.ball else self.colour_of(name)

    def draw_ball(self, painter: Painter, camera: Camera, name: str, t: float, at: Point, radius: float) -> None:
        """A ball at time t in s; a lone one that is drawn larger than it is has a ring around it that says so."""
        larger = len(self.balls) == 1 and radius > UNSAID * self.radii[name] * camera.scale
        self.looks[name].draw(painter, at, radius, self.turn(name, t), self.unit, larger)

    def lying(self, name: str) -> np.ndarray:
        """The matrix by which a ball is turned at the start."""
        return np.eye(3)

    def rolls(self, name: str) -> bool:
        """Whether a ball turns about level axes, too."""
        setup = self.run.setup
        return setup.plane is not None and bool(setup.plane_of(name).rolls)

    def turn(self, name: str, t: float) -> np.ndarray:
        """The matrix by which a ball is turned at time t in s: where it rolls, about level axes, too."""
        if not self.rolls(name):
            return turned((0.0, 0.0, self.run.angle(name, t))) @ self.lying(name)
        return self._turnings[name].at(t)

    @cached_property
    def _turnings(self) -> dict[str, Turning]:
        """Of the balls that roll on a plane."""
        run = self.run

        def turning(name: str) -> Turning:
            times = [*(arc.t0 for arc in run.arcs[name]), run.arcs[name][-1].t1]
            return Turning(lambda t: (*run.rolling_spin(name, t), run.state(name, t)[4]), times, self.lying(name))

        return {name: turning(name) for name in self.balls}

    def impacts(self, camera: Camera) -> list[Mark]:
        """The impacts that are marked."""
        marked: list[Mark] = []
        for mark in sorted(self.path.marks(), key=lambda mark: -mark.hardness):
            near = (dist(mark.at, other.at) * camera.scale < APART * self.unit for other in marked)
            if mark.hardness >= max(self.LEAST_IMPACT, self.SOFT * [*marked, mark][0].hardness) and not any(near):
                marked.append(mark)
        return sorted(marked, key=lambda mark: mark.t)

    def strobe(self, sheet: Sheet, camera: Camera) -> list[str]:
        """A lone ball at even times, a bead in its place where balls would overlap; what to note of that."""
        if len(self.balls) > 1:
            return []
        painter = sheet.painter
        every = nice(max(self.span, 0.01) / BALLS)
        moments = [i * every for i in range(max(1, ceil(self.told / every - 1e-9)))]
        radius, look = max(self.radius * camera.scale, mark_radius(self.rows)), self.looks[self.ball]
        states = np.array([self.run.state(self.ball, t)[:2] for t in [*moments, self.told]])
        *places, end = self.spots(camera, states, radius)
        over = self.last(camera)
        bead, last, crowded = min(BEAD * radius, max(2.0, LARGEST_BEAD * self.unit)), None, False
        for t, at in zip(moments, places, strict=True):
            near = [2.2 * radius > dist(at, other) for other in ([end] if last is None else [end, last])]
            if t > 0 and any(near):
                painter.disc(at, bead + max(0.7, 0.8 * self.unit), RIM, 0.8)
                painter.disc(at, bead, look.colour)
                crowded |= not is_under(at, over, self.unit)
            else:
                look.draw(painter, at, radius, self.turn(self.ball, t), self.unit)
                last = at
        return [
            f"a {self.thing} every {every:g} s",
            *([f"a bead where {self.things} would overlap"] if crowded else []),
        ]

    def place_balls(self, painter: Painter, camera: Camera, t: float) -> None:
        """All that are there at time t in s, over their shadows."""
        placed = self._placed(camera, t)
        for draw in (self.shadow, self.draw_ball):
            for name, spot in placed.items():
                draw(painter, camera, name, t, *spot)

    def _traces(self, sheet: Sheet, camera: Camera) -> None:
        """All paths, other runs' below; that of the ball that is played is kept as ``trace``, in px."""
        traces = {name: self.traced(camera, path.points) for name, path in self.paths.items()}
        self.trace = traces.pop(self.ball)
        for ghost in self.ghosts:
            ghost.draw(sheet, self.traced(camera, ghost.points))
        for name, points in traces.items():
            draw_trace(sheet, points, self.colour_of(name), self.thickness(name))
        draw_trace(sheet, self.trace, self.colour_of(self.ball), self.thickness(self.ball))

    def _strings(self, painter: Painter, camera: Camera, t: float) -> None:
        """Of the balls that hang."""
        for name, (x, y) in self.strings:
            ends = [camera.pixel(x, y), camera.pixel(*self.run.state(name, t)[:2])]
            painter.line(ends, STRING * self.unit, self.STRING)

    def _trails(self, sheet: Sheet, camera: Camera, t: float) -> None:
        """Where the balls have been: a thin line, and a thick one of late; and where those of other runs are. All under
        the headline."""
        painter = sheet.painter
        sheet.surface.set_clip((0, sheet.top_row, *self.size))
        for ghost in self.ghosts:
            ghost.draw_in_frame(sheet, self.traced(camera, ghost.points), self.spots(camera, ghost.at(t), 0.0)[0])
        for name, (moments, places) in self._tracks.items():
            if t <= self.told:
                been = np.vstack([places[: np.searchsorted(moments, t)], self.run.state(name, t)[:2]])
                painter.thread(self.spots(camera, been, 0.0), self.unit, self.faint_of(name))
            self.trail(painter, camera, name, t)
        sheet.surface.set_clip(None)

    def trail(self, painter: Painter, camera: Camera, name: str, t: float) -> None:
        """Where a ball has been of late, at time t in s."""
        path = self.paths[name]
        first, last = np.searchsorted(path.samples[:, 0], (t - self.TRAIL, t))
        late = self.spots(camera, np.vstack([path.points[first:last], self.run.state(name, t)[:2]]), 0.0)
        if np.ptp(late, axis=0).max() > 2:
            width = 1.1 * max(self.radii[name] * camera.scale, self.least)
            painter.fading(late[apart(late, 3.0)], width, self.colour_of(name), 0.9)

    @cached_property
    def _tracks(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Times (s) and places (m) along each ball's path that can be told apart where frames begin."""
        camera, found = self.view(0.0), {}
        for name, path in self.paths.items():
            some = apart(camera.pixels(path.points), 4.0)
            found[name] = path.samples[some, 0], path.points[some]
        return found

    def _placed(self, camera: Camera, t: float, in_frame: bool = False) -> dict[str, tuple[Point, float]]:
        """Of each ball that is there at time t in s, where it is drawn and with what radius, in px."""
        placed, least = {}, self._least(in_frame)
        for name in self.present(t):
            radius = max(self.radii[name] * camera.scale, least)
            x, y = self.spots(camera, np.array([self.run.state(name, t)[:2]]), radius)[0]
            placed[name] = (float(x), float(y)), radius
        return placed

    def last(self, camera: Camera) -> tuple[Point, float]:
        """Where the ball that is played hides what is behind it, and its radius there, in px: 0 once it is caught."""
        at, radius = self._placed(camera, self.told).get(self.ball, ((0.0, 0.0), 0.0))
        return at, radius * self.looks[self.ball].solid

    def present(self, t: float) -> list[str]:
        """The balls that have not been caught at time t in s."""
        gone = {event.ball for event in self.run.events if event.kind == "caught" and event.t <= t}
        return [name for name in self.balls if name not in gone]

    def traced(self, camera: Camera, points: np.ndarray) -> np.ndarray:
        """A path in px, in as many points as can be told apart."""
        traced = self.spots(camera, points, 0.0)
        return traced[apart(traced, FINEST)]

    def _still(self, camera: Camera) -> pygame.Surface:
        """What stands still; kept while the camera does."""
        if self._standing is None or self._standing[0] != camera:
            surface = blank(self.size) if self._standing is None else self._standing[1]  # new memory is slow
            self.backdrop(Painter(surface), camera)
            self._standing = camera, surface
        return self._standing[1]

    def _room(self, sheet: Sheet, camera: Camera, t: float | None) -> float:
        """Draw what is in the upper right corner; how much room that leaves for the headline, in px."""
        inset = self.inset(sheet, camera, t)
        right = sheet.frame.right if inset is None else inset.left - 2 * sheet.gap
        if any(self.wind):
            right = sheet.wind(*self.wind, right, sheet.frame.top).left - 2 * sheet.gap
        return right - sheet.frame.left
