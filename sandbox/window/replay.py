"""A shot in a file: its parameters and the run as recorded. JSON: read back exactly, checked, never executed."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.arc import Arc
from sandbox.engine.run import Event, Numerics, Run
from sandbox.errors import RequestError, RunError
from sandbox.files import reason, written_whole
from sandbox.scene import Scene, load, simulate
from sandbox.window.session import Session, Shot

FORMAT, VERSION = "sandbox replay", 1
SUFFIX = ".replay.json"


def save(shot: Shot, source: str, path: Path) -> None:
    """Write a shot; ``source`` is what its scene was loaded by."""
    run = shot.run
    body = {
        "scene": source,
        "changes": shot.changes,
        "parameters": shot.scene.parameters.model_dump(mode="json"),
        "accuracy": asdict(run.accuracy),
        "duration": run.duration,
        "ended": run.ended,
        "result": _plain(run.result),
        "events": [[e.t, e.kind, e.ball, e.partner, e.speed, e.x, e.y] for e in run.events],
        "arcs": {ball: [_arc(arc) for arc in arcs] for ball, arcs in run.arcs.items()},
    }
    record = {"format": FORMAT, "version": VERSION, "check": _sum(body), "body": body}
    try:
        with written_whole(path) as file:
            json.dump(record, file)
    except OSError as error:
        raise RunError(f"{path}: cannot be written: {reason(error)}") from None


def _plain(result: dict[str, Any]) -> Any:
    """As JSON gives it back."""
    return json.loads(json.dumps(result, default=str))


def _arc(arc: Arc) -> list[Any]:
    curves = (arc.x, arc.y, arc.vx, arc.vy, arc.spin)
    end = None if arc.end is None else list(arc.end)
    return [arc.t0, arc.t1, list(arc.start), *map(list, curves), [list(c) for c in arc.rolling_spin], end]


def _sum(body: dict[str, Any]) -> str:
    text = json.dumps(body, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def read(path: Path) -> tuple[Session, Shot]:
    """The shot of a file with its session. Raises RequestError where it is damaged or of another version."""
    try:
        record = json.loads(path.read_text("utf-8"))
    except OSError as error:
        raise RequestError(f"{path}: cannot be read: {reason(error)}") from None
    except (ValueError, RecursionError):
        raise RequestError(f"{path}: damaged: it is not JSON to its end") from None
    if not isinstance(record, dict) or record.get("format") != FORMAT:
        raise RequestError(f"{path}: not a replay")
    if record.get("version") != VERSION:
        raise RequestError(f"{path}: a replay of version {record.get('version')}, and this program reads {VERSION}")
    body = record.get("body")
    if not isinstance(body, dict) or _sum(body) != record.get("check"):
        raise RequestError(f"{path}: damaged: its contents are not those that were written")
    try:
        session = Session(body["scene"], body["changes"])
        scene = load(body["scene"], body["parameters"])
        shot = Shot(scene, _run(scene, body), dict(body["changes"]))
    except (KeyError, TypeError, ValueError) as error:
        raise RequestError(f"{path}: damaged: {type(error).__name__} {error}") from None
    session.shots.append(shot)
    return session, shot


def _run(scene: Scene, body: dict[str, Any]) -> Run:
    arcs = {ball: [_read_arc(item) for item in items] for ball, items in body["arcs"].items()}
    events = [Event(*item) for item in body["events"]]
    accuracy = Accuracy(**body["accuracy"])
    run = Run(scene.build(), accuracy, arcs, events, Numerics(), body["duration"], body["ended"])
    run.result = body["result"]
    return run


def _read_arc(item: list[Any]) -> Arc:
    t0, t1, start, x, y, vx, vy, spin, rolling, end = item
    more = tuple(tuple(curve) for curve in rolling)
    last = None if end is None else tuple(end)
    return Arc(t0, t1, tuple(start), tuple(x), tuple(y), tuple(vx), tuple(vy), tuple(spin), None, more, last)


def compared(shot: Shot) -> str:
    """Simulate a replayed shot again; in words, how far the two are apart."""
    again = simulate(shot.scene)
    if again.arcs.keys() != shot.run.arcs.keys():
        return "simulated again there are other balls"
    apart = 0.0
    times = [shot.run.duration * i / 500 for i in range(501)]
    for ball in again.arcs:
        for t in times:
            a, b = shot.run.state(ball, t), again.state(ball, t)
            apart = max(apart, ((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5)
    if apart == 0.0 and _plain(again.result) == _plain(shot.run.result):
        return "simulated again it is the same to the last bit"
    return f"simulated again it is up to {apart:.2g} m away"
