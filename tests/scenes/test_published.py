"""Published cases: every row of sandbox/lab/published beside ours. The tables are those of ``sandbox validate``."""

from __future__ import annotations

from sandbox.lab.validate import as_text, cases, validate
from sandbox.scene import listings


def test_every_case_holds_or_says_why_not_and_most_hold():
    rows = validate()
    silent = [f"{row.scene} {row.name} {row.result}" for row in rows if not row.holds and not row.reason]
    assert silent == []
    assert [row.name for row in rows if row.holds and row.reason] == []
    assert sum(row.holds for row in rows) >= 0.85 * len(rows)
    exact = [row for row in rows if row.source.startswith("exact")]
    assert len(exact) >= 20
    assert all(row.holds for row in exact)
    assert max(map(len, as_text(rows))) <= 80


def test_every_case_names_its_source_and_every_scene_has_cases():
    assert all(case.source for case in cases())
    scenes = {listing.name for listing in listings() if "/" not in listing.name}
    assert {case.scene.partition("/")[0] for case in cases()} >= scenes


def test_a_wrong_number_would_be_seen():
    """Half as much drag again, and the tour table no longer holds."""
    rows = validate("golf", {"ball.drag.model": "constant", "ball.drag.coefficient": 0.4})
    assert sum(row.holds for row in rows) < 0.5 * len(rows)


def test_a_result_that_a_changed_scene_lacks_does_not_hold():
    """On a dry lane no third pin is struck: the case says so, in place of an IndexError."""
    rows = validate("bowling", {"dry": 0.15})
    lacking = [row for row in rows if row.computed is None]
    assert [row.result for row in lacking] == ["met.3"]
    assert not lacking[0].holds
    assert "none" in "\n".join(as_text(lacking))


def test_another_model_takes_the_place_of_the_one_in_a_case():
    """A case with a constant coefficient, too, is computed with the model that is asked for."""
    rows = validate("golf", {"ball.drag.model": "usga", "ball.lift.model": "usga"})
    assert not any(row.holds for row in rows if row.name == "p = 1, 45 deg")
