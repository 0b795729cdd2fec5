"""What a test of a task names, checked: in files and from Python alike."""

from collections.abc import Sequence

import numpy as np

from ..base.files.fields import Vector3
from ..errors import InputError, UnknownName
from .object_model import ObjectModel

__all__ = ["check_contacts", "check_once", "check_parts", "unit_vector"]

_ZERO = 1e-9


def check_parts(names: Sequence[str], obj: ObjectModel, source: str) -> None:
    """Refuses parts that the object does not have.

    Raises:
        UnknownName: with the nearest that it has.
    """
    known = [part.name for part in obj.parts]
    for i, name in enumerate(names):
        if name not in known:
            raise UnknownName(source, f"test.parts.{i}", f"part of object {obj.name}", name, known)


def check_contacts(numbers: Sequence[int], n_contacts: int, source: str) -> None:
    """Refuses numbers, of at least 0, of contacts that a task does not have, or that stand twice.

    Raises:
        InputError: with the first of them.
    """
    for i, number in enumerate(numbers):
        if number >= n_contacts:
            raise InputError(source, f"test.contacts.{i}", f"contacts are numbered 0 to {n_contacts - 1}")
    check_once(numbers, source, "test.contacts")


def check_once(entries: Sequence[str] | Sequence[int], source: str, field: str) -> None:
    """Refuses what stands twice.

    Raises:
        InputError: with the first such entry.
    """
    for i, entry in enumerate(entries):
        if entry in entries[:i]:
            raise InputError(source, f"{field}.{i}", f"{entry} stands twice")


def unit_vector(v: Vector3, source: str, field: str) -> Vector3:
    """A vector of length 1 in the direction of `v`.

    Raises:
        InputError: it is zero.
    """
    length = float(np.linalg.norm(v))
    if length < _ZERO:
        raise InputError(source, field, "must not be the zero vector")
    x, y, z = (np.array(v) / length).tolist()
    return x, y, z
