"""Measures the tables and pictures of accuracy.md again: ``python docs/measure_accuracy.py``.

Or only some of them, by name: ``trade`` (two minutes on an idle machine), ``stress`` (ten minutes and more),
``validate`` (ten seconds; it writes the count in README.md, too), ``rim`` (half a minute), ``check`` (ten minutes). The
page is written after each.
"""

from __future__ import annotations

import os
import platform
import random
import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from statistics import median
from time import perf_counter

import pymunk

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS
from sandbox.errors import RunError
from sandbox.lab import chart
from sandbox.lab.published import COUNTED, KINDS
from sandbox.lab.reference import REFERENCE, apart, places
from sandbox.lab.stress import FAILED, Outcome, stress, summary
from sandbox.lab.tables import length, length_or_below, time
from sandbox.lab.teeth import summary as summary_of_teeth
from sandbox.lab.teeth import teeth
from sandbox.lab.trade import TARGETS, Trade, report_of, trade
from sandbox.lab.validate import Compared, share_that_holds, validate
from sandbox.lab.verdicts import Verdicts
from sandbox.parameters import walk
from sandbox.scene import check, compare, listings, load
from sandbox.scene import simulate as simulate_scene
from sandbox.scene.running import SAFETY, simulate_at
from sandbox.sport.amounts import significant

DOCS = Path(__file__).resolve().parent
PAGE, README = DOCS / "accuracy.md", DOCS.parent / "README.md"

#: How many published numbers hold, as README.md says it.
COUNT = r"(`sandbox validate`:\s)\d+ of \d+ measured\snumbers"

#: Scenes in the tables, those of them with a picture, and the one whose parts are listed.
SCENES = ("golf", "soccer", "soccer-curl", "basketball", "basketball/rattle", "billiards", "billiards/cut")
PICTURES = ("golf", "basketball/rattle")
PARTS = "soccer"
#: The truth for the errors that a check claims.
TRUTH = LEVELS["precise"].finer().finer()

#: Shots at the rim, and how many per number of touches are compared with the reference.
SHOTS, ENOUGH = 3000, 150

DEFAULTS = ("golf", "soccer", "soccer-curl", "basketball", "billiards")


def main(wanted: Sequence[str]) -> None:
    for name, measured in {
        "trade": traded,
        "stress": stressed,
        "validate": validated,
        "rim": rimmed,
        "check": checked,
    }.items():
        if not wanted or name in wanted:
            page = PAGE.read_text("utf-8")
            for block, lines in measured().items():
                page = filled(page, block, lines)
            PAGE.write_text(page, "utf-8")


def report(what: str, started: float) -> None:
    sys.stderr.write(f"{what}: {time(perf_counter() - started)}\n")


def traded() -> dict[str, list[str]]:
    found = {}
    for name in SCENES:
        started = perf_counter()
        found[name] = trade(load(name))
        report(f"trade {name}", started)
    for name in PICTURES:
        chart.draw(report_of(found[name]), DOCS / "images" / f"trade-{name.replace('/', '-')}.png")
    return {
        "levels": [*levels(found), "", machine()],
        "cheapest": cheapest(found),
        "against pymunk": against_pymunk(found),
        "verdicts": verdicts(found),
        "parts": parts(found[PARTS]),
    }


def stressed() -> dict[str, list[str]]:
    started = perf_counter()
    outcomes = stress([])
    report("stress, bare setups", started)
    for name in DEFAULTS:
        started = perf_counter()
        outcomes += stress([load(name)], with_bare=False)
        report(f"stress {name}", started)
    return {"stress": extremes(outcomes), "failed": failed(outcomes)}


def validated() -> dict[str, list[str]]:
    started = perf_counter()
    rows = validate()
    report("validate", started)
    readme, count = re.subn(COUNT, f"\\g<1>{share_that_holds(rows)}", README.read_text("utf-8"))
    assert count == 1
    README.write_text(readme, "utf-8")
    said = summary_of_teeth(teeth(rows))
    return {"kinds": kinds(rows), "by sport": by_sport(rows), "teeth": [f"{said}."]}


def checked() -> dict[str, list[str]]:
    """Of the errors that a check claims, how many the true one exceeds; without what the check calls chaotic."""
    rows = []
    for title, faster in (("all scenes and presets", 1.0), ("each 3 % faster", 1.03)):
        started = perf_counter()
        ratios = sorted(ratio for listing in listings() for ratio in claims(listing.name, faster))
        report(f"check, {title}", started)
        beyond = [sum(ratio > most for ratio in ratios) for most in (1.0, 3.0, 10.0)]
        shares = [f"{count} ({100.0 * count / len(ratios):.1f} %)" for count in beyond]
        rows.append([title, str(len(ratios)), *shares, f"{1.0 / ratios[len(ratios) // 2]:.1f}"])
    headings = ["", "claimed errors", "exceeded by the true one", "more than 3 times", "more than 10 times"]
    return {"check": markdown([*headings, "claimed over true, median"], rows)}


def claims(name: str, faster: float) -> Iterator[float]:
    """The true error over the claimed one, of each number of a scene's result that is not known from the start."""
    scene = load(name)
    speed = scene.controls.speed
    if faster != 1.0:
        known = {parameter.key: parameter for parameter in walk(scene.parameters)}
        if speed not in known:
            return
        scene = scene.changed({speed: known[speed].within(faster * known[speed].value)})
    try:
        run = simulate_scene(scene)
        claimed, truth = check(scene, run), compare(run, simulate_at(scene, TRUTH))
    except RunError as error:
        sys.stderr.write(f"{name}: {error}\n")
        return
    for fact, twice in truth.errors.items():
        unsure = {*claimed.chaotic, *claimed.changed_by_nudge, *claimed.changed}
        if fact not in unsure and scene.facts[fact].final_when != "start" and claimed.errors.get(fact):
            ratio = (twice if isinstance(run.result[fact], int) else twice / SAFETY) / claimed.errors[fact]
            if ratio > 1.0:
                sys.stderr.write(f"{name} {fact}: {ratio:.2f} times the claimed {claimed.errors[fact]:.3g}\n")
            yield ratio


def rimmed() -> dict[str, list[str]]:
    started = perf_counter()
    found = rattled()
    report("rim", started)
    headings = ["touches of the rim", "shots", "median", "90th percentile", "worst", "other touches"]
    rows = []
    for touches, errors in sorted(found.items()):
        known = sorted(error for error in errors if error is not None)
        cells = [length(known[int(share * (len(known) - 1))]) for share in (0.5, 0.9, 1.0)] if known else [""] * 3
        rows.append([touches, str(len(errors)), *cells, str(len(errors) - len(known))])
    return {"rim": markdown(headings, rows)}


def rattled() -> dict[str, list[float | None]]:
    """Errors in m of random shots at the level balanced, by how often they touch the rim; None if the reference
    touches other things."""
    chance = random.Random(1)
    found: dict[str, list[float | None]] = {}
    for _ in range(SHOTS):
        speed, angle, spin = chance.uniform(7.2, 7.7), chance.uniform(46.0, 60.0), chance.uniform(0.0, 300.0)
        setup = load("basketball", {"launch.speed": speed, "launch.angle": angle, "launch.spin": spin}).build()
        run = simulate(setup, LEVELS["balanced"])
        met = [event.partner for event in run.events if event.kind == "impact"]
        touches = sum(name.startswith("rim") for name in met)
        name = "6 and more" if touches > 5 else str(touches)
        if len(found.setdefault(name, [])) >= ENOUGH:
            continue
        reference = simulate(setup, REFERENCE)
        same = met == [event.partner for event in reference.events if event.kind == "impact"]
        t = min(run.duration, reference.duration)
        error = apart(places(run, t), places(reference, t))
        found[name].append(error if same else None)
    return found


def filled(page: str, name: str, lines: Iterable[str]) -> str:
    """The page with new lines between the marks of a block."""
    block = "\n".join([f"<!-- {name} -->", *lines, "<!-- end -->"])
    page, count = re.subn(rf"<!-- {name} -->\n.*?<!-- end -->", lambda match: block, page, flags=re.DOTALL)
    assert count == 1, name
    return page


def markdown(headings: Sequence[str], rows: Iterable[Sequence[str]], left: int = 1) -> list[str]:
    rule = ["---" if column < left else "--:" for column in range(len(headings))]
    return ["| " + " | ".join(row) + " |" for row in (headings, rule, *rows)]


def machine() -> str:
    python = platform.python_version()
    return f"Python {python}, pymunk {pymunk.version}, {platform.machine()}, {os.cpu_count()} cores; one core is used."


def levels(found: dict[str, Trade]) -> list[str]:
    rows = []
    for name, one in found.items():
        least = one.reference.error
        cells = [f"{length_or_below(p.error_m, least)} in {time(p.wall_s)}" for p in one.levels.values()]
        speed = round(one.levels["balanced"].times_real_time, -1)
        at, chaos = one.reference.time, one.reference.diverges_at
        when = f"{at:.3g} s" if chaos is None else f"{at:.3g} s, chaotic from {chaos:.3g} s"
        rows.append([f"`{name}`", when, *cells, f"{speed:.0f} x"])
    aims = [f"{name}, aims at {length(p.accuracy.tolerance)}" for name, p in found["golf"].levels.items()]
    return markdown(["scene", "measured after", *aims, "balanced over real time"], rows)


def cheapest(found: dict[str, Trade]) -> list[str]:
    rows = []
    for name, one in found.items():
        best = [one.best(target) for target in TARGETS]
        cells = ["" if b is None else f"{b.name}, {time(b.wall_s)}" for b in best]
        rows.append([f"`{name}`", *cells])
    return markdown(["scene", *map(length, TARGETS)], rows, left=1 + len(TARGETS))


def against_pymunk(found: dict[str, Trade]) -> list[str]:
    """The cheapest setting of the plain method for each error, and its time over that of the cheapest of all."""
    rows = []
    for name, one in found.items():
        cells = []
        for target in TARGETS:
            best, plain = one.best(target), one.best(target, "plain")
            reached = best is not None and plain is not None
            ratio = significant(plain.wall_s / best.wall_s) if reached else ""
            cells.append(f"{ratio} ({plain.setting})" if reached else "not reached")
        rows.append([f"`{name}`", *cells])
    return markdown(["scene", *map(length, TARGETS)], rows)


def verdicts(found: dict[str, Trade]) -> list[str]:
    maps = {name: one.verdicts for name, one in found.items() if one.verdicts is not None}
    methods = max((list(one.methods) for one in maps.values()), key=len)  # slow methods are left out
    rows = [
        [f"`{name}`", str(one.shots), *(_counts(one.methods.get(method)) for method in methods)]
        for name, one in maps.items()
    ]
    return markdown(["scene", "shots", *methods], rows)


def _counts(found: Verdicts | None) -> str:
    """Same, other and failed."""
    return "too slow" if found is None else f"{found.same} / {found.other} / {found.failed}"


def parts(found: Trade) -> list[str]:
    body = [[*row.cells()[:4], row.effect] for row in found.ablation]
    return markdown(["part", "", "first touch", f"after {found.reference.time:.3g} s", "result"], body, left=2)


def extremes(outcomes: list[Outcome]) -> list[str]:
    table = summary(outcomes)
    return markdown([column.heading for column in table.columns], table.cells)


def failed(outcomes: list[Outcome]) -> list[str]:
    own = [o for o in outcomes if o.outcome == FAILED and o.method not in ("plain", "explicit-euler")]
    if not own:
        return ["No other row of the exact method failed."]
    rows = [[o.method, o.scene or "bare", o.extreme, o.message] for o in own]
    return ["Other failures of the exact method:", "", *markdown(["integrator", "scene", "extreme", "what"], rows, 4)]


def kinds(rows: list[Compared]) -> list[str]:
    body = []
    for kind, meaning in KINDS.items():
        own = [row for row in rows if row.kind == kind]
        counts = "yes" if kind in COUNTED else "no"
        body.append([kind, meaning, counts, str(len(own)), str(sum(row.holds for row in own))])
    return markdown(["kind", "", "counted", "numbers", "hold"], body, left=3)


def by_sport(rows: list[Compared]) -> list[str]:
    """Of each sport the measured numbers, how many hold and how far they are off; and the others."""
    body = []
    for sport in sorted({row.sport.partition("/")[0] for row in rows}):
        own = [row for row in rows if row.sport.partition("/")[0] == sport]
        measured = [row for row in own if row.kind in COUNTED]
        others = [row for row in own if row.kind not in COUNTED]
        off = [abs(row.difference) / row.tolerance for row in measured if row.difference is not None and row.tolerance]
        held = (sum(row.holds for row in group) for group in (measured, others))
        counts = [f"{hold} of {len(group)}" for hold, group in zip(held, (measured, others), strict=True)]
        body.append([sport, counts[0] if measured else "none", f"{median(off):.2f}" if off else "", counts[1]])
    return markdown(["sport", "measured, hold", "off by, median", "others, hold"], body)


if __name__ == "__main__":
    main(sys.argv[1:])
