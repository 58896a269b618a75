"""The parts of a place, seen from the side: ground, what lies behind it, and things that stand on it."""

from sandbox.picture.places.courts import COURT_WIDTH, tennis_court
from sandbox.picture.places.ground import Ground, Line, Planks, Stripes, boards, turf
from sandbox.picture.places.scenery import Hall, Landscape, Scenery, Stands
from sandbox.picture.places.things import Net, Person, Post, Shape, Thing, goal, net_across, standing_table

__all__ = [
    "COURT_WIDTH", "Ground", "Hall", "Landscape", "Line", "Net", "Person", "Planks", "Post", "Scenery", "Shape",
    "Stands", "Stripes", "Thing", "boards", "goal", "net_across", "standing_table", "tennis_court", "turf"
]  # fmt: skip
