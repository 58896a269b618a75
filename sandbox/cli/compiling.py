"""The command ``compile``: the kernel of many shots as machine code."""

from __future__ import annotations

import click

from sandbox.cli.arguments import say


@click.command("compile")
def _compile_kernel() -> None:
    """Compile the flight of many shots, once.

    Sweeps and searches then take a fraction of the time.

    It needs numba, only for this (pip install "sports-sandbox[fast]"), and a C compiler. The library is put into your
    cache folder; before that, 1,000 of its paths are compared with those of the interpreted program, bit by bit. It is
    used from then on by all that computes many shots, until the program changes; --no-compiled does without it.

    \b
    Examples:
      sandbox compile
      sandbox sweep golf --over launch.speed=50:80:400 --out speeds.csv
      sandbox --no-compiled sweep golf --over launch.speed=50:80:400 --out speeds.csv
    """
    from sandbox.engine.kernel.building import install

    made = install()
    equal = f"1,000 paths equal those without it, bit by bit ({made.check_s:.0f} s)"
    say(f"{made.file}\ncompiled in {made.build_s:.0f} s; {equal}")
