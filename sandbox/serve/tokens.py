"""The tokens in the addresses. They are kept for some hours: open pages come back when the server starts again."""

from __future__ import annotations

import json
import os
import re
import secrets
from contextlib import suppress
from pathlib import Path
from time import time
from typing import NamedTuple

from sandbox.files import state_folder
from sandbox.serve.limits import KEPT

#: Bytes of a token: 72 bits cannot be guessed, and 12 letters can still be typed.
_BYTES = 9


class Tokens(NamedTuple):
    """The tokens that must be in the address, of players and of the teacher, by the names of their pages."""

    play: str
    teach: str


def tokens(fresh: bool = False) -> Tokens:
    """Return those of the last start, unless that is long ago or they are to be ``fresh``; where nothing can be kept,
    they are new each time."""
    file = state_folder() / "serve.json"
    found = None if fresh else _read(file)
    made = found or Tokens(secrets.token_urlsafe(_BYTES), secrets.token_urlsafe(_BYTES))
    _write(file, made)
    return made


def _read(file: Path) -> Tokens | None:
    """Return what was kept; None if it is too old, may have been read by others, or is not what was written."""
    with suppress(OSError, ValueError, TypeError, AttributeError):
        state = file.stat()
        if state.st_mode & 0o077 == 0 and 0.0 <= time() - state.st_mtime < KEPT:
            found = Tokens(**json.loads(file.read_text("utf-8")))
            if found.play != found.teach and all(re.fullmatch(rf"[\w-]{{{_BYTES * 4 // 3}}}", each) for each in found):
                return found
    return None


def _write(file: Path, made: Tokens) -> None:
    """Keep them where nobody else can read them, if that can be done."""
    part = file.with_suffix(f".{os.getpid()}.part")
    with suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as out:
            json.dump(made._asdict(), out)
        part.replace(file)
