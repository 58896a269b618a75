"""Input of a scene: balls, bodies, surfaces, when a run ends, and how accurately it is computed."""
