"""The player's choices of what is seen: switches, how much of the path while aiming, the tape, and an overlay."""

from __future__ import annotations

from typing import Any

from sandbox.picture.path import first_impact, time_after
from sandbox.tasks.file import SHOWN
from sandbox.window.game import Game
from sandbox.window.measure import Tape
from sandbox.window.overlay import Overlay
from sandbox.window.shots import Shot

#: How much of the path is shown while aiming; and how tasks call it.
AHEAD = ("all", "to the first contact", "the first metre", "nothing")
_OF_TASKS = dict(zip(SHOWN, AHEAD, strict=True))
#: Switches of the laboratory: nothing of them is seen outside it.
LABORATORY = frozenset(("arrows", "charts", "tape", "cost"))
#: The fan can be made this many times wider or narrower.
_WIDEST = 16.0


class Shown:
    """The player's choices of what is seen of a game."""

    def __init__(self, game: Game) -> None:
        self.game = game
        self.on = {"ghosts", *(LABORATORY & {*game.memory.in_lab})}  # commands that are switched on
        self._ahead = AHEAD[0]
        self.fan_width = 1.0  # times the usual spread
        self.tape: Tape | None = None
        self.overlay: Overlay | None = None

    @property
    def ahead(self) -> str:
        """The part of the path that is shown while aiming: the player's choice, or that of the contest."""
        contest = self.game.referee.contest
        return self._ahead if contest is None else _OF_TASKS[contest.path_shown]

    @property
    def in_lab(self) -> bool:
        """True if the values of a laboratory are shown: clock, forces, arrows, charts; not while one plays for
        something, unless that is a prediction."""
        contest = self.game.referee.contest
        return self.game.memory.lab and (contest is None or contest.takes_marks)

    def sees(self, name: str) -> bool:
        """True if a switch is on, and where the laboratory has it, if one is there."""
        return name in self.on and (name not in LABORATORY or self.in_lab)

    def switch_lab(self) -> None:
        """Show the values of a laboratory, with arrows and charts if nothing else was chosen, or do not: now and next
        time."""
        self.game.memory.lab = not self.game.memory.lab
        if self.game.memory.lab and not self.on & LABORATORY:
            self.on |= {"arrows", "charts"}
        self.remember()

    def remember(self) -> None:
        """Keep for the next time what is switched on in the laboratory; the tape is laid anew."""
        self.game.memory.in_lab = sorted(self.on & (LABORATORY - {"tape"}))
        self.game.memory.save()

    @property
    def visible_state(self) -> tuple[Any, ...]:
        """All that can be seen of it."""
        overlay = self.overlay
        return (
            frozenset(self.on),
            self.in_lab,
            self.ahead,
            self.fan_width,
            self.tape,
            overlay,
            overlay and overlay.picture_count,
        )

    def open(self, overlay: Overlay | None) -> None:
        """Show something over the picture, in place of what is there."""
        self.overlay = overlay

    def click_overlay(self, at: tuple[int, int]) -> None:
        """Do what a click (px) does to the overlay; one that does nothing closes it."""
        overlay, self.overlay = self.overlay, None
        if overlay is not None and overlay.pressed(at):
            self.overlay = overlay

    def key_in_overlay(self, key: int) -> bool:
        """Do what a key does in the overlay; returns whether it does anything there."""
        overlay = self.overlay
        stays = overlay.key(key) if overlay is not None else None
        if stays is False and self.overlay is overlay:
            self.overlay = None
        return stays is not None

    def widen_fan(self, factor: float) -> None:
        """Show the fan with a spread so many times as wide."""
        self.fan_width = min(max(self.fan_width * factor, 1 / _WIDEST), _WIDEST)
        self.on.add("fan")

    def show_more_ahead(self) -> None:
        """Show the next amount of the path while aiming."""
        self._ahead = AHEAD[(AHEAD.index(self._ahead) + 1) % len(AHEAD)]

    def put_tape_away(self) -> None:
        """Show no tape."""
        self.on.discard("tape")
        self.tape = None

    @property
    def has_panel(self) -> bool:
        """True if the panel is open."""
        return "panel" in self.on

    @property
    def follows(self) -> bool:
        """True if the camera goes with the story of the shot that is watched."""
        watching = self.game.watching
        return watching.playback is not None and watching.live is None and "view" in self.on

    @property
    def hides_path(self) -> bool:
        """True if the player has to predict what happens; in a contest nothing tells him but the path, as far as he
        sees it."""
        contest = self.game.referee.contest is not None
        return self.game.watching.playback is None and (contest or self.ahead != AHEAD[0])

    @property
    def time(self) -> float:
        """The time of the shot at which the balls are drawn, in s."""
        playback = self.game.watching.playback
        return playback.t if playback is not None else 0.0

    @property
    def answering(self) -> float | None:
        """The time of the shot, and on after its end, at which what was hit answers; None if nothing is to."""
        playback = self.game.watching.playback
        return playback.camera_time if self.follows and playback is not None and not self.game.memory.calm else None

    def until(self, shot: Shot) -> float | None:
        """The time until which the path is shown, in s; None for all of it."""
        if self.game.watching.playback is not None:
            return self.time
        driven = {each.name for each in shot.run.setup.surfaces if each.motion is not None}
        if driven and self.game.session.controls.held:  # what the player's keys move decides from there on
            return next((e.t for e in shot.run.events if e.kind == "impact" and e.partner in driven), None)
        if self.ahead == "to the first contact":
            return first_impact(shot.run, shot.ball)
        if self.ahead == "the first metre":
            return time_after(1.0, shot.track(shot.ball))
        return 0.0 if self.ahead == "nothing" else None
