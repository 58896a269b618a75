"""Golden pictures: what passes, what fails, what is written when."""

import copy
import json
import re
import shutil
import textwrap
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import sandbox
from sandbox.picture.difference import LOWEST, NEIGHBOURHOOD, ROUNDING_LEVELS, coarser, compare
from sandbox.picture.frames import to_image
from sandbox.picture.painter import Painter, blank
from sandbox.record import SAMPLES, TOLERANCE, as_text, changed_results, first_change, known_part, merged, record
from sandbox.sport.facts import Fact
from tests.own_scene import copy_of

pytest_plugins = ["pytester"]

DROP = Path(__file__).parents[1] / "scenes" / "drop"

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
def test_a_pixel_of_size_or_half_a_pixel_of_place_fails(radius, rim):
    before = ball(radius=radius, rim=rim)
    assert not compare(before, ball(radius=radius, rim=rim)).matters
    assert compare(before, ball(radius=radius + 0.5, rim=rim)).matters
    assert compare(before, ball(x=60.5, radius=radius, rim=rim)).matters


def test_one_edge_pixel_smoothed_differently_passes():
    other = ball()
    other.putpixel((56, 45), (120, 130, 140))
    difference = compare(ball(), other)
    assert difference.largest > 3 * ROUNDING_LEVELS
    assert not difference.matters


def test_one_pixel_of_another_colour_fails():
    other = ball()
    other.putpixel((20, 20), (255, 0, 0))
    difference = compare(ball(), other)
    assert difference.together == 1
    assert difference.matters


@pytest.mark.parametrize(("contrast", "wider", "matters"), [(15, 0.4, False), (15, 1.0, True), (30, 0.25, True)])
def test_a_thicker_line_fails_by_how_much_it_stands_out(contrast: int, wider: float, matters: bool):
    def line(width: float) -> Image.Image:
        surface = blank((160, 90))
        surface.fill((50, 50, 50))
        Painter(surface).line([(20.0, 45.0), (140.0, 45.0)], width, (50 + contrast,) * 3)
        return to_image(surface)

    assert compare(coarser(line(2.0)), line(2.0 + wider)).matters == matters


def test_rounding_of_every_pixel_passes():
    noise = np.random.default_rng(1).integers(-3, 4, (90, 160, 3))
    other = Image.fromarray(np.clip(np.asarray(ball()).astype(int) + noise, 0, 255).astype(np.uint8))
    assert not compare(ball(), other).matters


def test_what_a_golden_picture_keeps_of_the_colours_is_no_change():
    noise = np.random.default_rng(2).integers(0, 256, (90, 160, 3), np.uint8)
    other = coarser(Image.fromarray(noise))
    difference = compare(Image.fromarray(noise), other)
    assert (difference.largest, difference.share) == (2, 0.0)


@pytest.mark.parametrize("level", range(96, 104))
@pytest.mark.parametrize("shift", [-7, -6, 6, 7])
def test_a_sky_or_a_line_of_another_colour_fails(level: int, shift: int):
    """By so few levels, wherever in a golden level's range the colour lies; and in one channel alone."""
    before = Image.new("RGB", (160, 90), (level, 90, 200))
    sky = Image.new("RGB", (160, 90), (level + shift, 90, 200))
    assert compare(coarser(before), sky).matters
    trace = before.copy()
    trace.paste((level + shift, 90, 200), (20, 45, 140, 46))
    assert compare(coarser(before), trace).matters


def test_a_shade_that_is_off_by_four_levels_fails():
    shade = np.broadcast_to(np.linspace(90, 160, 90).round()[:, None, None], (90, 160, 3)).astype(np.uint8)
    for shift in (-4, 4):
        other = (shade.astype(int) + shift).astype(np.uint8)
        assert compare(coarser(Image.fromarray(shade)), Image.fromarray(other)).matters


@pytest.mark.parametrize("rounding", [-ROUNDING_LEVELS, -1, 1, ROUNDING_LEVELS])
def test_rounding_the_other_way_everywhere_passes(rounding: int):
    every = np.arange(2, 254, dtype=np.uint8).reshape(-1, 6)
    image = Image.fromarray(np.repeat(every[:, :, None], 3, axis=2))
    other = Image.fromarray((np.asarray(image).astype(int) + rounding).astype(np.uint8))
    difference = compare(coarser(image), other)
    assert (difference.share, difference.matters) == (0.0, False)


def test_many_single_pixels_fail_together():
    other = ball()
    for x in range(NEIGHBOURHOOD, 160, 2 * NEIGHBOURHOOD):
        other.putpixel((x, 10), (0, 0, 0))
    assert compare(ball(), other).matters


def test_a_line_of_text_in_another_colour_fails():
    other = ball()
    for x in range(100, 104):
        other.putpixel((x, 80), tuple(level + LOWEST - ROUNDING_LEVELS - 1 for level in SKY))
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


@pytest.fixture
def scene_project(pytester, monkeypatch):
    """A project with a golden test of a run, whose numbers and colours the environment chooses."""
    monkeypatch.delenv("CI", raising=False)
    shutil.copytree(DROP, pytester.path / "drop", ignore=shutil.ignore_patterns("__pycache__"))
    pytester.makepyfile(
        test_it="""
        import json, os
        import sandbox

        def test_it(golden):
            golden.check("it", sandbox.simulate(sandbox.load("./drop", json.loads(os.environ.get("CHANGES", "{}")))))
        """
    )
    return pytester


@pytest.fixture(scope="module", autouse=True)
def _loaded():
    """All that a run and its picture need, but the scene: pytest forgets what is imported in a run within a run."""
    scene = sandbox.load(DROP)
    scene.picture(sandbox.simulate(scene)).poster()


def again(project, *options: str):
    """Run the project's tests; its scene is imported afresh."""
    return project.runpytest_inprocess("-p", "no:cacheprovider", *options)


def kept(spoil):
    """What becomes of the file of a record when its contents are spoilt."""

    def spoilt(whole: bytes) -> bytes:
        record = json.loads(whole)
        spoil(record)
        return json.dumps(record).encode()

    return spoilt


#: Golden files, what happens to them, and what is said of it; None where it is a change as any other.
SPOILT = [
    ("json", lambda whole: b"<<<<<<< HEAD\n", "is damaged: Expecting value: line 1 column 1*"),
    ("json", lambda whole: b"[]", "is damaged: not a record of a run*"),
    ("png", lambda whole: b"", "is damaged: cannot identify image file*"),
    ("png", lambda whole: whole[:60], "is damaged: image file is truncated*"),
    ("json", kept(lambda kept: kept["states"]["ball"][3].pop()), "is damaged: not a record of a run, or not a whole *"),
    ("json", kept(lambda kept: kept["states"]["ball"][3].__setitem__(1, None)), "is damaged: not a record of a run*"),
    ("json", kept(lambda kept: kept["events"][0].pop()), "is damaged: not a record of a run*"),
    *(
        ("json", kept(spoil), None)
        for spoil in (
            lambda kept: kept["states"]["ball"].pop(),
            lambda kept: kept["states"]["ball"].clear(),
            lambda kept: kept["states"]["ball"][3].__setitem__(0, 0.0),
            lambda kept: kept["states"].clear(),
            lambda kept: kept["events"].clear(),
            lambda kept: kept["result"].clear(),
            lambda kept: kept.pop("result"),
        )
    ),
]


class TestRuns:
    def changed(self, project, monkeypatch, changes: str = "{}"):
        again(project, "--golden-update").assert_outcomes(passed=1)
        monkeypatch.setenv("CHANGES", changes)
        return again(project)

    def test_update_keeps_what_happened_beside_the_picture(self, scene_project):
        result = again(scene_project, "--golden-update")
        result.stdout.fnmatch_lines(["*golden files written*", "*it.json: new", "*it.png: new"])
        kept = json.loads((scene_project.path / "golden" / "it.json").read_text())
        assert kept["result"]["bounces"] == len(kept["events"])
        assert len(kept["states"]["ball"]) == SAMPLES
        again(scene_project).assert_outcomes(passed=1)

    def test_another_process_gets_the_same(self, scene_project):
        again(scene_project, "--golden-update")
        scene_project.runpytest_subprocess("-p", "no:cacheprovider").assert_outcomes(passed=1)

    def test_a_missing_one_fails_and_says_how_to_make_it(self, scene_project):
        again(scene_project).stdout.fnmatch_lines(["*it has no golden picture*pytest --golden-update*"])
        again(scene_project, "--golden-update")
        (scene_project.path / "golden" / "it.json").unlink()
        again(scene_project).stdout.fnmatch_lines(["*it has no golden run*it.json*pytest --golden-update*"])

    def test_damaged_and_emptied_goldens_are_named_and_remade(self, scene_project):
        test = scene_project.path / "test_it.py"
        each = test.read_text().replace(
            "def test_it(golden):", f"@pytest.mark.parametrize('n', range({len(SPOILT)}))\ndef test_it(golden, n):"
        )
        test.write_text("import pytest\n" + textwrap.dedent(each).replace('"it"', "f'it{n}'"))
        again(scene_project, "--golden-update")
        whole = {}
        for number, (kind, spoil, _) in enumerate(SPOILT):
            file = scene_project.path / "golden" / f"it{number}.{kind}"
            whole[file] = file.read_bytes()
            file.write_bytes(spoil(whole[file]))
        result = again(scene_project)
        result.assert_outcomes(failed=len(SPOILT))
        told = [f"it{n}: *it{n}.{kind} {said}" for n, (kind, _, said) in enumerate(SPOILT) if said]
        told += ["*make it again: pytest --golden-update", "*first at t = 1 s: ball is new"]
        result.stdout.fnmatch_lines_random(told)
        result.stdout.no_fnmatch_line("*another exception occurred*")
        again(scene_project, "--golden-update").assert_outcomes(passed=len(SPOILT))
        assert {file: file.read_bytes() for file in whole} == whole

    def test_a_visible_difference_below_the_tolerance_is_reported(self, scene_project, monkeypatch):
        """A picture that shows the eighth digit of gravity."""
        picture = scene_project.path / "drop" / "picture.py"
        shows = (
            "surface.fill((9, 9, 9 + 100 * (self.run.scene.parameters.gravity > 9.81)), (2, 2, 9, 9)); return surface"
        )
        picture.write_text(picture.read_text().replace("return surface", shows))
        result = self.changed(scene_project, monkeypatch, '{"gravity": 9.8100001}')
        told = "*it: the run differs from its golden run by less than the tolerance of 1e-06: t = 0.6*, ball impact *"
        result.stdout.fnmatch_lines([told, "the picture shows it: *of the pixels changed*"])

    @pytest.mark.parametrize(
        ("changes", "first"),
        [
            ('{"floor.restitution": 0.79}', "t = 0.652 s, ball, *final_height is *"),
            ('{"gravity": 9.8101}', "t = 0.0435 s, ball, vy is*"),
        ],
    )
    def test_says_that_the_physics_changed_and_where_first(self, scene_project, monkeypatch, changes, first):
        result = self.changed(scene_project, monkeypatch, changes)
        result.assert_outcomes(failed=1)
        result.stdout.fnmatch_lines([f"*it differs from its golden run: the physics changed: first at {first}"])

    def test_a_change_within_the_tolerance_passes(self, scene_project, monkeypatch):
        self.changed(scene_project, monkeypatch, '{"gravity": 9.8100000001}').assert_outcomes(passed=1)

    def test_says_that_only_the_drawing_changed(self, scene_project, monkeypatch):
        again(scene_project, "--golden-update")
        picture = scene_project.path / "drop" / "picture.py"
        picture.write_text(picture.read_text().replace("set_at((16,", "set_at((17,"))
        lines = picture.read_text().replace("return surface", "surface.fill((9, 90, 9), (2, 2, 9, 9)); return surface")
        picture.write_text(lines)
        result = again(scene_project)
        result.stdout.fnmatch_lines(
            [
                "*it differs from its golden picture: same physics, the drawing changed: *of the pixels changed*",
                "expected, actual and difference, side by side: *it.png",
                "if the change is intended: pytest --golden-update",
            ]
        )

    def test_says_that_only_a_result_changed(self, scene_project, monkeypatch):
        again(scene_project, "--golden-update")
        scene = scene_project.path / "drop" / "scene.py"
        scene.write_text(scene.read_text().replace("return sum(", "return 99 or sum("))
        again(scene_project).stdout.fnmatch_lines(["*same motion, different result; bounces is 99, was *"])

    def test_says_that_a_label_a_unit_or_the_verdict_changed(self, scene_project):
        again(scene_project, "--golden-update")
        scene = scene_project.path / "drop" / "scene.py"
        known = scene.read_text()
        for old, new, said in (
            ('"bounces", "bounces", ""', '"bounces", "hops", ""', 'bounces is labelled "hops", was "bounces"'),
            ('"final height", "m"', '"final height", "cm"', 'final_height is labelled "final height (cm)", was "*(m)"'),
            ('"Bounced"', '"Bounced on"', 'the verdict is "Bounced on", was "Bounced"'),
        ):
            scene.write_text(known.replace(old, new))
            again(scene_project).stdout.fnmatch_lines([f"*same motion, different result; {said}"])

    def test_an_older_record_without_labels_passes_and_gets_them(self, scene_project):
        again(scene_project, "--golden-update")
        record = scene_project.path / "golden" / "it.json"
        whole = json.loads(record.read_text())
        record.write_text(as_text({key: value for key, value in whole.items() if key not in ("labels", "says")}))
        again(scene_project).assert_outcomes(passed=1)
        again(scene_project, "--golden-update").stdout.fnmatch_lines(["*the same run, with its parameters and labels"])
        assert json.loads(record.read_text()) == whole

    def test_a_new_fact_passes_and_is_one_more_line(self, scene_project):
        """In a record of another machine, which has other versions and last digits."""
        again(scene_project, "--golden-update")
        file = scene_project.path / "golden" / "it.json"
        other = json.loads(file.read_text())
        other["versions"] = "Python 3.99"
        other["states"]["ball"] = [[t, *(value * (1.0 + 2e-8) for value in row)] for t, *row in other["states"]["ball"]]
        before = as_text(other)
        file.write_text(before)
        scene = scene_project.path / "drop" / "scene.py"
        scene.write_text(
            scene.read_text().replace("FACTS = (", 'FACTS = (Fact("twice", "", "", lambda *_: 2 * bounces(*_)),')
        )
        result = again(scene_project)
        result.assert_outcomes(passed=1)
        result.stdout.fnmatch_lines(["*new since these golden records: *", "*it.json: twice"])
        assert file.read_text() == before
        again(scene_project, "--golden-update").stdout.fnmatch_lines(["*it.json: twice is new"])
        added = set(file.read_text().splitlines()) - set(before.splitlines())
        assert [line.split(":")[0] for line in added] == ['  "twice"']
        # of another length: within one second, compiled modules are told apart by the length of their source
        scene.write_text(scene.read_text().replace("2 * bounces", "30 * bounces"))
        again(scene_project).stdout.fnmatch_lines(["*same motion, different result; twice is *, was *"])

    def test_a_picture_without_a_surface_is_said_in_a_line(self, scene_project):
        picture = scene_project.path / "drop" / "picture.py"
        picture.write_text(picture.read_text().replace("return self.frame(self.run.duration)", "self.frame(0.0)"))
        result = again(scene_project)
        result.stdout.fnmatch_lines(["*picture.py, line *: Picture.poster must return a pygame.Surface*"])
        result.stdout.no_fnmatch_line("*frames.py*")

    def test_the_numbers_of_a_setup_are_guarded_too(self, pytester, monkeypatch):
        monkeypatch.delenv("CI", raising=False)
        pytester.makepyfile(
            """
            import os
            import sandbox
            from sandbox import Ball, Setup

            def test_it(golden):
                ball = Ball("ball", 1.0, 0.1, (0.0, 0.0), (1.0 + float(os.environ.get("MORE", 0.0)), 0.0))
                golden.check("it", sandbox.simulate(Setup([ball], duration=1.0)))
            """
        )
        again(pytester, "--golden-update").assert_outcomes(passed=1)
        again(pytester).assert_outcomes(passed=1)
        monkeypatch.setenv("MORE", "1e-4")
        told = (
            "it differs from its golden run: the physics changed: first at t = 0 s, ball, vx is 1.0001 m/s, was 1 m/s*"
        )
        result = again(pytester)
        result.stdout.fnmatch_lines([told])
        result.stdout.no_fnmatch_line("*the parameters are the same*")

    def test_a_failure_says_which_parameters_and_versions_differ(self, scene_project, monkeypatch):
        result = self.changed(scene_project, monkeypatch, '{"gravity": 9.9, "air.wind": [1, 0]}')
        said = "other parameters: gravity 9.81 -> 9.9 m/s^2; air.wind[[]0[]] 0 -> 1 m/s"
        result.stdout.fnmatch_lines(["*; final_height is * m, was * m*", said])
        record = scene_project.path / "golden" / "it.json"
        record.write_text(re.sub(r"numpy [^,]+", "numpy 1.26.4", record.read_text()))
        scene = scene_project.path / "drop" / "scene.py"
        scene.write_text(scene.read_text().replace("-self.mass *", "-1.01 * self.mass *"))
        monkeypatch.setenv("CHANGES", "{}")
        said = "recorded with Python *, numpy 1.26.4, pymunk *, pygame-ce *; this is Python *, numpy 2*, *"
        again(scene_project).stdout.fnmatch_lines(["the parameters are the same", said])

    def test_update_refreshes_parameters_and_keeps_the_numbers(self, scene_project, monkeypatch):
        self.changed(scene_project, monkeypatch, '{"air.wind": [1, 0]}').assert_outcomes(passed=1)
        record = scene_project.path / "golden" / "it.json"
        before = json.loads(record.read_text())
        told = "*it.json: the same run, with its parameters and labels"
        again(scene_project, "--golden-update").stdout.fnmatch_lines([told])
        after = json.loads(record.read_text())
        assert after["parameters"]["air"]["wind"] == [1.0, 0.0]
        assert {**after, "parameters": 0} == {**before, "parameters": 0}

    def test_a_traceback_has_the_frames_of_the_author_alone(self, scene_project):
        scene = scene_project.path / "drop" / "scene.py"
        scene.write_text(scene.read_text().replace("return 0.0 * velocity[0]", "return self.unknown"))
        result = scene_project.runpytest_subprocess("-p", "no:cacheprovider", "--tb=short")
        files = re.findall(r"^(\S+\.py):\d+: in ", str(result.stdout), re.MULTILINE)
        assert files == ["test_it.py", "drop/scene.py"]
        whole = scene_project.runpytest_subprocess("-p", "no:cacheprovider", "--full-trace")
        assert "running.py" in str(whole.stdout)

    def test_the_tolerance_is_that_of_the_check(self, scene_project, monkeypatch):
        test = scene_project.path / "test_it.py"
        told = "*it: the run differs from its golden run by less than the tolerance of 0.01: *"
        test.write_text(test.read_text().replace('"{}"))))', '"{}")))), tolerance=0.01'))
        self.changed(scene_project, monkeypatch, '{"gravity": 9.811}').assert_outcomes(passed=1)
        picture = scene_project.path / "drop" / "picture.py"
        shows = "surface.fill((9, 9, 9), (2, 2, 9, 9)); return surface"
        picture.write_text(picture.read_text().replace("return surface", shows))
        again(scene_project).stdout.fnmatch_lines([told])
        monkeypatch.setenv("CHANGES", '{"gravity": 10.5}')
        again(scene_project).stdout.fnmatch_lines(["*the physics changed*"])

    def test_a_size_of_its_own_and_the_picture_only(self, scene_project, monkeypatch):
        test = scene_project.path / "test_it.py"
        test.write_text(test.read_text().replace('"{}"))))', '"{}")))), size=(320, 180), picture_only=True'))
        again(scene_project, "--golden-update").assert_outcomes(passed=1)
        assert [file.name for file in (scene_project.path / "golden").iterdir()] == ["it.png"]
        with Image.open(scene_project.path / "golden" / "it.png") as picture:
            assert picture.size == (320, 180)
        monkeypatch.setenv("CHANGES", '{"gravity": 9.8101}')  # no pixel shows it
        again(scene_project).assert_outcomes(passed=1)


def test_a_chaotic_run_is_kept_until_it_diverges(pytester, monkeypatch):
    monkeypatch.delenv("CI", raising=False)
    pytester.makepyfile(
        """
        import os
        import sandbox

        def test_it(golden):
            until = float(os.environ["UNTIL"]) if "UNTIL" in os.environ else None
            golden.check("it", sandbox.simulate(sandbox.load("billiards/eight-ball-break")), until)
        """
    )
    result = again(pytester, "--golden-update")
    result.assert_outcomes(failed=1)
    told = re.search(
        r"it depends on rounding from t = (\S+) s on.*golden\.check\('it', run, until=(\S+)\)", str(result.stdout)
    )
    assert told is not None
    assert float(told[2]) == pytest.approx(0.8 * float(told[1]), rel=0.1)
    monkeypatch.setenv("UNTIL", "0.16")
    again(pytester, "--golden-update").assert_outcomes(passed=1)
    again(pytester).assert_outcomes(passed=1)
    monkeypatch.setenv("UNTIL", "0.17")
    again(pytester).stdout.fnmatch_lines(["*recorded until 0.16 and checked until 0.17*"])


class TestRecords:
    """The tolerances of what is compared, each at its edge."""

    def records(self, **changes):
        scene = sandbox.load("golf", changes)
        return record(sandbox.simulate(scene))

    def test_rounding_is_no_change(self):
        kept = self.records()
        other = copy.deepcopy(kept)
        for row in other["states"]["ball"]:
            row[1:] = [value * (1 + 0.5 * TOLERANCE) for value in row[1:]]
        assert first_change(kept, other) is None

    @pytest.mark.parametrize(("column", "name"), [(1, "x"), (2, "y"), (3, "vx"), (4, "vy"), (5, "spin")])
    def test_a_state_beyond_the_tolerance_is_named(self, column, name):
        kept = self.records()
        other = copy.deepcopy(kept)
        row = other["states"]["ball"][7]
        row[column] += 3 * (TOLERANCE + TOLERANCE * abs(row[column]))
        t, told = first_change(kept, other)
        assert t == row[0]
        assert f"ball, {name} is" in told

    def test_an_event_that_is_gone_new_or_another(self):
        kept = self.records()
        gone, new, other = (copy.deepcopy(kept) for _ in range(3))
        del gone["events"][-1]
        new["events"].append([99.0, "impact", "ball", "pin", 1.0])
        other["events"][0][3] = "bunker"
        assert first_change(kept, gone)[1].endswith("ball rest green is gone")
        assert first_change(kept, new)[1].endswith("ball impact pin is new")
        assert "ball impact bunker, was ball impact fairway" in first_change(kept, other)[1]

    def test_a_kind_of_event_that_is_new_leaves_a_record_valid(self):
        """Other events are a change; and one of a kind that the record has, or that is gone."""
        now = self.records()
        known = {**now, "events": [event for event in now["events"] if event[1] != "rest"], "versions": "Python 3.99"}
        part, new = known_part(known, now)
        assert (first_change(known, part), new) == (None, ["event rest"])
        assert merged(known, now) == {**now, "versions": "Python 3.99"}
        for other in ({**known, "events": []}, {**known, "events": known["events"][1:]}):
            assert first_change(other, known_part(other, now)[0]) is not None
        assert first_change(now, known_part(now, known)[0])[1].endswith("rest green is gone")

    def test_a_record_is_changed_where_the_run_changed(self):
        """Each number that is the same keeps its digits; a moved state has its own, and the versions are those now."""
        known, now = self.records(), self.records()
        now["versions"] = "Python 3.99"
        now["states"]["ball"] = [[value * (1.0 + 1e-9) for value in row] for row in now["states"]["ball"]]
        now["states"]["ball"][7][1] += 1.0
        now["result"]["carry"] *= 1.0 + 1e-9
        now["events"].insert(1, [0.5, "impact", "ball", "bird", 1.0])
        changed = {*as_text(merged(known, now)).splitlines()} - {*as_text(known).splitlines()}
        assert len(changed) == 3
        assert as_text(merged(known, {**now, "states": known["states"]})).count("bird") == 1

    def test_results(self):
        kept = self.records()
        other = copy.deepcopy(kept)
        other["result"] = {**kept["result"], "holed": True, "carry": kept["result"]["carry"] + 0.001, "extra": 1}
        del other["result"]["apex"]
        told = changed_results(kept, other)
        assert [line.split()[0] for line in told] == ["carry", "apex", "holed", "extra"]

    @pytest.mark.parametrize(
        ("before", "after", "same"),
        [
            ([1.0, {"a": True}], [1.0 + 1e-9, {"a": True}], True),
            ([1.0, 2.0], [1.0, 2.1], False),
            ([1.0], [1.0, 2.0], False),
            ({"a": 1.0}, {"a": 1.1}, False),
            ({"a": 1.0}, {"b": 1.0}, False),
            ([1.0], {"a": 1.0}, False),
            ({"a": 1.0}, 1.0, False),
            (True, 1, False),
            (1.0, 1, True),
            (None, 0.0, False),
            ("in", "out", False),
        ],
    )
    def test_results_of_any_kind(self, before, after, same: bool):
        for one, other in ((before, after), (after, before)):
            assert (changed_results({"result": {"it": one}}, {"result": {"it": other}}) == []) is same

    def test_results_have_the_label_and_unit_of_their_fact(self):
        facts = {"clearance": Fact("clearance", "over the net", "m", lambda run, parameters: 0.0)}
        found = changed_results({"result": {"clearance": 0.3}}, {"result": {"clearance": 0.25}}, facts=facts)
        assert found == ["clearance (over the net) is 0.25 m, was 0.3 m"]
        found = changed_results({"result": {"clearance": 0.3}}, {"result": {"clearance": None}}, facts=facts)
        assert found == ["clearance (over the net) is null, was 0.3 m"]

    def test_text_reads_back(self):
        kept = self.records() | {"events": [], "result": {"spots": [1.0, {"a": "Fußball"}]}}
        assert json.loads(as_text(kept)) == kept


class TestThePlugin:
    @pytest.mark.parametrize(("processes", "options"), [("0", []), ("2", ["--golden-update"])])
    def test_name_clashes_are_refused_across_processes(self, project, processes: str, options: list[str]):
        first = (project.path / "test_it.py").read_text()
        (project.path / "test_other.py").write_text(first.replace('"white"', '"black"').replace("test_it", "test_more"))
        (project.path / "test_own.py").write_text(first.replace('"it"', '"own"'))
        result = run(project, f"--numprocesses={processes}", *options)
        assert result.ret == pytest.ExitCode.TESTS_FAILED
        both = (
            r"it is the golden name of test_it.py::test_it and test_other.py::test_more: each test needs its own name"
        )
        result.stdout.re_match_lines([both])
        assert len(list((project.path / "golden").glob("*"))) == (2 if options else 0)
        if options:
            result.stdout.fnmatch_lines(["*own.png: new"])

    def test_a_name_that_is_checked_twice_in_one_test_is_refused(self, project):
        text = (project.path / "test_it.py").read_text()
        (project.path / "test_it.py").write_text(
            text + '\n    golden.check("it", Image.new("RGB", (40, 30), "white"))\n'
        )
        result = run(project, "--golden-update")
        result.assert_outcomes(failed=1)
        result.stdout.fnmatch_lines(["it is checked twice in one test: each check needs a golden name of its own"])

    def test_a_time_that_is_none_is_refused(self, project):
        test = project.path / "test_it.py"
        times = "@__import__('pytest').mark.parametrize('until', [-1, 0.0, float('nan'), float('inf')])\n"
        checked = test.read_text().replace('"white")))', '"white")), until)')
        test.write_text(checked.replace("def test_it(golden)", f"{times}def test_it(golden, until)"))
        result = run(project, "--golden-update")
        result.assert_outcomes(failed=4)
        said = [f"*it: until = {until}: must be a time greater than 0 s" for until in (-1, 0.0, "nan", "inf")]
        result.stdout.fnmatch_lines(said)

    @pytest.mark.parametrize(
        ("checked", "said"),
        [
            ('"../it", image', "'../it': the name of a golden picture is that of a file*"),
            (
                '"it", np.asarray(image)',
                "it: only a run, a pygame surface or a Pillow image can be checked, not ndarray:*",
            ),
            ('"it", image, size=(3, 2)', "it: size = (3, 2): must be between *"),
            ('"it", image, tolerance=0.0', "it: tolerance = 0.0: must be greater than 0, in s, m, m/s and rad/s"),
        ],
    )
    def test_what_cannot_be_checked_is_said_in_a_line(self, project, checked: str, said: str):
        test = project.path / "test_it.py"
        text = test.read_text().replace("import os", "import os\nimport numpy as np")
        image = 'Image.new("RGB", (40, 30), os.environ.get("COLOUR", "white"))'
        test.write_text(text.replace(f'"it", {image}', checked.replace("image", image)))
        result = run(project, "--golden-update")
        result.assert_outcomes(failed=1)
        result.stdout.fnmatch_lines([said])
        assert not list(project.path.rglob("*.png"))

    def test_golden_files_that_no_test_uses_are_listed(self, project):
        run(project, "--golden-update")
        folder = project.path / "golden"
        for name in ("it.json", "old.png", "notes.txt"):
            (folder / name).write_text("")
        result = run(project, "--golden-unused")
        result.assert_outcomes(passed=1)
        result.stdout.fnmatch_lines(
            ["*golden files that no test has used*", str(folder / "it.json"), str(folder / "old.png")]
        )
        result.stdout.no_fnmatch_line("*notes.txt*")
        result.stdout.no_fnmatch_line("*it.png*")
        run(project).stdout.no_fnmatch_line("*no test has used*")

    def test_pictures_of_failures_are_no_golden_files(self, project, monkeypatch):
        run(project, "--golden-update")
        with monkeypatch.context() as changed:
            changed.setenv("COLOUR", "red")
            run(project).assert_outcomes(failed=1)
        assert (project.path / "out" / "golden" / "it.png").exists()
        run(project, "--golden-unused").stdout.no_fnmatch_line("*no test has used*")

    @pytest.mark.parametrize(
        "chosen", [["-k", "it"], ["test_it.py::test_it"], ["test_it.py"], ["--last-failed"], ["-x"], ["-m", "slow"]]
    )
    def test_unused_files_are_not_listed_of_a_selection(self, project, chosen: list[str]):
        result = project.runpytest("-p", "sandbox.golden", "--golden-unused", *chosen)
        assert result.ret == pytest.ExitCode.USAGE_ERROR
        result.stderr.fnmatch_lines([f"*--golden-unused needs all tests of a folder to run, not some by {chosen[0]}"])

    def test_a_missing_picture_fails_and_says_how_to_make_it(self, project):
        result = run(project)
        result.assert_outcomes(failed=1)
        result.stdout.fnmatch_lines(["*it has no golden picture*pytest --golden-update*"])
        assert not (project.path / "golden").exists()

    def test_update_makes_it_and_says_so(self, project):
        result = run(project, "--golden-update")
        result.assert_outcomes(passed=1)
        result.stdout.fnmatch_lines(["*golden files written*", "*it.png: new"])
        run(project).assert_outcomes(passed=1)

    def test_a_change_fails_and_shows_both_and_the_difference(self, project, monkeypatch):
        run(project, "--golden-update")
        monkeypatch.setenv("COLOUR", "red")
        result = run(project)
        result.assert_outcomes(failed=1)
        result.stdout.fnmatch_lines(["*100.00% of the pixels changed, the most by 254 of 255 levels*"])
        with Image.open(project.path / "out" / "golden" / "it.png") as shown:
            assert shown.size == (3 * 40 + 2 * 8, 30)
            assert shown.convert("RGB").getpixel((60, 15)) == (255, 0, 0)

    def test_update_leaves_alone_what_has_not_changed(self, project):
        run(project, "--golden-update")
        before = (project.path / "golden" / "it.png").stat().st_mtime_ns
        result = run(project, "--golden-update")
        result.stdout.no_fnmatch_line("*golden files written*")
        assert (project.path / "golden" / "it.png").stat().st_mtime_ns == before

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
    root = Path(__file__).parents[2]
    files = [*root.glob("tests/golden/*.*"), *root.glob("scenes/*/golden/*.*")]
    assert len(files) > 100
    assert [file.name for file in files if file.stat().st_size >= 80_000] == []


def test_the_shots_of_a_scene_of_ones_own_are_tests(project):
    folder = copy_of(DROP, project.path / "drop")
    file = folder / "shots.toml"
    file.write_text(
        '[[shot]]\ngolden = "drop"\n'
        '[[shot]]\nset = { "launch.height" = 1.0 }\nsays = "never"\ncard = { bounces = false }\n'
        '[[shot]]\nset = { "launch.height" = -1.0 }\nrefused = ["launch.height"]\n'
        '[[trend]]\nkey = "launch.height"\nvalues = [1, 2]\nresult = "bounces"\nleast = 1000.0\n'
    )
    done = run(project, "drop", "--golden-update")
    done.assert_outcomes(passed=2, failed=2)
    done.stdout.fnmatch_lines_random(["*not 'never'", "the card has bounces = *", "bounces = * for launch.height = *"])
    assert (folder / "golden" / "drop.json").exists()
    run(project, "drop").assert_outcomes(passed=2, failed=2)
    file.write_text("[[shot]]\ngolden = 3\n")
    run(project, "drop").stdout.fnmatch_lines_random(["*shots.toml: shot?0?.golden: Input should be a valid string*"])
