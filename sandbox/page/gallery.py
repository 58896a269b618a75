"""A folder with every scene and preset as poster and page, and an index: ``python -m sandbox.page.gallery FOLDER``."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from itertools import groupby
from pathlib import Path

from sandbox.page.parts import filled, html, save
from sandbox.page.replay import page_of
from sandbox.picture.frames import save_png
from sandbox.scene import listings, load, simulate

#: Size of the posters, in px.
SIZE = (1280, 720)


def build(folder: Path, names: Iterable[str] | None = None, tell: Callable[[str], object] = str) -> Path:
    """Write posters and pages of these scenes and presets, all by default, into a folder; returns its index."""
    folder.mkdir(parents=True, exist_ok=True)
    entries = []
    for name in [listing.name for listing in listings()] if names is None else names:
        tell(name)
        run = simulate(load(name))
        file = name.replace("/", "-")
        save_png(run.scene.picture(run, SIZE).poster(), folder / f"{file}.png")
        save(page_of(run), folder / f"{file}.html")
        entries.append((name, file, run.scene.verdict(run), run.scene.about))
    sections = (
        f"<h2>{html(scene)}</h2>\n<ul>{''.join(map(_entry, group))}</ul>"
        for scene, group in groupby(entries, key=lambda entry: entry[0].partition("/")[0])
    )
    index = folder / "index.html"
    about = f"{len(entries)} runs, each as a picture and as a page that plays it."
    save(filled("gallery.html", title="sports sandbox: gallery", about=about, scenes="\n".join(sections)), index)
    return index


def _entry(entry: tuple[str, str, str, str]) -> str:
    name, file, verdict, about = map(html, entry)
    return (
        f'<li><a href="{file}.html"><img src="{file}.png" alt="{name}: {verdict}" loading="lazy" width="1280" '
        f'height="720"><b>{name}</b><span>{verdict}</span><span>{about}</span></a></li>'
    )


if __name__ == "__main__":
    written = build(Path(sys.argv[1]), tell=lambda name: sys.stderr.write(f"{name}\n"))
    sys.stdout.write(f"wrote {written}\n")
