"""``python -m sandbox``: the program, also where its script is not on the PATH."""

import sys

from sandbox.cli import main

if __name__ == "__main__":  # worker processes of a sweep import this module too
    sys.exit(main())
