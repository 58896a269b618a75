"""Fit: the parameters of a scene that explain a measured track.

Least squares over runs that are computed together. Times of impact are exact, so positions are smooth in the
parameters through bounces too, and differences of neighbouring runs are good derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from sandbox.errors import RequestError
from sandbox.lab.axes import Span, as_axis, checked
from sandbox.lab.fit.data import Reading, data_of, read_data, table_of
from sandbox.lab.fit.frame import parse_free
from sandbox.lab.fit.launches import Launches
from sandbox.lab.fit.measured import Measured
from sandbox.lab.fit.models import chosen_models, compare
from sandbox.lab.fit.parsing import Film, parse_scale
from sandbox.lab.fit.problem import Declared, Problem
from sandbox.lab.fit.remedy import explained
from sandbox.lab.fit.squares import FarOff, Fit, solve
from sandbox.lab.mapped import choices_of
from sandbox.lab.runs import Progress, no_progress
from sandbox.parameters import value_at, walk
from sandbox.scene import Scene, as_scene
from sandbox.text import check_mapping
from sandbox.toml import toml_value


def fit(
    scene: Scene | str | Path,
    track: Mapping[str, Sequence[Any]] | str | Path | Sequence[str | Path],
    vary: Mapping[str, tuple[Any, Any] | None],
    *,
    free: Sequence[str] = (),
    scale: str | None = None,
    origin: tuple[float, float] = (0.0, 0.0),
    fps: float | None = None,
    balls: Mapping[str, str] | None = None,
    columns: Mapping[str, str] | None = None,
    where: Mapping[str, str] | Sequence[str] = (),
    without: Sequence[str] = (),
    models: str | Mapping[str, Sequence[Any]] | None = None,
    robust: bool = False,
    strict: bool = False,
) -> Fit:
    """The values of parameters that explain a measured track, with 95 % intervals.

    ``track`` is a table, a list of them, or columns: t in s since the launch, x and y in m as in the scene, and
    optionally ball; a name may have its unit, as ``"x (cm)"``. Without t, places are compared with the nearest point of
    the path. ``vary`` gives each parameter its range, or None for its declared bounds.

    Of a film, ``free`` names what is fitted too: "time", "origin", "tilt"; ``scale`` is ``"120 px = 1 m"``, for y
    downwards; ``origin`` is the scene's, in the numbers of the table; ``fps`` goes with a column frame; ``balls`` are
    the scene's by the names in the table.

    A table of launches has ``columns``: ``{"launch.speed": "Ball Speed [mph]", "carry": "Carry [yd]"}``, or those of a
    known device ``without`` some of them; only rows for which ``where`` holds are used: ``("Club=Driver",
    "launch.angle=10:20", "Spin<4000")``. A row with a fault is left out, and listed with its reason in
    ``measured.left_out``; with ``strict`` it raises RequestError.

    Raises RequestError for an invalid request, and RunError if no run near the best values could be completed.

    >>> import sandbox
    >>> track = {"t": [0.0, 0.2, 0.4], "x": [0.0, 1.0, 2.0], "y": [2.1, 2.9, 3.3]}
    >>> list(sandbox.fit("basketball", track, {"launch.speed": (6, 9)}).values)
    ['launch.speed']
    """
    chosen = as_scene(scene)
    check_mapping("vary", vary, '{"launch.speed": (5, 15)}')
    film = Film(None if scale is None else parse_scale(scale), (float(origin[0]), float(origin[1])), fps, balls or {})
    frees = parse_free("free", [free] if isinstance(free, str) else free)
    how = Reading(film, frees, replace(choices_of(columns, where, without, strict), decided=tuple(vary)))
    if isinstance(track, Mapping):
        measured = data_of(chosen, [("", table_of(track))], how)
    else:
        paths = [track] if isinstance(track, str | Path) else track
        measured = read_data(chosen, [Path(path) for path in paths], how)
    spans = [_span(chosen, "vary", key, given) for key, given in vary.items()]
    if models is None:
        return fit_track(chosen, measured, spans, robust)
    if isinstance(models, Mapping) and len(models) != 1:
        raise RequestError('models: must name one parameter, such as {"ball.drag.model": ["constant", "none"]}')
    key, words = (models, ()) if isinstance(models, str) else next(iter(models.items()))
    return compare(Problem(chosen, measured, spans, robust), key, chosen_models(chosen, "models", key, words))


def fit_track(
    scene: Scene,
    measured: Measured,
    spans: Sequence[Span],
    robust: bool = False,
    progress: Progress = no_progress,
) -> Fit:
    """Like ``fit``, for data and ranges already read."""
    keys = [span.key for span in spans]
    twice = next((key for key in keys if keys.count(key) > 1), None)
    if twice is not None:
        raise RequestError(f"--vary {twice}: given twice")
    given = next((key for key in keys if isinstance(measured, Launches) and key in measured.given), None)
    if given is not None:
        raise RequestError(f"--vary {given}: is a column of the table; to fit it, leave that out: --without {given}")
    problem = Problem(scene, measured, spans, robust, progress)
    try:
        return solve(problem)
    except FarOff as error:
        raise explained(error, problem) from None


def parse_varied(scene: Scene, text: str) -> Span:
    """``KEY=LO:HI``, or ``KEY`` for the declared bounds. Raises RequestError."""
    key, equals, body = (part.strip() for part in text.partition("="))
    parts = body.split(":")
    if equals and len(parts) != 2:
        raise RequestError(f"--vary {text}: write it as KEY or KEY=LO:HI, for example --vary launch.speed=5:15")
    return _span(scene, "--vary", key, tuple(toml_value(part.strip()) for part in parts) if equals else None)


def _span(scene: Scene, option: str, key: str, given: Any) -> Span:
    """The range of a parameter, its declared bounds if none is given. Raises RequestError."""
    if given is None:
        known = next((one for one in walk(scene.parameters, entries=True) if one.key == key), None)
        if known is None:
            checked(scene, option, key, 0.0)  # says what is wrong with the key
        if isinstance(value_at(scene.parameters, key), str):
            raise RequestError(f"{option} {key}: only numbers can be fitted; --models compares words")
        if known is None or known.low is None or known.high is None:
            raise RequestError(f"{option} {key}: has no bounds to search in; give a range, {key}=LO:HI")
        return Declared(key, known.low, known.high)
    low, high = given
    axis = as_axis(scene, key, (low, high), option)
    if not isinstance(axis, Span):
        raise RequestError(f"{option} {key}: only numbers can be fitted")
    return axis
