"""Every key of the window, in one table, from which the window reads its commands and the help its texts."""

from __future__ import annotations

from typing import NamedTuple

import pygame

CTRL, ALT = pygame.KMOD_CTRL, pygame.KMOD_ALT


class Binding(NamedTuple):
    """A key with its command; ``shown`` is how the help names it, "" if another line does."""

    key: int
    command: str
    shown: str
    meaning: str
    group: str
    modifier: int = 0


BINDINGS = (
    Binding(pygame.K_SPACE, "go", "Space", "shoot; pause, resume", "Play"),
    Binding(pygame.K_RETURN, "again", "Enter", "aim again; in billiards go on", "Play"),
    Binding(pygame.K_LEFT, "turn_left", "left right", "turn the shot (Shift: finely)", "Play"),
    Binding(pygame.K_RIGHT, "turn_right", "", "", "Play"),
    Binding(pygame.K_UP, "stronger", "up down", "stronger, weaker (Shift: finely)", "Play"),
    Binding(pygame.K_DOWN, "weaker", "", "", "Play"),
    Binding(pygame.K_e, "spin_up", "E D, wheel", "spin", "Play"),
    Binding(pygame.K_d, "spin_down", "", "", "Play"),
    Binding(pygame.K_x, "other_up", "X Z, Shift wheel", "second spin, where there is one", "Play"),
    Binding(pygame.K_z, "other_down", "", "", "Play"),
    Binding(pygame.K_r, "restart", "R", "from the start", "Watch"),
    Binding(pygame.K_PERIOD, "step", ". ,", "one step on, one step back", "Watch"),
    Binding(pygame.K_COMMA, "step_back", "", "", "Watch"),
    Binding(pygame.K_MINUS, "slower", "- +", "slower to 1/16, faster to 8", "Watch"),
    Binding(pygame.K_EQUALS, "faster", "", "", "Watch"),
    Binding(pygame.K_PLUS, "faster", "", "", "Watch"),
    Binding(pygame.K_KP_MINUS, "slower", "", "", "Watch"),
    Binding(pygame.K_KP_PLUS, "faster", "", "", "Watch"),
    Binding(pygame.K_p, "previous_shot", "P N", "previous, next shot", "Watch"),
    Binding(pygame.K_n, "next_shot", "", "", "Watch"),
    Binding(pygame.K_v, "view", "V", "near the ball", "See"),
    Binding(pygame.K_g, "ghosts", "G", "earlier shots", "See"),
    Binding(pygame.K_f, "fan", "F", "fan: 200 such shots, how many score", "See"),
    Binding(pygame.K_RIGHTBRACKET, "wider", "]", "a wider fan", "See"),
    Binding(pygame.K_LEFTBRACKET, "narrower", "[", "a narrower fan", "See"),
    Binding(pygame.K_EQUALS, "zoom_in", "Ctrl + -, Ctrl wheel", "larger, smaller", "See", CTRL),
    Binding(pygame.K_PLUS, "zoom_in", "", "", "See", CTRL),
    Binding(pygame.K_KP_PLUS, "zoom_in", "", "", "See", CTRL),
    Binding(pygame.K_MINUS, "zoom_out", "", "", "See", CTRL),
    Binding(pygame.K_KP_MINUS, "zoom_out", "", "", "See", CTRL),
    Binding(pygame.K_LEFT, "pan_left", "Alt arrows, Ctrl drag", "move the picture", "See", ALT),
    Binding(pygame.K_RIGHT, "pan_right", "", "", "See", ALT),
    Binding(pygame.K_UP, "pan_up", "", "", "See", ALT),
    Binding(pygame.K_DOWN, "pan_down", "", "", "See", ALT),
    Binding(pygame.K_0, "fit", "Ctrl 0", "see all of the shot", "See", CTRL),
    Binding(pygame.K_KP_0, "fit", "", "", "See", CTRL),
    Binding(pygame.K_o, "arrows", "O", "arrows: velocity and forces", "See"),
    Binding(pygame.K_w, "charts", "W", "charts over time", "See"),
    Binding(pygame.K_j, "energy", "J", "where the energy goes", "See"),
    Binding(pygame.K_t, "tape", "T", "tape; or drag with the right button", "See"),
    Binding(pygame.K_a, "accuracy", "A", "accuracy: fast, balanced, precise", "See"),
    Binding(pygame.K_s, "save_scene", "S", "a scene file with what was changed", "Keep"),
    Binding(pygame.K_c, "copy", "C", "copy the command line of this shot", "Keep"),
    Binding(pygame.K_F12, "screenshot", "F12", "picture of the window", "Keep"),
    Binding(pygame.K_F9, "animation", "F9", "animation of the last shot", "Keep"),
    Binding(pygame.K_F5, "save_replay", "F5", "replay file of the last shot", "Keep"),
    Binding(pygame.K_F6, "compare", "F6", "compute the shot again, and compare", "Keep"),
    Binding(pygame.K_F7, "open_replay", "F7", "see the newest replay; or drop one here", "Keep"),
    Binding(pygame.K_m, "menu", "M", "all scenes and presets; arrows, Enter", "More"),
    Binding(pygame.K_PAGEDOWN, "next_preset", "PgDn", "next preset", "More"),
    Binding(pygame.K_PAGEUP, "previous_preset", "PgUp", "previous preset", "More"),
    Binding(pygame.K_TAB, "panel", "Tab", "the panel of parameters", "More"),
    Binding(pygame.K_BACKSPACE, "reset", "Backspace", "all parameters as in the file", "More"),
    Binding(pygame.K_z, "undo", "Ctrl Z", "take back the last change", "More", CTRL),
    Binding(pygame.K_b, "rack", "B", "the balls back where they began", "More"),
    Binding(pygame.K_u, "sound", "U", "sound", "More"),
    Binding(pygame.K_F3, "cost", "F3", "what a frame and a run cost", "More"),
    Binding(pygame.K_F11, "fullscreen", "F11", "full screen", "More"),
    Binding(pygame.K_h, "help", "H", "all keys", "More"),
    Binding(pygame.K_F1, "help", "", "", "More"),
    Binding(pygame.K_ESCAPE, "back", "Esc", "close what is open, stop a run; aim again", "More"),
    Binding(pygame.K_q, "quit", "Ctrl Q", "exit", "More", CTRL),
    Binding(pygame.K_DOWN, "row_down", "Ctrl up down", "another row of the panel", "Panel", CTRL),
    Binding(pygame.K_UP, "row_up", "", "", "Panel", CTRL),
    Binding(pygame.K_RIGHT, "row_more", "Ctrl left right", "less, more of it (Shift: finely)", "Panel", CTRL),
    Binding(pygame.K_LEFT, "row_less", "", "", "Panel", CTRL),
    Binding(pygame.K_PAGEDOWN, "group_down", "Ctrl PgDn PgUp", "another group", "Panel", CTRL),
    Binding(pygame.K_PAGEUP, "group_up", "", "", "Panel", CTRL),
    Binding(pygame.K_BACKSPACE, "row_reset", "Ctrl Backspace", "as in the file", "Panel", CTRL),
)

#: Commands that repeat while a key is held: nudges and steps.
NUDGES = ("turn_left", "turn_right", "stronger", "weaker", "spin_up", "spin_down", "other_up", "other_down")
STEPS = ("step", "step_back", "zoom_in", "zoom_out", "pan_left", "pan_right", "pan_up", "pan_down")
ROWS = ("row_down", "row_up", "row_more", "row_less")
REPEATED = frozenset((*NUDGES, *STEPS, *ROWS))
#: Groups whose commands have no button of their own on the bar: it opens a list of them.
LISTED = ("See", "Keep", "More")


def listed(group: str) -> list[Binding]:
    """The commands in the bar's list of a group."""
    return [binding for binding in BINDINGS if binding.group == group and binding.shown]


def command_for(key: int, modifiers: int) -> str | None:
    """The command of a key that was pressed; with Ctrl or Alt only those that need it."""
    held = (bool(modifiers & CTRL), bool(modifiers & ALT))
    for binding in BINDINGS:
        if binding.key == key and held == (bool(binding.modifier & CTRL), bool(binding.modifier & ALT)):
            return binding.command
    return None
