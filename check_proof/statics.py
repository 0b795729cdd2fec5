"""Replays the log of a statics tree: forces at points of an object's regions can't balance each other.

Why it proves that: for a twist y = (a, w) of the object, a point p of a region moves with v = a + w x p, and
a soft-finger force there with f_n = 1 has at least the power

    (v . m - mu |(v x m, r w . m)|) / |m|,   m along the inward normal, mu the friction, r the spin arm.

Over a part of the region, v . m, v x m and w . m are polynomials in Bernstein form, their values lie in the
hull of the control points, and what makes the power positive is a convex cone. So where all control points
lie strictly in that cone, no force of the contact has power zero or less, wherever in the part it acts. If
that holds for all contacts of a box, forces of its points can't balance each other, unless all are zero. The
boxes of the tree cover all points. A load along d and one along -d can't both be carried then: what carries
them would together balance itself.

A contact that reaches further acts anywhere within a disc of radius s about its point: its power is at least
that, less (mu s |w . m| + s |w x m|) / |m|.

Everything is worked out in whole numbers, so nothing is rounded; numbers of the log are taken as they stand.
"""

from fractions import Fraction
from typing import Any

from .exact_motion import moved, product, root_above
from .exact_regions import PER_UNIT, ExactPart
from .reading import Rejected, items, numbers
from .statics_tree import Leaf, StaticsTree

__all__ = ["StaticsReplay"]


class StaticsReplay(StaticsTree):
    """A tree whose leaves show that forces at their points can't balance each other."""

    claim, largest = "friction", 1e3

    def _read_form(self, form: dict[str, Any], n_contacts: int) -> None:
        """Reaches, and the load, of which some direction must have its opposite: no more is needed of it."""
        reaches = numbers(form.get("reaches_m"), n_contacts).tolist()
        if not all(0.0 <= reach <= 1.0 for reach in reaches):
            raise Rejected("a reach is out of range")
        self._reaches = [PER_UNIT * Fraction(reach) for reach in reaches]
        directions = [tuple(numbers(d, 3).tolist()) for d in items(form.get("directions"))]
        known = {d for d in directions if any(d)}
        if not any(tuple(-x for x in d) in known for d in known):
            raise Rejected("no direction of the load has its opposite")

    def _is_shown(self, leaf: Leaf, value: Fraction) -> bool:
        return all(
            _lies_in_cone(part, leaf.twist, value, arm, reach)
            for part, arm, reach in zip(self._parts_of(leaf), self._arms, self._reaches, strict=True)
        )


def _lies_in_cone(
    part: ExactPart, twist: list[int], friction: Fraction, arm: Fraction, reach: Fraction
) -> bool:
    """Whether v . m > mu |(v x m, r w . m)| + mu s |w . m| + s |w x m| at all control points of these."""
    q = moved(part, twist)
    if not (q.towards > 0).all():
        return False
    # Everything times the denominators, which are above zero.
    mu, r, s = friction.as_integer_ratio(), arm.as_integer_ratio(), reach.as_integer_ratio()
    left = mu[1] * r[1] * s[1] * q.towards
    if s[0] > 0:
        m, spin = q.normals, q.spin
        tilts = [
            product(spin[(c + 1) % 3], m[(c + 2) % 3]) - product(spin[(c + 2) % 3], m[(c + 1) % 3])
            for c in range(3)
        ]
        tilt = root_above(sum(t * t for t in tilts))
        left = left - r[1] * s[0] * (mu[1] * tilt + mu[0] * abs(q.about))
        if not (left > 0).all():
            return False
    right = r[1] ** 2 * sum(t * t for t in q.across) + r[0] ** 2 * q.about * q.about
    return bool((left * left > (mu[0] * s[1]) ** 2 * right).all())
