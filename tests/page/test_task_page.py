"""The page of a finished game."""

from __future__ import annotations

import shlex
import shutil
from html import unescape
from pathlib import Path

import pytest

from sandbox.cli import main
from sandbox.page.parts import save
from sandbox.page.task import session_page
from sandbox.tasks import Session, find_task, load


@pytest.fixture(scope="module")
def page() -> str:
    session = Session(load("stop-dead"), seed=3, noise=False)
    for angle in (0.0, -2.0, -4.0):
        session.shoot({"launch.angle": angle})
    return session_page(session)


def test_a_game_says_its_score_and_each_shot(page: str):
    assert page.count("<section><h2>Attempt") == page.count("<iframe") == 3
    assert "0.10 m/s or less needed to pass" in page
    assert "Leave one of three balls slower than 0.1 m/s" in page
    assert "sandbox run stop-dead --seed 3 --attempt 1" in page
    assert "launch.angle = -4 deg" in page
    assert "balls[0].y = 0.0" in page


def test_the_command_of_a_task_of_your_own_names_its_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(find_task("stop-dead"), "my task.toml")
    session = Session(load("my task.toml"), seed=3)
    session.shoot({"launch.angle": 0.0})
    words = shlex.split(unescape(session_page(session).rpartition("<code>")[2].partition("</code>")[0]))
    assert words == ["sandbox", "run", "my task.toml", "--seed", "3", "--attempt", "1"]
    assert main([*words[1:], "--json"]) == 0


def test_a_shot_of_a_game_is_a_replay(page: str, browser, tmp_path: Path):
    file = tmp_path / "game.html"
    save(page, file)
    driver = browser.driver
    driver.get(file.as_uri())
    assert browser.text("h2") == ["Attempt 1", "Attempt 2", "Attempt 3"]
    driver.find_elements("tag name", "summary")[0].click()
    driver.switch_to.frame(driver.find_elements("tag name", "iframe")[0])
    driver.execute_async_script("const done = arguments[0]; window.ready.then(() => done(null))")
    assert driver.find_element("id", "play").is_displayed()
    assert "together" in browser.text("h1")[0]
    driver.switch_to.default_content()
