"""What notebooks show, and the notebooks under docs, executed."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sandbox
from sandbox.errors import RequestError

NOTEBOOKS = sorted((Path(__file__).parent.parent.parent / "docs" / "notebooks").glob("*.ipynb"))


def shown(cell: str, names: dict[str, Any]) -> Any:
    """What a cell shows: its last line is an expression, as in Jupyter."""
    tree = ast.parse(cell)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    return None if last is None else eval(compile(ast.Expression(last.value), "cell", "eval"), names)


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_run_and_their_values_can_be_shown(notebook: Path):
    """Without Jupyter, whose kernels take longer to start than the cells take."""
    names: dict[str, Any] = {"__name__": "__main__"}
    content = json.loads(notebook.read_text("utf-8"))
    assert content["nbformat"] == 4
    for cell in content["cells"]:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            value = shown("".join(cell["source"]), names)
            for how in ("_repr_html_", "_repr_mimebundle_", "_repr_png_"):
                if hasattr(value, how):
                    assert getattr(value, how)()


def test_there_are_three_notebooks():
    assert [path.stem for path in NOTEBOOKS] == ["student", "teacher", "test-engineer"]


def test_pictures_of_a_run(tmp_path: Path):
    run = sandbox.simulate("throws")
    assert run.poster(size=(480, 270)).size == (480, 270)
    assert run.frame(0.5, size=(320, 180)).size == (320, 180)
    assert run.poster(tmp_path / "a.png") is None
    assert (tmp_path / "a.png").stat().st_size > 1000
    assert run.animate(size=(320, 180), fps=5).data[:4] == b"RIFF"
    run.animate(tmp_path / "a.gif", size=(320, 180), fps=5)
    assert (tmp_path / "a.gif").read_bytes()[:3] == b"GIF"
    with pytest.raises(RequestError, match=r"must end in \.gif or \.webp"):
        run.animate(tmp_path / "a.mov")
    with pytest.raises(RequestError, match="fps = 0: must be from 1 to 240"):
        run.animate(fps=0)
    with pytest.raises(RequestError, match=r"size = \(0, 0\): must be between 320x180"):
        run.poster(size=(0, 0))
    wrong_arguments = [
        (lambda: run.poster(size=(1e3, 500.5)), r"size = \(1000.0, 500.5\): must be two whole numbers"),
        (lambda: run.graph(size="large"), "size = large: must be two whole numbers"),
        (lambda: run.poster(3), "path = 3: must be the name of a file"),
        (lambda: run.frames(3), "path = 3: must be the name of a file"),
        (lambda: run.frame("1"), "frame at t = '1': must be a number, in s"),
        (lambda: run.frame(-1.0), "frame at t = -1 s: the run is from 0 to"),
        (lambda: run.frame(run.duration + 0.01), "frame at t = .* s: the run is from 0 to"),
        (lambda: run.animate(fps="25"), "fps = '25': must be from 1 to 240"),
    ]
    for ask, said in wrong_arguments:
        with pytest.raises(RequestError, match=f"^{said}"):
            ask()
    assert run.frame(run.duration).size == run.frame(0).size == (960, 540)
    times = [0.0, 0.5, 1.0]
    assert np.array_equal(run.states("shot" if "shot" in run.arcs else "ball", times)[1], run.state("ball", 0.5))
    state = run.state("ball", 0.5)
    assert (state.x, state.vy) == (state[0], state[3])


def test_a_search_is_shown_as_a_table_and_a_chart():
    found = sandbox.aim("throws", {"launch.angle": (20.0, 30.0)}, {"distance": 19.0})._repr_html_()
    assert "<th>launch.angle (deg)</th>" in found
    assert '<img alt="throws: distance = 19 m"' in found


def test_html_of_scene_sweep_and_aim(tmp_path: Path):
    scene = sandbox.load("throws")
    assert "m above the ground" in scene._repr_html_() or "launch.speed" in scene._repr_html_()
    sweep = sandbox.sweep(scene, {"launch.angle": [30.0, 40.0, 50.0]})
    assert "<img" in sweep._repr_html_()
    sweep.plot(tmp_path / "a.png", of="apex")
    assert (tmp_path / "a.png").stat().st_size > 1000
    with pytest.raises(RequestError, match="nonsense"):
        sweep.plot(of="nonsense")
    three = sandbox.sweep(scene, {key: [1.0, 2.0] for key in ("launch.angle", "launch.speed", "release.height")})
    assert "one or two" in three._repr_html_()


def test_a_run_shows_its_card_and_the_page_that_plays_it():
    run = sandbox.simulate("throws")
    found = run._repr_html_()
    assert all(text in found for _, text in run.scene.rows(run))
    assert 'srcdoc="&lt;!doctype html&gt;' in found
    assert "<script" not in found  # only inside the frame
