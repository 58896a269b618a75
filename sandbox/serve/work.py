"""What the server has computed in other processes: scenes are loaded, run and drawn there.

Each function returns a ``Reply`` of Python's own types only, so that nothing of a scene's comes into the server's
process when it is read; an error is a line in it.
"""

from __future__ import annotations

import hashlib
import json
import zlib
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache, wraps
from math import isfinite
from typing import Any, ParamSpec

import numpy as np

from sandbox.errors import RunError, SandboxError
from sandbox.page.parts import css
from sandbox.page.playing import MOST_EVENTS, force_data, path_data, place_data, stage_data
from sandbox.page.replay import LAYOUTS
from sandbox.parameters import Parameter, walk
from sandbox.picture.energy_chart import bands_of, held_at_the_end
from sandbox.picture.path import simplify
from sandbox.picture.sheet import CARD, DENSITY
from sandbox.picture.view import View
from sandbox.scene import Scene, load, simulate
from sandbox.scene.scene_run import SceneRun
from sandbox.serve.calls import Changes, Kind, Reply
from sandbox.serve.limits import FAN, MEMORY, RESULT
from sandbox.sport.amounts import shown_in
from sandbox.sport.readings import words_of
from sandbox.tracebacks import one_line_error
from sandbox.window.aim import PUSH, Speeds, pull_speeds
from sandbox.window.fan import fan_of
from sandbox.window.panel import Setting
from sandbox.window.shots import Shot, scene_without_controls

#: Paths are sent in steps of this many digits after the point: to 1 um.
DIGITS = 6
#: A pull has the speeds at so many shares of it.
PULLS = 101
#: A line of a shot that others see has points to 1 cm, drawn for a picture of so many px.
LINE_DIGITS, LINE_PIXELS = 2, 900
#: A parameter that would make a run slow without a player seeing more of it.
KEPT = ("accuracy.",)

Arguments = ParamSpec("Arguments")


def replying(work: Callable[Arguments, Reply]) -> Callable[Arguments, Reply]:
    """What is raised becomes the error in the reply, in a line."""

    @wraps(work)
    def safe(*args: Arguments.args, **named: Arguments.kwargs) -> Reply:
        _limit_memory()
        try:
            reply = work(*args, **named)
            if len(reply.get("message", b"")) > RESULT:
                raise RunError(f"this run is too large to be sent: over {RESULT // 1000:,} kB")
            return reply
        except SandboxError as error:
            return {"error": str(error)}
        except MemoryError:
            return {"error": f"this run needs more than {MEMORY >> 30} GB of memory, and was ended"}
        except BaseException as error:  # of a scene's own code
            return {"error": one_line_error(error)}

    return safe


@lru_cache(maxsize=1)
def _limit_memory() -> None:
    """Bound this process's memory, where the system can."""
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
    except (ImportError, ValueError, OSError):
        pass


@lru_cache(maxsize=256)
def _scene(source: str) -> Scene:
    return load(source)


def packed(kind: str, **data: Any) -> bytes:
    """A message for the browser: JSON, deflated."""
    text = json.dumps({"is": kind, **rounded(data)}, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    return zlib.compress(text.encode(), 1)


def rounded(value: Any, digits: int = DIGITS) -> Any:
    """The same as JSON's types, numbers to so many digits after the point; NaN and infinities become null."""
    if isinstance(value, float):
        return round(value, digits) if isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): rounded(item, digits) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(item, digits) for item in value]
    return rounded(value.tolist(), digits) if hasattr(value, "tolist") else value


# ---------------------------------------------------------------------------------------------------------------------
# What a scene is
# ---------------------------------------------------------------------------------------------------------------------


@replying
def described(source: str) -> Reply:
    """A scene for the browser: its parameters with their bounds, what a pull does, the results it can predict."""
    scene = _scene(source)
    controls, known = scene.controls, {p.key: p for p in walk(scene.parameters, entries=True)}
    shown = [_setting(p, controls.sliders) for p in known.values() if _may_change(p)]
    shown += [_setting(known[key], ()) for key in controls.set_on_pull if key in known and key not in
              {each["key"] for each in shown}]  # fmt: skip
    order = {key: place for place, key in enumerate(controls.sliders)}
    shown.sort(key=lambda each: order.get(each["key"].partition("[")[0], len(order)))
    facts = [fact for fact in scene.facts.values() if fact.label and fact.unit and not fact.names]
    return {
        "kept": {
            "title": scene.title,
            "about": scene.about,
            "parameters": shown,
            "pull": _pull(scene),
            "facts": [{"key": fact.key, "label": fact.label, "unit": fact.unit} for fact in facts],
            "held": ", ".join(held.name for held in controls.held),
        }
    }


def _may_change(parameter: Parameter) -> bool:
    """True for numbers, words to choose from and switches that a player may change."""
    number = parameter.unit is not None and isinstance(parameter.value, float)
    switch = isinstance(parameter.value, bool)
    words = len(parameter.choices) > 1 and parameter.value is not None
    return (number or switch or words) and (not parameter.key.startswith(KEPT) or parameter.key == "accuracy.level")


def _setting(parameter: Parameter, sliders: Sequence[str]) -> dict[str, Any]:
    """One parameter as the page shows it; ``choices`` are None for a number."""
    setting = Setting(parameter.key, parameter, parameter.value)
    first = parameter.key in sliders or parameter.key.partition("[")[0] in sliders
    return {
        "key": parameter.key,
        "value": parameter.value,
        "unit": parameter.unit or "",
        "low": parameter.low,
        "high": parameter.high,
        "span": setting.span,
        "choices": None if setting.is_number else list(setting.words),
        "meaning": parameter.meaning,
        "first": first,
    }


def _pull(scene: Scene) -> dict[str, Any] | None:
    """What a pull sets: the speed at each share of a full pull, and what a key changes; None without speed or angle."""
    controls = scene.controls
    speed, angle = ({p.key: p for p in walk(scene.parameters)}.get(key) for key in (controls.speed, controls.angle))
    if speed is None or angle is None:
        return None
    speeds: Speeds = pull_speeds(controls, scene.parameters, speed, speed.value)
    return {
        "speed": controls.speed,
        "angle": controls.angle,
        "sets": dict(controls.set_on_pull),
        "speeds": [float(f"{speeds.at(share):.4g}") for share in np.linspace(0.0, 1.0, PULLS).tolist()],
        "push": float(f"{PUSH * speeds.highest:.1g}"),
        "spins": [{"key": spin.key, "step": spin.step} for spin in controls.spins],
    }


# ---------------------------------------------------------------------------------------------------------------------
# Runs
# ---------------------------------------------------------------------------------------------------------------------


@replying
def path(source: str, changes: Changes, n: int, narrow: bool, units: str) -> Reply:
    """The run while a player aims: its paths, verdict and numbers."""
    with shown_in(units):
        scene, run, view = _flown(source, changes, narrow)
        return {"message": packed("path", n=n, run=_run_data(scene, run, view))}


@replying
def hidden(source: str, changes: Changes, n: int, narrow: bool, units: str) -> Reply:
    """The run as far as a player knows it who is to predict it: where the balls begin."""
    with shown_in(units):
        scene, run, view = _flown(source, changes, narrow)
        data = path_data(view, run)
        for ball in data["balls"]:
            x, y, *_, spin = run.state(ball["name"], 0.0)
            ball |= {
                "path": {"arcs": [[[0.0, 0.0], [x], [y], [spin], 0]], "until": 0.0},
                "turned": None,
                "rolls": False,
            }
            ball["caught"] = None
        data |= {"events": [], "duration": 0.0, "told": 0.0, "verdict": "", "rows": [], "scored": False}
        return {"message": packed("path", n=n, run=data | {"place": _place(scene), "hidden": True})}


@replying
def shot(source: str, changes: Changes, n: int, narrow: bool, units: str) -> Reply:
    """The run that a player let go: with forces, events and energy, and what the others see of it."""
    with shown_in(units):
        scene, run, view = _flown(source, changes, narrow)
        several = len(run.setup.balls) > 1
        more = {
            **force_data(view, run),
            "told_events": [list(words_of(run, event, several)) for event in run.events[:MOST_EVENTS]],
            "energy": _energy(run),
        }
        numbers = {key: run.result[key] for key, fact in scene.facts.items() if fact.label and fact.unit}
        kept = {
            "verdict": scene.verdict(run),
            "scored": Shot(scene, run).scored,
            "facts": {key: value for key, value in numbers.items() if isinstance(value, int | float)},
            "line": _line(view, run.trajectory(view.ball)[:, 1:3], LINE_PIXELS),
        }
        return {"message": packed("shot", n=n, run=_run_data(scene, run, view) | more), "kept": rounded(kept)}


@replying
def stage(source: str, changes: Changes, n: int, narrow: bool, units: str) -> Reply:
    """The place without the run, as it is seen from where the whole run is in sight."""
    with shown_in(units):
        size, density = LAYOUTS[narrow]
        token = DENSITY.set(density)
        try:
            scene, _, view = _flown(source, changes, narrow, size)
            data = place_data(view) | {"view": stage_data(view), "place": _place(scene), "dark": view.on_dark}
            data["others"] = [[css(colour), css(CARD["text"])] for colour in view.OTHER_TRACES]
            data["good"] = css(CARD["good"])
        finally:
            DENSITY.reset(token)
        return {"message": packed("stage", n=n, stage=data)}


@replying
def fan(source: str, changes: Changes, n: int, narrow: bool, units: str) -> Reply:
    """Similar shots as a player would play them, and how many of them score."""
    with shown_in(units):
        scene = _scene(source).changed(changes, "")
        found = fan_of(scene, FAN)
        if found is None:
            return {"message": packed("fan", n=n, said="no fan: this shot does not start from the player's controls")}
        view = scene.picture(simulate(scene), LAYOUTS[0][0])
        lines = [[bool(shot.scored), _line(view, shot.path, LINE_PIXELS)] for shot in found.shots]
        bars = found.bars._asdict() if found.bars is not None else None
        return {"message": packed("fan", n=n, said=found.said, by=found.by, lines=lines, bars=bars)}


def _flown(
    source: str, changes: Changes, narrow: bool, size: tuple[int, int] | None = None
) -> tuple[Scene, SceneRun, View[Any]]:
    """The scene with its changes, its run and the run's picture."""
    scene = _scene(source).changed(changes, "")
    run = simulate(scene)
    return scene, run, scene.picture(run, size or LAYOUTS[narrow][0])


def _run_data(scene: Scene, run: SceneRun, view: View[Any]) -> dict[str, Any]:
    """What the page shows of every run."""
    return {
        **path_data(view, run),
        "verdict": scene.verdict(run),
        "rows": scene.rows(run),
        "scored": Shot(scene, run).scored,
        "place": _place(scene),
    }


def _place(scene: Scene) -> str:
    """A short text that is the same for shots from one place."""
    return hashlib.sha256(repr(scene_without_controls(scene)).encode()).hexdigest()[:12]


def _line(view: View[Any], points: np.ndarray, pixels: float) -> list[float]:
    """Points of a path in m, x and y one after the other: as many as a picture of so many px shows."""
    if not len(points):
        return []
    scale = pixels / max(float(np.ptp(view.points, axis=0).max()), 1e-6)
    thinned = simplify(points * scale) / scale
    digits = max(LINE_DIGITS, int(np.ceil(np.log10(scale))) + 1)
    return [round(value, digits) for value in thinned.ravel().tolist()]


def _energy(run: SceneRun) -> dict[str, Any] | None:
    """The energy over time by cause, in J: bands between ``foot`` and ``top``; None where there is none to show."""
    try:
        course = held_at_the_end(run)
        bands, put_in = bands_of(course)
    except (SandboxError, ValueError, ArithmeticError):
        return None
    shown = [{"name": band.name, "colour": css(band.colour), "top": _short(band.values), "foot": _short(band.foot)}
             for band in [*bands, *put_in]]  # fmt: skip
    return {"times": _short(course.times), "bands": shown} if shown else None


def _short(values: np.ndarray | None) -> list[float]:
    """Numbers to five figures."""
    return [] if values is None else [float(f"{value:.5g}") for value in values.tolist()]


@replying
def warmed(sources: Sequence[str]) -> Reply:
    """Import what is needed, and run each scene once: the first player does not wait for that."""
    for source in sources:
        scene = _scene(source)
        path_data(scene.picture(simulate(scene), LAYOUTS[0][0]), simulate(scene))
    return {"kept": {}}


#: What may be asked for.
WORKS: dict[Kind, Callable[[str, Changes, int, bool, str], Reply]] = {
    "path": path,
    "hidden": hidden,
    "stage": stage,
    "fan": fan,
    "shot": shot,
}
