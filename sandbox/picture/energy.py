"""A strip chart of energy by cause: what the balls have along the run, what was put in, and where the rest has gone."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf

import numpy as np
import pygame

from sandbox.engine.arc import Arc
from sandbox.engine.bernstein import piece
from sandbox.engine.ledger import Ledger, ledger
from sandbox.engine.path import Path
from sandbox.engine.run import Run
from sandbox.engine.setup import kinetic
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.path import chip, instants
from sandbox.picture.sheet import CARD, Entry, Sheet, nice
from sandbox.picture.vectors import colour_of

ENERGY = palette("energy")

#: The run is cut into so many pieces.
PIECES = 160
#: Causes that took less than this share of all energy are summed up as "other"; and at most so many are shown.
LEAST_SHARE, MOST_CAUSES = 0.004, 6
#: J; a run with less at the start has nothing to show.
LEAST_ENERGY = 1e-3
#: As many impacts are marked at most, those at less than this share of the hardest are not.
HITS, HARD = 12, 0.15
#: How dark what is lost is drawn.
LOST = 0.42
#: What was put in is hatched with lines this far apart, px on 720 rows.
HATCH = 6


#: Name, values in J over time, colour.
Band = tuple[str, np.ndarray, Colour]


@dataclass(frozen=True)
class Course:
    """Energy in J over time: arrays of the shape of ``times``."""

    times: np.ndarray  # s
    has: dict[str, np.ndarray]  # "height", "speed" and "spin" of all balls
    work: dict[str, np.ndarray]  # of each cause until then: positive what it put in, negative what it took

    @property
    def start(self) -> float:
        """All there is at the start, in J."""
        return float(sum(energy[0] for energy in self.has.values()))

    @property
    def taken(self) -> dict[str, np.ndarray]:
        """What each cause has taken."""
        return {name: np.maximum(-work, 0.0) for name, work in self.work.items()}

    @property
    def put_in(self) -> dict[str, np.ndarray]:
        """What each cause has put in, as wind does: with the start it makes up what there is and what was taken."""
        return {name: np.maximum(work, 0.0) for name, work in self.work.items()}


def course(run: Run) -> Course:
    """The energy of a run over time; height counts from the lowest that the balls come to."""
    called, times = _names(run), instants(run, PIECES)
    gained: dict[str, np.ndarray] = defaultdict(lambda: np.zeros(len(times)))
    for i, (a, b) in enumerate(pairwise([-inf, *times[1:]])):
        part = _piece_of(run, a, float(b))
        for kind in (part.work, part.impacts, part.contacts):
            for name, energy in kind.items():
                gained[called(name)][i + 1] += energy
    has = {name: np.zeros(len(times)) for name in ("height", "speed", "spin")}
    for ball in run.setup.balls:
        caught = run.caught_at(ball.name)
        for i, t in enumerate(times):
            x, y, vx, vy, *spins = run.state(ball.name, float(t))
            if run.setup.plane is not None:
                spins += run.rolling_spin(ball.name, float(t))
            if caught is not None and t >= caught:
                gained["pockets"][i] -= kinetic(ball, (x, y, vx, vy, *spins))
                break
            has["speed"][i] += kinetic(ball, (x, y, vx, vy, 0.0), t)
            has["spin"][i] += kinetic(ball, (x, y, 0.0, 0.0, *spins), t)
    sums = {name: np.cumsum(energy) for name, energy in gained.items()}
    fallen = sums.pop("gravity", np.zeros(len(times)))
    has["height"] = fallen.max() - fallen
    return Course(times, has, sums)


def hard_impacts(run: Run, ball: str = "") -> list[float]:
    """Times in s of the hardest impacts, of one ball or of all: none that is soft compared with the hardest."""
    impacts = (
        event for event in run.events if event.kind == "impact" and (not ball or ball in (event.ball, event.partner))
    )
    hits = sorted(((event.speed, event.t) for event in impacts), reverse=True)
    return sorted({t for speed, t in hits[:HITS] if speed >= HARD * hits[0][0]})


def _names(run: Run) -> Callable[[str], str]:
    """What causes are called here: two balls "balls", and surfaces by their kind where there are several of it."""
    balls = {ball.name for ball in run.setup.balls}
    surfaces = {surface.name for surface in run.setup.surfaces}
    kinds = Counter(name.split()[-1] for name in surfaces)

    def called(name: str) -> str:
        if not name:  # a contact of several balls, cut where none of its impacts is
            return "balls"
        kind = name.split()[-1]
        if name in surfaces:
            return f"{kind}s" if kinds[kind] > 1 else name
        return "balls" if set(name.split(" and ")) <= balls else name

    return called


def _piece_of(run: Run, a: float, b: float) -> Ledger:
    """The ledger of what happened after a and until b, in s."""
    arcs = {
        name: Path([_cut(arc, a, b) for arc in path if arc.t0 <= b and (arc.t1 > a or arc is path[-1])])
        for name, path in run.arcs.items()
    }
    return ledger(replace(run, arcs=arcs))


def _cut(arc: Arc, a: float, b: float) -> Arc:
    """The part of an arc between two times; its first instant where it begins at b or ended before a."""
    a, b = max(a, arc.t0), min(b, arc.t1)
    if a == arc.t0 and b == arc.t1:
        return arc
    if b <= a:
        return arc.until(arc.t0)
    h = arc.t1 - arc.t0
    u, v = (a - arc.t0) / h, (b - arc.t0) / h
    return Arc(a, b, arc.state(a), tuple(piece(curve, u, v) for curve in arc.curves), arc.contact)


def energy_chart(run: Run, size: tuple[int, int] = (1280, 720)) -> pygame.Surface:
    """The course of a run's energy as bands over time: below what the balls have, above it what each cause took.

    Where something put energy in, they reach above the start, and that part is hatched in its colour.
    """
    sheet = Sheet(size, on_dark=True)
    sheet.surface.fill(ENERGY["ground"])
    energy = course(run)
    bands, given = bands_of(energy), _given(energy)
    titles = [sheet.lettering.height(name) for name in (sheet.head, "small")]
    top, bottom = sheet.frame.top + sum(titles) + 4 * sheet.gap, sheet.frame.bottom - sheet.card_height()
    names = (f"{name} {joules(values[-1])}" for name, values, _ in [*bands, *given])
    labels = max((sheet.lettering.width(name, "small", bold=True) for name in names), default=0) + 3 * sheet.gap
    total = sum((values for _, values, _ in bands), np.zeros(len(energy.times)))
    tall = bottom - top - sheet.lettering.height("small") - 3 * sheet.gap
    scale = tall / max(float(total.max()), LEAST_ENERGY)
    step = nice(60 * sheet.unit / scale)
    levels = [i * step for i in range(1, int(tall / scale / step) + 1)]  # at the foot stands 0 s
    ticks = max(sheet.lettering.width(joules(level), "small") for level in levels) + 2 * sheet.gap
    plot = pygame.Rect(sheet.frame.left + ticks, top, sheet.frame.width - ticks - labels, tall)
    _axes(sheet, plot, run.duration, {level: plot.bottom - level * scale for level in levels})
    columns = plot.left + plot.width * energy.times / max(run.duration, 1e-9)
    spots = []
    for drawn, foot in ((bands, np.zeros(len(energy.times))), (given, np.full(len(energy.times), energy.start))):
        for _, values, colour in drawn:
            low, high = (plot.bottom - level * scale for level in (foot, foot + values))
            ends = np.column_stack([columns, high])
            if drawn is given:
                _hatch(sheet, columns, low, high, colour)
                sheet.painter.line(ends, max(1.0, 1.6 * sheet.unit), colour)
            else:
                sheet.painter.polygon(np.concatenate([ends, np.column_stack([columns, low])[::-1]]), colour)
                sheet.painter.line(ends, max(1.0, 1.2 * sheet.unit), ENERGY["ground"], 0.8)
            spots.append(np.column_stack([columns, high if drawn is given else (low + high) / 2, low - high]))
            foot = foot + values
    _impacts(sheet, plot, run)
    _name(sheet, plot, [*bands, *given], spots)
    if given:
        _start(sheet, plot, plot.bottom - energy.start * scale, joules(energy.start))
    sheet.headline("Where the energy goes", [_whole(energy, given), _title(run)], sheet.frame.width)
    sheet.columns(bottom, _entries(energy, bands, given))
    return sheet.surface


def _whole(energy: Course, given: Sequence[Band]) -> str:
    """What the shares on the card are shares of."""
    start, added = energy.start, [f"{joules(values[-1])} {name}" for name, values, _ in given]
    if not added:
        return f"shares of {joules(start)} at the start"
    total = start + sum(float(values[-1]) for _, values, _ in given)
    return f"shares of {joules(total)}: {joules(start)} at the start + {' + '.join(added)}"


def _entries(energy: Course, bands: Sequence[Band], given: Sequence[Band]) -> list[Entry]:
    """For the card: what there was and what was put in, in J, and as shares of both what is left and what was taken."""
    entries: list[Entry] = [("at the start", joules(energy.start))]
    entries += [(name, joules(values[-1]), mix(colour, CARD["text"], 0.3)) for name, values, colour in given]
    total = max(sum(float(values[-1]) for _, values, _ in bands), 1e-12)
    for name, values, colour in bands:
        share = 100 * values[-1] / total
        if share >= 0.05:
            entries.append((name, f"{share:.1f} %", mix(colour, CARD["text"], 0.3)))
    return entries


def bands_of(energy: Course) -> list[Band]:
    """What the balls have, and what the largest causes took, the largest first."""
    least, colours = _least(energy), _colours(energy)
    bands = [(name, values, ENERGY[name]) for name, values in energy.has.items() if values.max() > least]
    lost = energy.taken
    ordered = sorted(lost, key=lambda name: -lost[name].max())
    shown = [name for name in ordered[:MOST_CAUSES] if lost[name].max() > least]
    bands += [(name, lost[name], mix(colours[name], ENERGY["ground"], LOST)) for name in shown]
    rest = sum((lost[name] for name in ordered if name not in shown), np.zeros(len(energy.times)))
    if rest.max() > least:
        bands.append(("other", rest, ENERGY["other"]))
    return bands


def _given(energy: Course) -> list[Band]:
    """What was put in, named so."""
    least, colours = _least(energy), _colours(energy)
    given = {name: values for name, values in energy.put_in.items() if values.max() > least}
    return [(f"put in by {name}", values, colours[name]) for name, values in given.items()]


def _least(energy: Course) -> float:
    """The least energy that is shown by itself, in J."""
    return LEAST_SHARE * max(energy.start, 1e-12)


def _colours(energy: Course) -> dict[str, Colour]:
    """Of each cause, as in every other chart; another one only where two would look alike."""
    colours: dict[str, Colour] = {}
    for name in sorted(energy.work):
        wanted = [ENERGY["cause"].get(name) or colour_of(name), *ENERGY["spare"]]
        colours[name] = next((colour for colour in wanted if colour not in colours.values()), wanted[0])
    return colours


def _hatch(sheet: Sheet, columns: np.ndarray, low: np.ndarray, high: np.ndarray, colour: Colour) -> None:
    """Upright lines between two curves in px."""
    apart = max(4.0, HATCH * sheet.unit)
    for x in np.arange(columns[0] + apart, columns[-1], apart):
        foot, head = (float(np.interp(x, columns, rows)) for rows in (low, high))
        if foot - head >= 1.0:
            sheet.painter.line([(x, foot), (x, head)], max(1.0, 1.6 * sheet.unit), colour)


def _start(sheet: Sheet, plot: pygame.Rect, row: float, text: str) -> None:
    """A dashed line at what there was at the start, which says so."""
    unit = sheet.unit
    sheet.painter.dashes([(plot.left, row), (plot.right, row)], max(1.0, 1.4 * unit), CARD["text"], 8 * unit, 5 * unit)
    spots = [(plot.right - share * plot.width, row + 4 * unit, -1.0, 1.0) for share in (0.01, 0.2, 0.4, 0.6)]
    chip(sheet, f"{text} at the start", spots)


def _axes(sheet: Sheet, plot: pygame.Rect, duration: float, levels: Mapping[float, float]) -> None:
    """Lines at energies (J) in their rows, and round times below."""
    thin = max(1, round(sheet.unit))
    for level, row in levels.items():
        sheet.surface.fill(ENERGY["rule"], (plot.left, round(row), plot.width, thin))
        sheet.write(joules(level), "small", (plot.left - sheet.gap, row), sheet.quiet_ink, "midright")
    wide = plot.width / max(duration, 1e-9)
    step = nice(max(80 * sheet.unit, sheet.lettering.width("000.0 s ", "small")) / wide)
    for i in range(int(duration / step + 1e-9) + 1):
        column = round(plot.left + i * step * wide)
        sheet.surface.fill(sheet.quiet_ink, (column, plot.bottom, thin, round(5 * sheet.unit)))
        sheet.write(f"{i * step:g} s", "small", (column, plot.bottom + sheet.gap), sheet.quiet_ink, "midtop")


def _impacts(sheet: Sheet, plot: pygame.Rect, run: Run) -> None:
    """Dashed lines at the hardest impacts."""
    for t in hard_impacts(run):
        x = plot.left + plot.width * t / run.duration
        ends = [(x, plot.top), (x, plot.bottom)]
        sheet.painter.dashes(ends, max(1.0, sheet.unit), CARD["text"], 4 * sheet.unit, 4 * sheet.unit, 0.35)


def _name(sheet: Sheet, plot: pygame.Rect, bands: Sequence[Band], spots: Sequence[np.ndarray]) -> None:
    """Each band's name at its right end, moved apart where bands are thin; inside it where it has no right end."""
    tall = sheet.lettering.height("small")
    lasting = []
    for (name, values, colour), spot in zip(bands, spots, strict=True):
        if spot[-1, 2] >= 1.0:
            lasting.append((f"{name} {joules(values[-1])}", colour, float(spot[-1, 1])))
            continue
        x, y, thick = spot[int(spot[:, 2].argmax())]
        half = sheet.lettering.width(name, "small", bold=True) / 2 + sheet.gap
        if thick > tall + sheet.gap:
            x = min(max(x, plot.left + half), plot.right - half)
            sheet.label(name, "small", [(x, y, "center")], ENERGY["ground"], bold=True)
    rows = [round(min(row, plot.bottom - tall / 2 - sheet.gap)) for *_, row in lasting]
    for i in range(1, len(rows)):  # from the lowest up
        rows[i] = min(rows[i], rows[i - 1] - tall)
    over = plot.top + tall // 2 - rows[-1] if rows else 0
    if over > 0:
        rows[-1] += over
        for i in range(len(rows) - 2, -1, -1):
            rows[i] = max(rows[i], rows[i + 1] + tall)
    for (text, colour, end), row in zip(lasting, rows, strict=True):
        near, far = plot.right + sheet.gap / 2, plot.right + 2 * sheet.gap
        sheet.painter.line([(near, end), (far, row)], max(1.0, sheet.unit), colour)
        sheet.write(text, "small", (far + sheet.gap / 2, row), mix(colour, CARD["text"], 0.45), "midleft", bold=True)


def _title(run: Run) -> str:
    """What it is a run of."""
    scene = run.scene
    return "" if scene is None else f"{scene.name}/{scene.preset}" if scene.preset else scene.name


def joules(energy: float) -> str:
    """An energy as people write it."""
    if abs(energy) >= 999.5:
        return f"{energy / 1000:.3g} kJ"
    return f"{energy:.3g} J" if abs(energy) >= 0.0995 or energy == 0 else f"{1000 * energy:.3g} mJ"
