"""What sports share: facts, controls, and the parameters and forces of a ball. It names no sport."""
