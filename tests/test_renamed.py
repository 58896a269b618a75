"""Old names of what scenes and scripts use give an error that says the new one."""

from __future__ import annotations

from importlib import import_module

import pytest

from sandbox.engine.model import ball, setup
from sandbox.renamed import FIELDS, MODULES, NAMES
from sandbox.scene import running
from sandbox.sport import controls, facts


@pytest.mark.parametrize("old", MODULES)
def test_the_import_of_a_module_by_its_old_name_says_the_new_one(old: str):
    with pytest.raises(ModuleNotFoundError, match=rf"^sandbox\.{old} is now sandbox\.\w+\.\w+"):
        import_module(f"sandbox.{old}")


@pytest.mark.parametrize(("module", "old"), [(module, old) for module, names in NAMES.items() for old in names])
def test_an_old_name_says_the_new_one(module: str, old: str):
    new = NAMES[module][old].rpartition(".")[2]
    with pytest.raises(ImportError, match=rf"^{old} is now .*\b{new}$"):
        exec(f"from sandbox.{module} import {old}")


def test_other_names_are_missing_as_ever():
    with pytest.raises(ImportError, match="cannot import name 'Sphinx'"):
        exec("from sandbox.engine.model.setup import Sphinx")
    assert not hasattr(setup, "Sphinx")


CLASSES = {
    name: vars(module)[name]
    for module in (ball, setup, controls, facts, running)
    for name in FIELDS
    if name in vars(module)
}


@pytest.mark.parametrize(("name", "old"), [(name, old) for name, fields in FIELDS.items() for old in fields])
def test_an_old_argument_or_attribute_says_the_new_one(name: str, old: str):
    cls, new = CLASSES[name], FIELDS[name][old]
    with pytest.raises(TypeError, match=f"{name}: {old} is now {new}"):
        cls(**{old: ()})
    with pytest.raises(AttributeError, match=rf"{name}\.{old} is now {new}"):
        getattr(object.__new__(cls), old)
    assert hasattr(cls, new) or new in cls.__dataclass_fields__


@pytest.mark.parametrize("name", FIELDS)
def test_a_wrong_argument_or_attribute_is_named_as_ever(name: str):
    with pytest.raises(TypeError, match="unexpected keyword argument 'sphinx'"):
        CLASSES[name](sphinx=1)
    with pytest.raises(AttributeError, match="no attribute 'sphinx'"):
        object.__new__(CLASSES[name]).sphinx  # noqa: B018
