"""Frames to PNG: the cost of drawing compared with encoding, and the program's rate compared with what the cores could
encode.

Run ``python benchmarks/frames.py [--json F] [--levels] [--scenes golf,soccer]``. Every scene at 1280x720 with
everything on: trace, vectors, card. For each, in one process:

- drawing: a frame, on one core;
- Pillow: encoding the same pixels with Pillow alone at its fastest, on one core, interleaved with drawing;
- packing: encoding as in the program, without filters, on one core;
- limit: the program's packing alone, of prepared pictures, on all cores;
- whole: the whole command, ``sandbox run --frames``, from the run to the files in the folder, on all cores.

Times on one core are processor times, and "cpu" is a frame's processor time on all cores: they do not depend on other
load. Limit and whole, in frames per second of wall time, do, and are interleaved.

``--levels`` prints time and size of each compress_level; FRAME_LEVEL was chosen from it.
"""

from __future__ import annotations

import io
import os
import tempfile
import zlib
from collections import defaultdict
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from statistics import mean, median
from time import perf_counter, process_time
from typing import Any

from measured import command_line, keep, show, timed
from PIL import Image

import sandbox
from sandbox.picture import frames
from sandbox.scene import listings

SIZE = (1280, 720)
#: Frames of a scene: 60 per second of the run, and for a long run this many, evenly spread.
MOST_FRAMES = 240
#: Pictures prepared for measurements without drawing.
READY = 24
#: Repeats of limit and whole, interleaved.
ROUNDS = 3

PILLOW: dict[str, dict[str, int]] = {
    "level 1, RLE": {"compress_level": 1, "compress_type": zlib.Z_RLE},
    "level 1": {"compress_level": 1},
    "level 2": {"compress_level": 2},
    "level 3": {"compress_level": 3},
    "level 6, the default": {},
    "level 9": {"compress_level": 9},
}


def by_pillow(image: Image.Image, level: str = "level 1, RLE") -> int:
    """Size in bytes of the image encoded by Pillow."""
    data = io.BytesIO()
    image.save(data, "PNG", **PILLOW[level])
    return data.tell()


def by_us(image: Image.Image) -> int:
    """Size in bytes of the image encoded as a frame."""
    return len(frames.quick_png(image))


class Film:
    """The frames of one scene's default run."""

    def __init__(self, name: str):
        scene = sandbox.load(name)
        self.name, self.run = name, sandbox.simulate(scene)
        self.picture = scene.picture(self.run, SIZE)
        self.fps = min(60.0, MOST_FRAMES / self.run.duration)
        self.times = frames.frame_times(self.run.duration, self.fps)
        self.every = max(1, len(self.times) // READY)
        self.picture.frame(0.0)  # draws the static backdrop once

    def ready(self) -> list[Image.Image]:
        """A few frames, drawn."""
        return [frames.to_image(self.picture.frame(t)).copy() for t in self.times[:: self.every]]


def measure(film: Film) -> dict[str, Any]:
    """One scene's row."""
    drawing, pillow, packing = [], [], []
    for i, t in enumerate(film.times):
        seconds, surface = timed(film.picture.frame, t)
        drawing.append(seconds)
        if i % film.every == 0:
            image = frames.to_image(surface)
            pillow.append(timed(by_pillow, image)[0])
            packing.append(timed(by_us, image)[0])
    limits, wholes, cpu = [], [], []
    ready, cores = 2 * film.ready(), os.cpu_count() or 1
    for _ in range(ROUNDS):
        with ThreadPoolExecutor(cores) as pool:
            limits.append(len(ready) / timed(list, pool.map(by_us, ready), clock=perf_counter)[0])
        with tempfile.TemporaryDirectory() as folder:
            way, before = (film.picture, film.run, folder, film.fps), process_time()
            seconds, count = timed(frames.save_frames, *way, clock=perf_counter)
            wholes.append(count / seconds)
            cpu.append((process_time() - before) / count)
    return {
        "scene": film.name,
        "cores": cores,
        "drawing_ms": 1e3 * mean(drawing),
        "pillow_ms": 1e3 * mean(pillow),
        "packing_ms": 1e3 * mean(packing),
        "drawing_over_pillow": mean(drawing) / mean(pillow),
        "cpu_ms": 1e3 * median(cpu),
        "limit_frames_per_s": median(limits),
        "whole_frames_per_s": median(wholes),
        "whole_over_limit": median(wholes) / median(limits),
    }


def levels(films: Iterable[Film]) -> list[dict[str, Any]]:
    """Time and size of a PNG at each level: the mean over all scenes."""
    seconds, sizes = defaultdict(list), defaultdict(list)
    for film in films:
        for image in film.ready()[::4]:
            for name in PILLOW:
                spent, size = timed(by_pillow, image, name)
                seconds[f"Pillow, {name}"].append(spent)
                sizes[f"Pillow, {name}"].append(size)
            spent, size = timed(by_us, image)
            seconds["no filters, level 1"].append(spent)
            sizes["no filters, level 1"].append(size)
    return [{"packed": name, "ms": 1e3 * mean(seconds[name]), "kB": mean(sizes[name]) / 1e3} for name in seconds]


def report(rows: list[dict[str, Any]]) -> None:
    columns = {
        "scene": "{scene}",
        "drawing": "{drawing_ms:.1f} ms",
        "Pillow": "{pillow_ms:.1f} ms",
        "ratio": "{drawing_over_pillow:.2f}",
        "packing": "{packing_ms:.1f} ms",
        "cpu": "{cpu_ms:.1f} ms",
        "limit": "{limit_frames_per_s:.0f} /s",
        "whole": "{whole_frames_per_s:.0f} /s",
        "of limit": "{whole_over_limit:.2f}",
    }
    cores = rows[0]["cores"]
    show(f"{SIZE[0]}x{SIZE[1]}: drawing, Pillow, packing on one core; the others on {cores}", rows, columns)


def main() -> None:
    options = {
        "--levels": {"action": "store_true", "help": "time and size of each compress_level"},
        "--scenes": {"help": "comma-separated names; default: all"},
    }
    arguments = command_line(__doc__, options=options)
    names = [listing.name for listing in listings() if "/" not in listing.name]
    films = [Film(name) for name in (arguments.scenes.split(",") if arguments.scenes else names)]
    results: dict[str, Any] = {"frames": [measure(film) for film in films]}
    report(results["frames"])
    if arguments.levels:
        results["levels"] = levels(films)
        show("a frame as PNG", results["levels"], {"packed": "{packed}", "time": "{ms:.1f} ms", "size": "{kB:.0f} kB"})
    keep(arguments.json, results)


if __name__ == "__main__":
    main()
