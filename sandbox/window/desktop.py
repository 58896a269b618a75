"""The setting of the desktop for less motion."""

from __future__ import annotations

import subprocess
import sys
from contextlib import suppress

#: The commands that print whether motion is to be reduced, by platform, and what they print if it is: of GNOME and
#: desktops with its settings, and of macOS.
_ASKED = {
    "linux": (["gsettings", "get", "org.gnome.desktop.interface", "enable-animations"], "false"),
    "darwin": (["defaults", "read", "com.apple.universalaccess", "reduceMotion"], "1"),
}
_ANIMATED = 0x1042  # SPI_GETCLIENTAREAANIMATION
#: A desktop that does not answer within so many s asks for nothing.
_PATIENCE = 1.0


def reduces_motion() -> bool:
    """True if the desktop asks for less motion; False if not, or where that is not known."""
    if sys.platform == "win32":
        import ctypes

        animated = ctypes.c_int(1)
        ctypes.windll.user32.SystemParametersInfoW(_ANIMATED, 0, ctypes.byref(animated), 0)
        return not animated.value
    if sys.platform not in _ASKED:
        return False
    command, less = _ASKED[sys.platform]
    with suppress(OSError, subprocess.SubprocessError):
        found = subprocess.run(command, capture_output=True, encoding="utf-8", timeout=_PATIENCE, check=True)
        return found.stdout.strip() == less
    return False
