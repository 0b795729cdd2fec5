"""Reading YAML from people: a plain tree of fields, without the traps of the full language."""

import re
from pathlib import Path
from typing import Any

import yaml

from .errors import InputError
from .input_file import read_text

__all__ = ["read_yaml"]

_MAX_BYTES = 4 * 1024 * 1024
# Deeper than any field of ours; the loader recurses, so depth must be bounded before it starts.
_MAX_DEPTH = 32


def read_yaml(path: Path) -> dict[str, Any]:
    """Reads a YAML file that holds a mapping.

    Numbers follow YAML 1.2 (1e-3 is a number; 010, 1:30 and 2024-01-01 are text); aliases, tags, duplicate
    keys and keys other than text are refused.

    Raises:
        InputError: no such file, too large, not UTF-8, not YAML, or not a mapping.
    """
    text = read_text(path, _MAX_BYTES)
    try:
        _check_events(text)
        data = yaml.load(text, Loader=_Loader)  # noqa: S506  _Loader is a safe loader
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = f"line {mark.line + 1}" if mark else ""
        raise InputError(path, line, f"not valid YAML: {getattr(error, 'problem', None) or error}") from None
    except ValueError as error:  # such as an integer of too many digits
        raise InputError(path, "", f"not valid YAML: {error}") from None
    if not isinstance(data, dict):
        raise InputError(path, "", "must be a mapping of fields, such as `name: ...`")
    return data


class _Loader(yaml.CSafeLoader if hasattr(yaml, "CSafeLoader") else yaml.SafeLoader):  # type: ignore[misc]
    """A safe loader with the scalars of YAML 1.2 that refuses duplicate keys and keys other than text."""

    yaml_implicit_resolvers: dict[str, Any] = {}

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        seen = set()
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode) or key.tag != "tag:yaml.org,2002:str":
                raise _problem("a field name must be text (put others in quotes)", key)
            if key.value in seen:
                raise _problem(f"{key.value!r} stands twice", key)
            seen.add(key.value)
        return super().construct_mapping(node, deep)


for _tag, _pattern, _first in (
    ("null", r"~|null|Null|NULL|", ["~", "n", "N", ""]),
    ("bool", r"true|True|TRUE|false|False|FALSE", list("tTfF")),
    ("int", r"[-+]?(?:0|[1-9][0-9]*)", list("-+0123456789")),
    (
        "float",
        r"[-+]?(?:\.[0-9]+|(?:0|[1-9][0-9]*)(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)",
        list("-+.0123456789"),
    ),
):
    _Loader.add_implicit_resolver(f"tag:yaml.org,2002:{_tag}", re.compile(f"(?:{_pattern})$"), _first)


def _problem(text: str, where: Any) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=text, problem_mark=where.start_mark)


def _check_events(text: str) -> None:
    """Refuses what makes values of unforeseen type, size or depth, before anything is built."""
    depth = 0
    for event in yaml.parse(text, Loader=_Loader):
        if isinstance(event, yaml.AliasEvent):
            raise _problem("aliases (*name) are not accepted: write the value out", event)
        if getattr(event, "tag", None) is not None:
            raise _problem("tags (!name) are not accepted", event)
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > _MAX_DEPTH:
                raise _problem(f"nested more than {_MAX_DEPTH} levels deep", event)
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
