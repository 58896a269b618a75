"""The panel: a slider, a choice or a switch for every parameter, made from its declaration."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import inf
from time import perf_counter
from typing import Any, get_args

import pygame
import pygame_gui
from pygame_gui.core import UIContainer
from pygame_gui.elements import (
    UIButton,
    UIDropDownMenu,
    UIHorizontalSlider,
    UILabel,
    UIPanel,
    UIScrollingContainer,
    UITextEntryLine,
)

from sandbox.parameters import Parameter, walk
from sandbox.picture.lettering import Lettering
from sandbox.picture.sheet import rows_of
from sandbox.window.background import PATIENCE
from sandbox.window.session import Session
from sandbox.window.theme import NAMED, theme

WIDTH, NARROWEST = 320, 280  # px on 720 rows; px
#: Smallest scale, so that text in a small window can still be read.
LEAST_UNIT = 0.8
#: A slider reaches this many times the value in the file to either side, and at least this share of the bounds.
REACH, LEAST_REACH = 1.5, 0.02
FAVOURITES = "this shot"
#: Layers from the panel up to the knobs of its sliders.
OVER = 6


@dataclass
class Row:
    """The elements of one number, word or switch."""

    parameter: Parameter
    index: int | None  # within a vector
    label: UILabel | None = None
    entry: UITextEntryLine | None = None
    slider: UIHorizontalSlider | None = None
    choice: UIDropDownMenu | None = None
    switch: UIButton | None = None
    reset: UIButton | None = None
    shown: Any = None

    def part(self, value: Any) -> Any:
        return value if self.index is None or value is None else value[self.index]

    def whole(self, session: Session, part: Any) -> Any:
        """The parameter's value with this row's part replaced."""
        if self.index is None:
            return part
        values = list(session.value(self.parameter.key))
        values[self.index] = part
        return values


class Over(UIContainer):
    """A layer over the rows for lists that open there; it lets the mouse through to the rows."""

    def check_hover(self, time_delta: float, hovered_higher_element: bool) -> bool:
        return False


class Panel:
    """The panel in ``rect`` of a window of ``size``; calls ``change`` with changes, ``reset`` with keys to reset."""

    def __init__(
        self,
        size: tuple[int, int],
        rect: pygame.Rect,
        session: Callable[[], Session],
        change: Callable[[Mapping[str, Any]], bool],
        reset: Callable[[str | None], object],
        group: str = FAVOURITES,
        patience: float = PATIENCE,
    ) -> None:
        self._session, self.change, self.reset, self.rect = session, change, reset, rect
        self.unit, self.lettering = max(LEAST_UNIT, rows_of(size) / 720), Lettering(rows_of(size))
        self.manager = pygame_gui.UIManager(size, theme(self.unit))
        self.group, self.patience = group, inf  # it is built in the background
        self._build()
        self.patience = patience

    @property
    def session(self) -> Session:
        return self._session()

    # The elements

    def _build(self) -> None:
        """All elements, for the group that is shown."""
        self.manager.clear_and_reset()
        self.scene = self.session.scene
        unit, rect = self.unit, self.rect
        self.row, gap = round(26 * unit), round(10 * unit)
        self.panel = UIPanel(rect, manager=self.manager, margins=dict.fromkeys(("left", "right", "top", "bottom"), 0))
        inner = rect.width - 2 * gap
        groups = self._groups()
        if self.group not in groups:
            self.group = FAVOURITES
        half = (inner - gap) * 6 // 10
        over = Over(pygame.Rect((0, 0), rect.size), self.manager, container=self.panel, starting_height=OVER)
        self.chooser = UIDropDownMenu(
            list(groups), self.group, pygame.Rect(gap, gap, half, self.row), self.manager, container=over
        )
        self.reset_all = UIButton(
            pygame.Rect(2 * gap + half, gap, inner - half - gap, self.row),
            "reset all",
            self.manager,
            container=self.panel,
            tool_tip_text="every parameter as in the scene file (Backspace)",
        )
        top = 2 * gap + self.row
        self.container = UIScrollingContainer(
            pygame.Rect(gap, top, rect.width - gap, rect.height - top),
            self.manager,
            container=self.panel,
            allow_scroll_x=False,
        )
        self.rows: list[Row] = []
        self.chosen: int | None = None  # the row that keys change
        self.wide, self._foot = inner - gap, 0
        self._waiting = [row for parameter in groups[self.group] for row in self._rows_of(parameter)]
        self._add_rows()

    @property
    def complete(self) -> bool:
        """Whether all rows are there."""
        return not self._waiting

    def _add_rows(self) -> None:
        """Make as many rows as a frame has time for; the others follow in the next."""
        started = perf_counter()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # a long name is cut; its tooltip has all of it
            while self._waiting and perf_counter() - started < self.patience:
                row = self._waiting.pop(0)
                self._foot = self._place(row, self._foot) + round(10 * self.unit)
                self.rows.append(row)
        if self.complete:
            self.container.set_scrollable_area_dimensions((self.wide, self._foot))

    def _groups(self) -> dict[str, list[Parameter]]:
        """Parameters by heading, those with a slider in the scene's controls first."""
        groups: dict[str, list[Parameter]] = {FAVOURITES: []}
        by_key = {p.key: p for p in walk(self.scene.parameters)}
        groups[FAVOURITES] = [by_key[key] for key in self.session.controls.sliders if key in by_key]
        for parameter in by_key.values():
            if any(True for _ in self._rows_of(parameter)):
                groups.setdefault(parameter.key.rpartition(".")[0] or self.scene.name, []).append(parameter)
        if not groups[FAVOURITES]:
            groups[FAVOURITES] = groups.get("launch", [])
        return groups

    def _rows_of(self, parameter: Parameter) -> Iterator[Row]:
        """One row for a number, a word or a switch, several for a vector, none for what a row cannot show."""
        value = parameter.value
        if isinstance(value, tuple) and parameter.unit is not None:
            yield from (Row(parameter, index) for index in range(len(value)))
        elif (
            parameter.choices or isinstance(value, bool) or (parameter.unit is not None and not isinstance(value, list))
        ):
            yield Row(parameter, None)

    def _place(self, row: Row, top: int) -> int:
        """Make the elements of a row; returns where they end."""
        parameter, height, unit = row.parameter, self.row, self.unit
        tip = f"{parameter.key}: {parameter.meaning}"
        if parameter.low is not None and parameter.high is not None:
            tip += f"; from {parameter.low:g} to {parameter.high:g} {parameter.unit}".rstrip()
        small, field = round(24 * unit), round(84 * unit)
        place: dict[str, Any] = {"manager": self.manager, "container": self.container}
        left = self.wide - field - small - 4
        label = self._label(row, left)
        row.label = UILabel(pygame.Rect(0, top, left, height), label, **place)
        row.label.set_tooltip(tip)
        row.reset = UIButton(
            pygame.Rect(self.wide - small, top, small, height), "×", tool_tip_text="as in the scene file", **place
        )
        value = row.part(parameter.value)
        if parameter.choices:
            words: list[Any] = [str(word) for word in parameter.choices]
            unset = "as the level says" if parameter.key.startswith("accuracy.") else "left out"
            words = [unset, *words] if value is None or self._optional(parameter) else words
            chosen = unset if value is None else str(value)
            rect = pygame.Rect(0, top + height, self.wide, height)
            row.choice = UIDropDownMenu(words, chosen, rect, expansion_height_limit=round(200 * unit), **place)
            end = top + 2 * height
        elif isinstance(value, bool):
            rect = pygame.Rect(left, top, field, height)
            row.switch = UIButton(rect, "on" if value else "off", tool_tip_text=tip, **place)
            end = top + height
        else:
            row.entry = UITextEntryLine(pygame.Rect(left, top, field, height), **place)
            row.entry.set_text(_written(value))
            end = top + height
            if value is not None:
                span = self._span(row)
                slim = round(16 * unit)
                rect = pygame.Rect(0, end + 3, self.wide, slim)
                row.slider = UIHorizontalSlider(
                    rect, min(max(value, span[0]), span[1]), span, click_increment=(span[1] - span[0]) / 100, **place
                )
                end += slim + 3
        row.shown = value
        return int(end)

    def _label(self, row: Row, room: int) -> str:
        """The name of a row with its unit, shortened to fit."""
        key, unit = row.parameter.key, row.parameter.unit
        part = "" if row.index is None else f" {'xyz'[row.index]}"
        ending = f"  [{unit}]" if unit else ""
        short = key.rpartition(".")[2]
        names = [key, short] if self.group == FAVOURITES else [short]
        texts = [name.replace("_", " ").replace(".", " ") + part for name in names]
        texts = [*(text + ending for text in texts), texts[-1]]
        return next((text for text in texts if self.lettering.width(text, "small") <= room - 6), texts[-1])

    def _optional(self, parameter: Parameter) -> bool:
        """Whether a word may be left out."""
        node: Any = type(self.scene.parameters)
        values: Any = self.scene.parameters
        *path, last = parameter.key.split(".")
        for part in path:
            values = getattr(values, part)
            node = type(values)
        return type(None) in get_args(node.model_fields[last].annotation)

    def _span(self, row: Row) -> tuple[float, float]:
        """The ends of a slider: around the value of the file, within the bounds."""
        parameter = row.parameter
        low, high = parameter.low or 0.0, parameter.high if parameter.high is not None else 1.0
        base: Any = self.session.base.parameters
        for part in parameter.key.split("."):
            base = getattr(base, part, None)
        value = row.part(base) if base is not None else row.part(parameter.value)
        if value is None:
            value = row.part(parameter.value)
        reach = max(REACH * abs(value), LEAST_REACH * (high - low))
        if high - low <= 4 * reach:
            return float(low), float(high)
        return float(max(low, value - reach)), float(min(high, value + reach))

    # What happens

    @property
    def typing(self) -> bool:
        """Whether keys go into a field."""
        return any(row.entry is not None and row.entry.is_focused for row in self.rows)

    def handle(self, event: pygame.event.Event) -> bool:
        """Handle an event; returns whether it was the panel's."""
        used = self.manager.process_events(event)
        match event.type:
            case pygame_gui.UI_BUTTON_PRESSED:
                self._clicked(event.ui_element)
            case pygame_gui.UI_HORIZONTAL_SLIDER_MOVED:
                row = self._row("slider", event.ui_element)
                if row is not None:
                    self._set(row, float(f"{event.value:.4g}"))
            case pygame_gui.UI_TEXT_ENTRY_FINISHED:
                row = self._row("entry", event.ui_element)
                if row is not None:
                    self._typed(row, event.text.strip())
            case pygame_gui.UI_DROP_DOWN_MENU_CHANGED:
                if event.ui_element is self.chooser:
                    self.group = event.text
                    self._build()
                else:
                    row = self._row("choice", event.ui_element)
                    if row is not None:
                        word = next((w for w in row.parameter.choices if str(w) == event.text), None)
                        self._set(row, word)
                        self._build()
        return bool(used)

    def _row(self, part: str, element: Any) -> Row | None:
        return next((row for row in self.rows if getattr(row, part) is element), None)

    def _clicked(self, element: Any) -> None:
        if element is self.reset_all:
            self.reset(None)
            self._build()
        elif (row := self._row("reset", element)) is not None:
            self.reset(row.parameter.key)
            self._build()
        elif (row := self._row("switch", element)) is not None:
            self._set(row, not row.shown)

    def _set(self, row: Row, value: Any) -> None:
        self.change({row.parameter.key: row.whole(self.session, value)})
        self.refresh()

    # By key

    def choose(self, by: int) -> None:
        """Go to another row, ``by`` rows on."""
        self.chosen = (self.chosen + by if self.chosen is not None else min(by, 0)) % max(1, len(self.rows))
        bar = self.container.vert_scroll_bar
        label = self.rows[self.chosen].label
        if bar is not None and label is not None:
            first = self.rows[0].label
            assert first is not None
            height = self.container.scrollable_container.rect.height
            bar.set_scroll_from_start_percentage((label.rect.top - first.rect.top) / height)

    def nudge(self, by: float) -> None:
        """More or less of the chosen row: a hundredth of its slider, the next word, on or off."""
        if self.chosen is None:
            self.choose(0)
        row = self.rows[self.chosen or 0]
        value = row.part(self.session.value(row.parameter.key))
        if row.choice is not None:
            words = list(row.parameter.choices)
            here = words.index(value) + (1 if by > 0 else -1) if value in words else 0
            self._set(row, words[here % len(words)])
            chosen = self.chosen
            self._build()
            self.chosen = chosen
        elif row.switch is not None:
            self._set(row, not value)
        elif row.slider is not None:
            low, high = row.slider.value_range
            value += by * (high - low) / 100
            bounds = row.parameter.low, row.parameter.high
            if bounds[0] is not None and bounds[1] is not None:
                value = min(max(value, bounds[0]), bounds[1])
            self._set(row, float(f"{value:.5g}"))

    def turn(self, by: int) -> None:
        """Go to another group, ``by`` groups on."""
        groups = list(self._groups())
        self.group = groups[(groups.index(self.group) + by) % len(groups)]
        self._build()

    def reset_row(self) -> None:
        """The chosen row as in the file."""
        if self.chosen is not None:
            chosen = self.chosen
            self.reset(self.rows[chosen].parameter.key)
            self._build()
            self.chosen = chosen

    def _typed(self, row: Row, text: str) -> None:
        """Set a number, or text with a unit; an empty field leaves an optional number out."""
        value: Any = text
        try:
            value = float(text)
        except ValueError:
            value = None if not text and row.part(row.parameter.value) is None else text
        self._set(row, value)
        if row.entry is not None:
            row.entry.unfocus()
        self.refresh(everything=True)

    def refresh(self, everything: bool = False) -> None:
        """Show the current parameters."""
        if self.session.scene is self.scene and not everything:
            return
        if self.session.base.folder != self.scene.folder:
            self._build()
            return
        self.scene = self.session.scene
        for row in self.rows:
            value = self.session.value(row.parameter.key)
            value = row.part(value)
            if value == row.shown and not everything:
                continue
            row.shown = value
            if row.entry is not None and not (row.entry.is_focused and not everything):
                row.entry.set_text(_written(value))
            if row.slider is not None and value is not None and not row.slider.has_moved_recently:
                low, high = row.slider.value_range
                row.slider.set_current_value(min(max(value, low), high))
            if row.switch is not None:
                row.switch.set_text("on" if value else "off")

    def close_lists(self) -> bool:
        """Close a list of words that is open; whether one was."""
        lists = [self.chooser, *(row.choice for row in self.rows if row.choice is not None)]
        opened = [choice for choice in lists if choice.current_state is choice.menu_states["expanded"]]
        for choice in opened:
            if choice.current_state is not None:
                choice.current_state.target_state, choice.current_state.should_transition = "closed", True
        return bool(opened)

    def update(self, dt: float) -> None:
        if not self.complete:
            self._add_rows()
        self.refresh()
        self.manager.update(dt)

    def draw(self, surface: pygame.Surface) -> None:
        surface.fill(NAMED["background"], self.rect)
        self.manager.draw_ui(surface)
        label = self.rows[self.chosen].label if self.chosen is not None else None
        if label is not None:
            surface.fill(NAMED["accent"], (self.rect.left + 3, label.rect.top + 3, 3, label.rect.height - 6))


def _written(value: Any) -> str:
    return "" if value is None else f"{value:.6g}"
