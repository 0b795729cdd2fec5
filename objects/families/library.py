"""The families by name; `family:mug:17` is the mug of seed 17, as an object and as a task."""

from functools import cache

import numpy as np

from ...errors import InputError, UnknownName
from ..object_model import ObjectModel
from .bottle import make_bottle
from .box import make_box
from .cylinder import make_cylinder
from .handle import make_handle
from .member import Family, Member
from .mug import make_mug
from .plate import make_plate

__all__ = ["FAMILIES", "FAMILY_PREFIX", "check_family", "family_grasps", "family_object", "is_family"]

FAMILIES: dict[str, Family] = {
    "bottle": Family("bottles of PET or glass, up to half full, held around the body", make_bottle),
    "box": Family("solid boxes of oak or plastic, pinched across their thickness", make_box),
    "cylinder": Family("solid rods of oak, plastic or aluminium, pinched across", make_cylinder),
    "handle": Family("handles of tools with a bulge, held by two fingers against the thumb", make_handle),
    "mug": Family("stoneware mugs, held by the handle, or around the body", make_mug),
    "plate": Family("stoneware plates, held by the rim, or by rim and base", make_plate),
}

FAMILY_PREFIX = "family:"
_LARGEST_SEED = 2**31
# The same numbers for every family would make, say, heavy mugs and heavy boxes coincide.
_STREAMS = {name: i for i, name in enumerate(("box", "cylinder", "bottle", "mug", "handle", "plate"))}
_FRICTION = (0.45, 0.75)


def is_family(name: str) -> bool:
    """Whether a name asks for a member of a family."""
    return name.startswith(FAMILY_PREFIX)


def check_family(name: str, *, source: str = "object", field: str = "") -> None:
    """Looks whether a name such as `family:mug:17` stands for an object; makes nothing.

    Raises:
        InputError: no such family, or no seed.
    """
    _parse(name, source, field)


def family_object(name: str, *, source: str = "object", field: str = "") -> ObjectModel:
    """The object that a name such as `family:mug:17` stands for; the same on every call.

    Args:
        name: `family:`, the family, `:`, and the seed.
        source: what asked for it, for error messages.
        field: field of `source` that names it.

    Raises:
        InputError: no such family, or no seed.
    """
    family, seed = _parse(name, source, field)
    return _object(family, seed)


def family_grasps(
    name: str, *, source: str = "object", field: str = ""
) -> tuple[tuple[tuple[str, str], ...], ...]:
    """Pairs of regions, of the hand and of the object, by which its family suggests to hold the object.

    The usual ones first, then those for a member that is too heavy for them.

    Args:
        name: as of the object.
        source: what asked for it, for error messages.
        field: field of `source` that names it.

    Raises:
        InputError: no such family, or no seed.
    """
    member = _member(*_parse(name, source, field))
    return (member.contacts, *member.stronger)


def _parse(name: str, source: str, field: str) -> tuple[str, int]:
    family, _, text = name.removeprefix(FAMILY_PREFIX).partition(":")
    if family not in FAMILIES:
        raise UnknownName(source, field, "family", family, FAMILIES)
    if not (text.isascii() and text.isdigit()) or len(text) > 10 or int(text) >= _LARGEST_SEED:
        raise InputError(
            source,
            field,
            f"{name[:80]!r}: the seed must be a whole number from 0 to 2^31 - 1, as in "
            f"{FAMILY_PREFIX}{family}:17",
        )
    return family, int(text)


def _random(family: str, seed: int) -> np.random.Generator:
    return np.random.default_rng([_STREAMS[family], seed])


@cache
def _member(family: str, seed: int) -> Member:
    return FAMILIES[family].make(_random(family, seed))


@cache
def _object(family: str, seed: int) -> ObjectModel:
    member = _member(family, seed)
    # From a stream of its own: shapes stay as they are when friction is drawn in another way.
    friction = round(float(np.random.default_rng([_STREAMS[family], seed, 1]).uniform(*_FRICTION)), 3)
    sources = {
        **member.sources,
        "friction": "uniform in 0.45 to 0.75, around the 0.6 of DexGraspBench and Dexonomy",
    }
    description = f"Seed {seed} of the {FAMILIES[family].description}"
    return ObjectModel(f"{family}_{seed}", member.parts, friction, dict(member.regions), sources, description)
