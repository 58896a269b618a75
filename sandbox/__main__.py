"""``python -m sandbox``: the program, where its folder is on no path."""

import sys

from sandbox.cli import main

if __name__ == "__main__":  # processes that a sweep starts import this module too
    sys.exit(main())
