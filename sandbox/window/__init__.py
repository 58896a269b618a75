"""The interactive program: a pygame window on a scene, with a panel made from its parameters."""

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # its greeting, on stdout
