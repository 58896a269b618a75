"""The modules of a scene's folder, imported from wherever the folder stands."""

from __future__ import annotations

import hashlib
import importlib
import importlib.util
import linecache
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import ModuleType

from pydantic import ValidationError

from sandbox import resources
from sandbox.errors import RequestError, sys_exit_as_error
from sandbox.files import is_given
from sandbox.parameters import wrong_group

#: Scene folders are imported as packages below this name, which nothing else uses.
_NAMESPACE = "sandbox_scenes"


def module_in(folder: Path, name: str) -> ModuleType:
    """``folder/name.py``, imported as part of a package, so that relative imports and pickling work in it."""
    package = _package_of(folder)
    if f"{package}.{name}" in sys.modules:
        return importlib.import_module(f"{package}.{name}")
    try:
        with sys_exit_as_error():
            _package(_NAMESPACE, resources.folder("scenes"))
            _package(package, folder)
            is_given(folder / f"{name}.py")
            return importlib.import_module(f"{package}.{name}")
    except ValidationError as error:  # a group without defaults, made where the module is imported
        raise ValueError(wrong_group(error)).with_traceback(error.__traceback__) from None
    except (SyntaxError, ValueError):  # for NUL bytes Python names no file, and not always a SyntaxError
        file = folder / f"{name}.py"
        if b"\0" in file.read_bytes():
            raise RequestError(f"{file}: not a text file, it holds NUL bytes") from None
        raise


def forget(folder: Path) -> dict[str, ModuleType]:
    """Make the next import read the modules of a scene's folder again; returns the modules so far."""
    package = _package_of(folder)
    names = [name for name in sys.modules if name == package or name.startswith(f"{package}.")]
    for file in folder.glob("*.py"):  # two versions of the same length, saved within a second, look alike to Python
        Path(importlib.util.cache_from_source(str(file))).unlink(missing_ok=True)
    importlib.invalidate_caches()
    linecache.checkcache()
    return {name: sys.modules.pop(name) for name in names}


@contextmanager
def read_again(folder: Path) -> Iterator[None]:
    """Read the modules of a scene's folder again; if the work inside fails, restore the modules so far."""
    before = forget(folder)
    try:
        yield
    except BaseException:
        forget(folder)
        sys.modules.update(before)
        raise


@cache
def _package_of(folder: Path) -> str:
    """Name of the package that a scene's folder is imported as."""
    package = f"{_NAMESPACE}.{re.sub(r'[^0-9A-Za-z_]', '_', folder.name)}"
    if folder.parent != resources.folder("scenes"):
        # Two folders with the same name may be in use at once.
        package += "_" + hashlib.sha256(str(folder).encode()).hexdigest()[:12]
    return package


def _package(name: str, folder: Path) -> None:
    """Make ``folder`` importable under ``name``."""
    if name in sys.modules:
        return
    init = folder / "__init__.py"
    if not is_given(init):
        package = sys.modules[name] = ModuleType(name)
        package.__path__ = [str(folder)]
        return
    spec = importlib.util.spec_from_file_location(name, init, submodule_search_locations=[str(folder)])
    assert spec is not None
    assert spec.loader is not None  # a .py file always has one
    package = sys.modules[name] = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(package)
    except BaseException:
        del sys.modules[name]
        raise
