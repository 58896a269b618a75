"""Pictures to files: a poster, PNG frames, a GIF, an animated WebP. Every file is written whole or not at all."""

from __future__ import annotations

import filecmp
import io
import os
import struct
import sys
import zlib
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import chain, pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pygame
from PIL import GifImagePlugin, Image

from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError
from sandbox.files import atomic_write, backup_of, check_replaced, folder_of_parts, is_stream, put_output
from sandbox.picture.story import frame_times

if TYPE_CHECKING:
    from sandbox.picture.view import View

#: zlib's level for frames, which are many and passing. Measured by ``python benchmarks/frames.py --levels``, mean over
#: all scenes at 1280x720, ms on one core and kB: Pillow 24 and 171 at its quickest (level 1, RLE), 24 and 195 at
#: level 1, 45 and 142 at level 6, 292 and 131 at level 9. Most of the 24 ms go into choosing a filter for each line;
#: without filters, which flat colours hardly need, level 1 takes 9 and 192.
_FRAME_LEVEL = 1
#: Pillow's level for a poster, which is kept.
_POSTER_LEVEL = 6
#: Smaller than a GIF, in all colours. Each frame is whole: parts of frames leave traces of what has moved on, and take
#: no less room. "method" is the effort of the encoder, from 0 to 6: 3 takes twice the time for 2 %.
_WEBP = {"quality": 82, "method": 2, "kmin": 0, "kmax": 1}
#: ffmpeg's options: quality (lower is better, 18 looks as drawn), colours that all players know, and even sides.
_VIDEO = ["-crf", "18", "-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-movflags", "+faststart"]
#: The colours of a GIF are chosen from so many frames.
_PALETTE_FRAMES = 16
#: The index of what stays as it was, after all colours.
_SEE_THROUGH = 255
#: Pixels of all frames that wait to be written, at 3 bytes each.
MOST_PIXELS = 100_000_000
#: Viewers slow a GIF down that shows more frames per second than this.
FASTEST_GIF = 50
#: The last picture of an animation stays for so long, in s, before it begins again.
PAUSE = 2.0

#: A mark in every frame, by which those of an earlier run are told from files that a user put there.
_OURS = b"Software\0sports sandbox, one of the frames of a run"
_FRAMES = "frame_[0-9][0-9][0-9][0-9][0-9].png"

_Progress = Callable[[int, int], object]


def to_image(surface: pygame.Surface) -> Image.Image:
    """The surface as a Pillow image, RGB."""
    if (sys.byteorder, surface.get_bitsize(), surface.get_masks()[:3]) == ("little", 32, (0xFF0000, 0xFF00, 0xFF)):
        # The common layout, four times as fast.
        return Image.frombuffer("RGB", surface.get_size(), surface.get_view("0"), "raw", "BGRX", surface.get_pitch(), 1)
    return Image.frombytes("RGB", surface.get_size(), pygame.image.tobytes(surface, "RGB"))


def _film(picture: View[Any], times: Sequence[float], progress: _Progress | None) -> Iterator[Image.Image]:
    """The frames at these times in s, each drawn when it is asked for."""
    for done, t in enumerate(times, 1):
        yield to_image(picture.frame(t))
        if progress:
            progress(done, len(times))


def save_png(surface: pygame.Surface, path: Path | str) -> None:
    """Write a surface as PNG. Raises OSError where it cannot be written."""
    data = io.BytesIO()
    to_image(surface).save(data, "PNG", compress_level=_POSTER_LEVEL)
    _write(Path(path), data.getvalue())


def quick_png(image: Image.Image) -> bytes:
    """An RGB image as PNG, in half the time that Pillow needs: no line is filtered (see FRAME_LEVEL)."""
    width, height = image.size
    lines = np.zeros((height, 1 + 3 * width), np.uint8)  # each begins with its filter: 0 for none
    lines[:, 1:] = np.asarray(image).reshape(height, 3 * width)
    parts = {
        b"IHDR": struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0),  # 8 bits of red, green and blue
        b"tEXt": _OURS,
        b"IDAT": zlib.compress(lines.data, _FRAME_LEVEL),
        b"IEND": b"",
    }
    chunks = (
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(data, zlib.crc32(name)))
        for name, data in parts.items()
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def save_frames(picture: View[Any], run: Run, folder: Path | str, fps: float, progress: _Progress | None = None) -> int:
    """Write frame_00000.png, frame_00001.png, ... into a folder, all or none; returns how many.

    Frames of an earlier run are kept in a folder with ``~``, all of them, or a film made of the folder would end in two
    runs. Raises RequestError where a folder holds frames that somebody else made, OSError where it cannot be written.
    """
    folder = Path(folder)
    check_frames_folder("--frames", folder)
    folder.mkdir(parents=True, exist_ok=True)
    times = frame_times(run.duration, fps)
    names = [f"frame_{number:05d}.png" for number in range(len(times))]
    with folder_of_parts(folder, "frames") as part, ThreadPoolExecutor() as pool:
        written: deque[Future[int]] = deque()
        for name, image in zip(names, _film(picture, times, progress), strict=True):
            # Pillow and zlib do not hold Python up; no more pictures wait than keep all cores at work, fewer if large
            written.append(pool.submit(lambda file, image: file.write_bytes(quick_png(image)), part / name, image))
            while len(written) > min(2 * (os.cpu_count() or 1), MOST_PIXELS // (image.width * image.height)):
                written.popleft().result()
        for waiting in written:
            waiting.result()
        _keep_frames(folder, part)
        for name in names:
            (part / name).replace(folder / name)
    return len(times)


def _keep_frames(folder: Path, new: Path) -> None:
    """Move the frames of an earlier run into the folder with ``~``, unless the new ones are the same."""
    frames, backup = sorted(folder.glob(_FRAMES)), backup_of(folder.resolve())
    same = filecmp.cmpfiles(folder, new, [frame.name for frame in frames], shallow=False)[0]
    if len(same) == len(frames):
        return
    backup.mkdir(exist_ok=True)
    for older in backup.glob(_FRAMES):
        older.unlink()
    for frame in frames:
        frame.replace(backup / frame.name)


def check_frames_folder(option: str, folder: Path) -> None:
    """Raise RequestError if the folder, or that of its backup, has a file named like a frame that the sandbox did not
    write: it would be overwritten, or end up in the same film."""
    for place in (folder, backup_of(folder.resolve())):
        for file in sorted(place.glob(_FRAMES)):
            if not _is_ours(file):
                raise RequestError(
                    f"{option} {place}: {file.name} in it was not written by the sandbox; name another folder, or move "
                    "it"
                )


def _is_ours(file: Path) -> bool:
    """True if a file is a frame of an earlier run."""
    try:
        with file.open("rb") as opened:
            return opened.read(8 + 25 + 8 + len(_OURS)).endswith(b"tEXt" + _OURS)
    except OSError:
        return False


def save_gif(picture: View[Any], run: Run, path: Path | str, fps: float, progress: _Progress | None = None) -> int:
    """Write the run as an animated GIF that repeats; returns the number of frames.

    All frames share one palette, and times are rounded to the 10 ms that the format knows so that none is lost. Of each
    frame only what differs from the frame before is kept; Pillow alone would hold all frames in memory.
    Raises OSError where it cannot be written.
    """
    fps = min(fps, FASTEST_GIF)
    times, before = _moments(picture, fps), None
    colours = shared_palette(picture, times)
    palette = bytes(colours.getpalette("RGB") or []).ljust(3 * 256, b"\0")
    parts = []
    for image, stay in zip(_film(picture, times, progress), _durations(times, 10, fps), strict=True):
        shown = np.asarray(image.quantize(palette=colours, dither=Image.Dither.NONE))
        changed = shown if before is None else np.where(shown == before, _SEE_THROUGH, shown).astype(np.uint8)
        part, before = Image.frombytes("P", image.size, changed.tobytes()), shown
        parts += GifImagePlugin.getdata(part, duration=stay, transparency=_SEE_THROUGH, disposal=1)
    head = b"GIF89a" + struct.pack("<HHBBB", *image.size, 0b11110111, 0, 0) + palette  # 256 colours for all frames
    repeat = b"!\xff\x0bNETSCAPE2.0\x03\x01" + struct.pack("<H", 0) + b"\0"
    _write(Path(path), head + repeat + b"".join(parts) + b";")
    return len(times)


class _Film(Image.Image):
    """All frames as one image of Pillow's, each drawn when it is asked for."""

    def __init__(self, picture: View[Any], times: list[float], progress: _Progress | None):
        super().__init__()
        self.picture, self.times, self.progress = picture, times, progress
        self.n_frames, self.shown = len(times), -1
        self.seek(0)
        self._mode, self._size = self.im.mode, self.im.size

    def seek(self, frame: int) -> None:
        if frame != self.shown:
            self.im, self.shown = to_image(self.picture.frame(self.times[frame])).im, frame
            if self.progress:
                self.progress(frame + 1, self.n_frames)

    def tell(self) -> int:
        return self.shown


def save_webp(picture: View[Any], run: Run, path: Path | str, fps: float, progress: _Progress | None = None) -> int:
    """Write the run as an animated WebP that repeats, in all colours; returns the number of frames, of which equal ones
    are written as one. Raises OSError where it cannot be written.
    """
    times, data = _moments(picture, fps), io.BytesIO()
    film = _Film(picture, times, progress)
    film.save(data, "WEBP", save_all=True, duration=_durations(times, 1, fps), loop=0, **_WEBP)
    _write(Path(path), data.getvalue())
    return len(times)


def save_video(picture: View[Any], run: Run, path: Path | str, fps: float, progress: _Progress | None = None) -> int:
    """Write the run as a video (H.264 in MP4, which every player knows); returns the number of frames.

    A side with an odd number of px gets one more. Raises OSError where it cannot be written.
    """
    import imageio_ffmpeg

    times = _moments(picture, fps)
    times += [times[-1]] * round(PAUSE * fps)
    path = Path(path)
    if is_stream(path):
        raise RequestError(f"--video {path}: a video is not written in one piece; name a file")
    check_replaced("--video", path)
    with folder_of_parts(Path(os.path.realpath(path)).parent, "video") as folder:
        part = folder / "run.mp4"
        images = _film(picture, times, progress)
        first = next(images)
        encoder = imageio_ffmpeg.write_frames(
            str(part), first.size, fps=fps, macro_block_size=1, codec="libx264", quality=None,
            output_params=_VIDEO, ffmpeg_log_level="quiet",
        )  # fmt: skip
        try:
            encoder.send(None)
            for image in chain([first], images):
                encoder.send(image.tobytes())
        except OSError:
            raise OSError("ffmpeg stopped; is the disk full?") from None  # in place of its whole command
        finally:
            encoder.close()
        put_output(part, path)
    return len(times)


def _moments(picture: View[Any], fps: float) -> list[float]:
    """The times in s of the frames of an animation, at the pace of the picture's story, which the frames say."""
    picture.filmed = True
    return picture.film(fps)


def _durations(times: list[float], tick: int, fps: float) -> list[int]:
    """The time that each frame stays, in ms, where a format knows ticks of so many ms."""
    ends = [round(1000 / tick / fps * i) for i in range(len(times))]
    return [tick * (b - a) for a, b in pairwise(ends)] + [round(1000 * PAUSE)]


def shared_palette(picture: View[Any], times: list[float]) -> Image.Image:
    """255 colours for all frames, chosen from some of them.

    A colour counts by the square root of its area: small things such as ball and trace matter more than their size.
    """
    chosen = {times[round(i * (len(times) - 1) / (_PALETTE_FRAMES - 1))] for i in range(_PALETTE_FRAMES)}
    counts = np.zeros(1 << 18, np.int64)
    for t in sorted(chosen):
        for lines in np.array_split(np.asarray(to_image(picture.frame(t))), 16):  # some MB at a time
            packed = (lines >> 2).astype(np.uint32) @ np.array([1 << 12, 1 << 6, 1], np.uint32)
            counts += np.bincount(packed.ravel(), minlength=1 << 18)
    present = np.flatnonzero(counts)
    colours = np.stack([present >> 12, present >> 6 & 63, present & 63], axis=1).astype(np.uint8) << 2 | 2
    row = np.repeat(colours, np.ceil(np.sqrt(counts[present])).astype(int), axis=0)
    return Image.fromarray(row[None]).quantize(
        _SEE_THROUGH, method=Image.Quantize.MEDIANCUT, kmeans=2, dither=Image.Dither.NONE
    )


def _write(path: Path, data: bytes) -> None:
    with atomic_write(path) as file:
        file.buffer.write(data)
