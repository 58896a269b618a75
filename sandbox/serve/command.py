"""``sandbox serve``: scenes for every browser in the room."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from sandbox.cli.arguments import prints_to_stderr, say, units_option
from sandbox.errors import RequestError

if TYPE_CHECKING:
    from sandbox.serve.server import Address

#: The packages of the extra.
PACKAGES = ("starlette", "uvicorn", "websockets", "segno")


@click.command()
@click.argument("scenes", metavar="[SCENE]...", nargs=-1)
@click.option("--port", metavar="N", type=click.IntRange(0, 65535), help="Port; 0 for any.  [default: 8765 if free]")
@click.option("--share", is_flag=True, help="Let other devices in the network in, not only this computer.")
@click.option("--jobs", metavar="N", type=click.IntRange(1, 64), help="Processes that compute.  [default: cores + 2]")
@click.option("--fresh", is_flag=True, help="Make new addresses; by default those of the last 12 hours stay valid.")
@click.option(
    "--json", "as_json", is_flag=True, help="Print the addresses as one line of JSON.", callback=prints_to_stderr
)
@units_option
def serve(scenes: tuple[str, ...], port: int | None, share: bool, jobs: int | None, fresh: bool, as_json: bool) -> None:
    """Play in any browser; --share: on every phone in the room.

    All computing is done here. The first address is for players; the second is the teacher's: who is there, one scene
    for all, everybody's shots. SCENE is a scene with its presets, one preset, a task or a scene file; by default all
    scenes and tasks.

    \b
    Examples:
      sandbox serve
      sandbox serve golf basketball --share
      sandbox serve free-throw
    """
    from importlib.util import find_spec

    missing = [package for package in PACKAGES if find_spec(package) is None]
    if missing:
        needed = ", ".join(missing)
        raise RequestError(f"sandbox serve needs {needed}, not installed here: pip install {' '.join(missing)}")
    from sandbox.serve.server import Options
    from sandbox.serve.server import serve as serve_scenes
    from sandbox.sport.amounts import chosen_units

    serve_scenes(scenes, Options(port, share, chosen_units(), jobs, fresh), _json if as_json else _text)


def _json(address: Address) -> None:
    from sandbox.files import json_text

    say(json_text(address._asdict()))


def _text(address: Address) -> None:
    """Print the addresses and what sharing means, and the first as a QR code."""
    import io

    import segno

    if address.shared:
        where = (
            "Shared: whoever is in this network and has the address can play here, and makes\n"
            "this computer compute. The connection is not encrypted. Ctrl-C ends it."
        )
    else:
        where = "Only browsers on this computer can open it; --share lets others in.\nCtrl-C ends it."
    code = io.StringIO()
    segno.make(address.url, micro=False).terminal(code, compact=True, border=2)
    say(f"players  {address.url}\nteacher  {address.teacher}\n\n{where}\n\n{code.getvalue().rstrip()}")
