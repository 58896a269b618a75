"""Scene options: what a scene may change in its picture. Each has a default; the rest of a picture is the same for all
scenes.

A scene's ``Picture`` is a :class:`~sandbox.picture.side.SideView` or a view from above, and overrides some of these
constants and methods. The views have a few more of their own: from the side in ``side_options.py``, the others in their
sections "scene options". Lengths are in m, times in s, and px are those of the picture.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, wraps
from math import atan2, degrees, hypot, pi
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np
import pygame

from sandbox.engine.contact.touch import Outline
from sandbox.errors import RunError
from sandbox.parameters import Group
from sandbox.picture.answer import Pulled, pulled_nets
from sandbox.picture.ball import SMALLEST, Fall, Look, least_radius, seams
from sandbox.picture.camera import Box, Camera
from sandbox.picture.painter import Painter
from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import Entry, Sheet
from sandbox.picture.story import Story
from sandbox.scene.deciding import decided_at
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import amount, metres, signed
from sandbox.text import shortened
from sandbox.tracebacks import is_ours

_CARD, _PLAIN = palette("card"), palette("plain")
_TRACES = palette("trace")["colours"]

#: A run that is shorter, in s, is told in ms.
_INSTANT = 0.1

#: The times at which the distance of a ball to surfaces that move is compared.
_NEAREST = 200

P = TypeVar("P", bound=Group)


def _function(member: Any) -> Any:
    """The function of a method, property or cached property."""
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


class SceneOptions(Generic[P]):
    """Everything that a scene may override, with defaults, and what it may ask for: run and size of the picture."""

    run: SceneRun
    parameters: P
    size: tuple[int, int]  # px
    sheet: Sheet  # the one drawn last
    unit: float  # what 1 px is on a picture of 720 rows
    rows: int  # for which letters and lines are made
    radii: dict[str, float]  # m, of each ball
    radius: float  # m, of the ball that is played
    #: The time in s at which what was hit answers, which goes on after the end of the run; None: it stands still.
    answering: float | None = None

    # Colours and words

    #: The look of the ball, and its name in notes: "" for a ball, or a body where it is a ``Body``.
    LOOK: ClassVar[Look] = Look(_PLAIN["ball"], seams(_PLAIN["marks"]))
    #: Looks of balls by name, where they differ.
    LOOKS: ClassVar[Mapping[str, Look]] = {}
    THING: ClassVar[str] = ""
    #: A caveat that is written wherever the result is shown, such as "not validated".
    CAVEAT: ClassVar[str] = ""
    #: Colours of the path, of the thin line of it that stays behind in frames (None: the same), and of the paths of
    #: other balls and other runs.
    TRACE: ClassVar[Colour] = _TRACES[0]
    FAINT_TRACE: ClassVar[Colour | None] = None
    OTHER_TRACES: ClassVar[Sequence[Colour]] = _TRACES[1:]
    #: Names of a spin below and of one above zero.
    SPIN_NAMES: ClassVar[tuple[str, str]] = ("topspin", "backspin")
    #: The direction that a camera may stretch, as notes call it: "heights" or "widths".
    STRETCHED: ClassVar[str] = "heights"
    #: The colour of strings.
    STRING_COLOUR: ClassVar[Colour] = _CARD["quiet"]
    #: The colour of surfaces that move.
    DRIVEN: ClassVar[Colour] = _PLAIN["surface"]
    #: True if text stands on dark ground, False if on light; None: as the place is where the headline stands.
    ON_DARK: ClassVar[bool | None] = None

    # How much is drawn

    #: The trail behind the ball in frames shows the path of so many s.
    TRAIL: ClassVar[float] = 0.5
    #: The balls along the path are spread over at least this share of its time.
    MIN_STROBE_SHARE: ClassVar[float] = 0.25
    #: The slowest impacts that are marked: in m/s, and as a share of the hardest.
    MIN_IMPACT: ClassVar[float] = 0.3
    MIN_IMPACT_SHARE: ClassVar[float] = 0.03
    #: Width of the paths of other balls, and of bodies, which may be thin, as a share of that of the ball in play.
    OTHER_WIDTH: ClassVar[float] = 0.6
    #: True if the plane of play is the ground.
    FROM_ABOVE: ClassVar[bool] = False
    #: True if all runs share the ground, so that one cannot be moved up or down to lie over another.
    SHARED_GROUND: ClassVar[bool] = False

    # What is shown

    @property
    def ball(self) -> str:
        """The ball that is played: its path is the picture's."""
        return self.run.setup.balls[0].name

    @property
    def balls(self) -> list[str]:
        """All that are drawn as balls."""
        return [ball.name for ball in self.run.setup.balls]

    @property
    def min_radius(self) -> float:
        """The smallest radius in px at which a ball is drawn: larger for one alone, since several may be close."""
        return least_radius(self.rows) if len(self.balls) == 1 else SMALLEST / 2

    @cached_property
    def story_end(self) -> float:
        """The time in s at which the path ends and the verdict is in."""
        return self.run.duration

    @cached_property
    def strobe_end(self) -> float:
        """The time in s until which balls are drawn along the path: the first touch, unless that is soon."""
        touches = (event.t for event in self.run.events if self.ball in (event.ball, event.partner))
        return max(min(next(touches, self.story_end), self.story_end), self.MIN_STROBE_SHARE * self.story_end)

    @property
    def moment(self) -> float:
        """The time in s at which the poster shows what moves besides the balls."""
        return 0.0

    @cached_property
    def driven_moment(self) -> float:
        """The time in s at which the poster shows surfaces that move: when the ball last hits one, or is nearest."""
        driven = [surface for surface in self.run.setup.surfaces if surface.motion is not None]
        names = {surface.name for surface in driven}
        met = [event.t for event in self.run.events if event.partner in names and event.t <= self.story_end]
        if met or not driven:
            return met[-1] if met else self.story_end

        def gap(t: float) -> float:
            x, y = self.run.state(self.ball, t)[:2]
            return min(Outline.of(surface.at(t).shape, 0.0).near(x, y).gap for surface in driven)

        return min(np.linspace(0.0, self.story_end, _NEAREST).tolist(), key=gap)

    @cached_property
    def decided(self) -> float:
        """The time in s at which the run is decided."""
        return decided_at(self.run, self.ball)

    @property
    def closest(self) -> Camera:
        """The camera of frames where it is nearest."""
        raise NotImplementedError

    @property
    def story(self) -> Story | None:
        """The place and time that the camera of frames goes to; None if it stays where it is."""
        return None

    def meeting(self, *places: Box, share: float = 0.35, spot: float, at: float | None = None) -> Story:
        """The story of a ball that comes to one of some places (m) at a time in s, by default when that decides: to the
        nearest, or where none is near to a spot of its own, so many m wide."""
        at = self.decided if at is None else at
        x, y = self.run.state(self.ball, at)[:2]

        def away(box: Box) -> float:
            return hypot(max(box.left - x, 0.0, x - box.right), max(box.bottom - y, 0.0, y - box.top))

        half = 0.5 * spot
        near = [box for box in places if away(box) <= max(spot, box.right - box.left, box.top - box.bottom)]
        return Story(min(near, key=away, default=Box(x - half, y - half, x + half, y + half)), at, share)

    @property
    def floor(self) -> float | None:
        """The height in m under which a camera that goes in shows nothing; None where any is as good."""
        return None

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        """The point in m that runs have in common when they are compared, and what it is."""
        return (0.0, 0.0), "the start"

    @property
    def strings(self) -> Sequence[tuple[str, tuple[float, float]]]:
        """The balls that hang on a string, each with the point in m where that is tied."""
        return ()

    @property
    def opening(self) -> pygame.Rect:
        """The part of the picture in which the place is seen, in px: a path ends at its edge."""
        return pygame.Rect((0, 0), self.size)

    def position_of(self, name: str, t: float) -> tuple[float, float]:
        """The place in m at which a ball is drawn at time t in s: its own, or where it ends up once it is caught."""
        return self.run.state(name, t)[:2]

    def look_of(self, name: str) -> Look:
        """The look of a ball."""
        return self.LOOKS.get(name, self.LOOK)

    def fall_of(self, name: str) -> Fall | None:
        """Return the fall of a ball that begins standing; None for one that does not."""
        return None

    def colour_of(self, name: str) -> Colour:
        """The colour of the path of a ball, or of anything else that moves."""
        others = [ball.name for ball in self.run.setup.balls if ball.name != self.ball]
        return self.TRACE if name == self.ball else self.OTHER_TRACES[others.index(name) % len(self.OTHER_TRACES)]

    def faint_of(self, name: str) -> Colour:
        """The colour of the thin line that stays where a ball has been, in frames."""
        return self.FAINT_TRACE if self.FAINT_TRACE and name == self.ball else self.colour_of(name)

    def initial_turn(self, name: str) -> np.ndarray:
        """The rotation matrix of a ball's look at the start."""
        return np.eye(3)

    # What is written

    def progress(self, t: float) -> tuple[str, str]:
        """Headline and note of a frame at time t in s, before the verdict is in."""
        return self.clock(t), ""

    def clock(self, t: float) -> str:
        """A time in s, in ms where all is over in an instant."""
        return f"{1e3 * t:.2f} ms" if self.run.duration < _INSTANT else f"{t:.2f} s"

    def position(self, t: float) -> list[Entry]:
        """Entries of the frame's card for the ball's position."""
        x, y, *_ = self.run.state(self.ball, t)
        return [("x", metres(x)), ("y", metres(y))]

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
        rpm, (below, above) = spin * 30 / pi, self.SPIN_NAMES
        return f"{abs(rpm):.0f} rpm {above if rpm > 0.0 else below}" if abs(rpm) >= 0.5 else "none"

    def remarks(self, camera: Camera) -> list[str]:
        """Notes on parts of the place that are not drawn to scale, or are out of sight."""
        return []

    # What is drawn, from the lowest layer up

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """Draw what stands still, all of it behind the ball."""

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """Draw what moves behind the ball, at time t in s."""

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        """Draw what hides the ball, at time t in s."""

    def landmarks(self, sheet: Sheet, camera: Camera) -> None:
        """Write the labels of the place, whatever the shot."""

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """Draw what only this sport has on its poster."""

    @property
    def aims(self) -> Sequence[Box]:
        """The targets of the shot, in m, such as a goal: nothing in the window covers them."""
        return ()

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect | None:
        """Draw a small picture in the upper right corner, at time t in s or on the poster; where it is."""
        return None

    @cached_property
    def pulled(self) -> Sequence[Pulled]:
        """The nets that the ball pulls out: surfaces of that name that it hits."""
        return pulled_nets(self.run, self.ball, self.FROM_ABOVE)

    def rolls(self, name: str) -> bool:
        """True if a ball turns about level axes, too."""
        setup = self.run.setup
        return setup.plane is not None and bool(setup.plane_of(name).rolls)

    def __init_subclass__(cls) -> None:
        """Report a forgotten ``return`` where a user's own picture overrides what has a value."""
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
