"""The tables of a run: sampling and columns of a trajectory, and what an impact keeps."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

import sandbox
from sandbox.cli import program, rows


def table(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_added_columns_of_a_trajectory_are_consistent(tmp_path: Path):
    """The forces are mass times acceleration; energy changes by the work of drag only: it falls."""
    run = sandbox.simulate(sandbox.load("throws", {"launch.speed": 30.0}))
    rows.write_trajectory(run, tmp_path / "put.csv", every=0.1, more=rows.MORE)
    found = [{key: float(cell) for key, cell in row.items() if key != "ball"} for row in table(tmp_path / "put.csv")]
    assert [row["t"] for row in found[:3]] == pytest.approx([0.0, 0.1, 0.2])
    flying = [row for row in found if row["y"] > 0.2]
    for row in flying:
        assert row["gravity_y"] + row["drag_y"] == pytest.approx(7.26 * row["ay"], rel=1e-5)
        assert row["gravity_x"] + row["drag_x"] == pytest.approx(7.26 * row["ax"], rel=1e-4)
    energies = [row["energy_speed"] + row["energy_height"] for row in flying]
    assert energies == sorted(energies, reverse=True)
    assert flying[0]["energy_height"] == pytest.approx(7.26 * 9.81 * 2.2)


def test_an_elastic_impact_keeps_momentum_and_energy():
    first, second, total = rows.impacts(sandbox.simulate("collisions"))
    assert {first["ball"], second["ball"], total["ball"]} == {"first", "second", "total"}
    for key in ("px", "py", "energy"):
        assert total[f"{key}_before"] == pytest.approx(total[f"{key}_after"], abs=1e-12)
        assert total[f"{key}_before"] == pytest.approx(first[f"{key}_before"] + second[f"{key}_before"])
    assert first["px_after"] == first["mass"] * first["vx_after"] != first["px_before"]


@pytest.mark.parametrize("preset", ["collisions", "collisions/heavy-on-light", "collisions/corner-on-face"])
def test_an_impact_keeps_angular_momentum_by_orbit_and_spin(preset: str):
    """m (x vy - y vx) + I w, smooth or rough, of balls and of boxes."""
    *each, total = list(rows.impacts(sandbox.simulate(preset)))[:3]
    assert total["angular_before"] == pytest.approx(total["angular_after"], abs=1e-9)
    assert total["angular_after"] == pytest.approx(sum(row["angular_after"] for row in each))
    assert total["spin_after"] == ""
    assert any(row["spin_after"] != row["spin_before"] for row in each) == (preset != "collisions")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--every", "0.1"], "--every 0.1: requires --trajectory F.csv"),
        (["--trajectory", "t.csv", "--every", "0"], "--every 0: must be at least"),
        (["--trajectory", "t.csv", "--every", "1 m"], '--every "1 m"'),
        (["--trajectory", "t.csv", "--every", "1e-8"], "more than 10,000,000 rows"),
        (
            ["--trajectory", "t.csv", "--columns", "speed"],
            'there is no "speed"; choose from acceleration, forces, energy',
        ),
        (["--columns", "forces"], "--columns forces: requires --trajectory"),
        (["--momentum", "m.png"], "--momentum m.png"),
    ],
)
def test_wrong_requests_are_one_line(
    arguments: list[str], expected: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
):
    monkeypatch.chdir(tmp_path)
    assert program.call(["run", "throws", *arguments]) == 2
    said = capsys.readouterr().err
    assert expected in said
    assert len(said.splitlines()) <= 2
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--family", "launch.angle"], "--family launch.angle: requires --plot"),
        (["--family", "gravity", "--plot", "p.png"], "--family gravity: is not swept over"),
        (["--family", "launch.angle", "--plot", "p.png"], "needs a grid over two parameters"),
    ],
)
def test_a_family_that_cannot_be_drawn_is_one_line(arguments: list[str], expected: str, tmp_path: Path, capsys):
    where = [str(tmp_path / word) if word == "p.png" else word for word in arguments]
    over = ["--over", "launch.angle=30,40", "--out", str(tmp_path / "s.csv")]
    assert program.call(["sweep", "throws", *over, *where]) == 2
    assert expected in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
