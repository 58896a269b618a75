"""Runs all comparisons and writes their output into benchmarks/results.md: ``make bench``, on an idle machine.

The page is written once, when all have run, so that all its numbers are of one program on one machine. The JSON of each
goes to out/benchmarks.
"""

from __future__ import annotations

import argparse
import os
import platform
import re
import shlex
import subprocess
import sys
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path
from time import perf_counter

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "benchmarks" / "results.md"
JSON = ROOT / "out" / "benchmarks"
PEER = ROOT / ".venv" / "pooltool" / "bin" / "python"

#: The script of each block, with its arguments.
SCRIPTS = {
    "engine": "benchmarks/engine.py",
    "bodies": "benchmarks/bodies.py",
    "billiards": "benchmarks/billiards_pooltool.py --pooltool .venv/pooltool/bin/python --cold",
    "forces": "benchmarks/forces.py",
    "frames": "benchmarks/frames.py",
    "sweep": "benchmarks/sweep.py",
    "scaling": "benchmarks/scaling.py",
    "start": "benchmarks/start.py",
}
#: Packages whose versions are listed.
PACKAGES = ("pymunk", "numpy", "scipy", "pillow", "pygame-ce", "pydantic", "click")


def main() -> None:
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    if not PEER.exists():
        raise SystemExit("there is no pooltool in .venv/pooltool to compare with: make .venv/pooltool/ready")
    JSON.mkdir(parents=True, exist_ok=True)
    page = filled(PAGE.read_text("utf-8"), "machine", machine(os.getloadavg()[0]))
    for name in SCRIPTS:
        began = perf_counter()
        printed = output_of(name)
        sys.stderr.write(f"{name}: {perf_counter() - began:.0f} s\n")
        page = filled(page, name, ["```console", f"$ python {SCRIPTS[name]}", *printed, "```"])
    PAGE.write_text(page, "utf-8")


def output_of(name: str) -> list[str]:
    """The lines that the script prints."""
    command = [sys.executable, *shlex.split(SCRIPTS[name]), "--json", str(JSON / f"{name}.json")]
    quiet = os.environ | {"PYGAME_HIDE_SUPPORT_PROMPT": "1", "COLUMNS": "110"}
    done = subprocess.run(command, cwd=ROOT, env=quiet, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{name} failed; see its error above")
    return [line.rstrip() for line in done.stdout.strip("\n").splitlines()]


def machine(load: float) -> list[str]:
    """Processor, system and versions; ``load`` is the load average of the minute before the start."""
    packages = ", ".join(f"{package} {version(package)}" for package in PACKAGES)
    return [
        f"{processor()}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}, "
        f"Python {platform.python_version()};",
        f"{packages}.",
        f"Load average in the minute before the start: {load:.1f}.",
    ]


def processor() -> str:
    """Its model, where the system says."""
    info = Path("/proc/cpuinfo")
    found = re.search(r"^model name\s*: (.+)$", info.read_text("utf-8"), re.MULTILINE) if info.exists() else None
    return found[1] if found else platform.processor() or "unknown processor"


def filled(page: str, block: str, lines: Iterable[str]) -> str:
    """The page with new lines in the block."""
    text = "\n".join([f"<!-- {block} -->", *lines, "<!-- end -->"])
    page, count = re.subn(rf"<!-- {block} -->\n.*?<!-- end -->", lambda match: text, page, flags=re.DOTALL)
    if count != 1:
        raise SystemExit(f"{PAGE.name} has {count} blocks {block!r}: expected one")
    return page


if __name__ == "__main__":
    main()
