"""The page of a run, in a real browser: what it shows and plays is what Python computed."""

from __future__ import annotations

import shlex
import tomllib
from html import unescape
from math import hypot
from pathlib import Path

import numpy as np
import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.wait import WebDriverWait

import sandbox
from sandbox.cli import main
from sandbox.page.parts import save
from sandbox.page.replay import LAYOUTS, page_of
from sandbox.parameters import parse_assignment
from sandbox.scene.writing import command
from sandbox.sport.amounts import amount, shown_in
from tests.own_scene import HANG
from tests.scenes.play import run_of

#: A flight with rolling, balls that turn about all axes, a heap, a body that turns.
RUNS = {
    "golf": None,
    "billiards": None,
    "collisions/bowl": {"duration": 0.45},
    "collisions/tumbling-box": None,
    "collisions/cradle-3": {"balls[0].x": -0.2, "duration": 0.2},
}


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory):
    """The file of a run's page, written once."""
    folder = tmp_path_factory.mktemp("pages")

    def page(name: str, *others: str) -> Path:
        file = folder / f"{'-'.join([name, *others]).replace('/', '-')}.html"
        if not file.exists():
            options = [word for other in others for word in ("--compare", other)]
            save(page_of(run_of(name, RUNS.get(name)), {other: run_of(other) for other in others}, options), file)
        return file

    return page


@pytest.mark.parametrize("name", RUNS)
def test_every_instant_is_that_of_python(browser, pages, name: str):
    """Positions to 1e-12 m, velocities, spins, and how balls are turned, at 36 times; and where they are drawn."""
    page, run = pages(name), run_of(name, RUNS[name])
    assert page.stat().st_size < 500_000
    browser.open(page)
    assert browser.run("document.getElementById('poster')") is None  # the canvas took its place
    times = [*np.linspace(0.0, run.duration, 33), *(event.t for event in run.events[:3])]
    view = run.scene.picture(run, LAYOUTS[0][0])
    states = browser.run(
        "arguments[0].map((t) => player.data.balls.slice(0, 4).map((ball) => ball.path.state(t)))", times
    )
    matrices = browser.run(
        "arguments[0].map((t) => player.data.balls.slice(0, 4).map((ball) => ball.turning?.at(t) ?? null))", times
    )
    angles = browser.run(
        "arguments[0].map((t) => player.data.balls.slice(0, 4).map((ball) => ball.path.angle(t)))", times
    )
    for t, found, matrix, angle in zip(times, states, matrices, angles, strict=True):
        for i, ball in enumerate(view.balls[:4]):
            expected = run.state(ball, t)
            assert found[i][:2] == pytest.approx(expected[:2], rel=1e-14, abs=1e-12)
            assert found[i][2:] == pytest.approx(expected[2:], rel=1e-9, abs=1e-7)
            if view.rolls(ball):
                np.testing.assert_allclose(matrix[i], view.turn(ball, t), atol=1e-6)
            else:
                assert angle[i] == pytest.approx(run.angle(ball, t), abs=1e-9)
    radius, places = view.min_radius, [balls[0][:2] for balls in states]
    spots = browser.run("arguments[0].map(([x, y]) => player.spot(player.main, x, y, arguments[1]))", places, radius)
    first = np.array([run.state(view.balls[0], t)[:2] for t in times])
    np.testing.assert_allclose(spots, view.spots(view.camera, first, radius), atol=0.5)
    assert browser.complaints() == []


def test_what_is_seen_from_near_by_is_played(browser, pages):
    """In bowling: each ball in its place in the enlarged part, and pins that have fallen seen from the side."""
    run = run_of("bowling")
    browser.open(pages("bowling"))
    view = run.scene.picture(run, LAYOUTS[0][0])
    for t in (0.0, 0.75 * run.duration):
        there, fallen = browser.run(
            """((t) => {
          const there = {}, fallen = [], { ball, fallen: falls } = player, { lens } = player.view;
          player.ball = function (each, ...rest) {
            if (this.view.scale === lens.scale) there[each.name] = this.spot(each, ...each.path.state(t));
            ball.call(this, each, ...rest);
          };
          player.fallen = function (each, ...rest) {
            if (this.view.scale === lens.scale) fallen.push(each.name);
            falls.call(this, each, ...rest);
          };
          player.seek(t);
          delete player.ball, delete player.fallen;
          return [there, fallen];
        })(arguments[0])""",
            t,
        )
        assert set(there) == set(view.balls)
        for name, at in there.items():
            assert at == pytest.approx(view.near_camera.pixel(*run.state(name, t)[:2]), abs=0.01)
        expected = {name for name, (start, _) in view.falls.items() if start <= t < (run.caught_at(name) or t + 1)}
        assert set(fallen) == expected
        assert bool(expected) == (t > 0.0)
    assert browser.complaints() == []


def test_the_camera_goes_with_the_story_as_in_frames(browser, pages):
    name = "soccer-curl/dive"
    browser.open(pages(name))
    view = run_of(name).scene.picture(run_of(name), LAYOUTS[0][0])
    for t in (0.0, 0.4, 0.8, view.camerawork.decided, 1.2, view.run.duration):
        x, y = map(float, view.run.state("ball", t)[:2])
        larger, slower, at = browser.run(
            """(([t, x, y]) => {
              player.seek(t);
              const at = player.onScreen(player.pixel(x, y)).map((value) => value / player.shown);
              return [player.seen().larger, player.keyframe()[4], at];
            })(arguments[0])""",
            [t, x, y],
        )
        camera = view.view(t)
        assert larger == pytest.approx(camera.scale / view.camera.scale, rel=0.05)
        assert at == pytest.approx(camera.pixel(x, y), abs=0.02 * view.size[0])
        assert slower == pytest.approx(view.slower(t), rel=0.2)
    assert browser.complaints() == []


def test_a_longer_run_that_is_compared_is_drawn_to_its_end(browser, pages):
    """Although this one ends before."""
    browser.open(pages("golf/headwind", "golf"))
    longer, shorter = run_of("golf"), run_of("golf/headwind")
    assert longer.duration > shorter.duration + 1.0
    assert browser.run("player.data.ghosts[0].line.at(-1)[2]") == pytest.approx(longer.duration)
    assert browser.run("player.main.line.at(-1)[2]") == pytest.approx(shorter.duration)


def test_path_and_rim_are_as_thick_as_on_the_poster(browser, pages):
    name = "collisions/tumbling-box"
    browser.open(pages(name))
    view = run_of(name).scene.picture(run_of(name), LAYOUTS[0][0])
    width, unit = 4.5 * view.unit * view.thickness("box"), view.unit
    drawn = browser.run("""(() => {
      const widths = [];
      player.context.stroke = function () {
        widths.push(this.lineWidth);
      };
      player.draw();
      delete player.context.stroke;
      return widths;
    })()""")
    assert drawn == pytest.approx([width + 2.0 * unit, width, 1.6 * unit])


def test_it_plays_by_mouse_keyboard_and_touch(browser, pages):
    run, driver = run_of("golf"), browser.driver
    browser.open(pages("golf", "golf/headwind"))
    assert browser.text("h1") == [run.scene.verdict(run)]
    rows = dict(run.scene.rows(run))
    assert browser.text(".card tbody th") == list(rows)
    assert browser.text(".card tbody td:nth-of-type(1)") == list(rows.values())
    assert browser.text(".card thead th") == ["golf", "golf/headwind"]
    assert "sandbox run golf --compare golf/headwind" in browser.text("code")
    assert not browser.run("player.playing")
    # play, and go on to the end by dragging; step, events, speed
    browser.run("player.power = -4")  # so slowly that it does not end before it is stopped
    driver.find_element(By.ID, "play").click()
    WebDriverWait(driver, HANG).until(lambda _: browser.run("player.t") > 0.2)
    driver.find_element(By.ID, "play").click()
    stopped = browser.run("player.t")
    assert 0.2 < stopped < run.duration
    assert not browser.run("player.playing")
    browser.run("player.power = 0")
    body = ActionChains(driver)
    browser.run("document.activeElement.blur()")
    body.send_keys(".", ".", ",", "-", "-").perform()
    assert browser.run("player.t") == pytest.approx(stopped + 1 / 60)
    assert browser.run("2 ** player.power") == 0.25
    assert browser.run("document.getElementById('rate').selectedOptions[0].text") == "1/4"
    browser.run("document.querySelector('details').open = true")
    driver.find_elements(By.CSS_SELECTOR, "#events button")[0].click()
    landing = run.events[0].t
    assert browser.run("player.t") == landing
    assert amount(landing, "s") in browser.text("#events li.past")[0]
    # a path is read by pointing at it, and a click goes there
    t, (x, y, *_) = 3.0, run.state("ball", 3.0)
    browser.run("player.seek(2.5)")  # the camera has not left it yet
    px, py = browser.run(f"player.onScreen(player.spot(player.main, {x}, {y}))")
    canvas = driver.find_element(By.ID, "picture")
    box = canvas.rect
    ActionChains(driver).move_to_element_with_offset(
        canvas, round(px - box["width"] / 2), round(py - box["height"] / 2)
    ).perform()
    hint = browser.run("document.getElementById('hint').innerText").splitlines()
    pointed = browser.run("player.pointed.t")
    assert pointed == pytest.approx(t, abs=0.05)
    state = run.state("ball", pointed)
    assert f"time {amount(pointed, 's')}" in hint
    assert f"speed {amount(hypot(*state[2:4]), 'm/s')}" in hint
    assert any(line.startswith("height ") for line in hint)
    assert any(line.startswith("spin ") and line.endswith("rpm backspin") for line in hint)
    ActionChains(driver).click().perform()
    assert browser.run("player.t") == pytest.approx(pointed)
    assert browser.run("document.getElementById('time').getAttribute('aria-valuetext')").startswith("time ")
    # at the end the verdict is marked for a moment: the ball is not in the hole
    browser.run("player.seek(player.data.told - 0.01)")
    browser.run("player.play()")
    WebDriverWait(driver, HANG).until(lambda _: browser.run("document.querySelector('h1').dataset.verdict") == "bad")
    WebDriverWait(driver, HANG).until(lambda _: browser.run("document.querySelector('h1').dataset.verdict") == "")
    # on a phone, in the dark, by touch
    browser.open(pages("golf", "golf/headwind"), 390, 844, dark=True)
    assert browser.run("document.documentElement.scrollWidth") <= 390
    assert browser.run("player.view === player.data.views[1]")
    x, y, *_ = run.state("ball", 2.0)
    at = browser.run(
        f"""(() => {{ const box = player.canvas.getBoundingClientRect(), [px, py] = player.spot(player.main, {x}, {y});
        return [box.left + px * player.shown, box.top + py * player.shown]; }})()"""
    )
    point = {"x": at[0], "y": at[1]}
    driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [point]})
    driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    assert browser.run("player.pointed.t") == pytest.approx(2.0, abs=0.1)
    assert browser.complaints() == []


def test_numbers_are_written_as_python_writes_them(browser, pages, tmp_path: Path):
    """In the units that were chosen."""
    values = [0.0, 0.0004, -0.0123, 0.0996, 5.0, -8.314, 9.99, 10.0, 123.4, 12345.6]
    with shown_in("us"):
        save(page_of(run_of("throws")), tmp_path / "us.html")
    for page, units in ((pages("golf"), None), (tmp_path / "us.html", "us")):
        browser.open(page)
        for unit in ("m", "m/s", "deg", "rpm", "s", "N"):
            with shown_in(units):
                expected = [amount(value, unit) for value in values]
            assert browser.run("arguments[0].map((value) => amount(value, arguments[1]))", values, unit) == expected
    assert any("ft" in text for text in browser.text(".card td"))


def test_a_page_says_how_to_run_it_again():
    """With lists of groups, too: what it says gives the same parameters."""
    balls = [{"name": "cue", "x": -0.4, "y": 0.1}, {"name": "3", "x": 0.5, "y": 0.0}]
    for source, changes in {
        "golf/driver": {"launch.speed": 70.0, "air.wind": [-3.0, 0.0], "ball.drag.model": "usga"},
        "billiards": {"rack": "none", "balls": balls, "cue.ball": "3"},
        "golf": {},
    }.items():
        scene = sandbox.load(source, changes)
        words = shlex.split(command(scene))
        assert words[:3] == ["sandbox", "run", source]
        settings = [text.partition("=") for text in words[4::2]]
        assert len(settings) == len(changes)
        said = {key: value if key in ("ball.drag.model", "rack") else tomllib.loads(f"it = {value}")["it"]
                for key, _, value in settings}  # fmt: skip
        assert sandbox.load(source, said).parameters == scene.parameters


def test_the_command_on_a_page_makes_that_page(tmp_path: Path, monkeypatch, capsys):
    """As pasted, with what it is compared with and the units; the other may be a file of one's own."""
    monkeypatch.chdir(tmp_path)
    Path("my shot.toml").write_text('scene = "golf"\nlaunch.angle = 14\n', "utf-8")
    for others in (["golf/headwind"], ["my shot.toml", "golf/headwind"]):
        asked = ["run", "golf/driver", "--set", "air.wind=[-3,0]", "--set", "ball.lift.model=usga"]
        asked += [f"--compare={other}" for other in others]
        assert main([*asked, "--units", "ft,mph", "--html", "first.html"]) == 0
        first = Path("first.html").read_text("utf-8")
        words = shlex.split(unescape(first.partition("<code>")[2].partition("</code>")[0]))
        assert words[0] == "sandbox"
        assert main([*words[1:], "--html", "second.html"]) == 0
        assert Path("second.html").read_text("utf-8") == first


def test_the_command_of_a_scene_of_your_own_has_its_changes(tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["new", "beach"]) == 0
    scene = sandbox.load("./beach", {"launch.speed": 11.0})
    words = shlex.split(command(scene))
    assert words == ["sandbox", "run", "./beach", "--set", "launch.speed=11"]
    assert sandbox.load(words[2], dict([parse_assignment(words[4])])).parameters == scene.parameters


def test_only_set_parameters_appear_in_the_chosen_units():
    def parameters(name: str) -> str:
        return page_of(run_of(name)).partition('<table class="parameters">')[2].partition("</table>")[0]

    assert "null" not in parameters("golf") + parameters("billiards")
    assert "76.44384 m/s" in parameters("golf")
    with shown_in("us"):
        assert ">171 mph<" in parameters("golf")
        assert " m/s<" not in parameters("soccer")


def test_text_of_others_is_text(tmp_path: Path):
    """A title or name with HTML in it stays text."""
    file = tmp_path / "shot.toml"
    file.write_text('# <script>alert(1)</script> & more\nscene = "throws"\n', "utf-8")
    page = page_of(sandbox.simulate(str(file)), {"</script><b>": run_of("throws")})
    assert "<script>alert" not in page
    assert "</script><b>" not in page
    assert "&lt;script&gt;alert(1)&lt;/script&gt; &amp; more" in page
