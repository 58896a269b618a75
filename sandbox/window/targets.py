"""The parts of the picture that the mouse can take hold of: handles, cards to click, the ball to set spin on."""

from __future__ import annotations

import pygame

from sandbox.window import hand
from sandbox.window.background import KeyedCache
from sandbox.window.game import Game
from sandbox.window.handles import Grip, grips
from sandbox.window.pad import Pad
from sandbox.window.screen import Screen
from sandbox.window.stages import Stages


class Targets:
    """Knows where the mouse is, and what of the picture is there; what is drawn adds its cards and the pad."""

    def __init__(self, game: Game, screen: Screen, stages: Stages) -> None:
        self.game, self.screen, self.stages = game, screen, stages
        self.mouse = (-1, -1)  # px
        self.picked_keys: tuple[str, str] | None = None  # the keys of the handle that was picked by key
        self.cards: dict[str, pygame.Rect] = {}  # those that can be clicked: the map's cells and the charts
        self.pad: Pad | None = None  # where spin is set by hand: for a cue unless it is switched off, else switched on
        self._once = KeyedCache()

    @property
    def on_picture(self) -> bool:
        """True if the mouse is on the picture."""
        return bool(self.screen.area.collidepoint(self.mouse))

    def clear(self) -> None:
        """Forget what was drawn."""
        self.cards.clear()
        self.pad = None

    @property
    def visible_grips(self) -> list[hand.ShownGrip]:
        """The handles that can be dragged now, with their places in px."""
        game, stage = self.game, self.stages.fitting
        if game.watching.playback is not None or game.grasp.pull is not None or stage is None:
            return []
        found: list[Grip] = self._once("grips", game.session.scene, lambda: grips(game.session))
        contest = game.referee.contest
        return hand.visible_grips(found, stage, self.screen.sheet, in_hand=contest is not None and contest.in_hand)

    def grip_at(self, at: tuple[int, int]) -> hand.ShownGrip | None:
        """The handle at a place in px."""
        return hand.nearest(self.visible_grips, at)

    def card_at(self, at: tuple[int, int]) -> str | None:
        """The name of the card at a place in px."""
        return next((name for name, rect in self.cards.items() if rect.collidepoint(at)), None)

    def pick(self, by: int) -> bool:
        """Take hold of the handle ``by`` places on; returns whether there is any."""
        keys = [shown.grip.keys for shown in self.visible_grips]
        if keys:
            now = keys.index(self.picked_keys) if self.picked_keys in keys else -1 if by > 0 else 0
            self.picked_keys = keys[(now + by) % len(keys)]
        return bool(keys)

    @property
    def picked(self) -> hand.ShownGrip | None:
        """The handle that was picked by key."""
        return next((shown for shown in self.visible_grips if shown.grip.keys == self.picked_keys), None)

    @property
    def held(self) -> Grip | None:
        """The handle that is dragged, that the mouse is on, or that was picked by key."""
        shown = (self.grip_at(self.mouse) if self.on_picture else None) or self.picked
        return self.game.grasp.grip or (shown.grip if shown is not None else None)
