"""The pages of players and the teacher, in a real browser: by touch, mouse and keyboard."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.select import Select
from selenium.webdriver.support.wait import WebDriverWait

import sandbox
from tests.browser import Browser
from tests.own_scene import HANG
from tests.serve.conftest import Client, Served, serving

NAME = '<img src=x onerror="x">'  # 23 characters: cut to 20


class Page:
    """A page of the server in a window of its own."""

    def __init__(self, browser: Browser, url: str, width: int = 1280, height: int = 900):
        self.browser, self.driver = browser, browser.driver
        self.driver.switch_to.new_window("tab")
        self.window = self.driver.current_window_handle
        browser.resize(width, height)
        self.driver.get(url)

    def at(self, width: int | None = None, height: int = 900) -> Page:
        """Bring it to the front."""
        self.driver.switch_to.window(self.window)
        if width is not None:
            self.browser.resize(width, height)
        return self

    def until(self, expression: str, *arguments: Any) -> None:
        """Wait until an expression is true."""
        wait = WebDriverWait(self.driver, HANG, 0.02)
        wait.until(lambda _: self.browser.run(f"Boolean({expression})", *arguments))

    def aimed(self) -> None:
        """Wait until the path of the aim, and its place, are there."""
        self.until("player && !ask.path.awaited && !ask.path.next && !ask.stage.awaited && state.run && state.stage")

    def find(self, name: str) -> Any:
        return self.driver.find_element(By.ID, name)

    def type(self, name: str, text: str) -> None:
        """Replace what is in a field."""
        self.find(name).send_keys(Keys.CONTROL, "a", Keys.NULL, text, Keys.TAB)

    def changes(self) -> dict[str, Any]:
        changes: dict[str, Any] = self.browser.run("state.changes")
        return changes

    def verdict(self) -> str:
        return self.browser.text("#verdict")[0]

    def complaints(self) -> list[Any]:
        """Return the messages of the console, and addresses that are not of this server."""
        asked = self.browser.run("performance.getEntriesByType('resource').map((entry) => entry.name)")
        own = self.browser.run("location.origin")
        others = [name for name in asked if not name.startswith((own, "data:"))]
        return [*self.driver.get_log("browser"), *others]


@pytest.fixture
def pages(browser: Browser, served: Served) -> Iterator[Any]:
    """Opens pages; they are closed at the end."""
    first, made = browser.driver.current_window_handle, []

    def opened(url: str = "", **size: int) -> Page:
        made.append(Page(browser, url if url.startswith("http") else served.url + url, **size))
        return made[-1]

    yield opened
    for page in made:
        page.at()
        page.driver.execute_script("sessionStorage.clear(); localStorage.clear()")
        page.driver.close()
    browser.driver.switch_to.window(first)


def said(source: str, changes: dict[str, Any]) -> str:
    run = sandbox.simulate(sandbox.load(source, changes))
    return run.scene.verdict(run)


def test_aim_shoot_and_compare_by_mouse_and_keys(pages, browser: Browser):
    page = pages("#basketball")
    page.aimed()
    canvas, before = page.find("picture"), page.verdict()
    assert before == said("basketball", {})
    # the path follows the pull
    mouse = ActionChains(page.driver, duration=20).move_to_element(canvas).click_and_hold()
    mouse.move_by_offset(-60, 50).move_by_offset(-20, 40).perform()
    page.aimed()
    changes = page.changes()
    assert changes["launch.angle"] == pytest.approx(48.4, abs=0.1)
    assert page.verdict() == said("basketball", changes) != before
    assert browser.run("player.pull.at") is not None
    assert not browser.run("state.shot")
    browser.run("document.getElementById('keep').click()")
    mouse = ActionChains(page.driver, duration=20)
    mouse.release().perform()
    page.until("state.shot && player.watched")
    assert browser.run("player.data.forces.causes.length") > 0
    page.driver.find_element(By.CSS_SELECTOR, "#shot-more summary").click()
    page.until("document.querySelector('#energy-legend li')")
    assert browser.text("#energy-legend li")[0].startswith("at the end, of ")
    assert browser.text("#card thead th")[0] == "now"
    assert "speed" in browser.text("#card thead th")[1]
    # keys: Escape aims again, arrows turn and strengthen, Enter lets go
    canvas.send_keys(Keys.ESCAPE, Keys.ARROW_LEFT, Keys.ARROW_UP)
    page.aimed()
    after = page.changes()
    assert after["launch.angle"] == pytest.approx(changes["launch.angle"] + 1.0)
    assert after["launch.speed"] == pytest.approx(changes["launch.speed"] + 0.1)
    assert page.verdict() == said("basketball", after)
    page.driver.find_element(By.TAG_NAME, "body").send_keys("----")  # however busy this machine is, it still plays then
    canvas.send_keys(Keys.ENTER)
    page.until("state.shot && player.playing")
    body = page.driver.find_element(By.TAG_NAME, "body")
    body.send_keys(Keys.SPACE)
    assert not browser.run("player.playing")
    assert page.complaints() == []


def test_a_break_is_where_python_has_it(pages, browser: Browser):
    """In the clusters of balls that touch, too."""
    page = pages("#billiards")
    page.aimed()
    run = sandbox.simulate("billiards")
    times = [each.t for each in run.events[:20]]
    names, states = browser.run(
        """((times) => [player.data.balls.map(({ name }) => name),
          times.map((t) => player.data.balls.map(({ path }) => path.state(t).slice(0, 2)))])(arguments[0])""",
        times,
    )
    expected = [[run.state(name, t)[:2] for name in names] for t in times]
    assert np.abs(np.array(states) - np.array(expected)).max() < 1e-5  # m
    assert page.complaints() == []


def test_sliders_fan_and_link(pages, browser: Browser, served: Served):
    """A link opens the same shot on another device."""
    page = pages("#golf/driver?launch.spin=3000", width=820, height=1100)
    page.aimed()
    assert page.changes() == {"launch.spin": 3000}
    slider = page.driver.find_element(By.CSS_SELECTOR, "input[type=range][aria-label='launch angle in deg']")
    slider.send_keys(Keys.ARROW_RIGHT)
    page.aimed()
    changes = page.changes()
    assert changes["launch.angle"] > sandbox.load("golf/driver").parameters.launch.angle
    page.type("set-gravity", "1.62")
    page.aimed()
    changes |= {"gravity": 1.62}
    assert page.verdict() == said("golf/driver", changes)
    page.type("set-gravity", "1e9")  # beyond the bounds: the bound
    assert page.changes()["gravity"] == float(page.find("set-gravity").get_attribute("max"))
    page.driver.find_element(By.CSS_SELECTOR, "[aria-label='gravity as in the scene']").click()
    assert "gravity" not in page.changes()
    page.find("fan").click()
    page.until("player.fan?.lines.length === 100 && !player.fan.late")
    assert "of 100 score" in browser.text("#fan-score")[0]
    link, changes_there = page.find("link").get_attribute("value"), page.changes()
    assert changes_there["launch.spin"] == 3000
    assert page.complaints() == []
    other = pages(link, width=390, height=844)
    other.aimed()
    assert other.changes() == changes_there
    assert browser.run("document.documentElement.scrollWidth") <= 390
    assert other.complaints() == []


def test_a_page_comes_back_when_the_server_starts_again(pages, browser: Browser, tmp_path: Path):
    """At the same address, with what was aimed; and links that cannot be read lead to a scene, and say why."""
    with serving("basketball", "--jobs", "1", state=tmp_path) as server:
        page = pages(server.url + "#basketball?launch.speed=9%")
        page.aimed()
        assert page.changes() == {}
        assert "must be a number" in browser.text("#told")[0]
        page.driver.get("about:blank")
        page.driver.get(f"{server.url}#basketball?{'&'.join(f'k{n}=1' for n in range(201))}")
        page.aimed()
        assert "at most 200 parameters" in browser.text("#told")[0]
        browser.run("(location.hash = '#basketball?launch.angle=60', 0)")
        page.until("state.changes['launch.angle'] === 60")
        page.aimed()
        assert page.complaints() == []
        server.stop()
        page.until("!document.getElementById('state').hidden")
    with serving("basketball", "--jobs", "1", state=tmp_path, port=server.port) as again:
        assert again.url == server.url
        page.until("document.getElementById('state').hidden")
        page.aimed()
        assert page.changes() == {"launch.angle": 60}
        assert page.verdict() == said("basketball", {"launch.angle": 60})
        browser.driver.get_log("browser")  # of connections that were refused


def test_touch_pulls_and_a_lost_connection_comes_back(pages, browser: Browser):
    page = pages("#basketball", width=390, height=844)
    page.aimed()
    x, y = browser.run(
        "(() => { const box = player.canvas.getBoundingClientRect(); return [box.left + 200, box.top + 150]; })()"
    )
    send = page.driver.execute_cdp_cmd
    for kind, at in (("Start", (x, y)), ("Move", (x - 30, y + 30)), ("Move", (x - 60, y + 70)), ("End", None)):
        points = [] if at is None else [{"x": at[0], "y": at[1]}]
        send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": points})
    page.until("state.shot")
    changes = page.changes()
    assert changes["launch.angle"] == pytest.approx(49.4, abs=0.1)
    browser.run("""(() => {
      window.said = [];
      wire.state = function (there, why) {
        said.push([there, why]);
        Wire.prototype.state.call(this, there, why);
      };
      wire.socket.close();
    })()""")
    page.until("said.length >= 2 && document.getElementById('state').hidden && !state.shot")
    assert [there for there, _ in browser.run("said")] == [False, True]
    page.aimed()
    assert page.changes() == changes
    assert page.verdict() == said("basketball", changes)
    assert page.complaints() == []


def test_a_teacher_and_two_pupils(pages, browser: Browser, served: Served):
    teacher = pages(served.teacher)
    teacher.until("state.scene && board")
    pupil = pages("#basketball")
    pupil.aimed()
    pupil.type("name", NAME)
    other = Client(served.url, name="Ben")
    teacher.at()
    teacher.until("state.room.players.some(({ here, name }) => here && name === arguments[0])", NAME[:20])
    assert NAME[:20] in "".join(browser.text("#players li"))
    assert browser.run("document.querySelectorAll('#players img').length") == 0
    browser.run("document.querySelector('#given [data-source=golf]').click()")  # one press
    teacher.until("state.room.lead.source === 'golf' && !ask.stage.awaited && !ask.path.awaited")
    Select(teacher.find("predict")).select_by_value("carry")
    pupil.at()
    pupil.until("state.source === 'golf' && state.run?.hidden && !ask.stage.awaited")
    assert pupil.verdict() == "Predict the carry, then shoot"
    assert not pupil.find("sports").is_enabled()
    pupil.find("predicted").send_keys("240", Keys.ENTER)
    pupil.until("state.shot")
    assert browser.text("#card tbody tr:first-child")[0] == "your prediction240 m"
    other.hear("scene", source="golf")
    other.hear("shot", n=other.ask("shoot", {"launch.angle": 30.0}, predicted=200.0))
    teacher.at()
    teacher.until("document.querySelectorAll('#shots tbody tr').length >= 2")
    teacher.until("state.room.players.filter(({ last }) => last).length >= 2 && !ask.stage.awaited")
    teacher.until("state.room.players.every(({ last }) => !last || board.beyond(last.line) < 0.02)")  # all are in sight
    names = browser.run("board.taken.map(({ left, top, wide }) => [left, left + wide, top])")
    assert len(names) >= 2
    assert all(a[1] <= b[0] or b[1] <= a[0] or abs(a[2] - b[2]) > 10 for a, b in combinations(names, 2))
    carry = sandbox.simulate("golf").result["carry"]
    rows = [row for row in browser.text("#shots tbody tr") if NAME[:20] in row]
    assert rows
    assert f"{carry:.1f}240{240 - carry:.2f}" in rows[0].replace("−", "-")
    assert "mean" in browser.text("#bars-title")[0]
    assert "standard deviation" in browser.text("#bars-title")[0]
    teacher.find("freeze").click()
    pupil.at()
    pupil.until("!document.getElementById('told').hidden")
    assert not pupil.find("shoot").is_enabled()
    teacher.at()
    teacher.find("freeze").click()
    teacher.find("free").click()
    pupil.at()
    pupil.until("document.getElementById('told').hidden && !state.lead.source")
    other.close()
    assert pupil.complaints() == []
    assert teacher.at().complaints() == []


def test_a_line_says_what_is_waited_for(pages, browser: Browser):
    """In place of the picture: never a black box, nor one that is stretched once a phone was turned."""
    page = pages("#basketball", width=390, height=844)
    page.aimed()
    line = "document.getElementById('waiting')"
    page.until(f"{line}.hidden")
    browser.run("(ask.stage.ask = () => {})")  # a server that takes long
    browser.resize(844, 390)
    page.until(f"!{line}.hidden")
    assert browser.text("#waiting") == ["Turning the picture ..."]
    browser.run("(delete ask.stage.ask, askStage())")
    page.until(f"{line}.hidden && fits(state.stage)")
    assert browser.run("player.across[0] / player.across[1]") == pytest.approx(
        browser.run("player.canvas.clientWidth / player.canvas.clientHeight"), rel=0.01
    )


def test_tiles_lead_to_tasks_and_scenes(pages, browser: Browser):
    """They are there before any script, and the picture of a tile before any player is computed; by keyboard, too."""
    page = pages("")
    assert browser.run("document.querySelectorAll('.tiles img').length") == 3
    assert browser.text(".tiles em") == ["Start here"]
    page.find("your-name").send_keys(Keys.TAB)
    for key in (Keys.TAB, Keys.ENTER):  # over the first tile to the second
        page.driver.switch_to.active_element.send_keys(key)
    assert browser.text("#chosen") == ["Golf"]
    page.until("state.scenes.size")
    browser.run("(ask.stage.ask = () => {})")  # a server that takes long
    page.driver.find_element(By.CSS_SELECTOR, ".sport [data-source='golf']").click()
    assert browser.text("#waiting")[0].lower() == "loading golf ..."
    assert "tile-golf.jpg" in browser.run("document.getElementById('waiting').style.backgroundImage")
    page.until("state.source === 'golf'")
    browser.run("(delete ask.stage.ask, askStage())")
    page.aimed()
    page.find("sports").click()
    assert browser.text("#chosen") == ["Golf"]
    assert page.complaints() == []


def test_a_pull_on_a_table_that_stands_upright(pages, browser: Browser):
    """Is turned with it: down the screen, the ball goes up it, along the table."""
    page = pages("#billiards", width=390, height=844)
    page.aimed()
    assert browser.run("player.view.turned")
    mouse = ActionChains(page.driver, duration=20).move_to_element(page.find("picture")).click_and_hold()
    mouse.move_by_offset(0, 100).perform()
    page.aimed()
    assert page.changes().get("cue.angle", 0.0) == pytest.approx(0.0, abs=0.5)
    seen = "((t) => player.onScreen(player.pixel(...player.main.path.state(t).slice(0, 2))))"
    start, on = browser.run(f"[{seen}(0), {seen}(0.05)]")
    assert on[1] < start[1] - 5
    assert on[0] == pytest.approx(start[0], abs=1.0)
    mouse = ActionChains(page.driver, duration=20)
    mouse.release().perform()
    page.until("state.shot")
    assert page.complaints() == []


def test_a_teacher_finds_and_presents_the_shots_of_other_scenes(pages, browser: Browser, served: Served):
    """Small pictures of all shots, of one task or player; one of them large, for all to see."""
    ann = Client(served.url, name="Ann", source="golf")
    run = ann.hear("shot", n=ann.ask("shoot"))["run"]
    teacher = pages(served.teacher)
    teacher.until("state.scene && board && state.source === 'basketball'")
    teacher.until("[...document.querySelectorAll('#which option')].some((each) => each.text.startsWith('golf ('))")
    assert any("Ann" in item and "active" in item and "in golf" in item for item in browser.text("#players li"))
    Select(teacher.find("which")).select_by_value("golf")
    teacher.until("state.source === 'golf' && state.run && document.querySelectorAll('#shots tbody tr').length")
    assert any("Ann" in row for row in browser.text("#shots tbody tr"))
    teacher.until("document.querySelector('#small img').naturalWidth === 320")
    assert all("golf" in item for item in browser.text("#small li"))
    teacher.driver.find_element(By.CSS_SELECTOR, "#small button").click()
    teacher.until("present.player && document.getElementById('presenting').hidden")
    assert browser.text("#presented-title") == [f"Ann: {run['verdict']}"]
    assert browser.run("present.player.main.path.arcs.length") == len(run["balls"][0]["path"]["arcs"])
    teacher.find("close").click()
    ann.close()
    assert teacher.complaints() == []


#: Every element with text of its own that is seen: its text, colour, and the grounds under it, the nearest first.
TEXTS = """(() => [...document.querySelectorAll("body *")].filter((each) => each.checkVisibility()
  && !each.disabled && [...each.childNodes].some((node) => node.nodeType === 3 && node.data.trim())).map((each) => {
    const grounds = [];
    for (let at = each; at; at = at.parentElement) grounds.push(getComputedStyle(at).backgroundColor);
    const over = each.closest(".picture") !== null && !each.closest("#waiting, #ending, #called");
    const text = each.textContent.trim().slice(0, 30);
    return over || each.closest("option, .hidden") ? null : [text, getComputedStyle(each).color, grounds];
  }).filter(Boolean))()"""


def channels(colour: str) -> list[float]:
    """Red, green and blue of 255, and opacity."""
    found = [float(part) for part in re.findall(r"[\d.]+", colour)]
    return [*found, 1.0][:4]


def test_all_that_is_written_can_be_read(pages, browser: Browser, served: Served):
    """With a contrast of 4.5 to 1 at least (WCAG AA), on light and on dark: tiles, a sport, a scene, and the teacher's
    page with the names of those who left."""
    gone = Client(served.url, name="Gone")
    gone.hear("welcome")
    page, scene, teacher = pages(""), pages("#basketball"), pages(served.teacher)
    teacher.until("state.room.players.some(({ name }) => name === 'Gone')")
    gone.close()
    teacher.until("document.querySelector('#players .away')")
    scene.at().aimed()
    sport = pages("")
    browser.run("(choose('golf'), 0)")
    for each in (page, sport, scene, teacher):
        each.at()
        for dark in (False, True):
            browser.resize(1280, 900, dark=dark)
            texts = browser.run(TEXTS)
            assert len(texts) > 5
            for text, ink, grounds in texts:
                ground = next(each for each in map(channels, grounds) if each[3] == 1.0)
                assert contrast(channels(ink)[:3], ground[:3]) >= 4.5, (text, ink, ground)


def contrast(one: Sequence[float], two: Sequence[float]) -> float:
    """The ratio of the luminances of two colours, as WCAG 2 defines it."""
    linear = (
        [share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4 for share in np.array(colour) / 255]
        for colour in (one, two)
    )
    low, high = sorted(float(np.dot([0.2126, 0.7152, 0.0722], each)) for each in linear)
    return (high + 0.05) / (low + 0.05)


def test_everything_has_a_label_and_fits(pages, browser: Browser):
    page = pages("#basketball")
    page.aimed()
    named = "each.labels?.length || each.getAttribute('aria-label') || each.textContent.trim()"
    every = "[...document.querySelectorAll('button, input, select, canvas, summary')]"
    assert browser.run(f"{every}.filter((each) => !({named})).map((each) => each.outerHTML)") == []
    buttons = "[...document.querySelectorAll('button, select')].filter((each) => each.offsetParent)"
    for width in (1280, 820, 390):
        browser.resize(width, 900)
        page.until("fits(state.stage) && player.view === state.stage.view")
        assert browser.run("document.documentElement.scrollWidth") <= width
        assert browser.run(f"{buttons}.filter((each) => each.offsetHeight < 32).map((each) => each.outerHTML)") == []
    browser.resize(844, 390)  # on its side: a finger on the picture aims, so it must not fill the screen
    page.until("fits(state.stage) && player.view === state.stage.view")
    page.until("document.getElementById('shoot').getBoundingClientRect().bottom <= innerHeight")
    assert page.complaints() == []
