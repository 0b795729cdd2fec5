"""Finger structures as strings: `URR`, `RU(RR)`, the kinds of the joints from the palm to the tip."""

import re
from dataclasses import dataclass

__all__ = ["FingerJoint", "parse_structure"]

_STRUCTURE = re.compile(r"(?:[RU]|\([RU]{2,6}\)){1,8}", re.ASCII)
_MOST_JOINTS = 8


@dataclass(frozen=True)
class FingerJoint:
    """One joint of a structure.

    Attributes:
        kind: R (revolute) or U (universal).
        leader: index in the structure of the joint whose flexion drives this one's; None where it is free.
    """

    kind: str
    leader: int | None

    @property
    def n_axes(self) -> int:
        """Number of axes."""
        return 2 if self.kind == "U" else 1


def parse_structure(text: str) -> tuple[FingerJoint, ...]:
    """The joints of a structure, the one at the palm first.

    Joints inside one pair of parentheses turn together, as under a bar in the paper's Table 1: of a universal
    joint only the flexion takes part.

    Raises:
        ValueError: the text is no structure.
    """
    if not _STRUCTURE.fullmatch(text) or len(text.strip("()")) > 2 * _MOST_JOINTS:
        raise ValueError(
            f"{text[:40]!r} is no finger structure: that is made of R and U, with parentheses around two or "
            "more that turn together, such as URR or RU(RR)"
        )
    joints: list[FingerJoint] = []
    leader: int | None = None
    inside = False
    for letter in text:
        if letter in "()":
            inside, leader = letter == "(", None
            continue
        joints.append(FingerJoint(letter, leader))
        if inside and leader is None:
            leader = len(joints) - 1
    if len(joints) > _MOST_JOINTS:
        raise ValueError(f"{text!r} has {len(joints)} joints, more than {_MOST_JOINTS}")
    return tuple(joints)
