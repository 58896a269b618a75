"""The page of a sweep, in a real browser: the point under the cursor, its numbers and its path."""

from __future__ import annotations

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
    canvas = browser.driver.find_element(By.ID, "map")
    box = canvas.rect
    ActionChains(browser.driver).move_to_element_with_offset(
        canvas, round(x - box["width"] / 2), round(y - box["height"] / 2)
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
    ActionChains(browser.driver).click(canvas).send_keys_to_element(canvas, "").perform()
    before = browser.run("explorer.chosen")
    canvas.send_keys("\ue014")  # the right arrow
    assert browser.run("explorer.chosen") == before + 7
    browser.resize(390, 844, dark=True)
    assert browser.run("document.documentElement.scrollWidth") <= 390
    assert browser.complaints() == []


def test_a_curve_and_what_is_too_much(browser, tmp_path: Path, capsys):
    page, out = tmp_path / "curve.html", tmp_path / "curve.csv"
    asked = ["sweep", "throws", "--set=launch.speed=13.0", "--over=launch.angle=20:60:9"]
    assert main([*asked, f"--out={out}", f"--html={page}"]) == 0
    said = "sandbox sweep throws --set launch.speed=13.0 --over launch.angle=20:60:9 --out sweep.csv"
    assert said in page.read_text()
    browser.open(page)
    assert browser.run("explorer.data.curves[0].points.length") == 9
    assert browser.complaints() == []
    large = ["--over=launch.angle=20:60:100", "--over=launch.speed=10:15:100"]
    assert main(["sweep", "throws", *large, f"--out={out}", f"--html={page}"]) == 2
    assert "6,000" in capsys.readouterr().err


@pytest.mark.parametrize("flag", ["--of=carry"])
def test_of_goes_with_a_page(flag: str, tmp_path: Path, capsys):
    assert main(["sweep", "golf", "--over=launch.angle=5:60:5", f"--out={tmp_path / 'a.csv'}", flag]) == 2
    assert "--plot or --html" in capsys.readouterr().err
