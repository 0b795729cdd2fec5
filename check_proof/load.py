"""Replays the log of a tree for the load: contacts of limited normal force carry no more of it.

Why it proves that: contacts that carry the load W d bring about the force -W d, without a torque about the
centre of mass. Along a twist y = (a, w) that has the power -W d . a. A soft-finger force of normal part f at
a point has at least the power

    -f max(0, mu |(v x m, r w . m)| - v . m) / |m|,   v = a + w x p, m along the inward normal,

with f at most F. So where W d is carried for d = a / |a|,

    W |a| <= sum over contacts of F max(0, mu |(v x m, r w . m)| - v . m) / |m|.

For any vector e, |m| |e| >= m . e. Over a part of the region all of this is of polynomials in Bernstein form,
whose values lie in the hull of their control points, and max(0, mu |...| - ...) <= t (m . e) is a convex
condition for them: the largest t over the control points, where all m . e are above zero, is one for all
points. The boxes of the tree cover all points. So at none of them is a larger load carried in every
direction.

Everything is worked out in whole numbers and fractions; square roots are rounded away from what is to be
shown, in their 64th binary digit.
"""

from fractions import Fraction
from math import isqrt
from typing import Any

from .exact_motion import moved, product, root_above
from .exact_regions import ExactPart
from .reading import Rejected, items, numbers
from .statics_tree import Leaf, StaticsTree, whole_numbers

__all__ = ["LoadReplay"]

_DIGITS = 64
_LARGEST_FRICTION, _LARGEST_FORCE_N = 1e3, 1e9


class LoadReplay(StaticsTree):
    """A tree whose leaves bound the load.

    Attributes:
        forces_N: largest normal forces that the log is about, once they are read.
    """

    claim, largest = "multiple", 1e12
    hints = frozenset({"along"})

    def __init__(self) -> None:
        super().__init__()
        self.forces_N: list[float] = []

    def _is_expected(self, form: Any, expected: Any) -> bool:
        """All but the largest forces, which are the log's own and part of what it says."""
        return isinstance(form, dict) and {k: form[k] for k in form if k != "forces_N"} == expected

    def _read_form(self, form: dict[str, Any], n_contacts: int) -> None:
        """Friction, weight and forces; there is nothing else in the form."""
        if set(form) != {
            "contacts", "centre_m", "spin_arms_m", "mass_kg", "friction", "gravity", "forces_N",
        }:  # fmt: skip
            raise Rejected("the form lacks something, or has something more")
        friction, gravity, mass = numbers([form["friction"], form["gravity"], form["mass_kg"]]).tolist()
        if not 0.0 <= friction <= _LARGEST_FRICTION:
            raise Rejected("the friction is out of range")
        if not gravity > 0.0:
            raise Rejected("the load has no weight")
        self.forces_N = numbers(form["forces_N"], n_contacts).tolist()
        if not all(0.0 < force <= _LARGEST_FORCE_N for force in self.forces_N):
            raise Rejected("a largest force is out of range")
        self._friction, self._weight = Fraction(friction), Fraction(mass) * Fraction(gravity)

    def _is_shown(self, leaf: Leaf, value: Fraction) -> bool:
        parts, a = self._parts_of(leaf), leaf.twist[:3]
        rows = items(leaf.hints["along"], len(parts))
        along = [whole_numbers(leaf.name, row, 3) for row in rows]
        moved_N = value * self._weight * Fraction(isqrt(sum(x * x for x in a) << 2 * _DIGITS), 1 << _DIGITS)
        power = Fraction(0)
        for part, arm, force_N, e in zip(parts, self._arms, self.forces_N, along, strict=True):
            most = _most_power(part, leaf.twist, self._friction, arm, e)
            if most is None:
                return False
            power += Fraction(force_N) * most
        return any(a) and power <= moved_N


def _most_power(
    part: ExactPart, twist: list[int], friction: Fraction, arm: Fraction, e: list[int]
) -> Fraction | None:
    """No force of the contact takes up more power by newton; None where normals may stand across e."""
    q, w = moved(part, twist), part.points[..., 3]
    lengths = sum(e[c] * product(w, part.normals[..., c]) for c in range(3))
    if not any(e) or not (lengths > 0).all():
        return None
    mu, r = friction.as_integer_ratio(), arm.as_integer_ratio()
    squares = r[1] ** 2 * sum(t * t for t in q.across) + r[0] ** 2 * q.about * q.about
    # Everything times the denominators of friction and arm, and by the digits of roots.
    across = mu[0] * root_above(squares << 2 * _DIGITS)
    power = across - ((mu[1] * r[1]) * q.towards << _DIGITS)
    scale = (mu[1] * r[1]) << 2 * _DIGITS
    size = isqrt(sum(x * x for x in e) << 2 * _DIGITS) + 1
    most = max(
        Fraction(int(p), int(length)) for p, length in zip(power.ravel(), lengths.ravel(), strict=True)
    )
    return max(Fraction(0), most) * size / scale
