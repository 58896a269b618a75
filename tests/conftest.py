"""The same verdict each time: hypothesis tries the same examples in every run, however slow the machine."""

import gc
import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings
from hypothesis.internal.conjecture import providers

from sandbox.cli import main
from tests.browser import browser  # noqa: F401
from tests.own_scene import DROP, Outcome, copy_of

for ignored, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(ignored) is signal.SIG_IGN:  # as a shell's & and nohup do; children would inherit it
        signal.signal(ignored, handler)

settings.register_profile(
    "steady", max_examples=60, derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("steady")
# or it also tries numbers that it finds in the modules imported so far: others in each order of the tests
providers._get_local_constants = lambda: providers._local_constants


def pytest_collection_finish() -> None:
    """Make garbage collection skip the libraries and all tests, and come ten times as seldom: it would take a tenth of
    the time."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(7_000, 10, 10)


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Callable[..., Outcome]:
    """Call the program in this process."""

    def called(*args: object) -> Outcome:
        code = main([str(arg) for arg in args])
        return Outcome(code, *capsys.readouterr())

    return called


@pytest.fixture
def printed(request: pytest.FixtureRequest) -> Callable[[str, str], None]:
    """Compares a text with ``tests/printed/NAME.txt``, which ``--golden-update`` writes."""

    def check(name: str, text: str) -> None:
        file = Path(__file__).parent / "printed" / f"{name}.txt"
        if request.config.getoption("--golden-update"):
            file.write_text(f"{text.rstrip()}\n", "utf-8")
        assert text.rstrip().splitlines() == file.read_text("utf-8").splitlines(), "if intended: pytest --golden-update"

    return check


@pytest.fixture
def drop(tmp_path: Path) -> Path:
    """A scene of the user's own: a copy of the folder ``drop``."""
    return copy_of(DROP, tmp_path / "drop")
