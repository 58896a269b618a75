"""The kernel compiled ahead of time, by numba and the C compiler, for ``sandbox compile``.

numba compiles ``fly_all``, with all it calls, to one LLVM module; its object is linked as a library that needs neither
numba nor Python. It is not installed before its paths are those of the interpreted kernel, bit by bit.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from importlib import import_module
from pathlib import Path
from time import perf_counter
from types import FunctionType, ModuleType
from typing import Any, NamedTuple

from sandbox.engine.kernel import leg
from sandbox.engine.kernel.checking import check
from sandbox.engine.kernel.library import OPTIONS, compiled, load, place
from sandbox.errors import RequestError, RunError
from sandbox.files import reason

#: How many axes each of the arrays has that ``fly_all`` takes after its first parameter.
_AXES = 2, 2, 3, 3, 3, 3, 2, 2, 2, 2, 2


class _Installed(NamedTuple):
    """A library, and the time that making it took."""

    file: Path
    build_s: float
    check_s: float


def install() -> _Installed:
    """Build the library, compare it with the interpreted kernel, and put it where it is looked for. Libraries of other
    sources are removed. Raises RequestError without numba, a C compiler or a place for it, RunError if its paths are
    others."""
    started, file = perf_counter(), place()
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        building = tempfile.TemporaryDirectory(prefix="building-", dir=file.parent)
    except OSError as error:
        raise RequestError(f"{file.parent}: the library cannot be put there: {reason(error)}") from None
    with building as folder:
        made = build(Path(folder))
        built = perf_counter()
        fly_all = load(made)
        if fly_all is None:
            raise RunError(f"{made.name}: the compiled kernel cannot be loaded")
        check(fly_all)
        for old in file.parent.glob(f"kernel-*{file.suffix}"):
            old.unlink()
        made.replace(file)
    compiled.cache_clear()
    return _Installed(file, built - started, perf_counter() - built)


def build(folder: Path) -> Path:
    """Build the library in a folder. Raises RequestError without numba or a C compiler."""
    compiler = shutil.which(os.environ.get("CC", "cc"))
    if compiler is None:
        raise RequestError("sandbox compile needs a C compiler, such as gcc: install one, or name it in CC")
    try:
        numba: Any = import_module("numba")
    except ImportError:
        raise RequestError('sandbox compile needs numba: pip install "sports-sandbox[fast]"') from None
    llvm = import_module("llvmlite.binding")

    fly_all = _compiled(numba)
    module = llvm.parse_assembly(str(fly_all._library._final_module).replace(fly_all.native_name, "fly_all"))
    machine = llvm.Target.from_default_triple().create_target_machine(opt=3, reloc="pic", codemodel="default")
    (folder / "kernel.o").write_bytes(machine.emit_object(module))
    (folder / "unused.c").write_text(_unused(module), encoding="utf-8")
    command = [compiler, "-shared", "-fPIC", "-w", "kernel.o", "unused.c", "-lm", "-o", "kernel.so"]
    linked = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if linked.returncode != 0:
        raise RunError(f"{' '.join(command)}: {linked.stderr.strip():.300}")
    return folder / "kernel.so"


def _compiled(numba: Any) -> Any:
    """``fly_all``, compiled for pointers to floats, each with the sizes of its array."""
    for function in _called(leg.fly_all, {}):
        numba.extending.register_jitable(function)
    fly_all, array = leg.fly_all, numba.carray

    # fmt: off
    def entry(  # type: ignore[no-untyped-def]
        first, shots, s0, s1, balls, b0, b1, forces, f0, f1, f2, surfaces, u0, u1, u2, regions, r0, r1, r2,
        rules, q0, q1, q2, counted, c0, c1, limits, l0, l1, arcs, a0, a1, events, e0, e1, found, d0, d1,
    ):
        return fly_all(
            first, array(shots, (s0, s1)), array(balls, (b0, b1)), array(forces, (f0, f1, f2)),
            array(surfaces, (u0, u1, u2)), array(regions, (r0, r1, r2)), array(rules, (q0, q1, q2)),
            array(counted, (c0, c1)), array(limits, (l0, l1)), array(arcs, (a0, a1)), array(events, (e0, e1)),
            array(found, (d0, d1)),
        )
    # fmt: on

    types = [numba.int64]
    for axes in _AXES:
        types += [numba.types.CPointer(numba.float64), *[numba.int64] * axes]
    return numba.cfunc(numba.int64(*types), **OPTIONS)(entry)


def _called(function: Any, found: dict[Any, None]) -> dict[Any, None]:
    """A function of the sandbox, and all of it that it calls."""
    if function not in found:
        found[function] = None
        names, known = function.__code__.co_names, function.__globals__
        there = [known.get(name) for name in names]
        there += [getattr(each, name, None) for each in there if isinstance(each, ModuleType) for name in names]
        there += [cell.cell_contents for cell in function.__closure__ or ()]
        for each in there:
            if isinstance(each, FunctionType) and each.__module__.startswith("sandbox."):
                _called(each, found)
    return found


def _unused(module: Any) -> str:
    """C that defines what the object names and never calls: the parts of numba and Python that raise errors, of which
    the kernel has none. A call would end the program."""
    functions = [each.name for each in module.functions if each.is_declaration and not each.name.startswith("llvm.")]
    variables = [each.name for each in module.global_variables if each.is_declaration]
    lines = ["#include <stdlib.h>", *(f"void {name}(void) {{ abort(); }}" for name in functions)]
    return "\n".join([*lines, *(f"void *{name};" for name in variables), ""])
