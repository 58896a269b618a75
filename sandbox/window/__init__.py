"""The interactive program: a pygame window on a scene, with a panel made from its parameters.

The parts call, and import, only those below them (tests/window/test_directions.py has the order of all modules)::

    app        App         the loop: passes on events and time, has the view drawn when something has changed
    pointer    Pointer     what the mouse does
    commands   do, TABLE   what a key or a button does
    view       View        puts together and passes time to what draws a game:
    drawing    Drawing         the picture above the bar: the shot on its stage, what the hand holds, messages
    cards      Cards           headline, numbers, fan, map and charts as cards, what the mouse reads
    targets    Targets         where the mouse is, and what it can take hold of
    viewpoint  Viewpoint       the camera: follow, zoom, move, hold
    *_of_shot  FanOfShot, MapOfShot    the fan and the map of the shot, computed by the workers
    stages     Stages          the stage of the shot, composed by a thread; the camera that was chosen for it
    screen     Screen          the window's surface, and where picture, panel and bar are on it
    shown      Shown           what is switched on; how much of the path, the tape and the overlay that are shown
    game       Game        what is played, without drawing: it passes time to
    referee, contest                           what is played for: a task or a match, shot by shot; front has the tiles
    grasp, opening, aiming, watching, path     pull or drag, another scene, changes of the aim, playback, the path
    session, shots, history                    the scene file and what was changed over it, shots so far, undo

Each part owns its state; a part below another never calls it, it is asked. A ``Stage`` is the place as it was composed
for one ``Shot`` (a scene and its run), with the path on it; ``layout.Layout`` finds a place for each card, given as
``Form``s of falling size. Scenes run in two other processes (``Workers``), which can be killed at any time: one
computes the path, the other what takes longer. ``LatestJob`` follows whatever a value is made of with such work.
"""

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # its greeting, on stdout
