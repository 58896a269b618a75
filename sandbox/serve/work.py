"""Computing for the server in other processes: scenes are loaded, run and drawn there.

Each function returns a ``Reply`` of Python's own types only, so that nothing of a scene's comes into the server's
process when it is read; an error is a line in it.
"""

from __future__ import annotations

import hashlib
import io
import json
import signal
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache, wraps
from typing import Any, ParamSpec

import numpy as np

from sandbox.errors import RunError, SandboxError
from sandbox.files import json_ready
from sandbox.page.parts import css
from sandbox.page.playing import event_rows, force_data, path_data, path_until, place_data, stage_data, story_data
from sandbox.parameters import Parameter, walk
from sandbox.picture.energy_chart import bands_of, held_at_the_end
from sandbox.picture.frames import to_image
from sandbox.picture.marks import lighter
from sandbox.picture.path import simplify
from sandbox.picture.sheet import CARD, drawn_at
from sandbox.picture.view import View
from sandbox.scene import Scene, load, simulate
from sandbox.scene.scene_run import SceneRun
from sandbox.serve import sessions
from sandbox.serve.calls import Ask, Duel, Game, Kind, Reply
from sandbox.serve.layout import Layout, layout_of
from sandbox.serve.limits import FAN, MEMORY, PATH, RESULT
from sandbox.sport.amounts import shown_in
from sandbox.tasks.sports import TILE
from sandbox.text import encodable, title_of
from sandbox.tracebacks import one_line_error
from sandbox.window.aim import PUSH, Speeds, pull_speeds
from sandbox.window.fan import fan_of
from sandbox.window.panel import Setting
from sandbox.window.shots import Shot, scene_without_controls

#: Runs are sent with so many digits after the point: paths to 1 um.
_DIGITS = 6
#: A pull has the speeds at so many shares of it.
_PULLS = 101
#: A line of a shot that others see has points to 1 cm, drawn for a picture of so many px.
_LINE_DIGITS, _LINE_PIXELS = 2, 900
#: A parameter that would make a run slow without a player seeing more of it.
_KEPT = ("accuracy.",)

#: How much larger letters and lines are on a small picture.
_SMALL_DENSITY = 1.6
Contest = sessions.InTask | sessions.InMatch | None
_STANDING = {sessions.InTask: "task", sessions.InMatch: "match"}

_Arguments = ParamSpec("_Arguments")


def _replying(work: Callable[_Arguments, Reply]) -> Callable[_Arguments, Reply]:
    """Return the function with errors caught: an exception becomes the error in the reply, in a line."""

    @wraps(work)
    def safe(*args: _Arguments.args, **named: _Arguments.kwargs) -> Reply:
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


@contextmanager
def _limited(seconds: float) -> Iterator[None]:
    """End what takes more processor time, where the system can. Raises RunError."""
    over = False

    def end(*_: object) -> None:
        nonlocal over
        over = True
        raise TimeoutError

    if not hasattr(signal, "SIGPROF"):
        yield
        return
    signal.signal(signal.SIGPROF, end)
    signal.setitimer(signal.ITIMER_PROF, seconds, 0.1)  # again, where pymunk's callbacks swallow it
    try:
        yield
    except Exception:  # an error of a force is another one by now
        if not over:
            raise
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    if over:
        raise RunError(f"this path takes more than {seconds:g} s to compute: let go to see the shot")


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


def _packed(kind: str, **data: Any) -> bytes:
    """A message for the browser: JSON, deflated; a run with its numbers to so many DIGITS."""
    ready = {key: json_ready(value, _DIGITS if key == "run" else None) for key, value in data.items()}
    text = json.dumps({"is": kind, **ready}, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    return zlib.compress(encodable(text).encode(), 1)


# ---------------------------------------------------------------------------------------------------------------------
# What a scene is
# ---------------------------------------------------------------------------------------------------------------------


@_replying
def described(source: str, is_task: bool, duel: Duel | None = None) -> Reply:
    """A scene, a task or the next shot of a match for the browser: its parameters with their bounds, what a pull does,
    the results to predict."""
    task = sessions.task_of(source) if is_task else None
    match = sessions.InMatch(Ask(source, {}, 0), duel) if duel is not None else None
    if task is not None:
        scene, limits = task.scene.changed(task.defaults), {it.key: (it.low, it.high) for it in task.controls}
    elif match is not None:
        scene, limits = match.contest.scene, dict(match.contest.limits)
    else:
        scene, limits = _scene(source), {}
    controls, known = scene.controls, {p.key: p for p in walk(scene.parameters, entries=True)}
    if limits:
        chosen = {key: known[key]._replace(low=low, high=high) for key, (low, high) in limits.items()}
    else:
        chosen = {key: p for key, p in known.items() if _may_change(p) or key in controls.set_on_pull}
    settings = [_setting(p, (*controls.sliders, *limits)) for p in chosen.values()]
    order = {key: place for place, key in enumerate(controls.sliders)}
    settings.sort(key=lambda each: order.get(each["key"].partition("[")[0], len(order)))
    facts = [fact for fact in scene.facts.values() if fact.label and fact.unit and not fact.names]
    kept: dict[str, Any] = {
        "title": title_of(source) if task is not None else scene.title,
        "about": task.goal if task is not None else scene.about,
        "parameters": settings,
        "pull": _pull(scene, chosen, bool(limits)),
        "facts": [{"key": fact.key, "label": fact.label, "unit": fact.unit} for fact in facts],
        "held": ", ".join(held.name for held in controls.held),
        "task": sessions.task_document(task) if task is not None else None,
        "match": None,
        "place": None,
    }
    if match is not None:
        rules = match.contest.match
        kept |= {"title": rules.title, "about": rules.goal, "match": match.standing, "facts": []}
        kept["place"] = list(rules.free[:2]) if len(rules.free) >= 2 else None  # along x and y
    return {"kept": kept}


def _may_change(parameter: Parameter) -> bool:
    """True for numbers, words to choose from and switches that a player may change."""
    number = parameter.unit is not None and isinstance(parameter.value, float)
    switch = isinstance(parameter.value, bool)
    words = len(parameter.choices) > 1 and parameter.value is not None
    return (number or switch or words) and (not parameter.key.startswith(_KEPT) or parameter.key == "accuracy.level")


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


def _pull(scene: Scene, chosen: Mapping[str, Parameter], limited: bool) -> dict[str, Any] | None:
    """Return the effect of a pull: the speed at each share of a full pull, and the steps of keys; None without speed or
    angle."""
    controls = scene.controls
    speed, angle = chosen.get(controls.speed), chosen.get(controls.angle)
    if speed is None or angle is None:
        return None
    speeds: Speeds = pull_speeds(controls, scene.parameters, speed, speed.value)
    return {
        "speed": controls.speed,
        "angle": controls.angle,
        "sets": {} if limited else dict(controls.set_on_pull),
        "speeds": [float(f"{speeds.at(share):.4g}") for share in np.linspace(0.0, 1.0, _PULLS).tolist()],
        "push": float(f"{PUSH * speeds.highest:.1g}"),
        "spins": [{"key": spin.key, "step": spin.step} for spin in controls.spins],
    }


# ---------------------------------------------------------------------------------------------------------------------
# Runs
# ---------------------------------------------------------------------------------------------------------------------


@contextmanager
def _drawing(ask: Ask) -> Iterator[Layout]:
    """Draw in the units and for the page of a player: the layout of his picture."""
    scene = sessions.task_of(ask.source).scene if isinstance(ask.game, Game) else _scene(ask.source)
    layout = layout_of(scene, ask.room)
    with shown_in(ask.units), drawn_at(layout.density, bare=True):
        yield layout


@_replying
def path(ask: Ask) -> Reply:
    """The run while a player aims: its paths, verdict and numbers; as much of it as a task or a game shows."""
    with _drawing(ask) as layout:
        scene, run, view, contest = _flown(ask, layout)
        until = sessions.shown_until(contest, run, view.ball)
        data = _run_data(scene, run, view) if until is None else _start(scene, run, view, until)
        return {"message": _packed("path", n=ask.n, run=data | _standing(contest))}


@_replying
def _hidden(ask: Ask) -> Reply:
    """The run as far as a player knows it who is to predict it: where the balls begin."""
    with _drawing(ask) as layout:
        scene, run, view, contest = _flown(ask, layout)
        return {"message": _packed("path", n=ask.n, run=_start(scene, run, view, 0.0) | _standing(contest))}


@_replying
def shot(ask: Ask) -> Reply:
    """The run that a player let go: with forces, events and energy, and what the others see of it."""
    with _drawing(ask) as layout:
        contest = sessions.contest_of(ask)
        scene = _scene(ask.source).changed(ask.changes, "") if contest is None else contest.aimed()
        run = simulate(scene)
        view = scene.picture(run, layout.size)
        verdict, good = (scene.verdict(run), Shot(scene, run).scored) if contest is None else contest.call(run)
        outcome = {}
        if isinstance(contest, sessions.InMatch):
            outcome = {fact: run.result[fact] for fact in contest.contest.match.facts}
        if contest is not None:
            contest.record(run)
        standing = _standing(contest)
        more = {**story_data(view), "event_rows": [], "energy": None, "verdict": verdict, "good": good, **standing}
        if contest is None:  # in a task or a match nobody sees them, and they take half of the time
            more |= {**force_data(view, run), "event_rows": event_rows(run), "energy": _energy(run)}
        numbers = {key: run.result[key] for key, fact in scene.facts.items() if fact.label and fact.unit}
        kept = {
            "verdict": verdict,
            "scored": good,
            "facts": {key: value for key, value in numbers.items() if isinstance(value, int | float)},
            "line": _line(view, run.trajectory(view.ball)[:, 1:3], _LINE_PIXELS),
            **standing,
        }
        message = _packed("shot", n=ask.n, run=_run_data(scene, run, view) | more)
        return {"message": message, "kept": json_ready(kept, _DIGITS) | {"outcome": json_ready(outcome)}}


@_replying
def small(ask: Ask) -> Reply:
    """A small picture of a shot: its whole path on its place, as a WebP file."""
    with shown_in(ask.units), drawn_at(_SMALL_DENSITY, bare=True):
        contest = sessions.contest_of(ask)
        scene = _scene(ask.source).changed(ask.changes, "") if contest is None else contest.aimed()
        view = scene.picture(simulate(scene), (2 * TILE[0], 2 * TILE[1]))
        for _ in view.layers():
            pass
        out = io.BytesIO()
        to_image(view.sheet.surface).reduce(2).save(out, "WEBP", quality=80, method=0)
        return {"message": out.getvalue()}


@_replying
def _stage(ask: Ask) -> Reply:
    """The place without the run, as it is seen from where the whole run is in sight; where the run is hidden, that of
    the scene's own shot."""
    with _drawing(ask) as layout:
        contest = sessions.contest_of(ask)
        if contest is not None and contest.path_shown != "all":
            ask = ask._replace(changes={})
        scene, _, view, _ = _flown(ask, layout)
        seen = stage_data(view, layout.turned)
        data = place_data(view) | {"view": seen, "room": ask.room, "place": _place(scene), "dark": view.on_dark}
        others = [(lighter(colour) if view.on_dark else colour, lighter(colour)) for colour in view.OTHER_TRACES]
        data["others"] = [tuple(map(css, both)) for both in others]  # on the picture and on the card
        data["good"] = css(CARD["good"])
        return {"message": _packed("stage", n=ask.n, stage=data)}


@_replying
def _fan(ask: Ask) -> Reply:
    """Similar shots as a player would play them, and how many of them score."""
    with _drawing(ask) as layout:
        contest = sessions.contest_of(ask)
        if contest is not None and contest.path_shown != "all":
            return {"message": _packed("fan", n=ask.n, said="no similar shots: the whole path is not shown here")}
        scene, _, view, _ = _flown(ask, layout)
        found = fan_of(scene, FAN)
        if found is None:
            said = "no fan: this shot does not start from the player's controls"
            return {"message": _packed("fan", n=ask.n, said=said)}
        lines = [[bool(shot.scored), _line(view, shot.path, _LINE_PIXELS)] for shot in found.shots]
        bars = found.bars._asdict() if found.bars is not None else None
        return {"message": _packed("fan", n=ask.n, said=found.said, by=found.by, lines=lines, bars=bars)}


def _flown(ask: Ask, layout: Layout) -> tuple[Scene, SceneRun, View[Any], Contest]:
    """The scene with its changes, its run, the run's picture, and what the player is in the middle of."""
    contest = sessions.contest_of(ask)
    scene = _scene(ask.source).changed(ask.changes, "") if contest is None else contest.scene()
    with _limited(PATH):
        run = simulate(scene)
    return scene, run, scene.picture(run, layout.size), contest


def _standing(contest: Contest) -> dict[str, Any]:
    """Return the player's standing in a task or a match, as a part of a message."""
    return {} if contest is None else {_STANDING[type(contest)]: contest.standing}


def _start(scene: Scene, run: SceneRun, view: View[Any], until: float) -> dict[str, Any]:
    """A run until a time in s, without what it comes to."""
    data = path_data(view, run)
    for ball in data["balls"]:
        ball |= {"path": path_until(run.arcs[ball["name"]], until), "rolls": False}
        ball |= dict.fromkeys(("turned", "caught", "fall"))
    data |= {"events": [], "duration": until, "told": until, "verdict": "", "rows": [], "scored": None}
    return data | {"place": _place(scene), "hidden": True}


def _run_data(scene: Scene, run: SceneRun, view: View[Any]) -> dict[str, Any]:
    """Return the part of a run that the page always shows."""
    return {
        **path_data(view, run),
        "verdict": scene.verdict(run),
        "rows": scene.rows(run),
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
    digits = max(_LINE_DIGITS, int(np.ceil(np.log10(scale))) + 1)
    return [round(value, digits) for value in thinned.ravel().tolist()]


def _energy(run: SceneRun) -> dict[str, Any] | None:
    """The energy over time by cause, in J: bands between ``foot`` and ``top``; None where there is none to show."""
    try:
        course = held_at_the_end(run)
        bands, put_in = bands_of(course)
    except (SandboxError, ValueError, ArithmeticError):
        return None
    curves = [{"name": band.name, "colour": css(band.colour), "top": _short(band.values), "foot": _short(band.foot)}
             for band in [*bands, *put_in]]  # fmt: skip
    return {"times": _short(course.times), "end": run.duration, "bands": curves} if curves else None


def _short(values: np.ndarray | None) -> list[float]:
    """Numbers to five figures."""
    return [] if values is None else [float(f"{value:.5g}") for value in values.tolist()]


@_replying
def warmed(sources: Sequence[str]) -> Reply:
    """Import what is needed, and run each scene once: the first player does not wait for that."""
    for source in sources:
        scene = _scene(source)
        run = simulate(scene)
        path_data(scene.picture(run), run)
    return {"kept": {}}


#: What may be asked for.
WORKS: dict[Kind, Callable[[Ask], Reply]] = {
    "path": path,
    "hidden": _hidden,
    "stage": _stage,
    "fan": _fan,
    "shot": shot,
}
