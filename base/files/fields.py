"""Types of the fields in files: names that are safe in file names and models, and numbers of sane size."""

import re
from typing import Annotated, Any, TypeAlias

from pydantic import AfterValidator, Discriminator, Field, Strict, Tag

__all__ = [
    "Coordinate",
    "Count",
    "Extent",
    "Finite",
    "Inertia3",
    "Inline",
    "Mass",
    "Name",
    "Named",
    "NamedOrInline",
    "Positive",
    "RegionName",
    "Text",
    "Vector3",
    "check_name",
    "check_region_name",
    "plain_name",
]

MAX_COORDINATE_M = 100.0
_MOST_CHARACTERS = 64
_NAME = re.compile(rf"[A-Za-z0-9_][A-Za-z0-9_.-]{{0,{_MOST_CHARACTERS - 1}}}", re.ASCII)
_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_.-]")


def check_name(name: str) -> str:
    """The name itself.

    Raises:
        ValueError: it is not one for a thing or its file; says what is allowed.
    """
    if not _NAME.fullmatch(name):
        raise ValueError(
            "a name is made of letters, digits, '_', '-' and '.', does not start with '.' or '-', "
            "and has at most 64 characters"
        )
    return name


def plain_name(text: str, otherwise: str = "_") -> str:
    """A name made of a text, such as that of a file or of a model: `_` for signs that names do not have.

    Args:
        text: the text.
        otherwise: the name where nothing of it is left, as of words in another script.
    """
    plain = _NOT_IN_NAMES.sub("_", text).lstrip(".-")[:_MOST_CHARACTERS]
    return plain if plain.strip("_") else otherwise


def check_region_name(name: str) -> str:
    """The name itself.

    Raises:
        ValueError: it is not one for a region; says what is allowed.
    """
    if len(name) > 128 or not all(_NAME.fullmatch(part) for part in name.split("/")):
        raise ValueError(
            "a region's name is made of letters, digits, '_', '-' and '.', in parts of at most 64 characters "
            "that '/' may join and that do not start with '.' or '-'"
        )
    return name


def _check_coordinate(value: float) -> float:
    if abs(value) > MAX_COORDINATE_M:
        raise ValueError(f"must lie within {MAX_COORDINATE_M:g} m of the origin (lengths are in metres)")
    return value


def _check_extent(value: float) -> float:
    if not 1e-5 <= value <= MAX_COORDINATE_M:
        raise ValueError(f"must lie in [1e-05, {MAX_COORDINATE_M:g}] m (lengths are in metres)")
    return value


def _named_or_inline(value: Any) -> str:
    return "<named>" if isinstance(value, str) else "<inline>"


# A field that holds either the name of something or its description in place:
# Annotated[Named | Annotated[Model, Inline], NamedOrInline]
Named: TypeAlias = Annotated[str, Tag("<named>")]
Inline = Tag("<inline>")
NamedOrInline = Discriminator(_named_or_inline)

# Strict: neither `true` nor the text "1" is a number.
Finite: TypeAlias = Annotated[float, Strict(), Field(ge=-1e9, le=1e9)]
Count: TypeAlias = Annotated[int, Strict(), Field(ge=0, le=10**15)]
Positive: TypeAlias = Annotated[float, Strict(), Field(gt=0, le=1e9)]
# MuJoCo refuses masses below 1e-15; nothing that a hand holds is as heavy as a tonne.
Mass: TypeAlias = Annotated[float, Strict(), Field(ge=1e-6, le=1e3)]
Coordinate: TypeAlias = Annotated[float, Strict(), AfterValidator(_check_coordinate)]
Extent: TypeAlias = Annotated[float, Strict(), AfterValidator(_check_extent)]
Vector3: TypeAlias = tuple[Coordinate, Coordinate, Coordinate]
Inertia3: TypeAlias = tuple[
    tuple[Finite, Finite, Finite], tuple[Finite, Finite, Finite], tuple[Finite, Finite, Finite]
]
Name: TypeAlias = Annotated[str, AfterValidator(check_name)]
RegionName: TypeAlias = Annotated[str, AfterValidator(check_region_name)]
Text: TypeAlias = Annotated[str, Field(max_length=2000)]
