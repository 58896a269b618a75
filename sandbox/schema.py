"""The JSON schema of a scene's files, by which editors complete and check them."""

from __future__ import annotations

import json
import re
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue

from sandbox.parameters import Group

#: The table of a scene file that names measured points.
MEASURED = {
    "type": "object",
    "additionalProperties": False,
    "properties": {"track": {"type": "string", "description": "CSV file with t (s), x, y (m) and ball, for pictures"}},
    "required": ["track"],
    "description": "measured points, as sandbox fit --save writes them",
}


def json_schema(parameters: Group, scene: str) -> dict[str, Any]:
    """JSON schema of the files of ``scene``; numbers may be strings with a unit. A file may leave every key out; the
    defaults are ``parameters``, the scene's own."""
    body = type(parameters).model_json_schema(schema_generator=_OfFiles)
    path = r"|\.\.?(/.*)?|/.+"  # of a scene that is not installed
    named = {
        "anyOf": [{"const": scene}, {"type": "string", "pattern": f"^({scene}/[A-Za-z0-9_-]+{path})$"}],
        "description": "the scene that this file is for, or the preset that it begins from",
    }
    _fill_in(body, body["$defs"], parameters, json.dumps(body))
    properties = {"scene": named, **body["properties"], "measured": MEASURED}
    # The draft that the TOML extensions of editors support.
    head = {"$schema": "http://json-schema.org/draft-07/schema#", "title": f"{scene} scene file"}
    return {**head, **body, "properties": properties}


def _fill_in(node: dict[str, Any], groups: dict[str, Any], values: Group, whole: str) -> None:
    """Write the defaults into the schema of a group. A group that several keys refer to is left as it is; ``whole`` is
    the schema as text, to count them."""
    node.pop("required", None)
    for name, default in values.model_dump(mode="json").items():
        entry, inner = node.get("properties", {}).get(name, {}), getattr(values, name)
        if default is not None:
            entry["default"] = default
        for reference in re.findall(r'"#/\$defs/(\w+)"', json.dumps(entry)) if isinstance(inner, Group) else ():
            chosen = groups[reference]
            if type(inner).__name__ == reference and whole.count(f'"#/$defs/{reference}"') == 1:
                _fill_in(chosen, groups, inner, whole)
            chosen.pop("required", None)


class _OfFiles(GenerateJsonSchema):
    """Schemas for files that may leave the word of a choice out; without titles, which only repeat the key."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False

    def model_schema(self, schema: Any) -> JsonSchemaValue:
        return {key: value for key, value in super().model_schema(schema).items() if key != "title"}

    def tagged_union_schema(self, schema: Any) -> JsonSchemaValue:
        return {"anyOf": super().tagged_union_schema(schema)["oneOf"]}
