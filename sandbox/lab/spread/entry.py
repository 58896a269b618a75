"""Commands that scatter adds."""

COMMANDS = {"spread": "sandbox.lab.spread.command"}
