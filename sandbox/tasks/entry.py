"""Commands and parts that tasks and games for two add."""

COMMANDS = {"tasks": "sandbox.tasks.command"}
PARTS = {"schemas of tasks": "sandbox.tasks.schema", "tasks": "sandbox.tasks.command"}
