"""Scenes: what they are, how they are found and run, and how accurate their results are."""

from sandbox.scene.checking import Check, check, compare
from sandbox.scene.finding import (
    Listing,
    as_scene,
    listings,
    listings_in,
    listings_of,
    load,
    parameters_of,
    reference,
    scene_files_in,
)
from sandbox.scene.running import simulate
from sandbox.scene.scene import Scene

__all__ = [
    "Check",
    "Listing",
    "Scene",
    "as_scene",
    "check",
    "compare",
    "listings",
    "listings_in",
    "listings_of",
    "load",
    "parameters_of",
    "reference",
    "scene_files_in",
    "simulate",
]
