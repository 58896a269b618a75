"""Drag and lift coefficients of a scene's ball by every model it may have: over Reynolds number and spin ratio."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.chart import figure, legend
from sandbox.lab.tables import paragraph, table
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


def as_text(found: Sequence[Curves]) -> list[str]:
    """A table of each coefficient; the model that the scene has is marked."""
    lines = []
    for one in found:
        what, other = ("Cd by Reynolds number", "no spin") if one.name == "drag" else ("Cl by spin ratio r w / v", "")
        lines += paragraph(f"{what}, {other or f'Re {one.fixed:.2g}'}", "")
        heads = [f"{x:.2g}" for x in one.at]
        rows = [(word, *(f"{v:.3f}" for v in row), _mark(one, word)) for word, row in one.models.items()]
        lines += table(("", *heads, ""), rows, "l" + "r" * len(heads) + "l") if rows else ["  none"]
        lines.append("")
    return lines[:-1]


def _mark(one: Curves, word: str) -> str:
    return "the scene's" if word == one.chosen else ""


def as_json(found: Sequence[Curves]) -> dict[str, Any]:
    """The curves, by the name of the coefficient."""
    return {one.name: vars(one) for one in found}


def draw(scene: Scene, path: Path) -> None:
    """Both coefficients as curves, one for each model; the scene's own is drawn thicker."""
    about = "Each line is a model that the scene file may name; the thick one is the scene's."
    with figure(path, f"{scene.name}: drag and lift coefficients", about, (11.0, 4.6)) as (sheet, _):
        axes = sheet.subplots(1, 2)
        for place, one in zip(axes, coefficients(scene, _POINTS), strict=True):
            for word, values in one.models.items():
                place.plot(one.at, values, label=word, linewidth=3.2 if word == one.chosen else 1.6)
            drag = one.name == "drag"
            place.set_xlabel("Reynolds number" if drag else f"spin ratio r w / v, at Re = {one.fixed:.2g}")
            place.set_ylabel("drag coefficient, without spin" if drag else "lift coefficient")
            place.set_ylim(bottom=0.0)
            place.grid(visible=True)
            if drag:
                place.ticklabel_format(axis="x", style="sci", scilimits=(0, 0))
            if one.models:
                legend(place)
