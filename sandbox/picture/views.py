"""Parts of a scene's picture: the views, the parts of a place, and what they draw with.

``plan`` and ``table`` have the parts of a place seen from above, ``courts`` the lines of courts and pitches.
"""

from sandbox.picture.above import AboveView
from sandbox.picture.ball import Fall, Look, Mark, Silhouette, dimples, near, patches, seams, turned
from sandbox.picture.camera import Area, Box, Camera, Eye
from sandbox.picture.lettering import Labels, text_mask
from sandbox.picture.long import LongView
from sandbox.picture.marks import draw_trace, mark_impacts
from sandbox.picture.painter import Painter, around_corners
from sandbox.picture.palette import Colour, mix, palette, scene_colours
from sandbox.picture.places import (
    COURT_WIDTH,
    Ground,
    Hall,
    Landscape,
    Line,
    Net,
    Person,
    Planks,
    Post,
    Scenery,
    Shape,
    Stands,
    Stripes,
    Thing,
    boards,
    courts,
    goal,
    net_across,
    plan,
    standing_table,
    table,
    tennis_court,
    turf,
)
from sandbox.picture.places.relief import Relief
from sandbox.picture.sheet import Entry, Sheet, SideRows
from sandbox.picture.side import NetView, SideView
from sandbox.picture.side_options import Length, Place
from sandbox.picture.story import Story
from sandbox.picture.view import View
from sandbox.sport.amounts import round_number_above

__all__ = [
    "COURT_WIDTH",
    "AboveView",
    "Area",
    "Box",
    "Camera",
    "Colour",
    "Entry",
    "Eye",
    "Fall",
    "Ground",
    "Hall",
    "Labels",
    "Landscape",
    "Length",
    "Line",
    "LongView",
    "Look",
    "Mark",
    "Net",
    "NetView",
    "Painter",
    "Person",
    "Place",
    "Planks",
    "Post",
    "Relief",
    "Scenery",
    "Shape",
    "Sheet",
    "SideRows",
    "SideView",
    "Silhouette",
    "Stands",
    "Story",
    "Stripes",
    "Thing",
    "View",
    "around_corners",
    "boards",
    "courts",
    "dimples",
    "draw_trace",
    "goal",
    "mark_impacts",
    "mix",
    "near",
    "net_across",
    "palette",
    "patches",
    "plan",
    "round_number_above",
    "scene_colours",
    "seams",
    "standing_table",
    "table",
    "tennis_court",
    "text_mask",
    "turf",
    "turned",
]
