"""Commands that sessions add."""

COMMANDS = {"session": "sandbox.lab.session.command"}
