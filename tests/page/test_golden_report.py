"""All golden failures as one page: pictures with a slider, and which ball differs, when, in which quantity."""

from __future__ import annotations

pytest_plugins = ["pytester"]

TEST = """
import sandbox
from PIL import Image

def test_shot(golden):
    golden.check("shot", sandbox.simulate(sandbox.load("throws", {"launch.speed": SPEED})))

def test_picture(golden):
    golden.check("picture", Image.new("RGB", (64, 36), COLOUR))
"""


def made(speed: str, colour: str) -> str:
    return TEST.replace("SPEED", speed).replace("COLOUR", colour)


def test_failures_are_one_page(pytester, browser, monkeypatch):
    monkeypatch.delenv("CI", raising=False)
    pytester.makepyfile(made("13.0", "'red'"))
    pytester.runpytest("--golden-update", "--golden-report", "out/all.html").assert_outcomes(passed=2)
    assert "No golden failures" in (pytester.path / "out" / "all.html").read_text("utf-8")
    pytester.makepyfile(made("13.1", "'blue'"))
    result = pytester.runpytest("--golden-report", "out/all.html")
    result.assert_outcomes(failed=2)
    result.stdout.fnmatch_lines(["*golden failures as a page: *all.html"])
    browser.resize(1280, 900)
    browser.driver.get((pytester.path / "out" / "all.html").as_uri())
    assert browser.text("h1") == ["2 golden failures"]
    assert browser.text("h2") == ["picture", "shot"]
    differs = browser.text("li")
    assert any("ball, vx is" in line and "was" in line for line in differs)
    assert any(line.startswith("distance is") for line in differs)
    browser.run(
        "(() => { const range = document.querySelector('input'); range.value = 80; "
        "range.dispatchEvent(new Event('input')); })()"
    )
    assert "80%" in browser.run("document.querySelector('.above').style.clipPath")
    assert browser.run("[...document.images].every((image) => image.naturalWidth > 0)")
    assert browser.complaints() == []


def test_missing_damaged_and_resized_goldens_are_on_the_page(pytester, browser, monkeypatch):
    monkeypatch.delenv("CI", raising=False)
    pytester.makepyfile(made("13.0", "'red'"))
    pytester.runpytest("--golden-report", "all.html").assert_outcomes(failed=2)
    browser.driver.get((pytester.path / "all.html").as_uri())
    assert browser.text("h1") == ["2 golden failures"]
    assert all("has no golden picture" in line for line in browser.text("section > p:nth-of-type(2)"))
    assert browser.text("figcaption") == ["actual", "actual"]
    assert browser.run("[...document.images].every((image) => image.naturalWidth > 0)")
    pytester.runpytest("--golden-update")
    (pytester.path / "golden" / "shot.json").write_text("[]")
    pytester.makepyfile(made("13.0", "'red'").replace("(64, 36)", "(64, 40)"))
    pytester.runpytest("--golden-report", "all.html").assert_outcomes(failed=2)
    browser.driver.get((pytester.path / "all.html").as_uri())
    said = browser.text("section > p:nth-of-type(2)")
    assert "it is 64x40, the golden one 64x36" in said[0]
    assert "is damaged: not a record of a run" in said[1]
    assert browser.text("figcaption") == ["expected", "actual", "actual"]
    assert browser.complaints() == []


def test_another_name_is_refused(pytester):
    result = pytester.runpytest("--golden-report", "report.txt")
    result.stderr.fnmatch_lines(["*--golden-report report.txt: its name must end in .html*"])
