"""Rays onto the outside of a link, which is a union of convex shapes, in the link's frame."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ...geometry import Box, Capsule, Hull, Shape, Sphere, transform_points
from .enter import enter_planes

__all__ = ["Hits", "cast_onto", "surface_points"]


class Hits(NamedTuple):
    """Where rays enter a link first.

    Attributes:
        depth: (n,) along each ray, in units of its direction; inf for a ray that misses.
        normal: (n, 3) unit outward normals there.
    """

    depth: Array
    normal: Array


def cast_onto(shapes: tuple[Shape, ...], origins: Array, directions: Array) -> Hits:
    """Casts rays from `origins` (n, 3) outside all shapes along unit `directions` (n, 3)."""
    depth, normal = np.full(len(origins), np.inf), np.zeros((len(origins), 3))
    for shape in shapes:
        near = np.flatnonzero(_pass_near(shape, origins, directions))
        if not len(near):
            continue
        own = _enter(shape, origins[near], directions[near])
        nearer = own.depth < depth[near]
        depth[near[nearer]] = own.depth[nearer]
        normal[near[nearer]] = own.normal[nearer]
    return Hits(depth, normal)


def surface_points(shapes: tuple[Shape, ...]) -> Array:
    """Points (n, 3) that span the shapes: corners of polyhedra, and points all over balls."""
    clouds = []
    for shape in shapes:
        match shape:
            case Hull():
                clouds.append(shape.vertices)
            case Box():
                signs = np.array(np.meshgrid(*3 * [[-1.0, 1.0]])).reshape(3, -1).T
                T = shape.T_link_box
                clouds.append(transform_points(T, signs * shape.half_extents))
            case Sphere():
                clouds.append(shape.centre + shape.radius * _DIRECTIONS)
            case Capsule():
                clouds += [end + shape.radius * _DIRECTIONS for end in (shape.start, shape.end)]
    return np.concatenate(clouds) if clouds else np.zeros((0, 3))


def _pass_near(shape: Shape, o: Array, d: Array) -> NDArray[np.bool_]:
    """Whether each ray meets the box around a polyhedron, grown to a ball; round shapes are quick anyway."""
    if not isinstance(shape, Hull):
        return np.ones(len(o), dtype=bool)
    low, high = shape.bounds
    off = o - 0.5 * (low + high)
    across = off - np.einsum("ij,ij->i", off, d)[:, None] * d
    return np.asarray(np.linalg.norm(across, axis=1) <= 0.5001 * np.linalg.norm(high - low))


def _sphere_directions(count: int) -> Array:
    """Unit vectors (count, 3) spread evenly, on a Fibonacci lattice."""
    k = np.arange(count) + 0.5
    z = 1.0 - 2.0 * k / count
    angle = np.pi * (1.0 + np.sqrt(5.0)) * k
    r = np.sqrt(1.0 - z**2)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z])


_DIRECTIONS = np.concatenate([np.eye(3), -np.eye(3), _sphere_directions(120)])


def _enter(shape: Shape, o: Array, d: Array) -> Hits:
    match shape:
        case Sphere():
            return _enter_ball(shape.centre, shape.radius, o, d)
        case Capsule():
            return _enter_capsule(shape, o, d)
        case Box():
            R, p = shape.T_link_box[:3, :3], shape.T_link_box[:3, 3]
            A = np.concatenate([R.T, -R.T])
            return _enter_planes(A, A @ p + np.tile(shape.half_extents, 2), o, d)
        case Hull():
            return _enter_planes(*shape.planes, o, d)


def _enter_planes(A: Array, b: Array, o: Array, d: Array) -> Hits:
    """Of the body {x: A x <= b}."""
    depth, first = np.empty(len(o)), np.empty(len(o), dtype=np.int64)
    A, b, o, d = (np.ascontiguousarray(array) for array in (A, b, o, d))
    enter_planes(A, b, o, d, depth, first)
    return Hits(depth, A[first])


def _enter_ball(centre: Array, radius: float, o: Array, d: Array) -> Hits:
    off = o - centre
    b = np.einsum("ij,ij->i", off, d)
    square = b**2 - np.einsum("ij,ij->i", off, off) + radius**2
    depth = np.where(square >= 0.0, -b - np.sqrt(np.maximum(square, 0.0)), np.inf)
    depth = np.where(depth >= 0.0, depth, np.inf)
    at = o + np.where(np.isfinite(depth), depth, 0.0)[:, None] * d
    return Hits(depth, (at - centre) / radius)


def _enter_capsule(shape: Capsule, o: Array, d: Array) -> Hits:
    axis = shape.end - shape.start
    length = float(np.linalg.norm(axis))
    e = axis / length
    off = o - shape.start
    across_o, across_d = off - np.outer(off @ e, e), d - np.outer(d @ e, e)
    a = np.einsum("ij,ij->i", across_d, across_d)
    b = np.einsum("ij,ij->i", across_o, across_d)
    c = np.einsum("ij,ij->i", across_o, across_o) - shape.radius**2
    square = b**2 - a * c
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = (-b - np.sqrt(np.maximum(square, 0.0))) / a
    along = (off + np.nan_to_num(depth, posinf=0.0, neginf=0.0)[:, None] * d) @ e
    hit = (a > 1e-12) & (square >= 0.0) & (depth >= 0.0) & (along >= 0.0) & (along <= length)
    depth = np.where(hit, depth, np.inf)
    at = across_o + np.where(hit, depth, 0.0)[:, None] * across_d
    best = Hits(depth, at / shape.radius)
    for end in (shape.start, shape.end):
        ball = _enter_ball(end, shape.radius, o, d)
        nearer = ball.depth < best.depth
        best = Hits(
            np.where(nearer, ball.depth, best.depth), np.where(nearer[:, None], ball.normal, best.normal)
        )
    return best
