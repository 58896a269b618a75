"""The JSON schema of a scene's task files, by which editors complete and check them."""

from __future__ import annotations

from typing import Any

from sandbox import parameters as declared
from sandbox.scene import Scene
from sandbox.schema import HEAD, OfFiles, json_schema
from sandbox.tasks.file import TaskFile
from sandbox.tasks.scoring import KINDS


def task_schema(scene: Scene) -> dict[str, Any]:
    """JSON schema of the task files of a scene: its keys and facts by name, and what ``set`` may change."""
    of_scene = json_schema(scene.parameters, scene.name)
    body = TaskFile.model_json_schema(schema_generator=OfFiles)
    groups, properties = body["$defs"], body["properties"]
    facts = [*scene.facts, *(["made"] if scene.controls.scores else [])]
    keys = [parameter.key for parameter in declared.walk(scene.parameters, entries=True)]
    in_lists = {"type": "string", "pattern": r"\[[0-9]+\]"}  # of a list that may be longer here
    for name in ("StartEntry", "ControlEntry"):
        groups[name]["properties"]["key"] |= {"anyOf": [{"enum": keys}, in_lists]}
    score = groups["ScoreEntry"]["properties"]
    score["fact"] |= {"enum": facts}
    score["how"] |= {"enum": [*KINDS]}
    for table in (score["wanted"], properties["goes_on"], properties["ends"]):
        table["propertyNames"] = {"enum": facts}
    properties["pass"] = properties.pop("passing")
    properties["score"] = {"anyOf": [{"type": "string", "enum": facts}, {"$ref": "#/$defs/ScoreEntry"}]}
    properties["scene"] = {key: of_scene["properties"]["scene"][key] for key in ("anyOf", "description")}
    changed = {name: entry for name, entry in of_scene["properties"].items() if name not in ("scene", "measured")}
    properties["set"] |= {"properties": changed, "additionalProperties": False}
    body["required"] = ["pass" if name == "passing" else name for name in body["required"]]
    return {**HEAD, "title": f"{scene.name} task file", **body, "$defs": {**of_scene["$defs"], **groups}}
