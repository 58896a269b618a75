"""A run as numbers, words and lists, for files and between processes; and replay files, which are never executed."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, astuple
from pathlib import Path
from typing import Any

import numpy as np

# A replay restores each arc with its contact, so that it is drawn and read like the run that was recorded: the surface
# that is touched and where, the direction of the motion along it, and the spin rate. Those are types of the engine.
from sandbox.engine.contact.driven import DrivenPath, MovingObstacle
from sandbox.engine.contact.touch import Obstacle, Touching
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.motion.body_point_contact import BodyPointContact
from sandbox.engine.motion.sustained_contact import SustainedContact
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.path import Path as Arcs
from sandbox.engine.paths.phase import InCluster, InHeap, Phase
from sandbox.engine.paths.run import Event, Numerics
from sandbox.errors import RequestError, RunError
from sandbox.files import atomic_write, read_given, writing
from sandbox.scene import Scene, load
from sandbox.scene.discovery import folder_of, is_installed
from sandbox.scene.scene_run import SceneRun
from sandbox.text import shortened
from sandbox.window.session import Session
from sandbox.window.shots import Shot

_FORMAT, _VERSION = "sandbox replay", 2
#: Most bytes of a replay: that of an hour with all its arcs has less.
_LARGEST = 200_000_000
#: No number of a run is as large.
_FARTHEST = 1e15
SUFFIX = ".replay.json"


def save(shot: Shot, path: Path) -> None:
    """Write a shot."""
    body = {
        "scene": shot.changes.source,
        "changes": shot.changes.values,
        "parameters": shot.scene.parameters.model_dump(mode="json"),
        "run": _through_json(data_of(shot.run)),
    }
    record = {"format": _FORMAT, "version": _VERSION, "check": checksum(body), "body": body}
    with writing("", path), atomic_write(path) as file:
        json.dump(record, file)


def _through_json(values: dict[str, Any]) -> Any:
    """The values as JSON returns them."""
    return json.loads(json.dumps(values, default=str))


def checksum(body: dict[str, Any]) -> str:
    text = json.dumps(body, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def read(path: Path, scene: str | None = None, running: Path | None = None) -> Shot:
    """The shot of a file. Raises RequestError if it is damaged or of another version.

    A file from somebody else runs no code: its scene must be installed, or be the ``scene`` that the player names, or
    be in the folder ``running``, whose code runs already.
    """
    try:
        record = json.loads(read_given(path, _LARGEST))
    except (ValueError, RecursionError):
        raise RequestError(f"{path}: damaged: not complete JSON") from None
    if not isinstance(record, dict) or record.get("format") != _FORMAT:
        raise RequestError(f"{path}: not a replay")
    if record.get("version") != _VERSION:
        raise RequestError(f"{path}: a replay of version {record.get('version')}, but this program reads {_VERSION}")
    body = record.get("body")
    if not isinstance(body, dict) or checksum(body) != record.get("check"):
        raise RequestError(f"{path}: damaged: its contents do not match its checksum")
    if not all(isinstance(body.get(part), dict) for part in ("changes", "parameters", "run")):
        raise RequestError(f"{path}: damaged: a part of it is missing")
    try:
        source = scene if scene is not None else _allowed(str(body["scene"]), path, running)
        session = Session(source, body["changes"])
        recorded = load(source, body["parameters"])
        shot = Shot(recorded, run_of(recorded, body["run"]), session.changes, recorded=True)
        recorded.verdict(shot.run), recorded.rows(shot.run)  # which the player sees first
    except (AttributeError, KeyError, IndexError, TypeError, ValueError, OverflowError, RunError) as error:
        raise RequestError(f"{path}: damaged: {type(error).__name__} {shortened(str(error), 200)}") from None
    return shot


def _allowed(source: str, path: Path, running: Path | None) -> str:
    """A recorded scene whose code may run. Raises RequestError."""
    folder = folder_of(source)
    if folder is None or not (is_installed(folder) or folder == running):
        raise RequestError(
            f"{path}: is of {source}, which is not an installed scene; sandbox play --scene FOLDER {path} plays it "
            "with the code of the scene in FOLDER"
        )
    return source


def compared(recorded: SceneRun, again: SceneRun) -> str:
    """In words, how far apart a recorded run and the same shot, simulated again, are."""
    if again.arcs.keys() != recorded.arcs.keys():
        return "simulated again: different balls"
    times = np.linspace(0.0, recorded.duration, 501).tolist()
    later = [min(t, again.duration) for t in times]  # a run that ended before stays as it ended
    ways = [again.states(ball, later)[:, :2] - recorded.states(ball, times)[:, :2] for ball in again.arcs]
    apart = max(float(np.hypot(*way.T).max()) for way in ways)
    if apart == 0.0 and _through_json(again.result) == _through_json(recorded.result):
        return "simulated again: identical to the last bit"
    return f"simulated again: up to {apart:.2g} m apart"


# The run


def data_of(run: SceneRun) -> dict[str, Any]:
    """A run without its setup, which the scene builds again; surfaces are given by their indices in it."""
    places = {id(surface): place for place, surface in enumerate(run.setup.surfaces)}
    return {
        "accuracy": asdict(run.accuracy),
        "duration": run.duration,
        "ended": run.ended,
        "numerics": asdict(run.numerics),
        "result": run.result,
        "events": [(e.t, e.kind, e.ball, e.partner, e.speed, e.x, e.y) for e in run.events],
        "arcs": {ball: [_arc_data(arc, places) for arc in arcs] for ball, arcs in run.arcs.items()},
    }


def run_of(scene: Scene, record: dict[str, Any]) -> SceneRun:
    """The run of a scene. Raises KeyError, TypeError, ValueError or IndexError if the record is not one of it."""
    setup = scene.build()
    balls = {ball.name: ball for ball in setup.balls}
    if record["arcs"].keys() != balls.keys() or not all(record["arcs"].values()) or not _is_time(record["duration"]):
        raise ValueError("not all balls have a path")
    driven = {place: DrivenPath(each) for place, each in enumerate(setup.surfaces) if each.motion is not None}
    arcs = {
        name: Arcs([_arc(item, setup, balls[name], driven) for item in items]) for name, items in record["arcs"].items()
    }
    events = [Event(*item) for item in record["events"]]
    if record["duration"] > max(path[-1].t1 for path in arcs.values()):
        raise ValueError("no path lasts as long as the run")
    if not all(_is_number(number) for event in events for number in (event.t, event.speed, event.x, event.y)):
        raise ValueError("an event contains something that is not a number")
    if not all(isinstance(word, str) for event in events for word in (event.kind, event.ball, event.partner)):
        raise ValueError("an event contains something that is not a word")
    return SceneRun(
        setup,
        Accuracy(**record["accuracy"]),
        arcs,
        events,
        Numerics(**record["numerics"]),
        record["duration"],
        record["ended"],
        scene,
        record["result"],
    )


#: How a ball touches others along an arc, by its name in a file.
_WITH_BALLS: dict[str, type[InHeap | InCluster]] = {"Heaped": InHeap, "Pressing": InCluster}
_NAMES = {kind: name for name, kind in _WITH_BALLS.items()}


def _arc_data(arc: Arc, places: dict[int, int]) -> tuple[Any, ...]:
    contact: Any = arc.contact
    if isinstance(contact, SustainedContact):
        phase, obstacle, touching, direction, spin_rate = contact
        contact = phase.value, places[id(obstacle.surface)], tuple(touching), direction, spin_rate
    elif contact is not None:
        contact = _NAMES[type(contact)], *astuple(contact)
    return arc.t0, arc.t1, arc.start, arc.curves, contact, arc.end


def _arc(item: Any, setup: Setup, ball: Ball, driven: Mapping[int, DrivenPath]) -> Arc:
    t0, t1, start, curves, contact, end = item
    if not all(curves) or not all(len(state) == len(curves) >= 5 for state in (start, end or start)):
        raise ValueError("a path has no whole state")
    numbers = [start, *curves, *([] if end is None else [end])]
    if not all(map(_is_time, (t0, t1))) or not all(_is_number(part) for curve in numbers for part in curve):
        raise ValueError("a path contains something that is not a number")
    if contact is not None and contact[0] in _WITH_BALLS:
        kind, *moved = contact
        if not all(map(_is_number, moved)):
            raise ValueError("a contact contains something that is not a number")
        contact = _WITH_BALLS[kind](*moved)
    elif contact is not None:
        phase, place, (gap, nx, ny, curvature, center, feature), direction, spin_rate = contact
        touching = Touching(gap, nx, ny, curvature, tuple(center), feature)
        kind = BodyPointContact if ball.rotates else SustainedContact
        surface, path = setup.surfaces[place], driven.get(place)
        on = Obstacle(surface, ball.radius) if path is None else MovingObstacle(surface, path, ball.radius)
        contact = kind(Phase(phase), on, touching, direction, spin_rate)
    last = None if end is None else tuple(end)
    return Arc(t0, t1, tuple(start), tuple(map(tuple, curves)), contact, last)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _FARTHEST


def _is_time(value: Any) -> bool:
    return _is_number(value) and value >= 0.0
