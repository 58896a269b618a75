"""Mistakes in a scene of the user's own: told in a line, or by the user's own lines of a traceback."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from sandbox.cli.new import new_scene
from tests.own_scene import BUILD, DROP, Outcome, assert_refused, change, copy_of

Call = Callable[..., Outcome]

NAME = "beachvolley"
#: A file of ``drop``, or of what ``sandbox new`` writes.
OF_DROP, OF_NEW, PICTURE = "drop/scene.py", f"{NAME}/scene.py", f"{NAME}/picture.py"
#: Where a method of the new picture, of the drop's force, and of its surface begin.
PLACE, FORCE, FLOOR = "    @cached_property", "        return 0.0 * velocity[0]", "friction=0.5)"
BALL, GRAVITY = "    ball = Ball(", "Gravity(parameters.ball.mass, parameters.gravity)"


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("written") / NAME
    new_scene(folder)
    return folder


@pytest.fixture
def scene(written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with both scenes, in which we are."""
    copy_of(DROP, tmp_path / "drop")
    copy_of(written, tmp_path / NAME)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (OF_DROP, "class Throw", "1 / 0\nclass Throw", "ZeroDivisionError: division by zero"),
        (OF_DROP, BALL, "    ball = nowhere(", "NameError: name 'nowhere' is not defined"),
        (OF_DROP, FORCE, "        return velocity[2], self", "IndexError: tuple index out of range"),
        (OF_DROP, "bounces(run, parameters) > 0", "run.events[99]", "IndexError: list index out of range"),
        (OF_DROP, "FACTS = (", "FACTS = [", "SyntaxError: "),
        (
            OF_DROP,
            'return "Bounced"',
            'return run.result["gone"] and "Bounced"',
            "UnknownFact: 'gone': no such",
        ),
        (OF_DROP, "duration=parameters.duration", "length=parameters.duration", "TypeError: "),
        (OF_DROP, '"m/s", low=0', '"furlong", low=0', 'ValueError: "furlong" is not a known unit: use'),
        (OF_DROP, '"m/s", low=0', '"MPH", low=0', 'ValueError: "MPH" is not a known unit: did you me'),
        (OF_DROP, "import Group,", "import Accuracies, Group,", "ImportError: cannot import name 'Accuracies'"),
        (OF_DROP, "class Throw", "raise SystemExit(0)\nclass Throw", "ExitCalled: SystemExit(0)"),
        (OF_DROP, BALL, f"    exit(0)\n{BALL}", "ExitCalled: SystemExit(0)"),
        (OF_DROP, FORCE, "        raise SystemExit('well')\n        return 0", "ExitCalled: SystemExit('we"),
        (OF_DROP, FLOOR, "friction=0.5, law=lambda *_: exit(0))", "ExitCalled: SystemExit(0)"),
        (OF_DROP, BALL, f"    raise GeneratorExit\n{BALL}", "ExitCalled: GeneratorExit()"),
        (OF_DROP, f"({GRAVITY},)", GRAVITY, "forces = Gravity(mass=0.2, gravity=9.81) must be a list: write it in [ ]"),
        (OF_DROP, "Setup((ball,)", "Setup(ball", "must be a list: write it in [ ]"),
        (OF_DROP, FORCE, "        raise BrokenPipeError\n        return 0", "BrokenPipeError"),
        (OF_DROP, FORCE, "        raise StopIteration\n        return 0", "StopIteration"),
        (OF_DROP, FORCE, "        raise ValueError('a\\x1b[31mb')\n        return 0", "ValueError: a\\u001b[31mb"),
        (OF_NEW, "launch.height, parameters", "launch.hight, parameters", "AttributeError: 'Toss' object has no"),
        (OF_NEW, "def build(", "\udcff\ndef build(", "SyntaxError: "),
        (
            OF_NEW,
            'fact_from(landing, "x")',
            'fact_from(landing, "ex")',
            'ValueError: fact_from(..., "ex"): a Moment has t',
        ),
        (OF_NEW, 'until=Touches("floor", 4)', "until=lambda event: event.foo", "AttributeError: 'Event'"),
        (OF_NEW, 'Touches("floor"', 'Touches("flor"', "times=4): unknown name; choose from ball, floor"),
        (OF_NEW, "duration=20.0", "duration=-20.0", "duration = -20.0 s must be positive"),
        (PICTURE, '"shooting"', '"hopping"', "pose = 'hopping': there is no such pose; the poses are standing, sho"),
        (PICTURE, '"shooting"', '"serving"', "'serving': colours lacks racket; this pose needs racket, far, body, sh"),
        (PICTURE, "Place(Hall", "Place(Hole", "NameError: name 'Hole' is not defined"),
        (PICTURE, "launch.height)", "launch.hight)", "AttributeError: 'Toss' object has no"),
        (PICTURE, "import Ground", "import Grounds, Ground", "ImportError: cannot import name 'Grounds' from 'sandbox"),
        (
            OF_NEW,
            "launch: Toss = group(...,",
            "launch: Toss = group(Toss(),",
            'ValueError: Toss: speed has no default (and 2 more); give it one, or write group(..., "...") in place of '
            "Toss(): then the scene's file has it",
        ),
        (
            OF_NEW,
            "launch: Toss = group(...,",
            "launch: Toss = group(Toss(speed='far', angle=1, spin=1, height=1),",
            'ValueError: Toss: speed = "far": is not a number with a unit; use m/s, km/h, mph, kn or ft/s',
        ),
        (OF_NEW, "    Setup,", "    Set_up,", "ImportError: cannot import name 'Set_up' from 'sandbox.kit'"),
        (PICTURE, PLACE, f"    def poster(self): exit(0)\n\n{PLACE}", "SystemExit: 0"),
        (PICTURE, PLACE, f"    def poster(self): open('gone')\n\n{PLACE}", "FileNotFoundError: "),
    ],
)
def test_a_failure_shows_the_users_lines_only(call: Call, scene: Path, file: str, old: str, new: str, expected: str):
    change(scene / file, old, new)
    code, out, err = call("run", f"./{file.partition('/')[0]}", "--poster", "poster.png", "--json")
    assert (code, out) == (1, "")
    assert err.startswith("error: your scene failed\n")
    assert expected in err.splitlines()[-1]
    files = [line.split('"')[1] for line in err.splitlines() if line.startswith("  File ")]
    assert set(files) == {str(scene / file)}
    assert not Path("poster.png").exists()


#: What an engine or a sweep is given: told by ``run``, and by ``sweep`` as well.
HANDED_OVER = [
    (OF_DROP, "parameters.duration)", "parameters.duration, until=lambda: True)", "until is called as until(event): "),
    (OF_DROP, FLOOR, "friction=0.5, law=lambda: None)", "is called as law(normal_speed, tangential_speed): "),
    (OF_DROP, FLOOR, "friction=0.5, law=lambda *_: None)", "must return a Bounce of numbers, such as Bounce(rest"),
    (OF_DROP, FLOOR, "friction=0.5, law=lambda *_: (0.5, 0.5))", "and returned (0.5, 0.5) (drop/{})"),
    (OF_DROP, FLOOR, "friction=0.5, law=lambda *_: 'hard')", "and returned 'hard'"),
    (OF_DROP, f"{FORCE},", "        return 1j,", "Gravity is called with (t, position, velocity, spin)"),
    (
        OF_DROP,
        f"{FORCE},",
        "        return float('nan'),",
        "spin) and must return (fx, fy) in N, a torque one number in N m",
    ),
    (OF_DROP, f"{FORCE},", "        return 10**400,", "int too large to convert to float (drop/{})"),
    *(
        (OF_DROP, "FACTS = (", f"x = []\nx.append(x)\nFACTS = (Fact('odd', '', '', lambda run, _: {what}),", said)
        for what, said in (
            (
                "x",
                "the fact odd must return a number, a text of at most 400 characters, true or false, or a list or "
                "dictionary of those, but returned [[...]]",
            ),
            ("[1j]", "or a list or dictionary of those, but returned [1j]"),
            ("10**400", "the fact odd must return a num"),
            ("run", "or a list or dictionary of those, but returned <Run"),
        )
    ),
    *(
        (OF_DROP, "FACTS = (", f"FACTS = (Fact('odd', '{label}', 'm', lambda run, _: {what}),", said)
        for label, what, said in (
            ("odd", "'far'", "drop/{}: the fact odd must return a number in m, a list of them, or None, but return"),
            ("odd", "{'a': 1.0}", "a list of them, or None, but returned {'a': 1.0}"),
            ("odd", "True", "a list of them, or None, but returned True"),
            ("", "{'a': [1.0, 'far']}", "a list of them, or None, but returned {'a': [1.0, 'far']}"),
        )
    ),
]
#: What a scene defines.
DEFINED = [
    (OF_DROP, '"bounces", "bounces"', '"bounces", 5', "FACTS: key and label must be text, but are 'bounces' and 5"),
    (OF_DROP, '"", bounces)', '"", lambda run: 1)', "FACTS: bounces is computed as compute(run, parameters): too many"),
    (OF_DROP, '"", bounces)', '"", 1)', "FACTS: bounces is computed as compute(run, parameters): 1 is not a callable"),
    (OF_DROP, "def build", "def construct", "a scene needs Parameters, build; build is missing"),
    (OF_DROP, "class Parameters(SceneParameters)", "class Numbers(SceneParameters)", "Parameters is missing"),
    (OF_DROP, "class Parameters(SceneParameters)", "class Parameters(dict)", "must be a sandbox.parameters.SceneParam"),
    (OF_DROP, "class Parameters(SceneParameters)", "class Parameters(Group)", "must be a sandbox.parameters.ScenePar"),
    (OF_NEW, "width: float =", "width: Nowhere =", "scene.py: Parameters: name 'Nowhere' is not defined"),
    (OF_NEW, "return Setup([", "Setup([", "{}: build must return a Setup, but returned None"),
    (OF_NEW, 'return "Never', '"Never', "{}: verdict must return text, but returned None"),
    (OF_NEW, "FACTS = (", "FACTS = (3,", "FACTS must be a tuple of facts, but 3 is not one"),
    (OF_NEW, '"apex", "m"', '"apex", "metres"', 'FACTS: apex has the unit "metres", which is not known'),
    (OF_NEW, 'final_when="floor"', 'final_when="flor"', 'has final_when="flor"; choose from start, end, ball, floor'),
    (OF_NEW, '"apex", "apex"', '"distance", "apex"', "FACTS: two are called distance"),
    (OF_NEW, "def build(parameters: Parameters)", "def build()", "build is called as build(parameters)"),
    (OF_NEW, "def verdict(run: SceneRun, ", "def verdict(", "verdict is called as verdict(run, parameters)"),
    (OF_NEW, "return 0.0, self.push", "0.0, self.push", "must return"),
    (OF_NEW, "return 0.0, self.push", "return self.push", "must return"),
    (OF_NEW, "velocity: Any, spin: Any)", "velocity: Any)", "is called with"),
    (OF_NEW, "CONTROLS = Controls(", "CONTROLS = dict(", "CONTROLS must be a sandbox.sport.controls.Controls"),
    (OF_NEW, 'Handle("fan.place"', 'Handle("fan.plaice"', 'CONTROLS handles "fan.plaice": unknown key; did you mean f'),
    (OF_NEW, "full_pull_speed=20.0", 'speed="launch.sped"', 'CONTROLS speed "launch.sped": unknown key; did'),
    (OF_NEW, '(Spin("launch.spin", 20.0),)', '(Spin("launch.spin", 20.0))', "CONTROLS spins = Spin("),
    (OF_NEW, "full_pull_speed=20.0", 'scores="enbed"', 'CONTROLS scores "enbed": no such result; did you mean ended?'),
    (OF_NEW, "full_pull_speed=20.0", 'fan_fact="apx"', 'CONTROLS fan_fact "apx": no such result; did you mean apex?'),
    (PICTURE, "class Picture", "class Pictures", "Picture(run, parameters, size, ghosts) is missing"),
    (PICTURE, "Picture(SideView[Parameters])", "Picture", "Picture must be a SideView or an AboveView"),
    (PICTURE, PLACE, f"    def __init__(self, run): ...\n{PLACE}", "called as Picture(run, parameters, size, ghosts)"),
    (PICTURE, PLACE, f"    def frame(self, x, t): ...\n{PLACE}", "called as Picture.frame(self, t)"),
    (PICTURE, PLACE, f"    def poster(self): ...\n{PLACE}", "must return a pygame.Surface, and returned None"),
    (PICTURE, PLACE, f"    def frame(self, t): ...\n\n    def poster(self): return 3\n\n{PLACE}", "and returned 3"),
    (PICTURE, "return Place(", "Place(", "picture.py, line 15: Picture.place must return a Place, and returned None"),
    (
        PICTURE,
        PLACE,
        f"    @property\n    def moment(self): ...\n\n{PLACE}",
        "Picture.moment must return a float, and r",
    ),
    (
        PICTURE,
        PLACE,
        f"    def notes(self, camera): ...\n\n{PLACE}",
        "Picture.notes must return a list[str], and returned None",
    ),
    *((file, "import", "import\0", f"{file}: not a text file, it holds NUL bytes") for file in (OF_NEW, PICTURE)),
]


LINE = re.compile(r"scene\.py, line \d+")


@pytest.mark.parametrize(("file", "old", "new", "expected"), HANDED_OVER + DEFINED)
def test_what_is_given_wrongly_is_said_in_a_line(call: Call, scene: Path, file: str, old: str, new: str, expected: str):
    change(scene / file, old, new)
    outcome = call("run", f"./{file.partition('/')[0]}", "--poster", "poster.png")
    assert_refused(outcome._replace(err=LINE.sub("{}", outcome.err)), expected, code=outcome.code or 1)


@pytest.mark.parametrize(("file", "old", "new", "expected"), HANDED_OVER)
def test_a_sweep_says_it_too(call: Call, scene: Path, file: str, old: str, new: str, expected: str):
    change(scene / file, old, new)
    outcome = call("sweep", "./drop", "--over", "launch.height=1:2:30", "--jobs", 1, "--out", "rows.csv")
    assert_refused(outcome._replace(out="", err=LINE.sub("{}", outcome.err)), expected, code=1)


def test_a_fact_that_is_not_a_number_did_not_happen(call: Call, scene: Path):
    change(scene / OF_DROP, "FACTS = (", "FACTS = (Fact('odd', 'odd', 'm', lambda run, _: float('nan')),")
    lines = [line for line in call("run", "./drop").out.splitlines() if "odd" in line]
    assert lines == ["  warning: odd is not a finite number, and null in JSON"]
    assert "nan" not in call("aim", "./drop", "--vary", "launch.height=1:2", "--target", "odd=2").out


def test_a_range_in_which_all_runs_fail_says_where(call: Call, scene: Path):
    change(scene / OF_DROP, BUILD, f"{BUILD}    raise StopIteration\n")
    outcome = call("aim", "./drop", "--vary", "launch.height=1:2", "--target", "bounces=2")
    assert_refused(outcome, "the first error: StopIteration (drop/scene.py, line ", code=1)


@pytest.mark.parametrize("jobs", [1, 2])
def test_exit_in_a_sweep_fails_its_points(call: Call, scene: Path, jobs: int):
    change(scene / OF_DROP, BUILD, f"{BUILD}    if parameters.launch.height < 1.5: raise SystemExit(0)\n")
    assert call("sweep", "./drop", "--over", "launch.height=1,2", "--out", "rows.csv", "--jobs", jobs).code == 0
    head, failed, ran = Path("rows.csv").read_text("utf-8").splitlines()
    assert head.endswith(",error")
    assert re.search(r"ExitCalled: SystemExit\(0\): .* \(drop/scene\.py, line \d+\)", failed)
    assert ran.endswith(",")


def test_a_bug_of_ours_is_not_hidden(call: Call, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("sandbox.cli.card.card", lambda *_: [][0])
    monkeypatch.setattr("sandbox.tracebacks.is_ours", lambda filename: True)  # this test stands in for our own code
    with pytest.raises(IndexError):
        call("run", "golf")


def test_an_error_text_without_an_end_is_cut(call: Call, scene: Path):
    change(scene / OF_DROP, FORCE, f"        raise ValueError('y' * 100_000)\n{FORCE}")
    outcome = call("run", "./drop")
    assert (outcome.code, len(outcome.err) < 1_000) == (1, True)
    assert "ValueError: yyy" in outcome.err


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            'return "Bounced"',
            'return 100_000 * "x"',
            "verdict must return text of at most 400 characters, but returned 'x",
        ),
        ("float(run.state", "10**5000 * int(run.state", "final_height must return a number, a text of at most 400"),
        ("float(run.state", "100_000 * str(run.state", "final_height must return a number, a text of at most 400"),
        (
            "float(run.state",
            "dict.fromkeys([500 * 'k'], 1.0) or (run.state",
            "final_height must return a number, a text",
        ),
    ],
)
def test_what_no_card_has_room_for_is_refused(call: Call, scene: Path, old: str, new: str, expected: str):
    change(scene / OF_DROP, old, new)
    assert_refused(call("run", "./drop", "--poster", "x.png"), expected, 1)


def test_an_array_of_numpys_is_a_list(call: Call, scene: Path):
    change(scene / OF_DROP, "float(run.state", "__import__('numpy').array([1.0, 2.0]) if run else (run.state")
    outcome = call("run", "./drop", "--json")
    assert json.loads(outcome.out)["result"]["final_height"] == [1.0, 2.0]
    assert call("run", "./drop", "--poster", "x.png").code == 0
