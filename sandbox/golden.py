"""A pytest plugin that compares runs and pictures with golden ones in a folder near the tests.

    def test_my_scene(golden):
        golden.check("my_scene", sandbox.simulate(sandbox.load("my_scene.toml")))

The golden picture is ``golden/my_scene.png`` in the folder of the test or the nearest one above it; ``my_scene.json``
records the run, so that a failure can say whether the physics or the drawing changed. A picture (a
pygame surface or a Pillow image) can also be checked alone. ``pytest --golden-update`` makes and rewrites golden files
and lists them for review; on CI, where the variable CI is set, nothing is ever written. It changes a record only where
the run changed, and a fact that is new passes until it is recorded.

Each check may have its own limits: ``size`` of the picture in px, ``tolerance`` of the run's numbers, and
``picture_only=True`` compares what is drawn and not the run. ``pytest --golden-unused`` lists golden files that no test
has used; ``--golden-report F.html`` writes all failures as one page.

Only the beginning of a chaotic run is the same on another processor: ``golden.check("break", run, until=0.3)`` shows it
at that time in s and records what happened until then.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn, TypeVar

import pytest

from sandbox import entries, record, resources
from sandbox.errors import RequestError, RunError
from sandbox.files import check_size, forbidden, is_given, write_together
from sandbox.picture.difference import SIZE, as_png, coarser, compare, side_by_side, what_changed
from sandbox.record import Record
from sandbox.text import printable
from sandbox.tracebacks import is_hidden

if TYPE_CHECKING:
    import pygame
    from PIL import Image

    from sandbox.engine.paths.run import Run
    from sandbox.scene.scene_run import SceneRun
    from sandbox.sport.facts import Fact

    Subject = Run | pygame.Surface | Image.Image

__all__ = ["Golden", "golden"]

#: Most changes of a run that a message lists.
_MOST_CHANGES = 5

Known = TypeVar("Known")

NEW = "new"
#: Kinds of notes in the report of a test.
WRITTEN, _CHECKED, _USED, FAILED = "golden file written", "golden name", "golden file", "golden failure"
#: The part of an extension that writes failures as a page.
PAGES = "pages of golden failures"
_UNRECORDED = "golden record without it"
_HOW_TO_ACCEPT = "if the change is intended: pytest --golden-update"
FOLDER = "golden"
_REPORT = Path("out", "golden")
#: The folder of the sandbox itself, whose tests show its own frames.
_CHECKOUT = resources.PACKAGE.parent


class Golden:
    """The fixture: compares runs and pictures with the golden ones of one test."""

    def __init__(
        self, folder: Path, report: Path, update: bool, note: Callable[[str, str], None], with_page: bool = False
    ):
        """``note`` adds a line of a kind to the test's report: WRITTEN, CHECKED, USED, UNRECORDED or, ``with_page``,
        FAILED."""
        self.folder, self.report, self.update, self.note, self.with_page = folder, report, update, note, with_page
        self.checked: set[str] = set()

    def check(
        self,
        name: str,
        subject: Subject,
        until: float | None = None,
        *,
        size: tuple[int, int] = SIZE,
        tolerance: float = record.TOLERANCE,
        picture_only: bool = False,
    ) -> None:
        """Fail unless the subject matches the golden one of that name.

        The subject is a picture, or a run of a scene or a setup: its poster is drawn in a ``size`` in px, or with
        ``until`` the frame at that time in s. The run's numbers may differ by ``tolerance`` in s, m, m/s or rad/s, or
        by that share of themselves; with ``picture_only`` they are not compared.
        """
        from sandbox.engine.paths.run import Run
        from sandbox.scene.setup_scene import with_scene

        _check_request(name, until, size, tolerance)
        self.note(_CHECKED, str(self.folder / name))
        if name in self.checked:
            _fail(f"{name} is checked twice in one test: each check needs a golden name of its own")
        self.checked.add(name)
        subject = with_scene(subject) if isinstance(subject, Run) else subject
        run = subject if isinstance(subject, Run) and not picture_only else None
        image = _as_image(name, subject, until, size)
        png, text = self.folder / f"{name}.png", self.folder / f"{name}.json"
        for path in [png] if run is None else [png, text]:
            self.note(_USED, str(path))
        expected = self._known(name, image, png, _read)
        drawing = _changed_drawing(expected, image)
        known = None if run is None else self._known(name, image, text, record.read)
        whole = {} if run is None else record.record(run, until, (known or {}).get("duration"))
        actual, new = (whole, []) if known is None else record.known_part(known, whole)
        facts = {} if run is None else run.scene.facts
        physics = None if run is None else _changed_physics(known, actual, tolerance, facts)
        if self.update:
            written = {} if drawing is None else {png: (as_png(coarser(image)), drawing)}
            if run is not None and physics is not None:
                written[text] = _recorded(name, run, until, tolerance, known), physics
            elif known is not None and (new or any(known.get(key) != actual.get(key) for key in record.EXPLAINING)):
                change = "; ".join(f"{each} is new" for each in new) or "the same run, with its parameters and labels"
                written[text] = record.as_text(record.merged(known, whole, tolerance)).encode(), change
            self._write(written)
        elif drawing is None and physics is None:
            for each in new:
                self.note(_UNRECORDED, f"{text}: {each}")
        elif expected is None or physics == NEW:
            what, path = ("picture", png) if expected is None else ("run", text)
            message = f"{name} has no golden {what} at {path}"
            self._report(name, [message], image, expected)
            _fail(f"{message}; make it with pytest --golden-update")
        else:
            lines = list(_kind_of_change(name, known, actual, physics, drawing, tolerance))
            if run is not None and known is not None:
                lines += _cause(known, actual, run)
            changes = [] if known is None else _all_changes(known, actual, tolerance, facts)
            self._report(name, lines, image, expected, changes)
            _fail(*lines, *self._save_difference(name, expected, image, drawing), _HOW_TO_ACCEPT)

    def _write(self, written: Mapping[Path, tuple[bytes, str]]) -> None:
        """Write new golden files, all or none, and note how each has changed."""
        write_together({path: data for path, (data, _) in written.items()})
        for path, (_, change) in written.items():
            self.note(WRITTEN, f"{path}: {change}")

    def _report(
        self,
        name: str,
        lines: Sequence[str],
        actual: Image.Image,
        expected: Image.Image | None = None,
        changes: Sequence[str] = (),
    ) -> None:
        """Add a failure to the page of all failures, if there is to be one."""
        if not self.with_page:
            return
        same_size = expected is not None and expected.size == actual.size
        difference = what_changed(expected, actual) if expected is not None and same_size else None
        failure = entries.require(PAGES, "--golden-report").failure
        self.note(FAILED, json.dumps(failure(name, lines, changes, expected, actual, difference)))

    def _known(self, name: str, actual: Image.Image, path: Path, read: Callable[[Path], Known]) -> Known | None:
        """Return the content of a golden file; None if there is none, or a damaged one that is to be made again."""
        try:
            return read(path) if is_given(path) else None
        except (OSError, SyntaxError, ValueError) as error:
            if not self.update:
                message = f"{name}: {path} is damaged: {error}"
                self._report(name, [message], actual)
                _fail(message, "fetch it again, or make it again: pytest --golden-update")
            return None

    def _save_difference(
        self, name: str, expected: Image.Image, actual: Image.Image, drawing: str | None
    ) -> Iterator[str]:
        if drawing is not None:
            path = self.report / f"{name}.png"
            write_together({path: as_png(side_by_side(expected, actual))})
            yield f"expected, actual and difference, side by side: {path}"


def _recorded(name: str, run: SceneRun, until: float | None, tolerance: float, known: Record | None) -> bytes:
    """The golden record of a run, which changes one that is ``known`` where the run did; fails for one that depends on
    rounding."""
    chaos = record.diverges(run, until, tolerance)
    if chaos is not None:
        _fail(
            f"{name} depends on rounding from t = {chaos:.3g} s on, so another processor would differ; "
            f"check only the part before that: golden.check({name!r}, run, until={0.8 * chaos:.2g})"
        )
    recorded = record.record(run, until)
    return record.as_text(recorded if known is None else record.merged(known, recorded, tolerance)).encode()


def _check_request(name: str, until: float | None, size: tuple[int, int], tolerance: float) -> None:
    """Fail where a check is given what makes no sense."""
    if not isinstance(name, str) or name in ("", ".", "..") or "/" in name or forbidden(name):
        _fail(f'{name!r}: the name of a golden picture is that of a file in the folder golden, such as "my_shot"')
    if until is not None and not (isfinite(until) and until > 0.0):
        _fail(f"{name}: until = {until}: must be a time greater than 0 s")
    if not (isfinite(tolerance) and tolerance > 0.0):
        _fail(f"{name}: tolerance = {tolerance}: must be greater than 0, in s, m, m/s and rad/s")
    try:
        check_size(f"{name}: size = {size}", size)
    except RequestError as error:
        _fail(str(error))


def _kind_of_change(
    name: str, known: Record | None, actual: Record, physics: str | None, drawing: str | None, tolerance: float
) -> Iterator[str]:
    """Yield the kind of change, one line each."""
    small = None if known is None or physics is not None else _difference_below_tolerance(known, actual)
    if physics is not None:
        yield f"{name} differs from its golden run: {physics}"
        if drawing is not None:
            yield f"the drawing: {drawing}"
    elif small is not None:
        yield f"{name}: the run differs from its golden run by less than the tolerance of {tolerance:g}: {small}"
        yield f"the picture shows it: {drawing}"
    else:
        yield f"{name} differs from its golden picture: {'same physics, the drawing changed: ' * bool(actual)}{drawing}"


def _cause(known: Record, actual: Record, run: SceneRun) -> Iterator[str]:
    """Yield where a difference may come from, as far as the golden record has it: parameters, versions."""
    from sandbox.parameters import walk

    units = {parameter.key: parameter.unit for parameter in walk(run.scene.parameters, entries=True)}
    changed = record.changed_parameters(known, actual, units)
    if changed:
        first, more = changed[:_MOST_CHANGES], changed[_MOST_CHANGES:]
        yield f"other parameters: {'; '.join([*first, *([f'{len(more)} more'] if more else [])])}"
    elif len(known.get("parameters", ())) > 1:  # a bare setup has none but its accuracy
        yield "the parameters are the same"
    if known.get("versions", actual["versions"]) != actual["versions"]:
        yield f"recorded with {known['versions']}; this is {actual['versions']}"


def _difference_below_tolerance(known: Record, actual: Record) -> str | None:
    """The first event or result whose digits differ from those of the golden run, in words; None if there is none.

    States are left out: their times are rounded, which moves a fast ball by a few nanometres.
    """
    one, other = ({**each, "states": {}} for each in (known, actual))
    return next(iter(_all_changes(one, other, tolerance=0.0)), None)


def _fail(*lines: str) -> NoReturn:
    raise pytest.fail.Exception(printable("\n".join(lines)), pytrace=False) from None


def _changed_drawing(expected: Image.Image | None, actual: Image.Image) -> str | None:
    """Return the difference from the golden picture in words; None if it is small enough."""
    if expected is None:
        return NEW
    try:
        difference = compare(expected, actual)
    except ValueError as error:
        return str(error)
    return str(difference) if difference.matters else None


def _changed_physics(known: Record | None, actual: Record, tolerance: float, facts: Mapping[str, Fact]) -> str | None:
    """Return the difference from the golden run in words; None if it is the same."""
    if known is None:
        return NEW
    before, now = (recorded.get("until", "its end") for recorded in (known, actual))
    if before != now:
        return f"recorded until {before} and checked until {now}"
    first = record.first_change(known, actual, tolerance)
    results = record.changed_results(known, actual, tolerance, facts)
    if first is None and not results:
        return None
    moved = "same motion, different result" if first is None else f"the physics changed: first at {first[1]}"
    listed, more = results[: _MOST_CHANGES - 2], results[_MOST_CHANGES - 2 :]
    return "; ".join([moved, *listed, *(more if len(more) < 2 else [f"{len(more)} more"])])


def _all_changes(known: Record, actual: Record, tolerance: float, facts: Mapping[str, Fact] | None = None) -> list[str]:
    """Return all differences from the golden run in words: of each ball, the events and the results."""
    moved = [text for _, text in record.changes(known, actual, tolerance)]
    return [*moved, *record.changed_results(known, actual, tolerance, facts)]


def _as_image(name: str, subject: Subject, until: float | None, size: tuple[int, int]) -> Image.Image:
    import pygame
    from PIL import Image

    from sandbox.picture.frames import to_image
    from sandbox.scene.scene_run import SceneRun

    if isinstance(subject, Image.Image):
        return subject.convert("RGB")
    if isinstance(subject, pygame.Surface):
        return to_image(subject)
    if not isinstance(subject, SceneRun):
        _fail(
            f"{name}: only a run, a pygame surface or a Pillow image can be checked, not "
            f"{type(subject).__name__}: sandbox.simulate returns a run, and an array of pixels becomes an "
            "image by PIL.Image.fromarray"
        )
    picture = subject.scene.picture(subject, size)
    try:
        return to_image(picture.poster() if until is None else picture.frame(until))
    except RunError as error:
        _fail(str(error))


def _read(path: Path) -> Image.Image:
    from PIL import Image

    with Image.open(path) as file:
        return file.convert("RGB")


def _folder_for(test: Path, root: Path) -> Path:
    """The folder ``golden`` next to a test, or the nearest one above it; or, if there is none, next to the test."""
    for parent in test.parents:
        if (parent / FOLDER).is_dir():
            return parent / FOLDER
        if parent == root:
            break
    return test.parent / FOLDER


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--golden-update", action="store_true", help="make and rewrite golden files, and list them")
    parser.addoption("--golden-report", metavar="F.html", help="write all golden failures as one page")
    parser.addoption("--golden-unused", action="store_true", help="list golden files that no test has used")


def pytest_configure(config: pytest.Config) -> None:
    page = config.getoption("--golden-report")
    if page is not None and Path(page).suffix.lower() != ".html":
        raise pytest.UsageError(f"--golden-report {page}: its name must end in .html")
    if page is not None and entries.find(PAGES) is None:
        raise pytest.UsageError(entries.missing(PAGES, "--golden-report"))
    if config.getoption("--golden-unused") and (chosen := _selection(config)) is not None:
        raise pytest.UsageError(f"--golden-unused needs all tests of a folder to run, not some by {chosen}")
    if config.getoption("--golden-update") and os.environ.get("CI", "").lower() not in ("", "0", "false"):
        raise pytest.UsageError("--golden-update: golden files are never written on CI, and the variable CI is set")


def _selection(config: pytest.Config) -> str | None:
    """The option by which only some of the tests are run; None if there is none."""
    options = {"keyword": "-k", "markexpr": "-m", "lf": "--last-failed", "deselect": "--deselect", "maxfail": "-x"}
    chosen = (flag for option, flag in options.items() if config.getoption(option, None))
    return next(chosen, next((arg for arg in config.args if "::" in arg or Path(arg).is_file()), None))


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """The shots of a scene whose outcome is known are tests."""
    if file_path.name != "shots.toml" or not (file_path.parent / "scene.py").is_file():
        return None
    from sandbox.shots import ShotsFile

    return ShotsFile.from_parent(parent, path=file_path)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> None:
    """Hide the sandbox's own frames, so that a traceback shows the author's; --full-trace shows all of them."""
    if call.excinfo is not None and item.config.rootpath != _CHECKOUT:
        for entry in call.excinfo.traceback:
            if is_hidden(str(entry.path)):
                entry.frame.f_globals["__tracebackhide__"] = True  # pytest looks for it there


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Golden:
    """Compares runs and pictures with golden ones: ``golden.check("name", run)``."""
    return golden_of(request.node)


def golden_of(test: pytest.Item) -> Golden:
    """The fixture for the golden pictures of a test."""

    def note(kind: str, line: str) -> None:
        # Part of the test's report, which pytest-xdist sends back from its processes.
        test.user_properties.append((kind, line))

    config = test.config
    folder = _folder_for(test.path, config.rootpath)
    return Golden(folder, config.rootpath / _REPORT, bool(config.getoption("--golden-update")), note,
                  bool(config.getoption("--golden-report")))  # fmt: skip


def _noted(config: pytest.Config, kind: str) -> dict[str, set[str]]:
    """Return the lines that the tests of all processes have noted, each with the names of those tests."""
    terminal = config.pluginmanager.get_plugin("terminalreporter")
    lines: dict[str, set[str]] = {}
    for outcome in ("passed", "failed"):
        for report in terminal.stats.get(outcome, []) if terminal is not None else []:
            for key, line in getattr(report, "user_properties", ()):
                if key == kind:
                    lines.setdefault(line, set()).add(report.nodeid)
    return lines


def _used_twice(config: pytest.Config) -> list[str]:
    return [
        f"{Path(line).name} is the golden name of {' and '.join(sorted(tests))}: each test needs its own name"
        for line, tests in _noted(config, _CHECKED).items()
        if len(tests) > 1
    ]


def _unused(config: pytest.Config) -> list[str]:
    """The golden files in the folders whose tests were run which none of these has used."""
    folders = {
        folder
        for top in (Path(arg).absolute() for arg in config.args)
        for folder in top.rglob(FOLDER)
        if not any(part.startswith(".") for part in folder.relative_to(top).parts)
        and folder.parts[-len(_REPORT.parts) :] != _REPORT.parts  # pictures of failures
    }
    files = {str(file) for folder in folders for file in folder.glob("*") if file.suffix in (".png", ".json")}
    return sorted(files - set(_noted(config, _USED)))


def pytest_sessionfinish(session: pytest.Session) -> None:
    if _used_twice(session.config):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def _write_page(config: pytest.Config, path: Path) -> str:
    """Write the page of all failures; a line that says so, or why it could not be written."""
    failures = ((sorted(tests)[0], json.loads(line)) for line, tests in _noted(config, FAILED).items())
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        pages = entries.require(PAGES, "--golden-report")
        pages.save_page(sorted(failures, key=lambda failed: (failed[0], failed[1]["name"])), path)
    except OSError as error:
        return f"--golden-report {path}: cannot be written: {error.strerror}"
    return f"golden failures as a page: {path}"


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    if config.getoption("--golden-report"):
        terminalreporter.write_line(_write_page(config, Path(config.getoption("--golden-report"))))
    for title, lines in (
        ("golden files written: look at them", sorted(_noted(config, WRITTEN))),
        ("new since these golden records: pytest --golden-update adds it", sorted(_noted(config, _UNRECORDED))),
        ("golden names used twice", _used_twice(config)),
        ("golden files that no test has used", _unused(config) if config.getoption("--golden-unused") else []),
    ):
        if lines:
            terminalreporter.section(title)
            terminalreporter.write("".join(f"{line}\n" for line in lines))
