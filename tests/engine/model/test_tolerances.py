"""The tolerances of the engine rise in an order on which contacts depend, and each is used."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from sandbox.engine.model import tolerances

ENGINE = Path(tolerances.__file__).parents[1]
PAGE = Path(tolerances.__file__).read_text("utf-8")
NAMES = re.findall(r"^([A-Z_]+) = ", PAGE, re.MULTILINE)


def test_a_contact_that_is_found_is_one_when_it_is_resolved():
    lengths = ("GAP_ROUNDING", "NEGLIGIBLE_OVERLAP", "SEAM", "SKIN", "TOUCHING_GAP")
    values = [getattr(tolerances, name) for name in lengths]
    assert values == sorted(values)
    assert len(set(values)) == len(values)


@pytest.mark.parametrize("name", NAMES)
def test_each_is_used(name: str):
    used = [
        path
        for path in ENGINE.rglob("*.py")
        if path.name != "tolerances.py" and re.search(rf"\b{name}\b", path.read_text("utf-8"))
    ]
    assert used
