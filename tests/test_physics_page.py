"""docs/physics.md and docs/engine.md: every model has its section, and numbers in them are computed again."""

from __future__ import annotations

import importlib
import inspect
import math
import pkgutil
import re
from collections.abc import Iterator
from enum import Enum
from pathlib import Path
from typing import Any

import pytest

import sandbox.physics
from docs.lists import LISTS, page_with_lists, scenes
from sandbox.physics.integrators import INTEGRATORS

ROOT = Path(__file__).resolve().parent.parent
PHYSICS, ENGINE = ((ROOT / "docs" / f"{page}.md").read_text("utf-8") for page in ("physics", "engine"))
METHODS_AND_MODELS = PHYSICS + ENGINE

#: Arithmetic for floats and arrays alike, a method of INTEGRATORS written by hand, arguments of forces: no physics.
NOT_MODELS = {"elementwise", "checks", "dormand_prince", "of_ball"}


def modules() -> Iterator[Any]:
    for info in pkgutil.iter_modules(sandbox.physics.__path__):
        if info.name not in NOT_MODELS:
            yield importlib.import_module(f"sandbox.physics.{info.name}")


def models(module: Any) -> list[str]:
    """Public functions and classes of a module that compute something; a tuple or dict holds it, an Enum names it."""
    found = [
        name
        for name, thing in vars(module).items()
        if (inspect.isfunction(thing) or inspect.isclass(thing))
        and not name.startswith("_")
        and thing.__module__ == module.__name__
        and not (inspect.isclass(thing) and issubclass(thing, (tuple, dict, Enum)))
    ]
    return found or ["INTEGRATORS"]


MODELS = [(module.__name__, name) for module in modules() for name in models(module)]
HEADINGS = re.findall(r"^##+ .*$|^- `.*", METHODS_AND_MODELS, re.MULTILINE)  # or an item of a list, of a coefficient


def test_models_are_found():
    assert len(MODELS) > 25
    assert ("sandbox.physics.forces", "Drag") in MODELS
    assert ("sandbox.physics.integrators", "INTEGRATORS") in MODELS


def test_every_model_has_a_section():
    assert [name for _, name in MODELS if not any(f"`{name}`" in heading for heading in HEADINGS)] == []


@pytest.mark.parametrize("page", LISTS, ids=lambda page: page.name)
def test_lists_that_follow_from_the_code_are_in_step(page: Path):
    assert page.read_text("utf-8") == page_with_lists(page), "make lists"


@pytest.mark.parametrize("name", INTEGRATORS)
def test_the_integrators_are_listed_as_they_are(name: str):
    integrator = INTEGRATORS[name]
    assert f"| `{name}` | {integrator.order} | {integrator.evaluations} |" in ENGINE


CHECKS = re.findall(r"^\*\*Check\*\* `(.+)` is (\S+)$", METHODS_AND_MODELS, re.MULTILINE)


def test_checks_are_found():
    assert len(CHECKS) == METHODS_AND_MODELS.count("\n**Check**") > 20


@pytest.mark.parametrize(("expression", "stated"), CHECKS)
def test_what_the_page_states_is_computed_again(expression: str, stated: str):
    names = {name: thing for module in modules() for name, thing in vars(module).items()}
    value = eval(expression, {**names, "degrees": math.degrees, "radians": math.radians})
    digits = len(stated.partition("e")[0].replace(".", "").lstrip("0"))
    assert f"{value:.{digits}g}" == f"{float(stated):.{digits}g}"


def test_every_section_says_what_it_stands_on():
    """A source, or whose choice it is, in every section of a model that stands for something measured."""
    for section in re.split(r"^### ", PHYSICS, flags=re.MULTILINE)[1:]:
        title = section.partition("\n")[0]
        if not re.search(r"`(Gravity|UniformWind|Constant)`", title):
            assert re.search(r"Source|\*[Oo]urs\*|\(\d{4}|\b(19|20)\d\d\b", section), title


def test_the_accuracy_page_has_a_line_for_every_sport():
    page = (ROOT / "docs" / "accuracy.md").read_text("utf-8")
    rows = re.findall(r"^\| ([a-z-]+)[^|]*\| [^|]+\| [^|]+\|$", page.partition("| sport | as good as")[2], re.MULTILINE)
    assert {name for name, _ in scenes()} <= set(rows)
