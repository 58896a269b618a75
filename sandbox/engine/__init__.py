"""The engine: fly exactly, touch exactly, let pymunk push. The only room that imports pymunk."""
