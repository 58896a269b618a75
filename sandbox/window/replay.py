"""A shot in a file: its parameters and the run as recorded. JSON: read back exactly, checked, never executed."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from sandbox.errors import RequestError, RunError
from sandbox.files import reason, written_whole
from sandbox.scene import load, simulate
from sandbox.window.recorded import plain, run_of
from sandbox.window.session import Session, Shot

FORMAT, VERSION = "sandbox replay", 2
SUFFIX = ".replay.json"


def save(shot: Shot, source: str, path: Path) -> None:
    """Write a shot; ``source`` is what its scene was loaded by."""
    body = {
        "scene": source,
        "changes": shot.changes,
        "parameters": shot.scene.parameters.model_dump(mode="json"),
        "run": _plain(plain(shot.run)),
    }
    record = {"format": FORMAT, "version": VERSION, "check": _sum(body), "body": body}
    try:
        with written_whole(path) as file:
            json.dump(record, file)
    except OSError as error:
        raise RunError(f"{path}: cannot be written: {reason(error)}") from None


def _plain(values: dict[str, Any]) -> Any:
    """As JSON gives it back."""
    return json.loads(json.dumps(values, default=str))


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
        shot = Shot(scene, run_of(scene, body["run"]), dict(body["changes"]))
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise RequestError(f"{path}: damaged: {type(error).__name__} {error}") from None
    session.shots.append(shot)
    return session, shot


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
