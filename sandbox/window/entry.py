"""Commands and parts that the window adds."""

NEEDS = ("tasks",)
COMMANDS = {"play": "sandbox.window.command"}
