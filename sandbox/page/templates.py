"""The HTML, CSS and JavaScript files of pages, and how a page is put together from them; quick to import."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from string import Template

FOLDER = Path(__file__).parent
#: The scripts of a page that plays runs, in order; its own ones follow.
PLAYER = ("page.js", "paths.js", "player.js")


@cache
def source(name: str) -> str:
    """Return the text of one of the files here."""
    return (FOLDER / name).read_text("utf-8")


def framed(title: str, head: str, body: str) -> str:
    """Return a page with this title; ``head`` and ``body`` are HTML already."""
    return Template(source("frame.html")).substitute(title=title, head=head, body=body)


def with_player(template: str, more: str = "", **parts: str) -> str:
    """Return a template with its parts filled in, among them the controls of the player where it says ``$player``;
    ``more`` are further buttons of the player."""
    player = Template(source("player.html")).substitute(more=more)
    return Template(template).substitute(player=player, **parts)
