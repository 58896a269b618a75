"""Scenes, plans and files that tests of sweeps share."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

from sandbox.lab.axes import parse_axis
from sandbox.lab.plan import Plan
from sandbox.lab.sweep import SweepSummary, sweep_to_file, workers
from sandbox.scene import Scene
from tests.own_scene import BUILD, DROP, change, copy_of


def own_scene(folder: Path, in_build: str) -> Path:
    """A copy of drop that does something more in ``build``."""
    scene = copy_of(DROP, folder / "drop")
    change(scene / "scene.py", BUILD, BUILD + in_build)
    return scene


def grid(scene: Scene, *texts: str, **more: Any) -> Plan:
    return Plan(scene, tuple(parse_axis(scene, "--over", text) for text in texts), **more)


def table(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def swept(plan: Plan, path: Path) -> SweepSummary:
    with workers(1) as pool:
        return sweep_to_file(plan, path, pool)


def whole(plan: Plan, path: Path) -> bytes:
    swept(plan, path)
    assert not path.with_name(path.name + ".resume").exists()
    return path.read_bytes()
