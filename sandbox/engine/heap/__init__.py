"""Balls and bodies that lie on one another, stepped by pymunk."""
