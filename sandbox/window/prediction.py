"""Predict first: the player marks where the ball will land, then sees; the errors are collected."""

from __future__ import annotations

from math import dist

from sandbox.engine.model.shapes import Vector
from sandbox.picture.path import first_impact
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import metres
from sandbox.window.contest import Contest, Entries
from sandbox.window.shots import Shot

#: A prediction is good if it is off by no more than this share of the way.
_GOOD = 0.05
#: So many of the last errors are shown.
_SHOWN = 8


class Prediction(Contest):
    """Marks and landings of shots in one scene, which the player may change as he likes."""

    path_shown = "nothing"
    takes_marks = True

    def __init__(self, scene: Scene) -> None:
        self.name, self._scene = f"{scene.title}: predict first", scene
        self.errors: list[float] = []  # m
        self.fresh = False  # whether the mark is for the shot to come

    @property
    def scene(self) -> Scene:
        return self._scene

    @property
    def limits(self) -> None:
        return None

    def put(self, place: Vector) -> None:
        self.mark, self.landed, self.fresh = (float(place[0]), float(place[1])), None, True

    @property
    def missing(self) -> str:
        return "" if self.fresh else "first click where it will land"

    @property
    def headline(self) -> str:
        return "Click where it will land" if not self.fresh else "Pull back and let go, or press Space"

    @property
    def stand(self) -> str:
        return "from the side: where it first touches something; from above: where it stops"

    def aimed(self, scene: Scene) -> Scene:
        self._scene = scene
        return scene

    def _off(self, run: SceneRun) -> tuple[float, float]:
        """The distance in m of a landing beyond its mark, or from above away from it; and that of the whole shot."""
        shot, mark = Shot(run.scene, run), self.mark or (0.0, 0.0)
        (x0, y0), (_, x, y) = run.state(shot.ball, 0.0)[:2], _landing(shot)
        return (x - mark[0], abs(x - x0)) if shot.upright else (dist((x, y), mark), dist((x, y), (x0, y0)))

    def decided_at(self, run: SceneRun) -> float:
        return _landing(Shot(run.scene, run))[0]

    def would_score(self, run: SceneRun) -> bool:
        off, way = self._off(run)
        return abs(off) <= _GOOD * way

    def call(self, run: SceneRun) -> tuple[str, bool]:
        good = self.would_score(run)
        return "On the mark" if good else "Off the mark", good

    def record(self, run: SceneRun) -> None:
        shot, (off, _) = Shot(run.scene, run), self._off(run)
        self.good, self.landed, self.fresh = self.would_score(run), _landing(shot)[1:], False
        if shot.upright and self.mark is not None:
            self.mark = self.mark[0], self.landed[1]  # on the ground, as far as it was
        self.errors.append(abs(off))
        way = "from your mark" if not shot.upright else "beyond your mark" if off > 0.0 else "short of your mark"
        self.said = f"It lands {metres(abs(off))} {way}"

    def anew(self) -> Prediction:
        return Prediction(self._scene)

    @property
    def over(self) -> bool:
        return False

    @property
    def entries(self) -> Entries:
        if not self.errors:
            return [("predictions", "0")]
        mean = sum(self.errors) / len(self.errors)
        return [("predictions", str(len(self.errors))), ("off by", metres(self.errors[-1])),
                ("mean", metres(mean)), ("best", metres(min(self.errors)))]  # fmt: skip

    @property
    def table(self) -> Entries:
        first = max(0, len(self.errors) - _SHOWN)
        return [(f"prediction {number}", metres(error)) for number, error in enumerate(self.errors, 1)][first:]


def _landing(shot: Shot) -> tuple[float, float, float]:
    """The time in s and the place in m at which a shot lands: from the side where the ball first touches something,
    from above where it stops or is caught."""
    run, ball = shot.run, shot.ball
    t = first_impact(run, ball) if shot.upright else run.caught_at(ball)
    t = run.duration if t is None else t
    x, y = run.state(ball, t)[:2]
    return float(t), float(x), float(y)
