"""Axes of the object in which its contacts are written: the first along what keeps two regions apart.

In a frame of the designer's choice the difference of two contacts mixes all columns of the object's rotation.
Along these axes it is nearly a multiple of the first column, so its direction and the rotation are narrowed,
and split, together. The solutions are the same ones.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Cap, Patch
from ...objects import Contact, Task

__all__ = ["in_axes", "working_axes"]

# A direction must separate by this share more than one before it: normals leave equations shorter.
_BETTER = 0.02
# Sines below this don't tell directions apart.
_PARALLEL = 1e-3
# Entries of axes that are mere rounding; without them equations stay as short as the object's frame has them.
_ROUNDING = 1e-15


def working_axes(task: Task) -> Array:
    """Orthonormal axes in rows (3, 3), in the object's frame; its own where a region is not a bilinear patch.

    Curved patches tend to be given along axes in which they are simplest: x and y straight, z a Bernstein
    function. Turned, all three were, which costs more than what the axes save.

    The first is the direction that keeps two of the regions farthest apart for certain, of the normals of the
    patches and the differences of their middles. The second does the same among what is perpendicular to it.
    """
    patches = [c.object.region.patch for c in task.contacts if isinstance(c.object.region, Patch)]
    bilinear = [patch for patch in patches if patch.degree == (1, 1)]
    if task.T_palm_object is not None or len(bilinear) != len(task.contacts) or len(patches) < 2:
        return np.eye(3)
    clouds = [_offset_points(contact, patch) for contact, patch in zip(task.contacts, patches, strict=True)]
    directions = list(_directions(patches, clouds))
    first = _best(directions, clouds)
    level = [d - (d @ first) * first for d in directions]
    second = _best([d for d in level if np.linalg.norm(d) > _PARALLEL], clouds)
    second = _unit(second - (second @ first) * first)  # what a small difference has lost in rounding
    axes = np.array([first, second, np.cross(first, second)])
    return np.where(np.abs(axes) < _ROUNDING, 0.0, axes)


def in_axes(contact: Contact, axes: Array) -> Contact:
    """The contact with the object's patch in the frame with these axes; other regions are left alone."""
    region = contact.object.region
    if not isinstance(region, Patch):
        return contact
    turned = replace(region, patch=BezierPatch(region.patch.control_points @ axes.T))
    return replace(contact, object=replace(contact.object, region=turned))


def _offset_points(contact: Contact, patch: BezierPatch) -> Array:
    """Control points (n, 3) of a patch, or of where the centre of a hand's sphere may be, about."""
    points: Array = patch.control_points.reshape(-1, 3)
    cap = contact.hand.region
    return points + cap.radius * _unit(patch.normal.evaluate(0.5, 0.5)) if isinstance(cap, Cap) else points


def _directions(patches: Sequence[BezierPatch], clouds: Sequence[Array]) -> Iterator[Array]:
    """Unit vectors (3,): normals at the middles of patches, differences of the middles, tangents."""
    for patch in patches:
        yield _unit(patch.normal.evaluate(0.5, 0.5))
    for a, b in combinations(clouds, 2):
        between = a.mean(axis=0) - b.mean(axis=0)
        if between.any():
            yield _unit(between)
    for patch in patches:
        yield _unit(patch.du.evaluate(0.5, 0.5))
        yield _unit(patch.dv.evaluate(0.5, 0.5))


def _best(directions: Sequence[Array], clouds: Sequence[Array]) -> Array:
    """The unit vector (3,) along which two of the clouds are farthest apart; earlier ones have precedence."""
    best, separation = _unit(directions[0]), -np.inf
    for direction in directions:
        unit = _unit(direction)
        apart = _separation(unit, clouds)
        if np.isinf(separation) or apart > separation + _BETTER * abs(separation):
            best, separation = unit, apart
    return best


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v))


def _separation(unit: Array, clouds: Sequence[Array]) -> float:
    """The largest gap (m) along a direction between any two clouds of points; negative where all overlap."""
    along = [cloud @ unit for cloud in clouds]
    gaps = (max(a.min() - b.max(), b.min() - a.max()) for a, b in combinations(along, 2))
    return float(max(gaps))
