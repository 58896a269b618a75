"""A run of a scene: with its result, its verdict and its pictures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, NoReturn, Unpack

from sandbox.engine.model.change import Changes, changes_between
from sandbox.engine.paths.run import Run
from sandbox.text import no_such_result

if TYPE_CHECKING:
    from sandbox.scene.scene import Scene


#: The names of what a run has, looked up once and not for every shot of a sweep.
_FIELDS = tuple(each.name for each in fields(Run))


class UnknownFact(KeyError):
    """A run's result was asked for what is not in it."""

    def __str__(self) -> str:
        return str(self.args[0])  # a KeyError's own text has quotes around it


class Result(dict[str, Any]):
    """The facts of a run by name, each in its unit."""

    def __missing__(self, name: object) -> NoReturn:
        raise UnknownFact(f"{name!r}: {no_such_result(str(name), list(self))}")


@dataclass(repr=False)
class SceneRun(Run):
    """The run of a scene: a ``Run``, and ``result`` has the facts that the scene reads from it.

    >>> import sandbox
    >>> run = sandbox.simulate("golf")
    >>> run.scene.units["carry"], 200 < run.result["carry"] < 300
    ('m', True)
    """

    scene: Scene = field(compare=False)
    result: dict[str, Any]  # the facts, in their units

    def __post_init__(self) -> None:
        self.result = Result(self.result)

    @classmethod
    def of(cls, run: Run, scene: Scene, result: dict[str, Any]) -> SceneRun:
        """The run of a scene's setup with what its facts say of it."""
        return cls(**{name: getattr(run, name) for name in _FIELDS}, scene=scene, result=result)

    @property
    def data(self) -> Run:
        """The run without its scene."""
        return Run(**{name: getattr(self, name) for name in _FIELDS})

    def __repr__(self) -> str:
        what = f"{self.duration:.2f} s, {len(self.events)} events, ended by {self.ended}"
        return f"<Run of {self.scene.title}: {what}>"

    def fork(self, t: float, parameters: Mapping[str, Any] | None = None, /, **changes: Unpack[Changes]) -> SceneRun:
        """Return the run that goes on from time t in s with what is given changed, as ``Run.fork`` does; and with other
        ``parameters`` of the scene from then on: ``run.fork(0.5, {"air.wind": [-8, 0]})`` is a gust.

        Raises RequestError for parameters of what is over then, such as the launch.
        """
        scene = self.scene if parameters is None else self.scene.changed(parameters, "fork")
        given = Changes() if parameters is None else changes_between(self.scene.build(), scene.build())
        given.update(changes)
        run = super().fork(t, **given)
        return SceneRun.of(run, scene, scene.result(run))
