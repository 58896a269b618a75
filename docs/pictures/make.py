"""The pictures of README.md, made anew: ``make pictures``."""

from __future__ import annotations

import tempfile
from pathlib import Path

from PIL import Image

import sandbox
from sandbox.cli import main as program
from sandbox.picture.frames import to_image

HERE = Path(__file__).resolve().parent

#: What is shown of the sports, in rows of two.
SPORTS = ("golf", "basketball/bank-shot", "billiards/nine-ball-break", "soccer/dipping-free-kick")
SIZE, GAP = (720, 405), 6  # px
QUALITY = 88  # of JPEG: the smallest at which letters stay clean

SWEEP = ("sweep", "basketball", "--over", "launch.speed=6.8:8.6:73", "--over", "launch.angle=40:70:61")


def poster(name: str) -> Image.Image:
    """The poster of a scene or preset, drawn twice as large and scaled down."""
    scene = sandbox.load(name)
    large = to_image(scene.picture(sandbox.simulate(scene), (2 * SIZE[0], 2 * SIZE[1])).poster())
    return large.resize(SIZE, Image.Resampling.LANCZOS)


def sports() -> None:
    """One poster of each sport on a sheet."""
    rows = len(SPORTS) // 2
    sheet = Image.new("RGB", (2 * SIZE[0] + GAP, rows * SIZE[1] + (rows - 1) * GAP), "white")
    for i, name in enumerate(SPORTS):
        sheet.paste(poster(name), (i % 2 * (SIZE[0] + GAP), i // 2 * (SIZE[1] + GAP)))
    sheet.save(HERE / "sports.jpg", quality=QUALITY, subsampling=0, optimize=True, progressive=True)


def free_throws() -> None:
    """The map that the README shows, by the command that it names; few colours need few bytes."""
    with tempfile.TemporaryDirectory() as folder:
        plot = Path(folder, "map.png")
        program([*SWEEP, "--out", str(Path(folder, "map.csv")), "--plot", str(plot)])
        with Image.open(plot) as image:
            image.convert("RGB").quantize(64, dither=Image.Dither.NONE).save(HERE / "free-throws.png", optimize=True)


if __name__ == "__main__":
    sports()
    free_throws()
