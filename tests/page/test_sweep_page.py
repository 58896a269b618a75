"""The page of a sweep, in a real browser: the point under the cursor, its numbers and its path."""

from __future__ import annotations

import base64
import json
import re
import shlex
import zlib
from html import unescape
from pathlib import Path

import numpy as np
import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

import sandbox
from sandbox.cli import main

OVER = {"launch.speed": np.linspace(6.8, 8.6, 10), "launch.angle": np.linspace(40.0, 70.0, 7)}


def test_the_point_under_the_cursor(browser, tmp_path: Path, capsys):
    page = tmp_path / "map.html"
    over = [f"--over={key}={values[0]}:{values[-1]}:{len(values)}" for key, values in OVER.items()]
    assert main(["sweep", "basketball", *over, "--out", str(tmp_path / "map.csv"), "--html", str(page)]) == 0
    assert f"wrote {page}" in capsys.readouterr().out
    browser.open(page)
    sweep = sandbox.sweep("basketball", OVER)
    i = 4 * 7 + 2
    x, y = browser.run(f"explorer.at({i})")
    chart = browser.driver.find_element(By.ID, "map")
    box = chart.rect
    ActionChains(browser.driver).move_to_element_with_offset(
        chart, round(x - box["width"] / 2), round(y - box["height"] / 2)
    ).perform()
    said = dict(zip(browser.text("#here dt"), browser.text("#here dd"), strict=True))
    row = sweep.records[i]
    assert said["launch.angle"] == f"{row['launch.angle']:.1f}°"
    assert said["verdict"] == row["verdict"]
    run = sandbox.simulate(sandbox.load("basketball", {key: row[key] for key in OVER}))
    path = np.array(browser.run("explorer.points(explorer.chosen)"))
    width = np.ptp(run.trajectory("ball")[:, 1])
    for near in path[[0, len(path) // 2]]:  # the page draws to a px
        assert np.hypot(*(run.trajectory("ball", 1e-3)[:, 1:3] - near).T).min() < 0.01 * width
    ActionChains(browser.driver).click(chart).send_keys_to_element(chart, "").perform()
    before = browser.run("explorer.chosen")
    chart.send_keys("\ue014")  # the right arrow
    assert browser.run("explorer.chosen") == before + 7
    browser.resize(390, 844, dark=True)
    assert browser.run("document.documentElement.scrollWidth") <= 390
    assert browser.complaints() == []


@pytest.mark.parametrize(
    "asked",
    [
        ["basketball", "--over=launch.speed=6.9:8.5:7", '--over=launch.angle="0.8 rad","0.9 rad"', "--of=entry_angle"],
        ["throws", "--over=launch.speed=29 mph:31 mph", "--samples=9", "--seed=3", "--check"],
        ["golf/driver", "--set=air.wind[0]=-3", "--over=ball.drag.model=tour-fit,usga", "--over=launch.angle=9:12:4"],
    ],
    ids=lambda asked: asked[0].partition("/")[0],
)
def test_the_command_on_a_page_makes_that_page(asked: list[str], tmp_path: Path, monkeypatch):
    """As pasted: the same rows and the same page."""
    monkeypatch.chdir(tmp_path)
    assert main(["sweep", *asked, "--out=first.csv", "--html=first.html"]) == 0
    page = Path("first.html").read_text("utf-8")
    words = shlex.split(unescape(page.partition("<code>")[2].partition("</code>")[0]))
    assert main(words[1:]) == 0
    assert Path("sweep.html").read_text("utf-8") == page
    assert Path("sweep.csv").read_text("utf-8") == Path("first.csv").read_text("utf-8")


def test_each_point_is_where_the_chart_has_its_mark(tmp_path: Path):
    """At first the one nearest to the scene file's own shot, of 35.7 deg, is chosen."""
    page = tmp_path / "curve.html"
    asked = ["--over=launch.angle=20:60:9", f"--out={tmp_path / 'curve.csv'}", f"--html={page}", "--of=distance"]
    assert main(["sweep", "throws", *asked]) == 0
    text = page.read_text("utf-8")
    data = json.loads(zlib.decompress(base64.b64decode(re.search('id="data">([^<]*)', text)[1])))
    wide, tall = map(float, re.search('viewBox="0 0 ([0-9. ]+)"', text)[1].split())
    marks = re.findall('(?i)<use [^>]*x="([0-9.]+)" y="([0-9.]+)" style="fill: #d55e00', text)
    places = [(x * wide, y * tall) for x, y in zip(data["x"], data["y"], strict=True)]
    assert np.allclose(np.array(marks, float), places, atol=0.02)
    angles = np.linspace(20.0, 60.0, 9)
    own = sandbox.load("throws").parameters.launch.angle
    assert data["chosen"] == np.argmin(abs(angles - own))


def test_a_curve_and_what_is_too_much(browser, tmp_path: Path, capsys):
    page, out = tmp_path / "curve.html", tmp_path / "curve.csv"
    asked = ["sweep", "throws", "--set=launch.speed=13", "--over=launch.angle=20:60:9"]
    assert main([*asked, f"--out={out}", f"--html={page}"]) == 0
    said = "sandbox sweep throws --set launch.speed=13 --over launch.angle=20:60:9 --out sweep.csv"
    assert said in page.read_text()
    browser.open(page)
    assert browser.run("explorer.data.x.length") == 9
    assert browser.complaints() == []
    large = ["--over=launch.angle=20:60:100", "--over=launch.speed=10:15:100"]
    assert main(["sweep", "throws", *large, f"--out={out}", f"--html={page}"]) == 2
    assert "6,000" in capsys.readouterr().err


@pytest.mark.parametrize("flag", ["--of=carry"])
def test_of_goes_with_a_page(flag: str, tmp_path: Path, capsys):
    assert main(["sweep", "golf", "--over=launch.angle=5:60:5", f"--out={tmp_path / 'a.csv'}", flag]) == 2
    assert "--plot or --html" in capsys.readouterr().err
