"""Numbers that are assumed: each has its interval in the scene's file, and no default verdict depends on one."""

from __future__ import annotations

import re
from typing import Any

import pytest

import sandbox
from sandbox.parameters import value_at
from sandbox.scene import Scene

#: The facts of each scene that its verdict is about.
DECIDED = {
    "golf": ("ended", "holed"),
    "soccer": ("goal", "verdict"),
    "soccer-curl": ("goal", "verdict"),
    "basketball": ("made", "verdict"),
    "billiards": ("potted", "scratch"),
}
INTERVAL = re.compile(r"assumed[^;\n]*?, ([\d.]+) to ([\d.]+)")


def assumed(scene: Scene) -> dict[str, tuple[float, float]]:
    """The interval of every number of a scene's file whose comment says that it is assumed, by key."""
    table, found = "", {}
    for line in (scene.folder / f"{scene.name}.toml").read_text("utf-8").splitlines():
        if head := re.match(r"\[([\w.-]+)\]", line):
            table = f"{head[1]}."
        given = re.match(r"(\w+) = [\d.]+ +#(.*assumed.*)", line)
        if given:
            interval = INTERVAL.search(given[2])
            assert interval, f"{scene.name}: {table}{given[1]} is assumed, without an interval"
            found[table + given[1]] = float(interval[1]), float(interval[2])
    return found


@pytest.mark.parametrize("name", DECIDED)
def test_no_default_verdict_depends_on_an_assumed_number(name: str):
    scene = sandbox.load(name)

    def decided(changes: dict[str, Any]) -> list[Any]:
        result = sandbox.simulate(scene.changed(changes)).result
        return [result[fact] for fact in DECIDED[name]]

    usual = decided({})
    for key, ends in assumed(scene).items():
        assert ends[0] <= value_at(scene.parameters, key) <= ends[1], key
        assert [decided({key: end}) for end in ends] == [usual, usual], key
