"""Converts a run to numbers, words and lists, and back: for replay files, and between processes."""

from __future__ import annotations

from dataclasses import asdict
from math import isfinite
from typing import Any

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.arc import Arc
from sandbox.engine.lasting import LastingContact
from sandbox.engine.one_point import OnePoint
from sandbox.engine.path import Path
from sandbox.engine.run import Event, Numerics, Run
from sandbox.engine.setup import Ball, Body, Setup
from sandbox.engine.touch import Obstacle, Touching
from sandbox.scene import Scene


def data_of(run: Run) -> dict[str, Any]:
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


def run_of(scene: Scene, record: dict[str, Any]) -> Run:
    """The run of a scene. Raises KeyError, TypeError, ValueError or IndexError if the record is not one of it."""
    setup = scene.build()
    balls = {ball.name: ball for ball in setup.balls}
    if record["arcs"].keys() != balls.keys() or not all(record["arcs"].values()) or not _is_time(record["duration"]):
        raise ValueError("not all balls have a path")
    arcs = {name: Path([_arc(item, setup, balls[name]) for item in items]) for name, items in record["arcs"].items()}
    return Run(
        setup,
        Accuracy(**record["accuracy"]),
        arcs,
        [Event(*item) for item in record["events"]],
        Numerics(**record["numerics"]),
        record["duration"],
        record["ended"],
        record["result"],
        scene,
    )


def _arc_data(arc: Arc, places: dict[int, int]) -> tuple[Any, ...]:
    contact = None
    if isinstance(arc.contact, LastingContact):
        mode, obstacle, touching, direction, spin_rate = arc.contact
        contact = mode, places[id(obstacle.surface)], tuple(touching), direction, spin_rate
    return arc.t0, arc.t1, arc.start, arc.curves, contact, arc.end


def _arc(item: Any, setup: Setup, ball: Ball) -> Arc:
    t0, t1, start, curves, contact, end = item
    numbers = [start, *curves, *([] if end is None else [end])]
    if not all(map(_is_time, (t0, t1))) or not all(_is_number(part) for curve in numbers for part in curve):
        raise ValueError("a path contains something that is not a number")
    if contact is not None:
        mode, place, (gap, nx, ny, curvature, center, feature), direction, spin_rate = contact
        touching = Touching(gap, nx, ny, curvature, tuple(center), feature)
        kind = OnePoint if isinstance(ball, Body) else LastingContact
        contact = kind(mode, Obstacle(setup.surfaces[place], ball.radius), touching, direction, spin_rate)
    last = None if end is None else tuple(end)
    return Arc(t0, t1, tuple(start), tuple(map(tuple, curves)), contact, last)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


def _is_time(value: Any) -> bool:
    return _is_number(value) and value >= 0.0
