"""A pytest plugin that compares pictures with golden ones kept beside the tests.

    def test_my_scene(golden):
        golden.check("my_scene", picture.poster())

The golden picture is ``golden/my_scene.png`` in the folder of the test or the nearest one above it.
``pytest --golden-update`` makes and rewrites golden pictures and lists them for review; on CI, where the variable CI is
set, nothing is ever written.

The comparison is our own. Pixelmatch was tried: it forgives what it takes for anti-aliasing, and that is where a small
white ball on a pale sky differs when it is larger by a pixel all around (it counts 0 pixels, this counts 44); and it
takes 0.8 s for 640x360.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    import numpy as np
    from PIL import Image

#: A pixel has changed when a channel differs by more than this, of 255. Another machine's rounding moves it by 1 or 2,
#: a ball moved by a quarter of a pixel by 20 and more.
ROUNDING_LEVELS = 8
#: So many changed pixels may stand within NEIGHBOURHOOD px of each other: an edge pixel or two that was rounded the
#: other way. A ball of 7 px that is moved by half a pixel changes a dozen.
STRAY_PIXELS = 3
NEIGHBOURHOOD = 9
#: Share of all pixels that may have changed, strays all over the picture.
STRAY_SHARE = 0.0005

FOLDER = "golden"
REPORT = Path("out", "golden")


@dataclass(frozen=True)
class Difference:
    """How a picture differs from the golden one."""

    share: float  # of the pixels that have changed, 0 to 1
    largest: int  # levels, 0 to 255
    together: int  # most changed pixels within NEIGHBOURHOOD px
    at: tuple[int, int]  # middle of that neighbourhood, px

    @property
    def matters(self) -> bool:
        """Whether it is more than another machine's rounding."""
        return self.together > STRAY_PIXELS or self.share > STRAY_SHARE

    def __str__(self) -> str:
        return (
            f"{self.share:.2%} of the pixels changed, the most by {self.largest} of 255 levels; "
            f"{self.together} together near x = {self.at[0]}, y = {self.at[1]}"
        )


def compare(expected: Image.Image, actual: Image.Image) -> Difference:
    """How two pictures of the same size differ. Raises ValueError where their sizes do."""
    import numpy as np

    if expected.size != actual.size:
        raise ValueError(f"it is {actual.width}x{actual.height}, the golden one {expected.width}x{expected.height}")
    levels = _levels(expected, actual)
    changed = levels > ROUNDING_LEVELS
    # Sums over squares, from the sums over all that is above and to the left.
    reach = NEIGHBOURHOOD // 2
    sums = np.pad(np.pad(changed, reach).cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    near = sums[NEIGHBOURHOOD:, NEIGHBOURHOOD:] - sums[:-NEIGHBOURHOOD, NEIGHBOURHOOD:]
    near = near - sums[NEIGHBOURHOOD:, :-NEIGHBOURHOOD] + sums[:-NEIGHBOURHOOD, :-NEIGHBOURHOOD]
    row, column = np.unravel_index(int(near.argmax()), near.shape)
    return Difference(float(changed.mean()), int(levels.max()), int(near.max()), (int(column), int(row)))


def _levels(expected: Image.Image, actual: Image.Image) -> np.ndarray:
    """Largest difference of the three channels at each pixel, shape (height, width)."""
    import numpy as np

    a, b = (np.asarray(image.convert("RGB")).astype(np.int16) for image in (expected, actual))
    return np.abs(a - b).max(axis=2)


def side_by_side(expected: Image.Image, actual: Image.Image) -> Image.Image:
    """Expected, actual, and the difference: changed pixels red on a pale copy."""
    import numpy as np
    from PIL import Image

    images = [expected.convert("RGB"), actual.convert("RGB")]
    if expected.size == actual.size:
        levels = _levels(expected, actual)
        pale = 170 + np.asarray(expected.convert("L"))[:, :, None] // 3 * np.ones(3, np.uint8)
        pale[levels > ROUNDING_LEVELS] = (220, 20, 20)
        images.append(Image.fromarray(pale.astype(np.uint8)))
    sheet = Image.new(
        "RGB", (sum(i.width for i in images) + 8 * (len(images) - 1), max(i.height for i in images)), "white"
    )
    left = 0
    for image in images:
        sheet.paste(image, (left, 0))
        left += image.width + 8
    return sheet


class Golden:
    """The fixture: compares pictures with the golden ones of one test."""

    def __init__(self, folder: Path, report: Path, update: bool, tell: Callable[[str], None]):
        self.folder, self.report, self.update, self.tell = folder, report, update, tell

    def check(self, name: str, picture: Any) -> None:
        """Fail unless the picture (a pygame surface or a Pillow image) is like the golden one of that name."""
        from PIL import Image

        actual = _as_image(picture)
        path = self.folder / f"{name}.png"
        expected = None
        if path.exists():
            with Image.open(path) as file:
                expected = file.convert("RGB")
        problem = _problem(expected, actual)
        if problem is None:
            return
        if self.update:
            path.parent.mkdir(parents=True, exist_ok=True)
            _save(actual, path)
            self.tell(f"{path}: {problem}")
            return
        if expected is None:
            pytest.fail(f"{name} has no golden picture at {path}; make it with pytest --golden-update", pytrace=False)
        self.report.mkdir(parents=True, exist_ok=True)
        shown = self.report / f"{name}.png"
        _save(side_by_side(expected, actual), shown)
        pytest.fail(
            f"{name} is not like its golden picture: {problem}\n"
            f"expected, actual and difference, side by side: {shown}\n"
            f"if the change is meant: pytest --golden-update",
            pytrace=False,
        )


def _problem(expected: Image.Image | None, actual: Image.Image) -> str | None:
    """What is wrong with the actual picture, in words; None where it will do."""
    if expected is None:
        return "new"
    try:
        difference = compare(expected, actual)
    except ValueError as error:
        return str(error)
    return str(difference) if difference.matters else None


def _as_image(picture: Any) -> Image.Image:
    from PIL import Image

    if isinstance(picture, Image.Image):
        return picture.convert("RGB")
    from sandbox.picture.frames import to_image

    return to_image(picture)


def _save(image: Image.Image, path: Path) -> None:
    part = path.with_suffix(f".{os.getpid()}.part")
    try:
        image.save(part, "PNG", optimize=True)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def _folder_for(test: Path, root: Path) -> Path:
    """The folder ``golden`` beside a test, or the nearest above it; where there is none, one will be made beside it."""
    for parent in test.parents:
        if (parent / FOLDER).is_dir():
            return parent / FOLDER
        if parent == root:
            break
    return test.parent / FOLDER


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--golden-update", action="store_true", help="make and rewrite golden pictures, and list them")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--golden-update") and os.environ.get("CI", "").lower() not in ("", "0", "false"):
        raise pytest.UsageError("--golden-update: golden pictures are never written on CI, and the variable CI is set")


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Golden:
    """Compares pictures with golden ones: ``golden.check("name", picture)``."""

    def tell(line: str) -> None:
        # Kept with the test's report, which is how it gets home from another process.
        request.node.user_properties.append(("golden", line))

    config = request.config
    folder = _folder_for(request.path, config.rootpath)
    return Golden(folder, config.rootpath / REPORT, bool(config.getoption("--golden-update")), tell)


def pytest_terminal_summary(terminalreporter: Any) -> None:
    reports = [report for kind in ("passed", "failed") for report in terminalreporter.stats.get(kind, [])]
    lines = sorted({line for r in reports for key, line in getattr(r, "user_properties", ()) if key == "golden"})
    if lines:
        terminalreporter.section("golden pictures written, to be looked at")
        for line in lines:
            terminalreporter.line(line)
