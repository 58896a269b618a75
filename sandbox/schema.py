"""The JSON schema of a scene's files, by which editors complete and check them."""

from __future__ import annotations

import json
import re
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue

from sandbox.parameters import Group

#: The draft that the TOML extensions of editors support.
HEAD = {"$schema": "http://json-schema.org/draft-07/schema#"}
#: The table of a scene file that names measured points.
_MEASURED = {
    "type": "object",
    "additionalProperties": False,
    "properties": {"track": {"type": "string", "description": "CSV file with t (s), x, y (m) and ball, for pictures"}},
    "required": ["track"],
    "description": "measured points, as sandbox fit --save writes them",
}


def json_schema(parameters: Group, scene: str) -> dict[str, Any]:
    """JSON schema of the files of ``scene``; numbers may be strings with a unit. A file may leave every key out; the
    defaults are ``parameters``, the scene's own."""
    body = type(parameters).model_json_schema(schema_generator=OfFiles)
    path = r"|\.\.?(/.*)?|/.+"  # of a scene that is not installed
    named = {
        "anyOf": [{"const": scene}, {"type": "string", "pattern": f"^({scene}/[A-Za-z0-9_-]+{path})$"}],
        "description": "the scene that this file is for, or the preset that it begins from",
    }
    _fill_in(body, body["$defs"], parameters, json.dumps(body))
    properties = {"scene": named, **body["properties"], "measured": _MEASURED}
    if chosen := _chosen_by_default(parameters):
        own = {"properties": {"scene": {"const": scene}}}  # what begins from a preset may have chosen otherwise
        body |= {"if": own, "then": {"properties": chosen}}
    return {**HEAD, "title": f"{scene} scene file", **body, "properties": properties}


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


def _chosen_by_default(values: Group) -> dict[str, Any]:
    """Schemas, by key, of groups in which the scene's own choice holds where a file does not make one."""
    found: dict[str, Any] = {}
    for name, field in type(values).model_fields.items():
        inner, tag = getattr(values, name), field.discriminator
        if not isinstance(inner, Group):
            continue
        if isinstance(tag, str):
            chosen = {"$ref": f"#/$defs/{type(inner).__name__}"}
            found[name] = {"if": {"not": {"required": [tag]}}, "then": chosen}
        elif nested := _chosen_by_default(inner):
            found[name] = {"properties": nested}
    return found


class OfFiles(GenerateJsonSchema):
    """Schemas for files that may leave the word of a choice out; without titles, which only repeat the key."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False

    def model_schema(self, schema: Any) -> JsonSchemaValue:
        made = {key: value for key, value in super().model_schema(schema).items() if key != "title"}
        if "description" in made:  # the first paragraph of a docstring; the rest is for whoever reads the code
            made["description"] = " ".join(made["description"].partition("\n\n")[0].split())
        return made

    def nullable_schema(self, schema: Any) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])  # TOML has no null: such a key is left out

    def default_schema(self, schema: Any) -> JsonSchemaValue:
        made = super().default_schema(schema)
        return {key: value for key, value in made.items() if (key, value) != ("default", None)}

    def tagged_union_schema(self, schema: Any) -> JsonSchemaValue:
        words = {"type": "string", "enum": list(schema["choices"])}  # for editors, which do not look into anyOf
        branches = super().tagged_union_schema(schema)["oneOf"]
        return {"properties": {schema["discriminator"]: words}, "anyOf": branches}
