"""The setup that a scene passes to the engine: balls, surfaces, and when the run ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup_errors import call_user_function
from sandbox.engine.model.surface import ELASTIC, BounceLaw, Circle, Segment, Surface, Trap
from sandbox.physics.checks import check, short, with_fields_named
from sandbox.physics.elementwise import maximum, minimum
from sandbox.physics.hertz import PHENOLIC

if TYPE_CHECKING:
    from sandbox.engine.model.event import Event
    from sandbox.engine.model.shapes import Vector
    from sandbox.physics.integrators import State
    from sandbox.physics.plane import Plane


class ForceRegion(NamedTuple):
    """A region at whose border a force begins, ends or has a kink, such as a net: steps end there, and none through it
    is longer than ``step``, so that none skips it.

    >>> from sandbox import Ball, ForceRegion, Setup
    >>> net = ForceRegion(left=4.4, bottom=2.6, right=4.8, top=3.05, step=0.01)
    >>> setup = Setup([Ball("ball", mass=1.0, radius=0.1, position=(0, 0))], force_regions=[net])
    """

    left: float  # m
    bottom: float  # m
    right: float  # m
    top: float  # m
    step: float  # s


class Bounds(NamedTuple):
    """The world's edges in m: a ball outside them is an error.

    >>> from sandbox import Ball, Bounds, Setup
    >>> setup = Setup([Ball("ball", mass=1.0, radius=0.1, position=(0, 0))], bounds=Bounds(left=-1e6, right=1e6))
    """

    left: float = -1e5
    bottom: float = -1e5
    right: float = 1e5
    top: float = 1e5

    def hold(self, state: State) -> Any:
        """Return True if a ball in this state is inside, and all its numbers are finite."""
        x, y, vx, vy, spin = state[:5]
        inside = (self.left <= x) & (x <= self.right) & (self.bottom <= y) & (y <= self.top)
        motion = vx + vy + spin
        return inside & (motion - motion == 0.0)

    def describe_violation(self, state: State) -> str:
        """Return what is wrong with a ball in a state that they do not hold."""
        x, y, vx, vy, spin = state[:5]
        wrong = (
            f"is outside the world ({self.left:g} to {self.right:g} m, {self.bottom:g} to {self.top:g} m); shorten the "
            "duration, or widen the scene's bounds"
            if all(map(isfinite, state))
            else "is not finite; check the forces, or lower accuracy.step or accuracy.tolerance"
        )
        return f"position ({x:.6g}, {y:.6g}) m, velocity ({vx:.6g}, {vy:.6g}) m/s, spin {spin:.6g} rad/s {wrong}"


@dataclass(frozen=True)
class ContactModel:
    """The model of impacts of several balls at once.

    ``name`` is "rigid" (one impact after another; balls that touch act as one), "hertz" (every impact of balls by
    contact mechanics) or "auto" (contact mechanics only if a third body can be reached during the contact).
    ``stiffness`` is that of a pair in N/m^1.5; None means phenolic resin. ``wall_stiffness`` is that of a ball and a
    wall; 0 for walls, such as cushions, that are so much softer than balls that they push back after the balls have
    separated. ``along`` is the stiffness along a contact over that across it, 0.8 for most elastic balls, which spring
    back along it; infinite for balls that give way across it only.

    >>> from sandbox import Ball, ContactModel, Setup
    >>> ball = Ball("ball", mass=1.0, radius=0.1, position=(0, 0))
    >>> setup = Setup([ball], contact=ContactModel("hertz", stiffness=1e9))
    """

    name: Literal["auto", "rigid", "hertz"] = "auto"
    stiffness: float | None = None
    wall_stiffness: float = 0.0
    along: float = inf

    def __post_init__(self) -> None:
        if self.name not in ("auto", "rigid", "hertz"):
            raise ValueError(f'contact model: name = {short(self.name)} must be "auto", "rigid" or "hertz"')
        check("contact model", self, not_negative=["wall_stiffness"])
        if self.stiffness is not None:
            check("contact model", self, positive=["stiffness"])
        if self.along != inf:
            check("contact model", self, positive=["along"])

    def between(self, radius: float, other: float) -> float:
        """Stiffness in N/m^1.5 of two balls with these radii in m."""
        return PHENOLIC.between(radius, other) if self.stiffness is None else self.stiffness


class Rule(NamedTuple):
    """Ends a run when something with one of these ``names``, or anything but what is in ``but``, is touched for the
    ``times``-th time, later than ``after`` (s), no faster than ``fastest`` (m/s), at no place with ``left < x < right``
    (m)."""

    names: tuple[str, ...] = ()
    times: int = 1
    fastest: float = inf
    left: float = inf
    right: float = -inf
    after: float = -inf
    but: tuple[str, ...] = ()
    bounces: bool = False  # only impacts count, and not that it slides or rolls from now on

    def about(self, ball: str, partner: str) -> bool:
        """True if it is about these."""
        return (not self.names or ball in self.names or partner in self.names) and partner not in self.but

    def counts(self, event: Event) -> bool:
        """True if it counts this event."""
        kind = event.kind == "impact" or (not self.bounces and event.kind not in ("leave", "rest"))
        where = event.t > self.after and event.speed <= self.fastest and not self.left < event.x < self.right
        return kind and where and self.about(event.ball, event.partner)

    def ends(self, events: Sequence[Event]) -> bool:
        """True if the run ends with the last of these events."""
        return self.counts(events[-1]) and sum(map(self.counts, events)) >= self.times


class Until:
    """A condition for the end of a run that needs more than the latest event.

    >>> import sandbox
    >>> from sandbox import Ball, Setup, Until
    >>> class Beyond(Until):
    ...     def over(self, events):
    ...         return False
    ...     def passed(self, start, end):
    ...         return end[0] > 10.0
    >>> ball = Ball("ball", mass=1.0, radius=0.1, position=(0, 0), velocity=(5, 0))
    >>> sandbox.simulate(Setup([ball], until=Beyond())).ended
    'until'
    """

    def over(self, events: Sequence[Event]) -> bool:
        """Return True if the run ends with the last of these events."""
        return any(rule.ends(events) for rule in self.rules() or ())

    def passed(self, start: State, end: State) -> Any:
        """Return True if the run ends with a step between these states, without an event; floats, or arrays for many
        shots."""
        return False

    def line(self) -> tuple[Vector, Vector] | None:
        """A line at which a step that passes it may end the run, as ``passes`` says; None if there is none. Many shots
        need not be followed far beyond it."""
        return None

    def rules(self) -> Sequence[Rule] | None:
        """The rules by which ``over`` judges impacts of a single ball: the run is over as soon as one of these ends it.
        None if that is not all that it says."""
        return None


@dataclass(frozen=True)
class EndsBy(Until):
    """Ends a run as soon as one of these rules does."""

    of: tuple[Rule, ...]

    def rules(self) -> Sequence[Rule]:
        return self.of


def passes(x0: Any, y0: Any, x1: Any, y1: Any, a: Any, b: Any, c: Any, d: Any) -> Any:
    """True if the way from (x0, y0) to (x1, y1) leads over the line from (a, b) to (c, d) to its right; all in m."""
    ex, ey = c - a, d - b
    along, end = (x0 - a) * ex + (y0 - b) * ey, (x1 - a) * ex + (y1 - b) * ey
    inside = (minimum(along, end) > 0.0) & (maximum(along, end) < ex * ex + ey * ey)
    return inside & ((x0 - a) * ey - (y0 - b) * ex <= 0.0) & ((x1 - a) * ey - (y1 - b) * ex > 0.0)


def is_over(until: Callable[[Event], bool] | Until | None, events: Sequence[Event]) -> bool:
    """Return True if a run with this condition ends with the last of these events."""
    if isinstance(until, Until):
        return until.over(events)
    return until is not None and call_user_function(until, "until is called as until(event)", events[-1])


@dataclass(frozen=True)
class Touches(Until):
    """Ends a run when something is touched for the ``times``-th time: ``until=Touches("floor", 2)`` is the second
    bounce.

    ``what`` is the name of a surface, a ball or a trap.

    >>> import sandbox
    >>> from sandbox import Ball, Gravity, Segment, Setup, Surface, Touches
    >>> ball = Ball("ball", mass=1.0, radius=0.1, position=(0, 1), forces=[Gravity(9.81)])
    >>> floor = Surface("floor", Segment((-1, 0), (1, 0)), restitution=0.8, friction=0.0)
    >>> len(sandbox.simulate(Setup([ball], [floor], until=Touches("floor", 2))).events)
    2
    """

    what: str
    times: int = 1

    def __post_init__(self) -> None:
        check("Touches", self, names=["what"])
        if not isinstance(self.times, int | Integral) or self.times < 1:
            raise ValueError(f"Touches: times = {short(self.times)} must be a whole number, 1 or more")

    def rules(self) -> Sequence[Rule]:
        return [Rule((self.what,), self.times)]


@with_fields_named
@dataclass(frozen=True)
class Setup:
    """The initial state of a run. It ends when all balls rest, when ``until`` is met, or after ``duration`` s.

    It is data: made of dataclasses, tuples and module functions, so it can be pickled, compared and stacked.
    ``until`` is a function of the latest event, or an ``Until`` such as ``Touches``.
    ``between_balls(normal_speed, slip_speed)`` returns the Bounce of two balls; ``pairs`` gives a law for two by name:
    ``("ball", "keeper", law)``. With a ``plane`` the balls are seen from above, sliding and rolling on it by its law of
    motion, or that in ``planes`` under a ball's name: ``("ball", law)``; their own forces act along it.

    >>> from sandbox import Ball, Gravity, Segment, Setup, Surface
    >>> setup = Setup([Ball("ball", mass=0.62, radius=0.12, position=(0, 2), velocity=(5, 6), forces=[Gravity(9.81)])],
    ...               [Surface("floor", Segment((-10, 0), (30, 0)), restitution=0.8, friction=0.4)], duration=3.0)
    >>> setup.names
    ['ball', 'floor']
    """

    balls: Sequence[Ball]
    surfaces: Sequence[Surface] = ()
    duration: float = 60.0  # s
    until: Callable[[Event], bool] | Until | None = None
    between_balls: BounceLaw = ELASTIC
    plane: Plane | None = None
    traps: Sequence[Trap] = ()
    bounds: Bounds = Bounds()
    force_regions: Sequence[ForceRegion] = ()
    contact: ContactModel = ContactModel()
    pairs: Sequence[tuple[str, str, BounceLaw]] = ()
    planes: Sequence[tuple[str, Plane]] = ()
    discontinuities: Sequence[float] = ()  # s, growing: when forces may jump or bend; no step goes across

    def __post_init__(self) -> None:
        check(
            "setup", self, lists=["balls", "surfaces", "traps", "force_regions", "pairs", "planes", "discontinuities"]
        )
        self._check_kinds()
        names = [ball.name for ball in self.balls]
        if not names:
            raise ValueError("a setup needs at least one ball")
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"two balls are named {name!r}: names must be unique")
        if unknown := [name for trap in self.traps for name in trap.only if name not in names]:
            raise ValueError(f"setup: traps: there is no ball {unknown[0]!r}; there are {', '.join(map(repr, names))}")
        if self.planes and self.plane is None:
            raise ValueError("a setup with planes for some balls needs a plane for all others")
        if any(ball.rotates for ball in self.balls):
            if self.plane is not None:
                raise ValueError("bodies cannot move on a plane seen from above: only balls can")
            if self.contact.name == "hertz":
                raise ValueError('contact model "hertz" is for balls: bodies collide as rigid')
            if cushion := next((surface.name for surface in self.surfaces if surface.nose_height is not None), None):
                raise ValueError(f"surface {cushion!r} has a nose_height: only balls can meet it, no bodies")
        if len(names) > 1 and (losing := next((ball.name for ball in self.balls if ball.loss is not None), None)):
            raise ValueError(f"ball {losing!r} loses mass, so it must be the only ball")
        if not isinstance(self.duration, float | Real) or not 0.0 < self.duration < inf:
            raise ValueError(f"duration = {self.duration} s must be positive and finite")
        if isinstance(self.until, Touches) and self.until.what not in self.names:
            raise ValueError(f"until = {self.until}: unknown name; choose from {', '.join(self.names)}")

    def _check_kinds(self) -> None:
        """Raise ValueError for what is not of the kind that its place needs."""
        kind: type
        for name, kind in (("balls", Ball), ("surfaces", Surface), ("traps", Trap), ("force_regions", ForceRegion)):
            for each in getattr(self, name):
                if isinstance(each, Segment | Circle) and kind is Surface:
                    raise ValueError(f"setup: surfaces: {short(each)} is a shape: write Surface(name, shape, ...)")
                if not isinstance(each, kind):
                    or_body = " or Body" if kind is Ball else ""
                    raise ValueError(f"setup: {name}: {short(each)} is no {kind.__name__}{or_body}")
        for name, kind in (("bounds", Bounds), ("contact", ContactModel)):
            if not isinstance(getattr(self, name), kind):
                raise ValueError(f"setup: {name} = {short(getattr(self, name))} must be a {kind.__name__}")
        names = [ball.name for ball in self.balls]
        self._check_names("pairs", 2, names)
        self._check_names("planes", 1, names)
        for plane in ([] if self.plane is None else [self.plane]) + [law for _, law in self.planes]:
            if not hasattr(plane, "rolls"):
                raise ValueError(f"setup: {short(plane)} is no plane, such as a Cloth")
        for ball in self.balls if self.plane is not None else ():
            if (ball.forces or ball.torques) and not hasattr(self.plane_of(ball.name), "phase_under"):
                raise ValueError(
                    f"ball {ball.name!r} has forces or torques, and its plane {short(self.plane_of(ball.name))} has no "
                    "phase_under(applied, t, state, radius) that says what they do"
                )
        check("setup", self, laws=["between_balls"])
        for *_, law in self.pairs:
            if not callable(law):
                raise ValueError(f"setup: pairs: {short(law)} is no law: a function that returns a Bounce")
        if not (self.until is None or isinstance(self.until, Until) or callable(self.until)):
            raise ValueError(f"setup: until = {short(self.until)} must be a function of an event, or such as Touches")
        left, bottom, right, top = self.bounds
        if not (all(isinstance(edge, float | Real) for edge in self.bounds) and left < right and bottom < top):
            raise ValueError(f"setup: bounds = {short(self.bounds)} must be numbers in m, left < right, bottom < top")
        for region in self.force_regions:
            check("force region", region, finite=["left", "bottom", "right", "top"], positive=["step"])
        times = self.discontinuities
        if not all(isinstance(t, float | Real) and isfinite(t) for t in times) or [*times] != sorted(times):
            raise ValueError(f"setup: discontinuities = {short(times)} must be finite times in s, growing")

    def _check_names(self, what: str, count: int, balls: Sequence[str]) -> None:
        """Raise ValueError unless each law is for so many balls, and the only one for them."""
        form, known = ("(ball, ball, law)", "(ball, law)")[2 - count], ", ".join(map(repr, balls))
        seen: list[set[str]] = []
        for entry in getattr(self, what):
            if not isinstance(entry, list | tuple) or len(entry) != count + 1:
                raise ValueError(f"setup: {what}: {short(entry)} must be {form}")
            *named, _ = entry
            for name in named:
                if name not in balls:
                    raise ValueError(f"setup: {what}: there is no ball {name!r}; there are {known}")
            if len({*named}) < count:
                raise ValueError(f"setup: {what}: {short(entry)} names one ball twice")
            if {*named} in seen:
                raise ValueError(f"setup: {what}: two laws for {' and '.join(map(repr, named))}")
            seen.append({*named})

    @property
    def names(self) -> list[str]:
        """The names of all that can be touched."""
        touched: list[Ball | Surface | Trap] = [*self.balls, *self.surfaces, *self.traps]
        return list(dict.fromkeys(each.name for each in touched))

    @property
    def is_single_ball(self) -> bool:
        """True if it has one ball among surfaces at rest, and no more: many of these can be computed together."""
        alone = len(self.balls) == 1 and not self.balls[0].rotates
        still = all(surface.motion is None for surface in self.surfaces)
        return alone and still and len(self.surfaces) > 0 and self.plane is None and not self.traps

    def between(self, one: str, other: str) -> BounceLaw:
        """The law for impacts of two balls."""
        return next((law for *pair, law in self.pairs if {*pair} == {one, other}), self.between_balls)

    def plane_of(self, ball: str) -> Plane:
        """Return the plane that a ball slides and rolls on, seen from above."""
        assert self.plane is not None
        return dict(self.planes).get(ball, self.plane)

    def moves_in_closed_form(self, ball: Ball) -> bool:
        """Return True if a ball on a plane moves by its law alone, and that has a closed form."""
        return self.plane_of(ball.name).in_closed_form and not (ball.forces or ball.torques)

    def start_of(self, ball: Ball) -> State:
        """The state of a ball at the start."""
        rolls = self.plane is not None and self.plane_of(ball.name).rolls
        return (*ball.position, *ball.velocity, ball.spin, *(ball.rolling_spin if rolls else ball.initial_angle))

    def ends_with(self, events: Sequence[Event]) -> bool:
        """Return True if the run is over with the last of these events."""
        return is_over(self.until, events)
