"""The modules of a scene's folder, imported from wherever the folder stands."""

from __future__ import annotations

import hashlib
import importlib
import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

from sandbox import resources
from sandbox.errors import RequestError, no_exit

#: Scene folders are imported as packages below this name, which nothing else can have taken.
NAMESPACE = "sandbox_scenes"


def module_in(folder: Path, name: str) -> ModuleType:
    """``folder/name.py``, imported as part of a package, so that relative imports and pickling work in it."""
    built_in = resources.folder("scenes")
    _package(NAMESPACE, built_in)
    package = f"{NAMESPACE}.{re.sub(r'[^0-9A-Za-z_]', '_', folder.name)}"
    if folder.parent != built_in:
        # Two folders of one name may be in use at once.
        package += "_" + hashlib.sha256(str(folder).encode()).hexdigest()[:12]
    try:
        with no_exit():
            _package(package, folder)
            return importlib.import_module(f"{package}.{name}")
    except (SyntaxError, ValueError):  # of NUL bytes Python says neither where nor always as a SyntaxError
        file = folder / f"{name}.py"
        if b"\0" in file.read_bytes():
            raise RequestError(f"{file}: not a text file, it holds NUL bytes") from None
        raise


def _package(name: str, folder: Path) -> None:
    """Make ``folder`` importable under ``name``."""
    if name in sys.modules:
        return
    init = folder / "__init__.py"
    if not init.is_file():
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
