"""Reading YAML from people: a plain tree of fields, without the traps of the full language."""

import re
from pathlib import Path
from typing import Any

import yaml

from ...errors import InputError
from .input_file import read_text

__all__ = ["read_yaml"]

_MAX_BYTES = 4 * 1024 * 1024
# Deeper than any field of ours; the loader recurses, so depth must be bounded before it starts.
_MAX_DEPTH = 32


def read_yaml(path: Path, *, largest: int = _MAX_BYTES, aliases: bool = False) -> dict[str, Any]:
    """Reads a YAML file that holds a mapping.

    Numbers follow YAML 1.2 (1e-3 is a number; 010, 1:30 and 2024-01-01 are text); aliases, tags, duplicate
    keys and keys other than text are refused.

    Args:
        path: the file.
        largest: how many bytes it may have.
        aliases: whether a value may be named and used again, as programs write what stands twice; then it is
            the same object in both places, and may hold no further such names.

    Raises:
        InputError: no such file, too large, not UTF-8, not YAML, or not a mapping.
    """
    text = read_text(path, largest)
    try:
        _check_events(text, aliases=aliases)
        data = yaml.load(text, Loader=_Loader)  # noqa: S506  _Loader is a safe loader
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = f"line {mark.line + 1}" if mark else ""
        raise InputError(path, line, f"not valid YAML: {getattr(error, 'problem', None) or error}") from None
    except ValueError:  # all scalars that fit a pattern can be converted, but for such numbers
        raise InputError(path, "", "holds a whole number of thousands of digits") from None
    if data is None:
        raise InputError(path, "", "is empty: must be a mapping of fields, such as `name: ...`")
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


def _check_events(text: str, *, aliases: bool) -> None:
    """Refuses what makes values of unforeseen type, size or depth, before anything is built."""
    depth, named_at = 0, 0
    for event in yaml.parse(text, Loader=_Loader):
        if isinstance(event, yaml.CollectionStartEvent) and event.anchor and not named_at:
            named_at = depth + 1
        # What is used again and uses others again could grow without end.
        if isinstance(event, yaml.AliasEvent) and (not aliases or named_at):
            raise _problem("aliases (*name) are not accepted: write the value out", event)
        if getattr(event, "tag", None) is not None:
            raise _problem("tags (!name) are not accepted", event)
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > _MAX_DEPTH:
                raise _problem(f"nested more than {_MAX_DEPTH} levels deep", event)
        elif isinstance(event, yaml.CollectionEndEvent):
            if depth == named_at:
                named_at = 0
            depth -= 1
