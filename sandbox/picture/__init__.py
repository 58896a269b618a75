"""Pictures of runs: always off-screen. SDL's video is never started here: no window can open, no driver is needed."""

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # pygame greets on stdout, which belongs to --json
