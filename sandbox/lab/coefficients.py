"""Drag and lift coefficients of a scene's ball by every model it may have: over Reynolds number and spin ratio."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.report import Chart, Column, Panel, Report, Table, words
from sandbox.parameters import choices_of, value_at, walk
from sandbox.scene import Scene
from sandbox.sport.air import Air
from sandbox.sport.flight import Sphere

#: Models that show nothing: no force, and one value that stands in the file.
_FLAT = ("none", "constant")
#: Speeds over the full pull's at which drag is given, and spin ratios at which lift is.
_SPEEDS = (0.2, 0.4, 0.6, 0.8, 1.0)
_RATIOS = (0.05, 0.1, 0.2, 0.3, 0.5)
_POINTS = 400  # of a curve


@dataclass(frozen=True)
class Curves:
    """One coefficient by each of its models: ``values`` has a row for each model, as long as ``at``."""

    name: str  # "drag" or "lift"
    over: str  # "reynolds" or "spin_ratio"
    at: list[float]
    fixed: float  # the other of the two
    models: dict[str, list[float]]
    chosen: str  # the model that the scene has


def coefficients(scene: Scene, points: int | None = None) -> tuple[Curves, Curves]:
    """Cd over the Reynolds number at no spin, and Cl over the spin ratio at the Reynolds number of the launch.

    At a few round points, or at so many. Raises RequestError for a scene without a ball that flies.
    """
    ball, air = value_at(scene.parameters, "ball"), value_at(scene.parameters, "air")
    if not isinstance(ball, Sphere) or not isinstance(air, Air) or not air.air.density:
        raise RequestError(f"{scene.name}: no ball in it flies through air, so it has no coefficients")
    fastest = float(scene.controls.full_pull_speed)
    here = _reynolds(ball, air, value_at(scene.parameters, "launch.speed") or fastest)
    shares = _SPEEDS if points is None else np.linspace(0.02, 1.2, points)
    ratios = _RATIOS if points is None else np.linspace(0.0, max(_RATIOS), points)
    numbers = [_reynolds(ball, air, float(share) * fastest) for share in shares]
    return (
        _curves(scene, "drag", "reynolds", numbers, 0.0),
        _curves(scene, "lift", "spin_ratio", [float(ratio) for ratio in ratios], here),
    )


def _reynolds(ball: Sphere, air: Air, speed: float) -> float:
    """``rho v 2 r / mu`` at a speed in m/s."""
    return air.air.density * speed * 2.0 * ball.radius / air.viscosity


def _curves(scene: Scene, name: str, over: str, at: Sequence[float], fixed: float) -> Curves:
    key = f"ball.{name}.model"
    chosen = next(each for each in walk(scene.parameters) if each.key == key)
    found = {}
    for word in choices_of(scene.parameters, key):
        ball = value_at(scene.changed({key: word}).parameters, "ball")
        law = getattr(ball, name).coefficient_in(value_at(scene.parameters, "air").air, ball)
        if law is None or (word in _FLAT and word != chosen.value):
            continue
        pairs = [(x, fixed) if over == "reynolds" else (fixed, x) for x in at]
        found[word] = [float(law(*pair)) for pair in pairs]
    return Curves(name, over, list(at), fixed, found, str(chosen.value))


def report_of(scene: Scene) -> Report:
    """A table of each coefficient at round points, the scene's model marked, and both as curves.

    Raises RequestError for a scene without a ball that flies.
    """
    found = coefficients(scene)
    chart = Chart(
        [_panel(one) for one in coefficients(scene, _POINTS)],
        title=f"{scene.name}: drag and lift coefficients",
        about="Each line is a model that the scene file may name; the thick one is the scene's.",
        height=3.4,
    )
    return Report(
        lambda: {one.name: one for one in found},
        f"{scene.title}: drag and lift coefficients",
        [*map(_table, found), chart],
    )


def _table(one: Curves) -> Table:
    drag = one.name == "drag"
    title = "Cd by Reynolds number, no spin" if drag else f"Cl by spin ratio r w / v, Re {one.fixed:.2g}"
    columns = [words(), *(Column(f"{x:.2g}", write="{:.3f}".format) for x in one.at), words()]
    rows = [(word, *row, "the scene's" if word == one.chosen else "") for word, row in one.models.items()]
    return Table(columns, rows, title)


def _panel(one: Curves) -> Panel:
    def curves(axes: Any, colours: Mapping[str, Any]) -> None:
        for word, values in one.models.items():
            axes.plot(one.at, values, label=word, linewidth=3.2 if word == one.chosen else 1.6)
        axes.set_ylim(bottom=0.0)
        axes.grid(visible=True)

    drag = one.name == "drag"
    x = "Reynolds number, without spin" if drag else f"spin ratio r w / v, at Re = {one.fixed:.2g}"
    return Panel(curves, x, f"{one.name} coefficient")
