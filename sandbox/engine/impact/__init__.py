"""Impulses: single impacts by pymunk, several at once, and balls that are pressed together."""
