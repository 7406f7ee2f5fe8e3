"""What a declaration allows, read from its JSON schema: keys, kinds, units, bounds, choices.

One look at the models serves the CSV reader (which cells are numbers), the messages (what is allowed), and the
template files (what each key means).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

from pydantic import BaseModel

Kind = Literal[
    "number", "integer", "boolean", "time", "choice", "names", "identifier", "text", "rows", "list", "mapping", "other"
]
Loc = tuple[str | int, ...]

_WORDS: dict[Kind, str] = {
    "number": "a number",
    "integer": "a whole number",
    "boolean": "true or false",
    "time": "a time HH:MM or HH:MM:SS, beyond 24:00:00 for the next day",
    "names": "a list of names",
    "identifier": "a name or a whole number",
    "text": "a text (in quotes if it looks like a number)",
    "rows": "a list, or the name of a CSV file",
    "list": "a list",
    "mapping": "a mapping of keys and values",
    "other": "",
}

_KINDS: dict[str, Kind] = {
    "number": "number",
    "integer": "integer",
    "boolean": "boolean",
    "string": "text",
    "object": "mapping",
}


@dataclass(frozen=True, slots=True)
class Shape:
    """One node of a JSON schema with its references resolved.

    A drive is one of several declarations, told apart by a key (``kind``), its tag: such a union knows this key only,
    and `branch` picks the declaration that given data mean.
    """

    schema: Mapping[str, Any]
    definitions: Mapping[str, Any]

    @property
    def keys(self) -> tuple[str, ...]:
        """Known keys of a mapping, in the order of declaration."""
        return (self.tag_key,) if self.tag_key else tuple(self.schema.get("properties", ()))

    @property
    def required(self) -> tuple[str, ...]:
        """Keys that must be given."""
        return tuple(self.schema.get("required", ()))

    @property
    def tag_key(self) -> str:
        """The key that tells the branches of a union apart; empty for anything else."""
        return str(self.schema.get("discriminator", {}).get("propertyName", ""))

    @property
    def tags(self) -> tuple[str, ...]:
        """Values of that key, one for each branch."""
        return tuple(self.schema.get("discriminator", {}).get("mapping", ()))

    @property
    def unit(self) -> str:
        """Unit, or an empty string."""
        return str(self.schema.get("unit", ""))

    @property
    def meaning(self) -> str:
        """One sentence for people, or an empty string."""
        return str(self.schema.get("description", ""))

    @property
    def choices(self) -> tuple[Any, ...]:
        """Allowed values, if they are few and named."""
        if "const" in self.schema:
            return (self.schema["const"],)
        return tuple(self.schema.get("enum", ()))

    @property
    def kind(self) -> Kind:
        """What a value of this shape looks like."""
        if self.choices:
            return "choice"
        if self.tag_key:
            return "mapping"
        name = self.schema.get("type")
        if name == "array":
            return self._kind_of_list()
        if name == "string" and "pattern" in self.schema:
            return "time"
        return "identifier" if isinstance(name, list) else _KINDS.get(str(name), "other")

    def _kind_of_list(self) -> Kind:
        item = self.child(0)
        if item is None:
            return "list"
        if item.keys:
            return "rows"
        return "names" if item.kind == "identifier" else "list"

    def child(self, token: str | int) -> Shape | None:
        """Return the shape of a key, of the items of a list, or of the branch of a union by its tag; None if there is none."""
        if self.tag_key:
            return self._child_of_union(token)
        if isinstance(token, int):
            node = self.schema.get("items")
        else:
            node = self.schema.get("properties", {}).get(token, self.schema.get("additionalProperties"))
        return Shape(_resolved(node, self.definitions), self.definitions) if isinstance(node, dict) else None

    def _child_of_union(self, token: str | int) -> Shape | None:
        branches = self.schema["discriminator"]["mapping"]
        if token == self.tag_key:
            first = Shape(_resolved({"$ref": branches[self.tags[0]]}, self.definitions), self.definitions).child(token)
            return Shape({"enum": self.tags, "description": first.meaning if first is not None else ""}, self.definitions)
        if token not in self.tags:
            return None
        return Shape(_resolved({"$ref": branches[token]}, self.definitions), self.definitions)

    def branch(self, data: Any) -> Shape:
        """Return the branch of a union that `data` mean by their tag; this shape itself if it has none, or they name none."""
        tag = data.get(self.tag_key) if self.tag_key and isinstance(data, dict) else None
        found = self._child_of_union(tag) if isinstance(tag, str) and tag in self.tags else None
        return self if found is None else found

    def find(self, tokens: Loc) -> Shape | None:
        """Return the shape at the end of `tokens`, or None."""
        shape: Shape | None = self
        for token in tokens:
            shape = shape.child(token) if shape is not None else None
        return shape

    def untagged(self, tokens: Loc) -> Loc:
        """Return `tokens` of a validation error without the tags of unions, which are no keys of a file."""
        kept: list[str | int] = []
        shape: Shape | None = self
        for token in tokens:
            if shape is None or token not in shape.tags:
                kept.append(token)
            shape = shape.child(token) if shape is not None else None
        return tuple(kept)

    def allowed(self) -> str:
        """Return what may stand here, in words: kind, bounds and unit, or the choices."""
        if self.kind == "choice":
            return " | ".join(map(str, self.choices))
        words = ("above {:g}", "exclusiveMinimum"), ("at least {:g}", "minimum"), ("at most {:g}", "maximum")
        bounds = " and ".join(text.format(self.schema[key]) for text, key in words if key in self.schema)
        parts = [_WORDS[self.kind], f"[{self.unit}]" if self.unit else "", bounds]
        return " ".join(part for part in parts if part)


@cache
def shape_of(model: type[BaseModel]) -> Shape:
    """Return the shape of a declaration, keys as files write them."""
    schema = model.model_json_schema(by_alias=True)
    return Shape(schema, schema.get("$defs", {}))


def _resolved(node: Mapping[str, Any], definitions: Mapping[str, Any]) -> Mapping[str, Any]:
    # `X | None` is X that may be left out: files have no use for the null.
    branches = [branch for branch in node.get("anyOf", ()) if branch.get("type") != "null"]
    target = branches[0] if len(branches) == 1 else node
    if "$ref" in target:
        target = definitions[target["$ref"].rsplit("/", 1)[-1]]
    outer = {key: value for key, value in node.items() if key not in ("anyOf", "$ref")}
    return {**target, **outer}
