"""What the picture of a scene is made of, besides the parts of its place: the views, and what they draw with."""

from sandbox.picture.above import AboveView
from sandbox.picture.ball import Look, Mark, Silhouette, dimples, near, patches, seams, turned
from sandbox.picture.camera import Area, Box, Camera, Eye
from sandbox.picture.long import LongView
from sandbox.picture.painter import Painter
from sandbox.picture.sheet import Entry, Sheet, SideRows
from sandbox.picture.side import Length, NetView, Place, SideView
from sandbox.picture.view import View
from sandbox.sport.amounts import nice

__all__ = [
    "AboveView", "Area", "Box", "Camera", "Entry", "Eye", "Length", "LongView", "Look", "Mark",
    "NetView", "Painter", "Place", "Sheet", "SideRows", "SideView", "Silhouette", "View", "dimples", "near", "nice",
    "patches", "seams", "turned"
]  # fmt: skip
