"""Commands that fits add."""

COMMANDS = {"fit": "sandbox.lab.fit.command"}
