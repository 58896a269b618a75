"""Fixtures of the tests of sweeps."""

from __future__ import annotations

import pytest

from sandbox.scene import Scene, load
from tests.own_scene import DROP


@pytest.fixture
def falling() -> Scene:
    return load(DROP)


@pytest.fixture
def one_at_a_time(monkeypatch):
    """Shots that do not fly together."""
    monkeypatch.setattr("sandbox.lab.plan.fly_together", lambda *args: False)
