"""Commands that scenes in browsers add."""

NEEDS = ("page", "tasks", "window")
COMMANDS = {"serve": "sandbox.serve.command"}
