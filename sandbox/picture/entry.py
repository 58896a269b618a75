"""Parts that pictures add."""

PARTS = {"pictures": "sandbox.picture.plain", "images": "sandbox.picture.images"}
