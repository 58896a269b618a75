"""The interactive program: a pygame window on a scene, with a panel made from its parameters.

``game <- view <- commands <- pointer <- app``: each imports and calls only modules to its left.

``Game`` (game.py) is what is played, and draws nothing: a ``Session`` (the scene file, what was changed over it, undo),
the ``Shot`` of these parameters, the shots so far, the clock of the one that is watched (``Playback``). Scenes run in
two other processes, which can be killed at any time: one for the path, the other for what takes longer, such as fan.py
and score_map.py. ``View`` (view.py) draws a game: the ``Stage`` is the place as it was composed for one shot, with the
path on it. ``commands.do`` is what a key or a button does to a view and its game, ``Pointer`` what the mouse does.
``App`` is the loop: it passes on events and time, and draws the view when something has changed.
"""

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # its greeting, on stdout
