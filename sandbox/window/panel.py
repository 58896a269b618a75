"""The panel: a slider, a choice or a switch for every parameter, made from its declaration."""

from __future__ import annotations

import warnings
from typing import Any

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

from sandbox.parameters import Group, Parameter, walk
from sandbox.picture.lettering import Lettering
from sandbox.picture.sheet import rows_of
from sandbox.window.game import Game
from sandbox.window.session import Session
from sandbox.window.theme import CARD, theme

WIDTH, NARROWEST = 320, 280  # px on 720 rows; px
#: Smallest scale, so that text in a small window can still be read.
LEAST_UNIT = 0.8
#: A slider reaches this many times the value in the file to either side, and at least this share of the bounds.
REACH, LEAST_REACH = 1.5, 0.02
FAVOURITES = "this shot"
#: Layers from the panel up to the knobs of its sliders.
OVER = 6


class Row:
    """The elements of one number, word or switch: its name, what changes it, and a button that resets it."""

    def __init__(self, panel: Panel, parameter: Parameter, index: int | None, top: int) -> None:
        """``index`` is the place of a number within a vector; ``top`` is in px."""
        self.parameter, self.index = parameter, index
        self.place: dict[str, Any] = {"manager": panel.manager, "container": panel.container}
        self.unit, self.height, self.wide = panel.unit, panel.row, panel.wide
        self.shown = self.part(parameter.value)
        self.tip = f"{parameter.key}: {parameter.meaning}"
        if parameter.low is not None and parameter.high is not None:
            self.tip += f"; from {parameter.low:g} to {parameter.high:g} {parameter.unit}".rstrip()
        small, field = round(24 * self.unit), round(84 * self.unit)
        left = self.wide - field - small - 4
        self.label = UILabel(pygame.Rect(0, top, left, self.height), self._name(panel, left), **self.place)
        self.label.set_tooltip(self.tip)
        at = pygame.Rect(self.wide - small, top, small, self.height)
        self.reset = UIButton(at, "×", tool_tip_text="as in the scene file", **self.place)
        self.field = pygame.Rect(left, top, field, self.height)
        self.foot = self._make(panel.session)

    def _name(self, panel: Panel, room: int) -> str:
        """The parameter's name with its unit, shortened to fit."""
        key, unit = self.parameter.key, self.parameter.unit
        part = "" if self.index is None else f" {'xyz'[self.index]}"
        ending = f"  [{unit}]" if unit else ""
        names = [key, key.rpartition(".")[2]] if panel.group == FAVOURITES else [key.rpartition(".")[2]]
        texts = [name.replace("_", " ").replace(".", " ") + part for name in names]
        texts = [*(text + ending for text in texts), texts[-1]]
        return next((text for text in texts if panel.lettering.width(text, "small") <= room - 6), texts[-1])

    def part(self, value: Any) -> Any:
        """This row's part of the parameter's value."""
        return value if self.index is None or value is None else value[self.index]

    def changed(self, session: Session, value: Any) -> dict[str, Any]:
        """The change of the session that gives this part another value."""
        if self.index is not None:
            values = list(session.value(self.parameter.key))
            values[self.index] = value
            value = values
        return {self.parameter.key: value}

    # What its kinds differ in

    def _make(self, session: Session) -> int:
        """Make what changes it; returns where the row ends, in px."""
        raise NotImplementedError

    def show(self, value: Any) -> bool:
        """Show a value; returns whether that is possible without making the row anew."""
        raise NotImplementedError

    def taken(self, event: pygame.event.Event) -> tuple[Any] | None:
        """The value that an event gives it, if it does."""
        raise NotImplementedError

    def nudged(self, value: Any, by: float) -> Any:
        """The value after a step up or down."""
        raise NotImplementedError


class Number(Row):
    """A number: a field, and a slider unless it is left out."""

    slider: UIHorizontalSlider | None = None

    def _make(self, session: Session) -> int:
        self.entry = UITextEntryLine(self.field, **self.place)
        self.entry.set_text(_written(self.shown))
        if self.shown is None:
            return self.field.bottom
        low, high = span = self._span(session)
        rect = pygame.Rect(0, self.field.bottom + 3, self.wide, round(16 * self.unit))
        value = min(max(self.shown, low), high)
        self.slider = UIHorizontalSlider(rect, value, span, click_increment=(high - low) / 100, **self.place)
        return rect.bottom

    def _span(self, session: Session) -> tuple[float, float]:
        """The ends of the slider: around the value of the file, within the bounds."""
        parameter = self.parameter
        low, high = parameter.low or 0.0, parameter.high if parameter.high is not None else 1.0
        base = self.part(session.base_value(parameter.key))
        value = self.shown if base is None else base
        reach = max(REACH * abs(value), LEAST_REACH * (high - low))
        if high - low <= 4 * reach:
            return float(low), float(high)
        return float(max(low, value - reach)), float(min(high, value + reach))

    def show(self, value: Any) -> bool:
        if (value is None) != (self.slider is None):
            return False
        if not self.entry.is_focused:
            self.entry.set_text(_written(value))
        if self.slider is not None and not self.slider.has_moved_recently:
            low, high = self.slider.value_range
            self.slider.set_current_value(min(max(value, low), high))
        return True

    def taken(self, event: pygame.event.Event) -> tuple[Any] | None:
        if event.type == pygame_gui.UI_HORIZONTAL_SLIDER_MOVED and event.ui_element is self.slider:
            return (float(f"{event.value:.4g}"),)
        if event.type == pygame_gui.UI_TEXT_ENTRY_FINISHED and event.ui_element is self.entry:
            self.entry.unfocus()
            return (self.typed(event.text.strip()),)
        return None

    def typed(self, text: str) -> Any:
        """A number, or text with a unit; an empty field leaves an optional number out."""
        try:
            return float(text)
        except ValueError:
            return None if not text and self.parameter.optional else text

    def nudged(self, value: Any, by: float) -> Any:
        if self.slider is None:
            return value
        low, high = self.slider.value_range
        value += by * (high - low) / 100
        bounds = self.parameter.low, self.parameter.high
        if bounds[0] is not None and bounds[1] is not None:
            value = min(max(value, bounds[0]), bounds[1])
        return float(f"{value:.5g}")


class Word(Row):
    """One of several words."""

    def _make(self, session: Session) -> int:
        unset = "as the level says" if self.parameter.key.startswith("accuracy.") else "left out"
        values = [None] * (self.parameter.optional or self.shown is None) + list(self.parameter.choices)
        self.words = {unset if value is None else str(value): value for value in values}
        rect = pygame.Rect(0, self.field.bottom, self.wide, self.height)
        chosen, most = unset if self.shown is None else str(self.shown), round(200 * self.unit)
        self.choice = UIDropDownMenu(list(self.words), chosen, rect, expansion_height_limit=most, **self.place)
        return rect.bottom

    def show(self, value: Any) -> bool:
        text, _ = self.choice.selected_option
        return bool(self.words[text] == value)

    def taken(self, event: pygame.event.Event) -> tuple[Any] | None:
        if event.type == pygame_gui.UI_DROP_DOWN_MENU_CHANGED and event.ui_element is self.choice:
            return (self.words[event.text],)
        return None

    def nudged(self, value: Any, by: float) -> Any:
        values = list(self.words.values())
        return values[(values.index(value) + (1 if by > 0 else -1)) % len(values)]


class Switch(Row):
    """On or off."""

    def _make(self, session: Session) -> int:
        self.switch = UIButton(self.field, "on" if self.shown else "off", tool_tip_text=self.tip, **self.place)
        return self.field.bottom

    def show(self, value: Any) -> bool:
        self.switch.set_text("on" if value else "off")
        return True

    def taken(self, event: pygame.event.Event) -> tuple[Any] | None:
        pressed = event.type == pygame_gui.UI_BUTTON_PRESSED and event.ui_element is self.switch
        return (not self.shown,) if pressed else None

    def nudged(self, value: Any, by: float) -> Any:
        return not value


def _kind(parameter: Parameter) -> type[Row] | None:
    """What a parameter's row is; None if it cannot be shown."""
    if parameter.choices:
        return Word
    if isinstance(parameter.value, bool):
        return Switch
    return Number if parameter.unit is not None and not isinstance(parameter.value, list) else None


class Over(UIContainer):
    """A layer over the rows for lists that open there; it lets the mouse through to the rows."""

    def check_hover(self, time_delta: float, hovered_higher_element: bool) -> bool:
        return False


class Panel:
    """The rows of one group of parameters, in ``rect`` of a window of ``size``. It is made anew for another group, or
    where rows must change: see ``outdated``."""

    def __init__(
        self,
        size: tuple[int, int],
        rect: pygame.Rect,
        game: Game,
        group: str = FAVOURITES,
        chosen: int | None = None,
    ) -> None:
        """``chosen`` is the row that keys change."""
        self.game, self.rect = game, rect
        self.scene, self.base = game.session.scene, game.session.base
        self.unit = Lettering.larger * max(LEAST_UNIT, rows_of(size) / 720)
        self.lettering = Lettering(rows_of(size))
        self.manager = pygame_gui.UIManager(size, theme(self.unit))
        self.groups = self._groups()
        self.group = self.wanted = group if group in self.groups else FAVOURITES
        self.chosen, self.outdated = chosen, False
        self.row, gap = round(26 * self.unit), round(10 * self.unit)
        frame = UIPanel(rect, manager=self.manager, margins=dict.fromkeys(("left", "right", "top", "bottom"), 0))
        inner = rect.width - 2 * gap
        half, self.wide = (inner - gap) * 6 // 10, inner - gap
        over = Over(pygame.Rect((0, 0), rect.size), self.manager, container=frame, starting_height=OVER)
        at = pygame.Rect(gap, gap, half, self.row)
        self.chooser = UIDropDownMenu(list(self.groups), self.group, at, self.manager, container=over)
        at = pygame.Rect(2 * gap + half, gap, inner - half - gap, self.row)
        tip = "every parameter as in the scene file (Backspace)"
        self.reset_all = UIButton(at, "reset all", self.manager, container=frame, tool_tip_text=tip)
        top = 2 * gap + self.row
        at = pygame.Rect(gap, top, rect.width - gap, rect.height - top)
        self.container = UIScrollingContainer(at, self.manager, container=frame, allow_scroll_x=False)
        self.rows: list[Row] = []
        foot = 0
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # a long name is cut; its tooltip has all of it
            for parameter in self.groups[self.group]:
                kind, value = _kind(parameter), parameter.value
                for index in range(len(value)) if isinstance(value, tuple) else (None,):
                    if kind is not None:
                        self.rows.append(kind(self, parameter, index, foot))
                        foot = self.rows[-1].foot + gap
        self.container.set_scrollable_area_dimensions((self.wide, foot))

    @property
    def session(self) -> Session:
        return self.game.session

    def _groups(self) -> dict[str, list[Parameter]]:
        """Parameters by heading, those with a slider in the scene's controls first."""
        by_key = {p.key: p for p in walk(self.scene.parameters) if _kind(p) is not None}
        groups = {FAVOURITES: [by_key[key] for key in self.session.controls.sliders if key in by_key]}
        for parameter in by_key.values():
            groups.setdefault(parameter.key.rpartition(".")[0] or self.scene.name, []).append(parameter)
        groups[FAVOURITES] = groups[FAVOURITES] or groups.get("launch", [])
        return groups

    # What happens

    @property
    def typing(self) -> bool:
        """Whether keys go into a field."""
        return any(isinstance(row, Number) and row.entry.is_focused for row in self.rows)

    def handle(self, event: pygame.event.Event) -> bool:
        """Handle an event; returns whether it was the panel's."""
        used = self.manager.process_events(event)
        element = getattr(event, "ui_element", None)
        if element is not None:
            if event.type == pygame_gui.UI_DROP_DOWN_MENU_CHANGED and element is self.chooser:
                self._turn_to(event.text)
            elif event.type == pygame_gui.UI_BUTTON_PRESSED and element is self.reset_all:
                self.game.reset()
            for row in self.rows:
                if (value := row.taken(event)) is not None:
                    self.set(row, value[0])
                elif event.type == pygame_gui.UI_BUTTON_PRESSED and element is row.reset:
                    self.game.reset(row.parameter.key)
        return bool(used)

    def set(self, row: Row, value: Any) -> None:
        """Give a row another value; an invalid one is reported, and the row shows the valid one again."""
        self.game.change(row.changed(self.session, value))
        self.refresh(everything=True)

    def _turn_to(self, group: str) -> None:
        self.wanted, self.outdated, self.chosen = group, True, None

    def refresh(self, everything: bool = False) -> None:
        """Show the current parameters."""
        if self.session.scene is self.scene and not everything:
            return
        known, self.scene = self.scene, self.session.scene
        self.outdated |= self.session.base is not self.base
        self.outdated |= _shape(self.scene.parameters) != _shape(known.parameters)
        for row in self.rows if not self.outdated else ():
            value = row.part(self.session.value(row.parameter.key))
            if value != row.shown or everything:
                row.shown = value
                self.outdated |= not row.show(value)

    def close_lists(self) -> bool:
        """Close a list of words that is open; whether one was."""
        lists = [self.chooser, *(row.choice for row in self.rows if isinstance(row, Word))]
        opened = [choice for choice in lists if choice.current_state is choice.menu_states["expanded"]]
        for choice in opened:
            if choice.current_state is not None:
                choice.current_state.target_state, choice.current_state.should_transition = "closed", True
        return bool(opened)

    # By key

    def choose(self, by: int) -> None:
        """Go to another row, ``by`` rows on."""
        self.chosen = (self.chosen + by if self.chosen is not None else min(by, 0)) % max(1, len(self.rows))
        bar = self.container.vert_scroll_bar
        if bar is not None:
            top = self.rows[self.chosen].label.rect.top - self.rows[0].label.rect.top
            bar.set_scroll_from_start_percentage(top / self.container.scrollable_container.rect.height)

    def nudge(self, by: float) -> None:
        """More or less of the chosen row: a hundredth of its slider, the next word, on or off."""
        if self.chosen is None:
            self.choose(0)
        row = self.rows[self.chosen or 0]
        self.set(row, row.nudged(row.part(self.session.value(row.parameter.key)), by))

    def turn(self, by: int) -> None:
        """Go to another group, ``by`` groups on."""
        groups = list(self.groups)
        self._turn_to(groups[(groups.index(self.wanted) + by) % len(groups)])

    def reset_row(self) -> None:
        """The chosen row as in the file."""
        if self.chosen is not None:
            self.game.reset(self.rows[self.chosen].parameter.key)

    # In the window

    def update(self, dt: float) -> None:
        self.refresh()
        self.manager.update(dt)

    def draw(self, surface: pygame.Surface) -> None:
        surface.fill(CARD["background"], self.rect)
        self.manager.draw_ui(surface)
        if self.chosen is not None and self.chosen < len(self.rows):
            label = self.rows[self.chosen].label.rect
            surface.fill(CARD["accent"], (self.rect.left + 3, label.top + 3, 3, label.height - 6))


def _shape(parameters: Group) -> list[Any]:
    """The groups of the parameters, by which it is known what parameters there are."""
    inner = [_shape(value) for value in vars(parameters).values() if isinstance(value, Group)]
    return [type(parameters), *inner]


def _written(value: Any) -> str:
    return "" if value is None else f"{value:.6g}"
