"""A world for a game loop: a simulation that is stepped from frame to frame, changed, saved and restored."""

from __future__ import annotations

import pickle
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple, Unpack

from sandbox.engine.checkpoint import Checkpoint
from sandbox.engine.live import LiveSimulation, Record
from sandbox.engine.model.accuracy import Accuracy, resolve
from sandbox.engine.model.change import Changes, changes_between
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import setup_errors_named
from sandbox.engine.paths.run import Run, State
from sandbox.errors import RequestError
from sandbox.scene.scene import Scene, as_scene
from sandbox.scene.scene_run import SceneRun

#: The first item of a save; another number where its form changes.
_FORM = "sandbox world 1"


class _Saved(NamedTuple):
    """The content of a save. The scene comes before the record, since reading it imports the module of the rest."""

    form: str
    scene: Scene | None
    record: Record
    checkpoints: list[Checkpoint]  # the last one, without what came after it; none before the first
    t: float
    events: list[Event]
    unreported: list[Event]


class World:
    """A setup or a scene that is simulated from frame to frame.

    >>> from sandbox import Ball, Gravity, Segment, Setup, Surface, World
    >>> ball = Ball("ball", mass=0.6, radius=0.12, position=(0, 2), forces=[Gravity(9.81)])
    >>> floor = Surface("floor", Segment((-5, 0), (5, 0)), restitution=0.8, friction=0.4)
    >>> world = World(Setup([ball], [floor], duration=600.0))
    >>> while not world.events:
    ...     world.step(1 / 60)
    >>> world.events[0].partner, round(world.events[0].t, 6)  # s, exact, though frames are 17 ms apart
    ('floor', 0.619098)
    >>> world.apply(impulse=(0.0, 1.5))  # N s
    >>> world.state["ball"].vy > 7.0  # m/s
    True

    It is one simulation that stops at each frame and goes on from there: its events and paths are those of a run,
    however long frames are. It ends as a run does, after the setup's ``duration`` or when its ``until`` is met, but not
    when everything rests: then time goes on, and ``apply`` may set something in motion again.
    """

    def __init__(self, setup_or_scene: Setup | Scene | str | Path, accuracy: Accuracy | str | None = None) -> None:
        """It starts at t = 0. ``accuracy`` is a level's name or an Accuracy; by default that of the scene, and
        "balanced" for a setup."""
        scene = None if isinstance(setup_or_scene, Setup) else as_scene(setup_or_scene)
        setup = setup_or_scene if isinstance(setup_or_scene, Setup) else as_scene(setup_or_scene).build()
        if accuracy is None:
            accuracy = resolve() if scene is None else resolve(**scene.parameters.accuracy.model_dump())
        accuracy = resolve(level=accuracy) if isinstance(accuracy, str) else accuracy
        if accuracy.method != "exact":
            raise RequestError(
                'a world needs accuracy.method = "exact": the plain method cannot be stopped and changed'
            )
        self._scene = scene
        self._built = setup  # from the parameters of the scene
        self._t = 0.0  # s
        self._events: list[Event] = []
        self._unreported: list[Event] = []  # of contacts that last beyond the present
        with setup_errors_named():
            self._simulation = LiveSimulation(setup, accuracy)
            self._simulation.begin()
        self._seen = 0  # events of the simulation

    def __repr__(self) -> str:
        what = "a setup" if self._scene is None else self._scene.title
        return f"<World of {what}: t = {self._t:.6g} s, {self.ended or 'going on'}>"

    @property
    def t(self) -> float:
        """The time in s."""
        return self._t

    @property
    def ended(self) -> str:
        """The way it has ended: "until" or "duration"; "rest" while nothing moves, "" while something does."""
        return self._simulation.ended

    @property
    def state(self) -> Mapping[str, State]:
        """The states of all balls and bodies now, by name: x, y in m, vx, vy in m/s, spin in rad/s. Those that were
        caught or taken out are not among them."""
        return MappingProxyType({name: State(*state[:5]) for name, state in self._simulation.states(self._t).items()})

    def angle(self, body: str) -> float:
        """Return the angle in rad at which a body is now, counter-clockwise."""
        found = self._simulation.states(self._t).get(body, ())
        if len(found) != 6:
            raise RequestError(f"there is no body {body!r} now; a ball has no angle")
        return found[5]

    @property
    def events(self) -> list[Event]:
        """The events of the last step, in order of time, and those that ``apply`` has caused before it."""
        return list(self._events)

    def step(self, dt: float) -> None:
        """Go on by dt in s. Raises RunError if the simulation cannot go on, such as where a ball leaves its bounds."""
        if not (isinstance(dt, int | float) and isfinite(dt) and dt >= 0.0):
            raise RequestError(f"step of {dt} s: must be a finite number, and not negative")
        simulation, t = self._simulation, self._t + float(dt)
        with setup_errors_named():
            simulation.advance(t)
        self._t = min(t, simulation.end) if simulation.ended in ("until", "duration") else t
        new = simulation.noted_since(self._seen)
        self._seen += len(new)
        waiting = sorted([*self._unreported, *new], key=lambda event: event.t)
        self._events = [event for event in waiting if event.t <= self._t]
        self._unreported = waiting[len(self._events) :]

    def apply(self, parameters: Mapping[str, Any] | None = None, /, **changes: Unpack[Changes]) -> None:
        """Change something now: forces, torques, velocity, spin, position and impulse of balls; ``add`` and ``remove``
        balls; and the fields of the setup, all as in ``Run.fork``; and other ``parameters`` of the scene from now on.

        A ball in a simulated contact with others (some 0.1 ms) goes through it first. Raises RequestError for a change
        that cannot be; nothing has changed then.
        """
        scene, built, given = self._scene, self._built, Changes()
        if parameters is not None:
            if scene is None:
                raise RequestError("this world is of a setup: only one of a scene has parameters")
            scene = scene.changed(parameters, "apply")
            built = scene.build()
            given = changes_between(self._built, built)
        given.update(changes)
        with setup_errors_named():
            self._simulation.change(self._t, given)
        self._scene, self._built = scene, built

    def run(self) -> Run:
        """Return the run so far, which can be drawn and asked as any other; that of a scene has a result."""
        run = self._simulation.so_far(self._t)
        return run if self._scene is None else SceneRun.of(run, self._scene, self._scene.result(run))

    def save(self) -> bytes:
        """Return all that ``restore`` needs to go on exactly from here, in this process or in another.

        Its forces, laws and ``until`` must be objects of classes or functions that a module has, as is usual.
        """
        record, unreported = self._simulation.record, [*self._unreported, *self._simulation.noted_since(self._seen)]
        checkpoints = [each.alone() for each in record.checkpoints if each.t <= self._t][-1:]
        saved = _Saved(_FORM, self._scene, record, checkpoints, self._t, self._events, unreported)
        try:
            return pickle.dumps(tuple(saved))
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            said = f"this world cannot be saved: {error}"
            raise RequestError(f"{said}; forces, laws and until must be of classes or functions of a module") from None

    def restore(self, saved: bytes) -> None:
        """Go back, or on, to where ``saved`` was made, whatever this world was.

        A save is trusted like a program: reading it can run any code, so restore none that comes from somebody else.
        """
        try:
            found = _Saved(*pickle.loads(saved))
            if found.form != _FORM:
                raise ValueError(f"its form is {found.form!r}, not {_FORM!r}")
        except Exception as error:
            raise RequestError(f"this is no save of a world that can be restored here: {error}") from None
        found.record.checkpoints = found.checkpoints
        with setup_errors_named():
            self._simulation = found.record.at(found.t)
        self._scene, self._t, self._events, self._unreported = found.scene, found.t, found.events, found.unreported
        self._built = self._simulation.record.setup if found.scene is None else found.scene.build()
        self._seen = len(self._simulation.noted_since(0))
