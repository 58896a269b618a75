"""The panel: a slider, a list of words or a switch for every parameter, made from its declaration."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import pygame

from sandbox.parameters import Parameter
from sandbox.picture.palette import mix, palette
from sandbox.window.background import KeyedCache
from sandbox.window.canvas import Canvas
from sandbox.window.game import Game
from sandbox.window.overlay import Board, Overlay, Row

_CARD = palette("card")

_WIDTH, _NARROWEST = 320, 280  # px on 720 rows; px
#: A slider reaches this many times the value in the file to either side, and at least this share of the bounds.
_REACH, _LEAST_REACH = 1.5, 0.02
#: Opacity of the pale panel under a field or a button.
_FIELD_LIT = 0.16
#: Width of the field of a number in px where a line has 24, and radius of a slider's knob in px on 720 rows.
_FIELD, _KNOB = 84, 7
FAVOURITES, RESET_ALL = "this shot", "reset all"
#: Parts of a row.
FIELD_OF, SLIDER_OF, RESET_OF = "field", "slider", "reset"


@dataclass(frozen=True)
class Setting:
    """One number, word or switch; the same one when its value has changed."""

    key: str
    parameter: Parameter = field(compare=False)
    base: Any = field(default=None, compare=False)  # its value in the scene file

    @property
    def value(self) -> Any:
        return self.parameter.value

    @property
    def written(self) -> str:
        """The value as it is shown and typed."""
        if isinstance(self.value, bool):
            return "on" if self.value else "off"
        if self.value is None and self.parameter.choices:
            return "set by level" if self.key.startswith("accuracy.") else "default"
        return "" if self.value is None else f"{self.value:.6g}" if isinstance(self.value, float) else str(self.value)

    @property
    def is_number(self) -> bool:
        return self.parameter.unit is not None

    @property
    def words(self) -> list[Any]:
        """Its possible values, unless it is a number; None is for the default."""
        if not self.parameter.choices:
            return [False, True]
        return [None] * (self.parameter.optional or self.value is None) + list(self.parameter.choices)

    @property
    def span(self) -> tuple[float, float] | None:
        """The ends of the slider: around the value of the file, within the bounds; None for what has none."""
        if self.parameter.low is None or self.parameter.high is None or self.value is None:
            return None
        low, high = self.parameter.low, self.parameter.high
        value = self.value if self.base is None else self.base
        reach = max(_REACH * abs(value), _LEAST_REACH * (high - low) * (value == 0 or low < 0))
        if high - low <= 4 * reach:
            return low, high
        return max(low, value - reach), min(high, value + reach)

    def nudged(self, by: float) -> Any:
        """The value a hundredth of the slider on, the next word, on or off."""
        if not self.is_number:
            return self.words[(self.words.index(self.value) + (1 if by > 0 else -1)) % len(self.words)]
        if self.span is None:
            return self.value
        low, high = self.span
        return float(f"{self.parameter.within(self.value + by * (high - low) / 100):.5g}")

    def typed(self, text: str) -> Any:
        """A number, or text with a unit; an empty field leaves an optional number out."""
        try:
            return float(text)
        except ValueError:
            return None if not text and self.parameter.optional else text


def _can_be_shown(parameter: Parameter) -> bool:
    number = parameter.unit is not None and not isinstance(parameter.value, list)
    return bool(parameter.choices) or isinstance(parameter.value, bool) or number


class Panel(Overlay):
    """The rows of one group of parameters, in ``rect`` of the window; ``open_list`` shows a list over it."""

    def __init__(self, game: Game, open_list: Callable[[Board], object]) -> None:
        super().__init__()
        self.game, self.open_list = game, open_list
        self.rect = pygame.Rect(0, 0, 0, 0)
        self.wanted = FAVOURITES
        self.typing: Setting | None = None  # the row that keys go into
        self.before, self.after = "", ""  # the text of its field, before and after the caret
        self.whole = True  # whether all of it is selected
        self._once = KeyedCache()

    @property
    def groups(self) -> dict[str, list[Parameter]]:
        """Parameters by heading, those with a slider in the scene's controls first."""
        session = self.game.session
        groups: dict[str, list[Parameter]] = self._once("groups", (session.scene, session.limits), self._groups)
        return groups

    def _groups(self) -> dict[str, list[Parameter]]:
        session = self.game.session
        by_key = {key: p for key, p in session.parameters.items() if _can_be_shown(p)}
        if session.limits is not None:  # of a contest
            within = session.limits.items()
            return {FAVOURITES: [by_key[key]._replace(low=a, high=b) for key, (a, b) in within if key in by_key]}
        sliders = session.controls.sliders
        groups = {FAVOURITES: [p for slider in sliders for key, p in by_key.items() if slider in (key, key[:-3])]}
        for key, parameter in by_key.items():
            group = key.rpartition(".")[0]
            if "]" not in group:
                groups.setdefault(group or session.scene.name, []).append(parameter)
        groups[FAVOURITES] = groups[FAVOURITES] or groups.get("launch", [])
        return groups

    @property
    def group(self) -> str:
        """The group that is shown."""
        return self.wanted if self.wanted in self.groups else FAVOURITES

    @property
    def rows(self) -> list[Setting]:
        return [Setting(p.key, p, self.game.session.base_value(p.key)) for p in self.groups[self.group]]

    # What is done

    def set(self, row: Setting, value: Any) -> None:
        """Give a row another value; an invalid one is reported."""
        self.game.aiming.change({row.key: value})

    def turn_to(self, group: str) -> None:
        """Show another group."""
        self.wanted, self.first, self.chosen, self.typing = group, 0, None, None

    def turn(self, by: int) -> None:
        groups = list(self.groups)
        self.turn_to(groups[(groups.index(self.group) + by) % len(groups)])

    def press(self, at: tuple[int, int]) -> Callable[[tuple[int, int]], object] | None:
        """Do what a click on a part does; returns what dragging a slider from there does."""
        rect, what = next(((rect, what) for rect, what in self.places if rect.collidepoint(at)), (self.rect, None))
        if isinstance(what, tuple) and what[1] == SLIDER_OF:
            return lambda to: self.slide(what[0], rect, to)
        if what is not None:
            self.do(what)
        return None

    def do(self, what: Any) -> bool:
        """Do what a click on a part of it does."""
        if what == RESET_ALL:
            self.game.aiming.reset()
        elif what == FAVOURITES:
            self._offer(what, [(name, name) for name in self.groups], self.group, self.turn_to)
        else:
            row, part = what
            if part == RESET_OF:
                self.game.aiming.reset(row.key)
            elif row.is_number:
                self.begin_typing(row)
            elif isinstance(row.value, bool):
                self.set(row, not row.value)
            else:
                words = [(Setting(row.key, row.parameter._replace(value=word)).written, word) for word in row.words]
                self._offer(what, words, row.written, lambda word: self.set(row, word))
        return True

    def _offer(self, what: Any, words: list[tuple[str, Any]], now: str, choose: Callable[[Any], object]) -> None:
        """A list of words to choose from, next to the field of ``what``."""
        values, foot = dict(words), next(rect for rect, other in self.places if other == what)
        rows = [Row(f"={text}", text) for text in values]  # which is no command
        self.open_list(Board(rows, lambda action: choose(values[action[1:]]), foot, now=f"={now}"))

    def slide(self, row: Setting, slider: pygame.Rect, at: tuple[int, int]) -> None:
        """Drag the knob of a row's slider to a place in px."""
        if row.span is not None:
            low, high = row.span
            share = min(max((at[0] - slider.left - self.knob) / max(1, slider.width - 2 * self.knob), 0.0), 1.0)
            self.set(row, float(f"{low + share * (high - low):.4g}"))

    def begin_typing(self, row: Setting) -> None:
        """Keys go into the field of a row from now on; all of its text is selected."""
        self.typing, self.before, self.after, self.whole = row, row.written, "", True
        self.show(row)

    def type(self, event: pygame.event.Event) -> None:
        """A key that goes into a field: a letter, one that moves the caret or deletes, Ctrl A, C, X, V; Enter takes the
        text, Tab goes on to the next field too, Escape leaves the text."""
        before, after, ctrl = self.before, self.after, event.mod & pygame.KMOD_CTRL
        edits = {
            pygame.K_LEFT: (before[:-1], before[-1:] + after),
            pygame.K_RIGHT: (before + after[:1], after[1:]),
            pygame.K_HOME: ("", before + after),
            pygame.K_END: (before + after, ""),
            pygame.K_BACKSPACE: (before[:-1], after),
            pygame.K_DELETE: (before, after[1:]),
        }
        if self.whole:  # the caret is at its end
            edits |= {pygame.K_LEFT: ("", before), pygame.K_BACKSPACE: ("", ""), pygame.K_DELETE: ("", "")}
        if event.key in (pygame.K_RETURN, pygame.K_KP_ENTER):
            self.enter()
        elif event.key == pygame.K_TAB:
            self.enter(-1 if event.mod & pygame.KMOD_SHIFT else 1)
        elif event.key == pygame.K_ESCAPE:
            self.typing = None
        elif event.key in edits:
            self._put(*edits[event.key])
        elif ctrl and event.key == pygame.K_a:
            self.before, self.after, self.whole = before + after, "", True
        elif ctrl and event.key in (pygame.K_c, pygame.K_x):
            if self.whole:
                with suppress(pygame.error):  # there is no clipboard
                    pygame.scrap.put_text(before + after)
                    if event.key == pygame.K_x:
                        self._put("", "")
        else:
            text = event.unicode
            if ctrl and event.key == pygame.K_v:
                with suppress(pygame.error):  # there is no clipboard
                    text = pygame.scrap.get_text().strip()
            if text.isprintable() and text:
                self._put("" if self.whole else before, "" if self.whole else after, text)

    def _put(self, before: str, after: str, text: str = "") -> None:
        """Give the field a text with the caret in it."""
        self.before, self.after, self.whole = before + text, after, False

    def enter(self, then: int = 0) -> None:
        """Take what was typed, if something was; ``then`` type into the number so many rows on."""
        rows = [row for row in self.rows if row.is_number]
        text, typing, self.typing = (self.before + self.after).strip(), self.typing, None
        if typing not in rows:
            return
        now = rows.index(typing)
        if text != rows[now].written:
            self.set(typing, typing.typed(text))
        if then:
            self.begin_typing(rows[(now + then) % len(rows)])

    # By key

    def nudge(self, by: float) -> None:
        """More or less of the chosen row: a hundredth of its slider, the next word, on or off."""
        if self.chosen is None:
            self.step(1)
        for row in self.rows:
            if row == self.chosen:
                self.set(row, row.nudged(by))

    def reset_row(self) -> None:
        """The chosen row as in the file."""
        if self.chosen is not None:
            self.game.aiming.reset(self.chosen.key)

    # Drawing

    def lay_out(self, sheet: Canvas, height: int) -> None:
        """Its place at the right of the window."""
        wide = min(max(_NARROWEST, round(_WIDTH * sheet.unit)), sheet.size[0] // 2)
        self.rect = pygame.Rect(sheet.size[0] - wide, 0, wide, height)

    def compose(self) -> None:
        sheet, gap, self.knob = self.sheet, self.sheet.gap, round(_KNOB * self.sheet.unit)
        line = sheet.lettering.height("small") + gap
        sheet.surface.fill(_CARD["background"], self.rect)
        inner = self.rect.inflate(-4 * gap, -3 * gap)
        half = (inner.width - gap) * 6 // 10
        self.part(pygame.Rect(inner.topleft, (half, line)), FAVOURITES, self.group, lit=_FIELD_LIT, mark=1)
        place = pygame.Rect(inner.left + half + gap, inner.top, inner.width - half - gap, line)
        self.part(place, RESET_ALL, RESET_ALL, lit=_FIELD_LIT)
        top = inner.top + line + 2 * gap
        listed = self.listed(pygame.Rect(inner.left, top, inner.width, inner.bottom - top), 2 * line + gap // 2)
        for row, place in listed:
            self._row(row, place, line)
        for row, place in listed:
            if place.collidepoint(self.mouse):
                self._tip(row.parameter, self.mouse[1])

    def _row(self, row: Setting, place: pygame.Rect, line: int) -> None:
        sheet, gap, words = self.sheet, self.sheet.gap, bool(row.parameter.choices)
        top = pygame.Rect(place.topleft, (place.width, line))
        below = top.move(0, line)
        reset = pygame.Rect(top.right - line, top.top, line, line)
        field = pygame.Rect(reset.left - gap // 2 - _FIELD * line // 24, top.top, _FIELD * line // 24, line)
        right = (reset.left if words else field.left) - gap
        colour = _CARD["accent" if row == self.chosen else "text"]
        sheet.item(top, self._name(row, right - top.left), colour, left=top.left, right=right)
        if row.value != row.base:
            self.part(reset, (row, RESET_OF), "×", lit=_FIELD_LIT)
        typed = row == self.typing
        text = self._typed(field.width - 2 * gap) if typed else row.written
        self.part(below if words else field, (row, FIELD_OF), text, lit=_FIELD_LIT, mark=words)
        if typed:
            pygame.draw.rect(sheet.surface, _CARD["accent"], field, 1, border_radius=gap)
            if self.whole:
                selected = sheet.lettering.rect(text, "small", (field.left + gap, field.centery), "midleft")
                sheet.surface.fill(mix(_CARD["background"], _CARD["accent"], 0.4), selected)
                sheet.item(field, text, _CARD["text"])
        if row.span is not None:
            low, high = row.span
            self.places.append((below, (row, SLIDER_OF)))
            groove = pygame.Rect(below.left + self.knob, below.centery - 2, below.width - 2 * self.knob, 4)
            sheet.surface.fill(mix(_CARD["background"], _CARD["quiet"], 0.35), groove)
            share = min(max((row.value - low) / ((high - low) or 1.0), 0.0), 1.0)
            sheet.painter.disc((groove.left + share * groove.width, groove.centery), self.knob, _CARD["accent"])

    def _typed(self, room: int) -> str:
        """The text that is typed with its caret, from so far left that the caret is seen in ``room`` px."""
        before, caret = self.before, "" if self.whole else "|"
        while self.sheet.lettering.width(before + caret, "small") > room:
            before = before[1:]
        return before + caret + self.after

    def _name(self, row: Setting, room: int) -> str:
        """The parameter's name with its unit, as much of it as fits."""
        key, unit = row.key, row.parameter.unit
        if key.endswith("]"):
            key = f"{key[:-3]} {'xyz'[int(key[-2])]}"
        names = [key, key.rpartition(".")[2]] if self.group == FAVOURITES else [key.rpartition(".")[2]]
        texts = [name.replace("_", " ").replace(".", " ") for name in names]
        texts = [*(f"{text}  [{unit}]" if unit else text for text in texts), texts[-1]]
        return next((text for text in texts if self.sheet.lettering.width(text, "small") <= room), texts[-1])

    def _tip(self, parameter: Parameter, row: int) -> None:
        """Draw a parameter's meaning and bounds next to the panel."""
        text = f"{parameter.key}: {parameter.meaning}"
        if parameter.low is not None and parameter.high is not None:
            text += f"; from {parameter.low:g} to {parameter.high:g} {parameter.unit}".rstrip()
        lines, left = self.sheet.lettering.wrapped(text, "small", self.rect.width), self.rect.left - self.sheet.gap
        self.sheet.card([(each, _CARD["text"]) for each in lines], "topright", (left, row))
