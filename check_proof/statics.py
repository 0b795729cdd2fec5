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
from itertools import product
from math import isqrt
from typing import Any

import numpy as np

from .exact_regions import PER_UNIT, ExactChart, ExactPart, convolve, read_chart
from .log_replay import LogReplay, box_name
from .reading import Rejected, indices, items, numbers

__all__ = ["StaticsReplay"]

_MOST_CONTACTS, _MOST_ROOTS = 12, 4096
_MOST_OPEN = 2_000_000
_DEEPEST = 400
_LARGEST_TWIST = 1 << 40
_LARGEST_FRICTION = 1e3
# Parts of regions that are kept, for boxes share them.
_MOST_KEPT = 4096

Sides = tuple[tuple[Fraction, Fraction], ...]


class StaticsReplay(LogReplay):
    """Walks through the tree of boxes; what has been split or refuted is no longer open.

    Attributes:
        boxes: boxes replayed.
        steps: twists among them.
        friction: what the log claims, once it is read.
    """

    def __init__(self) -> None:
        super().__init__()
        self.friction: float | None = None
        self._open: dict[str, Sides] = {}
        self._leaves: list[tuple[str, Sides, list[int]]] = []
        self._parts: dict[tuple[int, int, Sides], ExactPart] = {}
        self._charts: list[list[ExactChart]] = []

    def _begin(self, form: Any, expected: Any) -> None:
        if self._charts:
            raise Rejected("a second set of regions")
        if expected is not None and form != expected:
            raise Rejected("the log's regions and load are not those of the task")
        if not isinstance(form, dict):
            raise Rejected("the regions are missing")
        contacts = items(form.get("contacts"))
        if not 1 <= len(contacts) <= _MOST_CONTACTS:
            raise Rejected("the number of contacts is out of range")
        centre = [Fraction(x) for x in numbers(form.get("centre_m"), 3).tolist()]
        arms = numbers(form.get("spin_arms_m"), len(contacts)).tolist()
        if not all(0.0 <= arm <= 1.0 for arm in arms):
            raise Rejected("a spin arm is out of range")
        reaches = numbers(form.get("reaches_m"), len(contacts)).tolist()
        if not all(0.0 <= reach <= 1.0 for reach in reaches):
            raise Rejected("a reach is out of range")
        self._arms = [PER_UNIT * Fraction(arm) for arm in arms]
        self._reaches = [PER_UNIT * Fraction(reach) for reach in reaches]
        _check_load(form)
        self._charts = [[read_chart(data, centre) for data in items(charts)] for charts in contacts]
        roots = list(product(*(range(len(charts)) for charts in self._charts)))
        if not 1 <= len(roots) <= _MOST_ROOTS:
            raise Rejected("a contact has no region, or too many parts")
        self._roots = roots
        whole = ((Fraction(0), Fraction(1)),) * (2 * len(contacts))
        self._open = {f"{k}/": whole for k in range(len(roots))}

    def _take(self, record: dict[str, Any]) -> None:
        """A box that is split, or claimed to be refuted by its twist, which is seen to at the end."""
        name = record.get("box")
        if not isinstance(name, str) or name not in self._open:
            raise Rejected("a record is of a box that is not open")
        sides = self._open.pop(name)
        self.boxes += 1
        if set(record) == {"box", "split"}:
            self._split(name, sides, record["split"])
        elif set(record) == {"box", "twist"}:
            twist = items(record["twist"], 6)
            if not all(type(x) is int and abs(x) <= _LARGEST_TWIST for x in twist):
                raise Rejected(f"box {box_name(name)}: a twist is not six whole numbers")
            self._leaves.append((name, sides, twist))
            self.steps += 1
        else:
            raise Rejected(f"box {box_name(name)}: is neither split nor refuted")

    def _split(self, name: str, sides: Sides, cut: Any) -> None:
        """Below and above a value of one parameter, which must lie inside."""
        k, value = items(cut, 2)
        k, at = int(indices([k], len(sides))[0]), Fraction(float(numbers([value])[0]))
        low, high = sides[k]
        if not low < at < high:
            raise Rejected(f"box {box_name(name)}: is split outside itself")
        if len(self._open) >= _MOST_OPEN or len(name) > _DEEPEST:
            raise Rejected("more boxes are open than fit into memory")
        self._open[name + "0"] = (*sides[:k], (low, at), *sides[k + 1 :])
        self._open[name + "1"] = (*sides[:k], (at, high), *sides[k + 1 :])

    def _finish(self, end: Any, digest: str) -> None:
        if not self._charts:
            raise Rejected("the regions are missing")
        if self._open:
            raise Rejected(
                f"{len(self._open)} boxes are left open, the first is {box_name(next(iter(self._open)))}"
            )
        friction = end.get("friction") if isinstance(end, dict) else None
        value = float(numbers([friction])[0])
        if not 0.0 <= value <= _LARGEST_FRICTION:
            raise Rejected("the friction is out of range")
        if end != {"friction": friction, "boxes": self.boxes, "sha256": digest}:
            raise Rejected("the log was changed after it was written: its checksum or its counts differ")
        for name, sides, twist in self._leaves:
            if not self._is_refuted(name, sides, twist, Fraction(value)):
                raise Rejected(f"box {box_name(name)}: its twist does not show that forces can't balance")
        self.friction = value

    def _is_refuted(self, name: str, sides: Sides, twist: list[int], friction: Fraction) -> bool:
        root = self._roots[int(name.partition("/")[0])]
        for i, number in enumerate(root):
            part = self._part(i, number, sides[2 * i : 2 * i + 2])
            if not _lies_in_cone(part, twist, friction, self._arms[i], self._reaches[i]):
                return False
        return True

    def _part(self, contact: int, number: int, sides: Sides) -> ExactPart:
        key = (contact, number, sides)
        if key not in self._parts:
            if len(self._parts) >= _MOST_KEPT:
                self._parts.clear()
            self._parts[key] = self._charts[contact][number].over(*sides)
        return self._parts[key]


def _lies_in_cone(
    part: ExactPart, twist: list[int], friction: Fraction, arm: Fraction, reach: Fraction
) -> bool:
    """Whether v . m > mu |(v x m, r w . m)| + mu s |w . m| + s |w x m| at all control points of these."""
    a, (x, y, z) = twist[:3], twist[3:]
    P, w = part.points[..., :3], part.points[..., 3]
    turned = (y * P[..., 2] - z * P[..., 1], z * P[..., 0] - x * P[..., 2], x * P[..., 1] - y * P[..., 0])
    v = [w * a[c] + turned[c] for c in range(3)]
    spin = [w * twist[3 + c] for c in range(3)]
    m = [part.normals[..., c] for c in range(3)]
    towards = sum(_product(v[c], m[c]) for c in range(3))
    if not (towards > 0).all():
        return False
    across = [
        _product(v[(c + 1) % 3], m[(c + 2) % 3]) - _product(v[(c + 2) % 3], m[(c + 1) % 3]) for c in range(3)
    ]
    about = sum(_product(spin[c], m[c]) for c in range(3))
    # Everything times the denominators, which are above zero.
    mu, r, s = friction.as_integer_ratio(), arm.as_integer_ratio(), reach.as_integer_ratio()
    left = mu[1] * r[1] * s[1] * towards
    if s[0] > 0:
        tilts = [
            _product(spin[(c + 1) % 3], m[(c + 2) % 3]) - _product(spin[(c + 2) % 3], m[(c + 1) % 3])
            for c in range(3)
        ]
        tilt = _root_above(sum(t * t for t in tilts))
        left = left - r[1] * s[0] * (mu[1] * tilt + mu[0] * abs(about))
        if not (left > 0).all():
            return False
    right = r[1] ** 2 * sum(t * t for t in across) + r[0] ** 2 * about * about
    return bool((left * left > (mu[0] * s[1]) ** 2 * right).all())


def _root_above(squares: Any) -> Any:
    """Whole numbers above the square roots of whole numbers."""
    return np.array([isqrt(x) + 1 for x in squares.ravel()], dtype=object).reshape(squares.shape)


def _product(a: Any, b: Any) -> Any:
    """The product of two scalar forms (., .)."""
    return convolve(a, b, lambda one, net: one * net)


def _check_load(form: dict[str, Any]) -> None:
    """The load must have weight, and some direction of it an opposite: that is all that is needed of it."""
    if not float(numbers([form.get("mass_kg")])[0]) > 0.0:
        raise Rejected("the load has no weight")
    directions = [tuple(numbers(d, 3).tolist()) for d in items(form.get("directions"))]
    known = {d for d in directions if any(d)}
    if not any(tuple(-x for x in d) in known for d in known):
        raise Rejected("no direction of the load has its opposite")
