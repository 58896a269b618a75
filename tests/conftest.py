"""The same verdict each time: hypothesis tries the same examples in every run, however slow the machine."""

import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from sandbox.cli import main
from tests.own_scene import DROP, Outcome, copy_of

for ignored, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(ignored) is signal.SIG_IGN:  # as a shell's & and nohup do; children would inherit it
        signal.signal(ignored, handler)

settings.register_profile("steady", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("steady")


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Callable[..., Outcome]:
    """Call the program in this process."""

    def called(*args: object) -> Outcome:
        code = main([str(arg) for arg in args])
        return Outcome(code, *capsys.readouterr())

    return called


@pytest.fixture
def drop(tmp_path: Path) -> Path:
    """A scene of the user's own: a copy of the folder ``drop``."""
    return copy_of(DROP, tmp_path / "drop")
