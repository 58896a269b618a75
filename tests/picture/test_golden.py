"""Golden pictures: what passes, what fails, what is written when."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from sandbox.golden import NEIGHBOURHOOD, ROUNDING_LEVELS, compare
from sandbox.picture.frames import to_image
from sandbox.picture.painter import Painter, blank

pytest_plugins = ["pytester"]

SKY, BALL, RIM = (190, 220, 230), (255, 255, 255), (42, 22, 8)


def ball(x: float = 60.0, radius: float = 3.5, rim: bool = True) -> Image.Image:
    """A white ball on a pale sky."""
    surface = blank((160, 90))
    surface.fill(SKY)
    painter = Painter(surface)
    if rim:
        painter.disc((x, 45.0), radius + 0.8, RIM, 0.65)
    painter.disc((x, 45.0), radius, BALL)
    return to_image(surface)


@pytest.mark.parametrize("rim", [True, False])
@pytest.mark.parametrize("radius", [3.5, 7.0, 12.0])
class TestABall:
    def test_is_like_itself(self, radius, rim):
        assert not compare(ball(radius=radius, rim=rim), ball(radius=radius, rim=rim)).matters

    def test_that_is_one_pixel_larger_fails(self, radius, rim):
        assert compare(ball(radius=radius, rim=rim), ball(radius=radius + 0.5, rim=rim)).matters

    def test_that_moved_by_half_a_pixel_fails(self, radius, rim):
        assert compare(ball(radius=radius, rim=rim), ball(x=60.5, radius=radius, rim=rim)).matters


def test_one_edge_pixel_smoothed_differently_passes():
    other = ball()
    other.putpixel((56, 45), (120, 130, 140))
    difference = compare(ball(), other)
    assert difference.largest > 3 * ROUNDING_LEVELS
    assert not difference.matters


def test_rounding_of_every_pixel_passes():
    noise = np.random.default_rng(1).integers(-3, 4, (90, 160, 3))
    other = Image.fromarray(np.clip(np.asarray(ball()).astype(int) + noise, 0, 255).astype(np.uint8))
    assert not compare(ball(), other).matters


def test_many_single_pixels_fail_together():
    other = ball()
    for x in range(NEIGHBOURHOOD, 160, 2 * NEIGHBOURHOOD):
        other.putpixel((x, 10), (0, 0, 0))
    assert compare(ball(), other).matters


def test_a_line_of_text_in_another_colour_fails():
    other = ball()
    for x in range(100, 104):
        other.putpixel((x, 80), tuple(level - ROUNDING_LEVELS - 1 for level in SKY))
    assert compare(ball(), other).matters


@pytest.fixture
def project(pytester, monkeypatch):
    """A project of its own with one golden test, whose picture the environment chooses."""
    monkeypatch.delenv("CI", raising=False)
    pytester.makepyfile(
        test_it="""
        import os
        from PIL import Image

        def test_it(golden):
            golden.check("it", Image.new("RGB", (40, 30), os.environ.get("COLOUR", "white")))
        """
    )
    return pytester


def run(project, *options: str):
    return project.runpytest("-p", "sandbox.golden", "-p", "no:cacheprovider", *options)


class TestThePlugin:
    def test_a_missing_picture_fails_and_says_how_to_make_it(self, project):
        result = run(project)
        result.assert_outcomes(failed=1)
        result.stdout.fnmatch_lines(["*it has no golden picture*pytest --golden-update*"])
        assert not (project.path / "golden").exists()

    def test_update_makes_it_and_says_so(self, project):
        result = run(project, "--golden-update")
        result.assert_outcomes(passed=1)
        result.stdout.fnmatch_lines(["*golden pictures written*", "*it.png: new"])
        run(project).assert_outcomes(passed=1)

    def test_a_change_fails_and_shows_both_and_the_difference(self, project, monkeypatch):
        run(project, "--golden-update")
        monkeypatch.setenv("COLOUR", "red")
        result = run(project)
        result.assert_outcomes(failed=1)
        result.stdout.fnmatch_lines(["*100.00% of the pixels changed, the most by 255 of 255 levels*"])
        with Image.open(project.path / "out" / "golden" / "it.png") as shown:
            assert shown.size == (3 * 40 + 2 * 8, 30)
            assert shown.convert("RGB").getpixel((60, 15)) == (255, 0, 0)

    def test_update_leaves_alone_what_has_not_changed(self, project):
        run(project, "--golden-update")
        before = (project.path / "golden" / "it.png").stat().st_mtime_ns
        result = run(project, "--golden-update")
        result.stdout.no_fnmatch_line("*golden pictures written*")
        assert (project.path / "golden" / "it.png").stat().st_mtime_ns == before

    def test_update_lists_what_other_processes_wrote(self, project):
        result = run(project, "--golden-update", "--numprocesses=1")
        result.stdout.fnmatch_lines(["*it.png: new"])

    def test_nothing_is_written_on_ci(self, project, monkeypatch):
        monkeypatch.setenv("CI", "true")
        assert run(project, "--golden-update").ret == pytest.ExitCode.USAGE_ERROR
        assert not (project.path / "golden").exists()

    def test_a_folder_above_the_test_is_used(self, project):
        (project.path / "golden").mkdir()
        test = project.mkdir("deeper") / "test_deeper.py"
        test.write_text((project.path / "test_it.py").read_text())
        run(project, "--golden-update", str(test)).assert_outcomes(passed=1)
        assert (project.path / "golden" / "it.png").exists()


def test_golden_pictures_are_small():
    pictures = list((Path(__file__).parents[1] / "golden").glob("*.png"))
    assert pictures
    assert all(picture.stat().st_size < 60_000 for picture in pictures)
