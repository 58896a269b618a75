"""Pictures to files: whole or not at all, as many as asked, as long as the run."""

import io
import re
import subprocess
import tracemalloc
from pathlib import Path

import numpy as np
import pygame
import pytest
from PIL import Image

import sandbox
from sandbox.picture import frames
from sandbox.picture.frames import (
    FASTEST_GIF,
    PAUSE,
    frame_times,
    quick_png,
    save_frames,
    save_gif,
    save_png,
    save_video,
    save_webp,
    to_image,
)
from sandbox.picture.painter import Painter, blank
from sandbox.picture.sheet import Sheet

ORANGE = (213, 94, 0)


class Run:
    def __init__(self, duration: float):
        self.duration = duration


class Picture:
    """A ball that goes from left to right over grey; it may fail at a time."""

    filmed = False

    def film(self, fps: float) -> list[float]:
        return frame_times(self.run.duration, fps)

    def __init__(self, run: Run, fails_at: float = np.inf):
        self.run, self.fails_at = run, fails_at

    def poster(self) -> pygame.Surface:
        return self.frame(0.0)

    def frame(self, t: float) -> pygame.Surface:
        if t >= self.fails_at:
            raise ZeroDivisionError("the picture failed")
        surface = blank((96, 54))
        surface.fill((120, 130, 140))
        Painter(surface).disc((10 + 70 * t / self.run.duration, 27), 4, ORANGE)
        return surface


def ball_at(image: Image.Image) -> float:
    """Where the ball is along x, in px."""
    pixels = np.asarray(image.convert("RGB")).astype(int)
    weight = np.clip(pixels[:, :, 0] - pixels[:, :, 2], 0, None).sum(axis=0)
    return float((np.arange(len(weight)) + 0.5) @ weight / weight.sum())


def test_pixels_keep_their_colours():
    surface = blank((3, 2))
    surface.set_at((2, 1), (1, 2, 3))
    assert to_image(surface).getpixel((2, 1)) == (1, 2, 3)
    other = pygame.Surface((3, 2), 0, 24)
    other.set_at((0, 1), (9, 8, 7))
    assert to_image(other).getpixel((0, 1)) == (9, 8, 7)


def test_an_image_does_not_change_with_its_surface():
    surface = blank((3, 2))
    image = to_image(surface)
    surface.fill((255, 255, 255))
    assert image.getpixel((0, 0)) == (0, 0, 0)


@pytest.mark.parametrize("size", [(96, 54), (7, 3), (1, 1)])
def test_quick_packing_loses_nothing(size):
    image = Image.fromarray(np.random.default_rng(4).integers(0, 256, (*size[::-1], 3), np.uint8))
    with Image.open(io.BytesIO(quick_png(image))) as packed:
        packed.verify()
    with Image.open(io.BytesIO(quick_png(image))) as packed:
        assert (packed.format, packed.mode, packed.size) == ("PNG", "RGB", size)
        assert packed.tobytes() == image.tobytes()


class TestPosters:
    def test_is_a_png(self, tmp_path):
        save_png(Picture(Run(1.0)).poster(), tmp_path / "poster.png")
        with Image.open(tmp_path / "poster.png") as image:
            assert (image.format, image.size) == ("PNG", (96, 54))
        assert [path.name for path in tmp_path.iterdir()] == ["poster.png"]

    def test_what_was_there_stays_when_the_disk_is_full(self, tmp_path, monkeypatch):
        (tmp_path / "poster.png").write_bytes(b"before")
        full = _fails_after(10)
        monkeypatch.setattr("sandbox.picture.frames.atomic_write", full)
        with pytest.raises(OSError, match="No space left"):
            save_png(blank((96, 54)), tmp_path / "poster.png")
        assert (tmp_path / "poster.png").read_bytes() == b"before"

    def test_a_folder_that_is_not_there(self, tmp_path):
        with pytest.raises(FileNotFoundError):
            save_png(blank((4, 4)), tmp_path / "nowhere" / "poster.png")


def _fails_after(count: int):
    """``atomic_write`` on a disk that has room for so many bytes."""
    from contextlib import contextmanager

    from sandbox.files import atomic_write

    class Full:
        def __init__(self, file):
            self.file = file

        def write(self, data: bytes) -> None:
            self.file.write(data[:count])
            raise OSError(28, "No space left on device")

    class Text:
        def __init__(self, file):
            self.buffer = Full(file.buffer)

    @contextmanager
    def full(path):
        with atomic_write(path) as file:
            yield Text(file)

    return full


class TestFrames:
    def test_one_for_each_time_and_the_end(self, tmp_path):
        run = Run(1.03)
        assert save_frames(Picture(run), run, tmp_path / "film", 10) == 12  # 0.0, 0.1, ... 1.0, and 1.03
        files = sorted((tmp_path / "film").iterdir())
        assert [file.name for file in files] == [f"frame_{i:05d}.png" for i in range(12)]
        for file, t in zip(files, [*np.arange(11) / 10, 1.03], strict=True):
            with Image.open(file) as image:
                assert ball_at(image) == pytest.approx(10 + 70 * t / 1.03, abs=0.2)

    def test_a_longer_film_before_leaves_nothing_behind(self, tmp_path):
        (tmp_path / "notes.txt").write_text("mine")
        for duration in (2.0, 1.0):
            save_frames(Picture(Run(duration)), Run(duration), tmp_path, 5)
        assert len(list(tmp_path.glob("frame_*.png"))) == 6
        assert (tmp_path / "notes.txt").read_text() == "mine"

    def test_tells_how_far_it_is(self, tmp_path):
        run, told = Run(1.0), []
        save_frames(Picture(run), run, tmp_path, 10, progress=lambda done, total: told.append((done, total)))
        assert told == [(i, 11) for i in range(1, 12)]


@pytest.mark.parametrize(
    ("duration", "fps", "times"),
    [
        (1.0, 4, [0.0, 0.25, 0.5, 0.75, 1.0]),
        (0.3, 10, [0.0, 0.1, 0.2, 0.3]),  # 0.3 * 10 is a little less than 3
        (0.9, 2, [0.0, 0.5, 0.9]),
        (1.001, 2, [0.0, 0.5, 1.001]),
        (0.0, 30, [0.0]),
    ],
)
def test_times_of_frames(duration, fps, times):
    assert frame_times(duration, fps) == pytest.approx(times)


SAVERS = {"": save_frames, ".gif": save_gif, ".webp": save_webp}


@pytest.mark.parametrize("suffix", SAVERS)
def test_all_or_nothing(tmp_path, suffix):
    run = Run(1.0)
    (tmp_path / "film").mkdir()
    with pytest.raises(ZeroDivisionError):
        SAVERS[suffix](Picture(run, fails_at=0.7), run, tmp_path / "film" / (suffix and f"run{suffix}"), 20)
    assert list((tmp_path / "film").iterdir()) == []


def read(path: Path) -> tuple[list[Image.Image], list[int]]:
    """The frames of an animation, and how long each stays in ms."""
    with Image.open(path) as image:
        frames, stays = [], []
        for i in range(image.n_frames):
            image.seek(i)
            frames.append(image.convert("RGB"))
            stays.append(image.info["duration"])
        assert image.info["loop"] == 0
    return frames, stays


@pytest.mark.parametrize(("suffix", "fps"), [(".gif", 10), (".gif", 24), (".gif", 30), (".webp", 10), (".webp", 60)])
def test_frames_and_how_long_they_stay(tmp_path, suffix, fps):
    run = Run(2.0)
    count = SAVERS[suffix](Picture(run), run, tmp_path / f"run{suffix}", fps)
    frames, stays = read(tmp_path / f"run{suffix}")
    assert len(frames) == count == 2 * fps + 1
    assert sum(stays[:-1]) == 2000  # ms, though 1/24 s and 1/30 s are no multiples of a GIF's 10 ms
    assert stays[-1] == 1000 * PAUSE
    for i in (0, fps, 2 * fps):
        assert ball_at(frames[i]) == pytest.approx(10 + 35 * i / fps, abs=0.6)


class TestGif:
    def test_small_things_keep_their_colour(self, tmp_path):
        run = Run(1.0)
        save_gif(Picture(run), run, tmp_path / "run.gif", 10)
        frames, _ = read(tmp_path / "run.gif")
        assert frames[5].getpixel((45, 27)) == pytest.approx(ORANGE, abs=4)

    def test_no_faster_than_viewers_show(self, tmp_path):
        run = Run(0.5)
        assert save_gif(Picture(run), run, tmp_path / "run.gif", 120) == FASTEST_GIF * 0.5 + 1


@pytest.mark.parametrize(
    ("source", "slower"),
    [
        ("volleyball/spike", 4),
        ("baseball-pitch", 4),
        ("tennis", 4),
        ("bullet-water", 16),
        ("golf", 1),
        ("basketball", 1),
    ],
)
def test_what_is_over_in_half_a_second_is_in_slow_motion(source, slower):
    run = sandbox.simulate(source)
    assert run.scene.picture(run, (320, 180)).slow_motion == slower


def test_an_animation_in_slow_motion_lasts_longer_and_says_so(tmp_path, monkeypatch):
    run = sandbox.simulate("volleyball/spike")
    picture, notes = run.scene.picture(run, (320, 180)), []
    headline = Sheet.headline
    monkeypatch.setattr(Sheet, "headline", lambda self, *said: notes.append(said[1]) or headline(self, *said))
    count = save_gif(picture, run, tmp_path / "run.gif", 10)
    _, stays = read(tmp_path / "run.gif")
    work = picture.camerawork  # which goes on for a while after the end
    assert count == len(stays) == int(10 * work.lasts) + 1
    assert sum(stays[:-1]) == pytest.approx(1000 * work.lasts, abs=120)
    assert work.lasts - work.goes_on >= 4 * run.duration - 1e-6
    assert any("slow motion, 4 times slower" in said for said in notes)


def test_frames_that_are_alike(tmp_path):
    """Are one that stays as long."""
    run = Run(1.0)

    class Still(Picture):
        def frame(self, t):
            return super().frame(0.0 if t < 0.5 else 1.0)

    assert save_webp(Still(run), run, tmp_path / "run.webp", 10) == 11
    (_, last), stays = read(tmp_path / "run.webp")
    assert stays[1] == 500 + 1000 * PAUSE
    assert ball_at(last) == pytest.approx(80, abs=0.6)


class TestMemory:
    def test_large_pictures_wait_in_small_numbers(self, monkeypatch, tmp_path):
        packed, waiting = [], []
        monkeypatch.setattr(frames, "MOST_PIXELS", 3 * 96 * 54)
        monkeypatch.setattr(frames, "quick_png", lambda image: packed.append(image) or b"")

        class Counting(Picture):
            def frame(self, t):
                waiting.append(len(waiting) - len(packed))
                return super().frame(t)

        save_frames(Counting(Run(3.0)), Run(3.0), tmp_path, 10)
        assert len(packed) == 31
        assert max(waiting) <= 3

    def test_a_palette_takes_no_more_memory_for_more_frames(self):
        class Large:
            def frame(self, t: float) -> pygame.Surface:
                return blank((960, 540))

        tracemalloc.start()
        try:
            frames.shared_palette(Large(), [t / 10 for t in range(200)])
            assert tracemalloc.get_traced_memory()[1] < 20e6  # bytes; the pixels of 16 such frames alone are 25e6
        finally:
            tracemalloc.stop()


def test_a_video_has_every_frame_and_a_gif_is_small(tmp_path: Path):
    """The video read back: its size (one px more where a side is odd), its rate, and colours close to those drawn."""
    imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")
    run = sandbox.simulate("throws")
    picture = run.scene.picture(run, (321, 180))
    count = save_video(picture, run, tmp_path / "a.mp4", 10)
    # By itself: imageio_ffmpeg.read_frames leaves its pipes open where ffmpeg has ended before it.
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", tmp_path / "a.mp4", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    read = subprocess.run(command, capture_output=True, check=True)
    assert re.search(r"Video: h264.* 322x180.* 10 fps", read.stderr.decode())
    shown = np.frombuffer(read.stdout, np.uint8).reshape(-1, 180, 322, 3)
    assert len(shown) == count
    drawn = np.asarray(to_image(picture.frame(1.0)))
    assert np.abs(shown[10][:, :321].astype(int) - drawn).mean() < 6
    assert sorted(tmp_path.iterdir()) == [tmp_path / "a.mp4"]
