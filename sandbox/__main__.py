"""``python -m sandbox``: the program, also where its script is not on the PATH."""

import sys

if __name__ == "__main__":  # worker processes of a sweep import this module too
    if not sys.flags.safe_path and sys.path[0] != __file__.removesuffix("/sandbox/__main__.py"):
        del sys.path[0]  # the current folder, whose modules must not replace those of Python
    from sandbox.cli import main

    sys.exit(main())
