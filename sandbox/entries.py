"""The entries of packages: what each adds to those below it, which find it here by name and import it on first use.

The file ``entry.py`` of a package has it as tables::

    NEEDS = ("tasks",)  # packages without which it adds nothing
    COMMANDS = {"play": "sandbox.window.command"}  # modules, by command
    PARTS = {"pages of runs": "sandbox.page.replay"}  # modules, by the name under which another package asks for it

So a package that only adds, an extension, can be taken off: without its folder the rest works as before.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType

from sandbox.errors import RequestError

#: Folders with packages that have entries.
_FOLDERS = (Path(__file__).parent, Path(__file__).parent / "lab")


@cache
def added(kind: str) -> Mapping[str, str]:
    """All tables of a kind as one, COMMANDS or PARTS: the module of each name."""
    files = [file for folder in _FOLDERS for file in folder.glob("*/entry.py")]
    names = [".".join(file.parent.relative_to(_FOLDERS[0]).parts) for file in files]
    entries = {name: import_module(f"sandbox.{name}.entry") for name in sorted(names)}
    usable = [entry for entry in entries.values() if set(getattr(entry, "NEEDS", ())) <= entries.keys()]
    return {name: module for entry in usable for name, module in getattr(entry, kind, {}).items()}


def find(part: str) -> ModuleType | None:
    """The module of a part; None where the package that adds it was taken off."""
    module = added("PARTS").get(part)
    try:
        return None if module is None else import_module(module)
    except ModuleNotFoundError as error:
        if not str(error.name).startswith("sandbox."):
            raise
        return None  # it joins two extensions, and the other was taken off


def require(part: str, by: str) -> ModuleType:
    """The module of a part. Raises RequestError, which names the option ``by`` which it was asked for."""
    found = find(part)
    if found is None:
        raise RequestError(missing(part, by))
    return found


def missing(part: str, by: str) -> str:
    """The message for an option ``by`` which a part was asked for that was taken off."""
    return f"{by}: this copy of sandbox is without {part}"
