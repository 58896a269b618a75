"""The coefficients of a ball by every model: what they are, and what of them is drawn."""

from __future__ import annotations

import json

import pytest

import sandbox
from sandbox.cli.program import call
from sandbox.lab.coefficients import coefficients, report_of
from sandbox.lab.report import as_text
from sandbox.physics.coefficients import asai_lift, goff_carre_drag


def test_they_are_those_of_the_models():
    drag, lift = coefficients(sandbox.load("soccer"))
    assert (drag.chosen, lift.chosen) == ("goff-carre", "pooled")
    assert drag.models["goff-carre"] == pytest.approx([goff_carre_drag(re, 0.0) for re in drag.at])
    assert lift.models["asai"] == pytest.approx([asai_lift(lift.fixed, ratio) for ratio in lift.at])
    assert lift.fixed == pytest.approx(1.204 * 27.0 * 0.22 / 1.789e-5)  # rho v 2 r / mu
    assert lift.models["spin-ratio"] == lift.at
    assert "constant" not in drag.models


def test_a_constant_is_shown_if_the_scene_has_it():
    drag, lift = coefficients(sandbox.load("basketball"))
    assert drag.models == {"constant": [0.5] * 5}
    assert "the scene's" in "".join(as_text(report_of(sandbox.load("basketball"))))
    assert (lift.chosen, [*lift.models]) == ("none", ["spin-ratio"])


def test_the_command_draws_and_prints(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert call(["coefficients", "soccer", "--plot"]) == 0
    assert (tmp_path / "soccer-coefficients.png").stat().st_size > 10_000
    assert "wrote soccer-coefficients.png" in capsys.readouterr().out
    assert call(["coefficients", "golf", "--json", "--plot", "own.png"]) == 0
    assert (tmp_path / "own.png").exists()
    assert json.loads(capsys.readouterr().out)["lift"]["chosen"] == "monitor-fit"


def test_a_scene_without_air_is_refused(capsys):
    assert call(["coefficients", "billiards"]) == 2
    assert "no ball in it flies through air" in capsys.readouterr().err
