"""Pictures of runs: always off-screen. SDL's video is never started here, so no window can open and no driver is needed."""

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # pygame greets on stdout, which belongs to --json
