"""Rods of a linkage that a model opens into a tree: they hang on a finger and bear no tip."""

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Shape, shape_mesh, transform_points
from ..hand import Hand
from ..kinematics import forward_kinematics
from .cast import surface_points

__all__ = ["is_closing_rod", "is_driven_rod", "links_before_rods", "reach_m"]

# A chain without a joint of its own that is so much shorter than the finger that moves it is a rod.
_SHORTER = 0.6
# Where a linkage was opened, the rod's free end lies as near to what it was cut from.
_CLOSES_M = 0.005


def links_before_rods(hand: Hand, T: Array, chain: list[int]) -> list[int]:
    """The chain, last link first, without rods at its end that lead back to the palm they were cut from.

    Args:
        hand: the hand.
        T: (n_links, 4, 4) T_palm_link with all joints at zero.
        chain: numbers of links from the last one towards the palm.
    """
    palm = hand.links[0].shapes
    while len(chain) > 1 and hand.links[chain[1]].shapes:
        here, before = (_points(hand, T, chain[i : i + 1]) for i in range(2))
        leads_back = _farthest_m(here, T, chain) < _farthest_m(before, T, chain)
        if not leads_back or not any(_height_m(shape, here) <= _CLOSES_M for shape in palm):
            break
        chain = chain[1:]
    return chain


def is_driven_rod(i: int, masters: list[frozenset[int]], reaches_m: list[float]) -> bool:
    """Whether chain i has no joint of its own and is much shorter than another that its joints move as well.

    Args:
        i: number of the chain.
        masters: of every chain, the independent joints that move it.
        reaches_m: of every chain, how far it reaches.
    """
    longest = max(reach for reach, joints in zip(reaches_m, masters, strict=True) if joints >= masters[i])
    return len(masters[i]) == 1 and reaches_m[i] < _SHORTER * longest


def is_closing_rod(hand: Hand, i: int, chains: list[list[int]], masters: list[frozenset[int]]) -> bool:
    """Whether chain i stays at a longer chain that its joints move as well, wherever these joints are.

    Such is the crank of a linkage whose other side bears the tip.

    Args:
        hand: the hand.
        i: number of the chain.
        chains: of links, the last one first.
        masters: of every chain, the independent joints that move it.
    """
    longer = [
        chain
        for chain, joints in zip(chains, masters, strict=True)
        if joints >= masters[i] and _n_joints(hand, chain) > _n_joints(hand, chains[i])
    ]
    if not longer or len(masters[i]) != 1:
        return False
    lower, upper = hand.limits.T
    poses = [forward_kinematics(hand, hand.expand(lower + s * (upper - lower))) for s in (0.0, 0.5, 1.0)]
    return any(all(_is_at(hand, T, chains[i][0], chain[0]) for T in poses) for chain in longer)


def reach_m(hand: Hand, T: Array, chain: list[int]) -> float:
    """How far a chain of links reaches from where it begins, in m."""
    return _farthest_m(_points(hand, T, chain), T, chain)


def _n_joints(hand: Hand, chain: list[int]) -> int:
    return sum(len(hand.links[link].axes) for link in chain)


def _is_at(hand: Hand, T: Array, a: int, b: int) -> bool:
    """Whether points of link a lie on a shape of link b or next to it."""
    back = np.linalg.inv(T[b])
    points = transform_points(back, _points(hand, T, [a]))
    return any(_height_m(shape, points) <= _CLOSES_M for shape in hand.links[b].shapes)


def _farthest_m(points: Array, T: Array, chain: list[int]) -> float:
    return float(np.linalg.norm(points - T[chain[-1]][:3, 3], axis=1).max())


def _points(hand: Hand, T: Array, links: list[int]) -> Array:
    """Points (n, 3) of links in the palm frame."""
    return np.concatenate([transform_points(T[i], surface_points(hand.links[i].shapes)) for i in links])


def _height_m(shape: Shape, points: Array) -> float:
    """How far the nearest of points (n, 3) lies off a convex shape, by the planes that bound it."""
    mesh = shape_mesh(shape)
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    flat = areas > 0.0
    normals = normals[flat] / areas[flat, None]
    heights = points @ normals.T - np.sum(normals * a[flat], axis=1)
    return float(heights.max(axis=1, initial=-np.inf).min(initial=np.inf))
