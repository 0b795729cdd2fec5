"""Joints of a hand by the names that files give them."""

from collections.abc import Sequence

from ....hands import Hand

__all__ = ["match_joints"]


def match_joints(hand: Hand, names: Sequence[str]) -> dict[str, int]:
    """Index in the hand's joint vector of each name that means one of its joints.

    A name is that of the joint, whatever its case, or with something added in front on either side, as by
    makers of scenes (`rh_FFJ3`, `robot0:FFJ3`, `FFJ3`), where that leaves no doubt.
    """
    known = [_plain(name) for name in hand.joint_names]
    found: dict[str, int] = {}
    for name in names:
        plain = _plain(name)
        same = [j for j, other in enumerate(known) if other == plain] or [
            j for j, other in enumerate(known) if _ends_in(plain, other) or _ends_in(other, plain)
        ]
        if len(same) == 1 and same[0] not in found.values():
            found[name] = same[0]
    return found


def _plain(name: str) -> str:
    return name.lower().replace("-", "_").replace(".", "_").replace(" ", "_")


def _ends_in(longer: str, shorter: str) -> bool:
    """Whether one is the other with a prefix that ends where a word does."""
    if not longer.endswith(shorter) or len(longer) == len(shorter):
        return False
    return longer[-len(shorter) - 1] in "_:/" and len(shorter) >= 2
