"""A world for a game loop: a simulation that is stepped from frame to frame, changed, saved and restored."""

from __future__ import annotations

import pickle
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import isfinite, nextafter
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
from sandbox.errors import RequestError, RunError
from sandbox.scene.scene import Scene, as_scene
from sandbox.scene.scene_run import SceneRun

#: The first item of a save; another number where its form changes.
_FORM = "sandbox world 2"


class _Saved(NamedTuple):
    """The content of a save. The scene comes before the record, since reading it imports the module of the rest."""

    form: str
    scene: Scene | None
    record: Record
    checkpoints: list[Checkpoint]  # the last one, without what came after it; none before the first
    t: float
    events: list[Event]
    unreported: list[Event]
    failed: str


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

    def __init__(
        self,
        source: Setup | Scene | str | Path | Run,
        accuracy: Accuracy | str | None = None,
        *,
        t: float | None = None,
    ) -> None:
        """It starts at t = 0 with a setup or a scene; with a run where that has ended, or at a time ``t`` in s of it.

        ``accuracy`` is a level's name or an Accuracy; by default that of the scene, and "balanced" for a setup. A run
        keeps its own.
        """
        if isinstance(source, Run):
            self._continue(source, accuracy, t)
            return
        if t is not None:
            raise RequestError(f"t = {t!r}: only the world of a run starts later than at 0 s")
        scene = None if isinstance(source, Setup) else as_scene(source)
        setup = source if isinstance(source, Setup) else as_scene(source).build()
        if accuracy is None:
            accuracy = resolve() if scene is None else resolve(**scene.parameters.accuracy.model_dump())
        accuracy = resolve(level=accuracy) if isinstance(accuracy, str) else accuracy
        if accuracy.method != "exact":
            raise RequestError(
                'a world needs accuracy.method = "exact": the plain method cannot be stopped and changed'
            )
        with setup_errors_named():
            simulation = LiveSimulation(setup, accuracy)
            simulation.begin()
        self._stand(simulation, 0.0, scene, setup)
        self._seen = 0

    def _continue(self, run: Run, accuracy: Accuracy | str | None, t: float | None) -> None:
        """Stand at a time of a run."""
        if accuracy is not None:
            raise RequestError("accuracy: the world of a run has that of the run")
        if not isinstance(run.record, Record):
            raise RequestError("this run cannot go on: it was read from a file, or computed by the plain method")
        t = run.duration if t is None else t
        if not (isinstance(t, int | float) and 0.0 <= t <= run.duration):
            raise RequestError(f"t = {t!r}: the run is from 0 to {run.duration:.12g} s")
        scene = run.scene if isinstance(run, SceneRun) else None
        with setup_errors_named():
            self._stand(run.record.at(t), float(t), scene, run.setup)

    def _stand(self, simulation: LiveSimulation, t: float, scene: Scene | None, built: Setup) -> None:
        """Be this simulation, at t in s."""
        noted = simulation.noted_since(0)
        self._stepping, self._failed = False, ""  # why it cannot go on before something is changed
        self._simulation, self._t, self._scene = simulation, t, scene
        self._built = built  # from the parameters of the scene
        self._seen = len(noted)  # events of the simulation
        self._events: list[Event] = []
        self._unreported = [event for event in noted if event.t > t]  # of contacts that last beyond the present

    @property
    def _live(self) -> LiveSimulation:
        """The simulation. Raises RunError for a force or law that reads the world that steps it."""
        self._refuse_inside()
        return self._simulation

    def _refuse_inside(self) -> None:
        """Raise RunError inside a step, where nothing but the step's forces and laws can come from."""
        if self._stepping:
            raise RunError(
                "a force, law or condition of this world reads it while it is stepped, when its state is that of "
                "before: it may depend on what it is called with, and on nothing else"
            )

    @contextmanager
    def _going_on(self) -> Iterator[LiveSimulation]:
        """Inside, the simulation goes on or is changed. Where that fails this world goes back to the last state that
        was true, unless a change was refused, which has changed nothing."""
        simulation = self._live
        changes = len(simulation.record.changes)
        self._stepping = True
        try:
            with setup_errors_named():
                yield simulation
        except BaseException as error:
            if not isinstance(error, RequestError) or len(simulation.record.changes) > changes:
                self._go_back(changes)
            raise
        finally:
            self._stepping = False

    def _go_back(self, changes: int) -> None:
        """Stand where the change after the first ``changes`` was made; or, if there is none, just before the event at
        which the simulation failed."""
        failed = self._simulation
        at = self._t if len(failed.record.changes) > changes else max(self._t, nextafter(failed.end, 0.0))
        del failed.record.changes[changes:]
        self._simulation = failed.record.at(at)
        self._arrive(at)

    def __repr__(self) -> str:
        what = "a setup" if self._scene is None else self._scene.title
        return f"<World of {what}: t = {self._t:.6g} s, {self._simulation.ended or 'going on'}>"

    @property
    def t(self) -> float:
        """The time in s."""
        self._refuse_inside()
        return self._t

    @property
    def ended(self) -> str:
        """The way it has ended: "until" or "duration"; "rest" while nothing moves, "" while something does."""
        return self._live.ended

    @property
    def state(self) -> Mapping[str, State]:
        """The states of all balls and bodies now, by name: x, y in m, vx, vy in m/s, spin in rad/s. Those that were
        caught or taken out are not among them."""
        return MappingProxyType({name: State(*state[:5]) for name, state in self._live.states(self._t).items()})

    def angle(self, body: str) -> float:
        """Return the angle in rad at which a body is now, counter-clockwise."""
        found = self._live.states(self._t).get(body, ())
        if len(found) != 6:
            raise RequestError(f"there is no body {body!r} now; a ball has no angle")
        return found[5]

    @property
    def events(self) -> list[Event]:
        """The events of the last step, in order of time, and those that ``apply`` has caused before it."""
        self._refuse_inside()
        return list(self._events)

    def step(self, dt: float) -> None:
        """Go on by dt in s.

        Raises RunError if the simulation cannot go on, such as where a ball leaves its bounds: then the world stands
        just before that, and goes on only after something is changed.
        """
        if not (isinstance(dt, int | float) and isfinite(dt) and dt >= 0.0):
            raise RequestError(f"step of {dt} s: must be a finite number, and not negative")
        if self._failed:
            raise RunError(f"{self._failed}; this world goes on when something is changed (apply)")
        t = self._t + float(dt)
        try:
            with self._going_on() as simulation:
                simulation.advance(t)
        except Exception as error:
            self._failed = str(error)
            raise
        self._arrive(min(t, simulation.end) if simulation.ended in ("until", "duration") else t)

    def _arrive(self, t: float) -> None:
        """Be at t in s, up to which the simulation has gone on."""
        self._t = t
        new = self._simulation.noted_since(self._seen)
        self._seen += len(new)
        waiting = sorted([*self._unreported, *new], key=lambda event: event.t)
        self._events = [event for event in waiting if event.t <= t]
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
        with self._going_on() as simulation:
            simulation.change(self._t, given)
        self._scene, self._built, self._failed = scene, built, ""

    def run(self) -> Run:
        """Return the run so far, which can be drawn and asked as any other; that of a scene has a result."""
        run = self._live.so_far(self._t)
        return run if self._scene is None else SceneRun.of(run, self._scene, self._scene.result(run))

    def save(self, history: bool = True) -> bytes:
        """Return all that ``restore`` needs to go on exactly from here, in this process or in another; without
        ``history`` not the paths and events so far, so that saves do not grow with time.

        Its forces, laws and ``until`` must be objects of classes or functions that a module has, as is usual.
        """
        simulation = self._live
        unreported = [*self._unreported, *simulation.noted_since(self._seen)]
        record = simulation.record.saved_at(self._t, history)
        saved = _Saved(_FORM, self._scene, record, record.checkpoints, self._t, self._events, unreported, self._failed)
        try:
            return pickle.dumps(tuple(saved))
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            said = f"this world cannot be saved: {error}"
            raise RequestError(f"{said}; forces, laws and until must be of classes or functions of a module") from None

    @classmethod
    def restore(cls, saved: bytes) -> World:
        """Return the world that was saved, where it stood.

        A save is trusted like a program: reading it can run any code, so restore none that comes from somebody else.

        >>> from sandbox import Ball, Gravity, Setup, World
        >>> world = World(Setup([Ball("ball", 0.6, 0.12, (0, 2), forces=[Gravity(9.81)])]))
        >>> world.step(0.5)
        >>> saved = world.save()
        >>> world.step(0.5)
        >>> World.restore(saved).t  # s
        0.5
        """
        try:
            found = _Saved(*pickle.loads(saved))
            if found.form != _FORM:
                raise ValueError(f"its form is {found.form!r}, not {_FORM!r}")
        except Exception as error:
            raise RequestError(f"this is no save of a world that can be restored here: {error}") from None
        found.record.checkpoints = found.checkpoints
        world = cls.__new__(cls)
        with setup_errors_named():
            simulation = found.record.at(found.t)
        built = simulation.record.setup if found.scene is None else found.scene.build()
        world._stand(simulation, found.t, found.scene, built)
        world._events, world._unreported, world._failed = found.events, found.unreported, found.failed
        return world
