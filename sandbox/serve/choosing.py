"""The first page of a player, as HTML: a tile for each sport, and what can be played in one."""

from __future__ import annotations

import re
from collections.abc import Mapping
from html import escape

from sandbox.scene.discovery import folder_of
from sandbox.serve.room import Listed
from sandbox.tasks.sports import TILE, TILE_FILE
from sandbox.text import title_of, with_noun

_START_HERE = "Start here"
#: What is played in a sport, in this order, each with its heading; presets are folded away.
_KINDS = {"task": "Tasks, from easy to hard", "game": "For two, each at a page of their own", "scene": "Just play"}


def tile_name(sport: str) -> str:
    """The name of the file of a sport's tile."""
    return f"tile-{re.sub(r'[^a-z0-9]+', '-', sport.lower()).strip('-')}.jpg"


def tiles_of(scenes: Mapping[str, Listed]) -> dict[str, bytes]:
    """The pictures of the sports that have one."""
    files = {sport: folder / TILE_FILE for sport in _by_sport(scenes) if (folder := folder_of(sport)) is not None}
    return {sport: file.read_bytes() for sport, file in files.items() if file.is_file()}


def choosing_page(scenes: Mapping[str, Listed]) -> str:
    """The tiles, and of each sport a list that is hidden until its tile is pressed."""
    by_sport = _by_sport(scenes)
    pictured = tiles_of(scenes).keys()
    easiest = next((name for name, each in scenes.items() if each.kind == "task"), "")
    start = scenes[easiest].sport if easiest else ""
    tiles, pages = [], []
    for sport, names in by_sport.items():
        direct = easiest if sport == start else names[0] if len(names) == 1 else ""
        tiles.append(_tile(sport, names, scenes, sport in pictured, direct, _START_HERE if sport == start else ""))
        if len(names) > 1:
            pages.append(_sport(sport, names, scenes))
    return f'<ul class="tiles">\n{"".join(tiles)}</ul>\n{"".join(pages)}'


def _by_sport(scenes: Mapping[str, Listed]) -> dict[str, list[str]]:
    """The names of all that may be played, by sport."""
    found: dict[str, list[str]] = {}
    for name, each in scenes.items():
        found.setdefault(each.sport or name, []).append(name)
    return found


def _tile(sport: str, names: list[str], scenes: Mapping[str, Listed], pictured: bool, direct: str, badge: str) -> str:
    """A tile, which opens the page of its sport, or ``direct``ly what it has, or what one begins with."""
    title = scenes[sport].title if sport in scenes and scenes[sport].title else title_of(sport.strip("./"))
    counts = {kind: sum(scenes[name].kind == kind for name in names) for kind in ("task", "game")}
    about = ", ".join(with_noun(count, kind) for kind, count in counts.items() if count)
    wide, tall = TILE
    picture = f'<img src="{tile_name(sport)}" width="{wide}" height="{tall}" alt="">' if pictured else "<i></i>"
    source = f' data-source="{escape(direct)}"' if direct else ""
    return (
        f'<li><button type="button" data-sport="{escape(sport)}"{source}>{picture}<b>{escape(title)}</b>'
        f"<span>{about}</span>{f'<em>{badge}</em>' if badge else ''}</button></li>\n"
    )


def _sport(sport: str, names: list[str], scenes: Mapping[str, Listed]) -> str:
    """The page of a sport: its tasks, its games, itself, and its presets."""
    parts = []
    for kind, heading in _KINDS.items():
        listed = [_entry(name, scenes[name], place) for place, name in enumerate(_of(kind, names, scenes), 1)]
        if listed:
            parts.append(f"<h3>{heading}</h3>\n<ul>\n{''.join(listed)}</ul>\n")
    presets = [_entry(name, scenes[name], 0) for name in _of("preset", names, scenes)]
    if presets:
        summary = with_noun(len(presets), "preset")
        parts.append(f"<details><summary>{summary}</summary>\n<ul>\n{''.join(presets)}</ul></details>\n")
    return f'<section class="sport" data-sport="{escape(sport)}" hidden>\n{"".join(parts)}</section>\n'


def _of(kind: str, names: list[str], scenes: Mapping[str, Listed]) -> list[str]:
    return [name for name in names if scenes[name].kind == kind]


def _entry(name: str, listed: Listed, place: int) -> str:
    """A button that plays something; tasks are numbered."""
    title = listed.title or title_of(name.rpartition("/")[2])
    number = f"{place}. " if listed.kind == "task" else ""
    return (
        f'<li><button type="button" data-source="{escape(name)}"><b>{number}{escape(title)}</b>'
        f"<span>{escape(listed.about)}</span></button></li>\n"
    )
