"""One run as a page: its poster, which can be played."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from sandbox.page.parts import css, filled, fonts, html, packed, rows, save, table
from sandbox.page.playing import event_rows, force_data, layout_data, path_data, place_data, story_data
from sandbox.parameters import Group, walk
from sandbox.picture.sheet import CARD, drawn_at
from sandbox.picture.view import View
from sandbox.scene.scene_run import SceneRun
from sandbox.scene.writing import command
from sandbox.sport.amounts import exact

#: The picture on a wide screen and on a phone: size in px, and how many times as large letters are drawn on it.
LAYOUTS = (((1600, 900), 1.0), ((801, 1001), 1.78))


def save_page(
    run: SceneRun, path: Path, ghosts: Mapping[str, SceneRun] | None = None, options: Sequence[str] = ()
) -> None:
    """Write the page of a run, as ``page_of`` makes it."""
    save(page_of(run, ghosts, options), path)


def page_of(run: SceneRun, ghosts: Mapping[str, SceneRun] | None = None, options: Sequence[str] = ()) -> str:
    """The page of a run, with other runs by name drawn pale behind it. ``options`` are the words that its command has
    besides those of the scene's parameters."""
    scene, verdict = run.scene, run.scene.verdict(run)
    views = list(_views(run, ghosts))
    wide, narrow = (layout.pop("poster") for _, layout in views)
    view = views[0][0]
    others = {ghost.label: css(ghost.light) for ghost in view.ghosts}
    labelled = [dict(scene.rows(run)), *(dict(ghost.run.scene.rows(ghost.run)) for ghost in view.ghosts)]
    card = [(label, *(texts.get(label, "–") for texts in labelled)) for label in labelled[0]]
    listed = (
        f'<li><button type="button"><b>{html(t)}</b> <span>{html(" ".join(filter(None, words)))}</span></button></li>'
        for t, *words in event_rows(run)
    )
    data = {
        **place_data(view),
        **path_data(view, run),
        **force_data(view, run),
        **story_data(view),
        "views": [layout for _, layout in views],
        "fonts": fonts(),
    }
    about = html(scene.about), _code(command(scene, "run", *options))
    return filled(
        "run.html",
        title=html(f"{scene.title}: {verdict}"),
        verdict=html(verdict),
        notes=html("   ·   ".join(view.heading.notes)),
        ground="dark" if view.on_dark else "light",
        picture=html(f"{scene.title}: {verdict}. The path of the {view.thing}; the numbers are in the table below."),
        poster=wide,
        poster_narrow=narrow,
        card=table(card, scene.title, "card", {scene.title: css(CARD["accent"]), **others} if others else None),
        events="\n".join(listed),
        events_open="open" if len(run.events) <= 8 else "",
        parameters=rows(
            (each.key, text_of(each.value, each.unit)) for each in walk(scene.parameters) if each.value is not None
        ),
        about="".join(f"<p>{text}</p>\n" for text in about if text),
        data=packed(data),
    )


def _code(text: str) -> str:
    """Text as a command, if there is one."""
    return f"<code>{html(text)}</code>" if text else ""


def text_of(value: Any, unit: str | None) -> str:
    """A parameter as people read it, with its unit: in the chosen units."""
    if isinstance(value, float):
        return exact(value, unit or "")
    if isinstance(value, list | tuple):
        return f"[{', '.join(text_of(each, unit) for each in value)}]"
    if isinstance(value, Group):
        inside = [f"{each.key}: {text_of(each.value, each.unit)}" for each in walk(value) if each.value is not None]
        return f"{{{', '.join(inside)}}}"
    return value if isinstance(value, str) else json.dumps(value)


# ------------------------------------------------------------------------------------------------------------- layers


def _views(run: SceneRun, ghosts: Mapping[str, SceneRun] | None) -> Iterator[tuple[View[Any], dict[str, Any]]]:
    """The picture in each layout, and what the page needs of it."""
    for size, density in LAYOUTS:
        with drawn_at(density):
            view = run.scene.picture(run, size, ghosts)
            yield view, layout_data(view)
