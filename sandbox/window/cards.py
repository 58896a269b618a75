"""Texts and cards over the picture of a shot: headline, numbers, verdict, fan, map, charts, cost, hints, readings."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import pygame

from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import Entry
from sandbox.sport.amounts import metres
from sandbox.window.background import KeyedCache, LatestJob
from sandbox.window.canvas import Canvas
from sandbox.window.charts import Charts
from sandbox.window.fan_card import fan_forms
from sandbox.window.fan_of_shot import FanOfShot
from sandbox.window.game import Game
from sandbox.window.layout import Form, Layout
from sandbox.window.map_of_shot import MapOfShot
from sandbox.window.measure import NEAR, draw_reading, reading
from sandbox.window.messages import reason
from sandbox.window.score_map import map_forms
from sandbox.window.scoreboard import headline_of
from sandbox.window.screen import Screen
from sandbox.window.shots import Shot
from sandbox.window.shown import Shown
from sandbox.window.stage import Stage, headline
from sandbox.window.targets import Targets
from sandbox.window.viewpoint import Viewpoint

_CARD = palette("card")

#: The most of the picture's width that a banner takes.
_WIDEST_BANNER = 0.6


class Cards:
    """Draws the cards of a shot where a layout finds room, and says to ``targets`` which can be clicked."""

    def __init__(
        self,
        game: Game,
        screen: Screen,
        shown: Shown,
        viewpoint: Viewpoint,
        fan: FanOfShot,
        map: MapOfShot,
        targets: Targets,
    ) -> None:
        self.game, self.screen, self.shown, self.viewpoint = game, screen, shown, viewpoint
        self.fan, self.map, self.targets = fan, map, targets
        self.head = pygame.Rect(0, 0, 0, 0)  # where the headline is
        self._once = KeyedCache()

    def draw_head(self, sheet: Canvas, layout: Layout, text: str, notes: Sequence[str], colour: Colour) -> None:
        """The headline at the upper left, or where there is room."""
        rect = layout.put("headline", headline(sheet, text, notes, colour), sheet.frame.topleft, "topleft")
        self.head = rect or pygame.Rect(*sheet.frame.topleft, 0, 0)

    def draw_words(self, sheet: Canvas, layout: Layout, stage: Stage, shot: Shot, forces: Sequence[Entry]) -> None:
        """The headline, and the numbers along the bottom."""
        playback = self.game.watching.playback
        text, colour = shot.verdict, _CARD["good"] if shot.scored else _CARD["text"]
        entries: Sequence[Entry] = shot.card
        if self.shown.hides_path:
            text, colour, entries = "Where will it go?", _CARD["text"], [("aimed", shot.aimed)]
        if playback is not None and not playback.over:
            picture = stage.picture_of(shot)
            text, colour, entries, forces = f"{playback.t:.2f} s", _CARD["text"], picture.live(playback.t), ()
            if not self.shown.in_lab:
                without = {"time", *(name for name, *_ in picture.vectors.entries(playback.t))}
                text, entries = shot.aimed, [entry for entry in entries if entry[0] not in without]
        live = self.game.watching.live is not None
        if playback is not None and live:
            text, _ = stage.picture_of(shot).progress(playback.t)
        notes = self._notes(shot) if live else [*self._notes(shot), *stage.notes]
        referee, contest = self.game.referee, self.game.referee.contest
        plays = contest is not None and not contest.takes_marks and not live  # without values of a laboratory
        if contest is not None and (referee.tells or plays):
            if referee.tells:
                text, said, colour = headline_of(referee, contest)
                notes = notes if self.game.grasp.holds else said
            else:
                stand = [] if contest.in_hand else [contest.stand]  # the ball was in hand only until the shot
                text, notes = contest.headline, [*stand, *notes]
            pulled = playback is None and self.game.session.may_change(_aim_keys(shot))
            entries = [
                (*entry, _CARD["accent" if place == contest.marked else "text"])
                for place, entry in enumerate(contest.entries)
            ]
            entries, forces = [*entries, *([("aimed", shot.aimed)] if pulled else [])], ()
        if playback is None or not playback.over or not self.game.banner.shows:  # which says the same
            self.draw_head(sheet, layout, text, notes, colour)
        numbers, overlay = pygame.Rect(0, sheet.card_row(), *sheet.size), self.shown.overlay
        if overlay is None or not overlay.place(self.screen.whole).colliderect(numbers):
            sheet.numbers([*entries, *forces])

    def _notes(self, shot: Shot) -> list[str]:
        """Notes on what can be done now, or on how the shot is watched."""
        game, playback = self.game, self.game.watching.playback
        if game.grasp.pull is not None:
            return ["let go to shoot, Esc to cancel", "Shift aims finely"]
        if game.grasp.grip is not None:
            return ["Shift goes in steps, Esc to cancel"]
        if playback is None:
            return ["pull back anywhere and let go, or press Space"]
        if game.watching.live is not None:
            names = ", ".join(f"{held.key.capitalize()}: {held.name}" for held in game.session.controls.held)
            return [names if playback.playing else "paused, Space goes on"]
        notes = [f"{'replay' if shot.recorded else 'shot'} {shot.number}"]
        slower = round(1 / playback.pace, 6)
        if playback.slowed and slower.is_integer():  # and not on its way there
            notes.append(f"slow motion, {slower:.0f} times slower (+ for faster)")
        if playback.over:
            again = "continue" if game.session.controls.next_start is not None else "aim again"
            if game.session.controls.held:
                return [f"Space to play again, Enter to {again}", *notes, "R to see it again"]
            notes.append(f"Enter to {again}, R to see it again")
        return notes

    def draw_cards(self, sheet: Canvas, layout: Layout, stage: Stage, shot: Shot) -> None:
        """Cards at the right: fan, map, charts, cost, hints."""
        game, shown, corner = self.game, self.shown, sheet.frame.topright

        def note(name: str, *lines: tuple[str, Colour]) -> None:
            layout.put(name, sheet.notes(lines), corner, "topright")

        if "fan" in shown.on and not shown.hides_path:
            found = self.fan.of(shot)
            share, spread = found.said if found is not None else (_why_none(self.fan.job, "the fan"), "")
            colour = _CARD["text" if self.fan.matches(shot) else "quiet"]
            lines = [(share, colour), *[(spread, _CARD["quiet"])] * bool(spread)]
            bars = found.bars if found is not None else None
            layout.put("fan", fan_forms(sheet, lines, bars), corner, "topright")
        if "map" in shown.on and not shown.hides_path:
            known = self.map.of(shot)
            if known is None:
                note("map", (_why_none(self.map.job, "the map"), _CARD["text"]))
            else:
                forms = map_forms(sheet, known, shot.aim, lambda cells: self.targets.cards.update({"map": cells}))
                layout.put("map", forms, corner, "topright")
        if shown.sees("charts") and not shown.hides_path and game.watching.live is None:
            charts: Charts = self._once("charts", (shot, game.memory.look), lambda: Charts(shot, stage.picture))
            t = shown.time if game.watching.playback is not None else None
            left = sheet.frame.left, layout.room.bottom
            at, anchor = (corner, "topright") if shot.upright else (left, "bottomleft")
            rect = layout.put("charts", charts.forms(sheet, t), at, anchor)
            self.targets.cards |= {"charts": rect} if rect is not None else {}
        if shown.sees("cost"):
            level = game.session.value("accuracy.level")
            text = f"frame {1e3 * self.screen.frame_cost:.1f} ms; run {1e3 * game.path.cost:.1f} ms, {level}"
            note("cost", (text, _CARD["accent"]))
        contest = game.referee.contest
        if contest is not None and contest.table:
            layout.put("table", [sheet.text(contest.table)], corner, "topright")
        hints = [] if contest is not None else [(text, _CARD["accent"]) for text in game.memory.hints.values()]
        if hints and game.grasp.pull is None:
            note("hints", *hints)

    def draw_readings(self, sheet: Canvas, layout: Layout, stage: Stage, shot: Shot) -> None:
        """The tape, and what the mouse reads."""
        shown, camera, mouse = self.shown, self.viewpoint.camera, self.targets.mouse
        if camera is None or shown.hides_path:
            return
        if shown.tape is not None and shown.in_lab:
            shown.tape.draw(sheet, layout, camera, shot.upright)
        reads = self.targets.on_picture and not pygame.mouse.get_pressed()[2]
        if not reads or shown.overlay is not None or self.game.grasp.holds:
            return
        read = reading(shot, stage.pixels, mouse, NEAR * sheet.unit, shown.until(shot))
        if read is not None:
            picture, (x, y, *_) = stage.picture, shot.run.state(read.ball, read.t)
            others = [("x", metres(x)), ("y", metres(y)), *picture.moving(read.ball, read.t)]
            entries = picture.live(read.t) if read.ball == shot.ball else others
            draw_reading(sheet, layout, shot, read, entries)


def _aim_keys(shot: Shot) -> tuple[str, str]:
    """The keys of what a pull sets."""
    return shot.scene.controls.speed, shot.scene.controls.angle


def _why_none(job: LatestJob[Any], what: str) -> str:
    """The reason why there is no such value."""
    return f"{what} ..." if job.error is None else reason(job.error)


def banner_forms(sheet: Canvas, text: str, good: bool | None) -> list[Form]:
    """A verdict: the words up to its first comma or colon in large letters, and below them the others; then smaller."""
    first, *others = re.split(r"[,;:] ", text, maxsplit=1)
    other = others[0][0].upper() + others[0][1:] if others and others[0] else ""
    return [_form(sheet, first, other, good, size) for size in ("huge", "large", "medium")]


def _form(sheet: Canvas, first: str, other: str, good: bool | None, size: str) -> Form:
    """A verdict with its first words in one size."""
    letters, gap, room = sheet.lettering, sheet.gap, _WIDEST_BANNER * sheet.size[0]
    below = "small" if size == "medium" else "medium"
    whole = letters.width(first, size, bold=True) <= room
    first, other = sheet.shortened(first, size, room, bold=True), sheet.shortened(other, below, room)
    wide = max(letters.width(first, size, bold=True), letters.width(other, below)) + 6 * gap
    colour = _CARD["text" if good is None else "good" if good else "bad"]
    tall = letters.height(size) + (letters.height(below) + gap) * bool(other) + 2 * gap

    def draw(rect: pygame.Rect) -> None:
        sheet.painter.panel(rect, _CARD["background"], 0.9, 12 * sheet.unit)
        at = sheet.write(first, size, (rect.centerx, rect.top + gap), colour, "midtop", True)
        if other:
            sheet.write(other, below, (rect.centerx, at.bottom), _CARD["text"], "midtop")

    return Form((wide, tall), draw, whole)
