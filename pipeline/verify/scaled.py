"""An object of another size."""

from dataclasses import replace

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Hull, MassProperties
from ...objects import ObjectModel, Part

__all__ = ["scaled_object"]


def scaled_object(obj: ObjectModel, factor: Array, *, keeps_mass: bool = False) -> ObjectModel:
    """The object with its coordinates multiplied by `factor` (3,), above zero, along its own axes.

    It has no regions and no Bezier surfaces, whose control points were given for another size.

    Args:
        obj: the object.
        factor: along x, y and z.
        keeps_mass: whether its mass was weighed, and stays; else its density does.
    """
    if np.all(factor == 1.0):
        return obj
    parts = tuple(_scaled_part(part, factor, keeps_mass) for part in obj.parts)
    return ObjectModel(obj.name, parts, obj.friction, {}, dict(obj.sources), obj.description)


def _scaled_part(part: Part, factor: Array, keeps_mass: bool) -> Part:
    mesh = part.mesh.copy()
    mesh.vertices = np.asarray(part.mesh.vertices) * factor
    # Of scaling by positive factors the order of a face's corners, and so its outside, knows nothing.
    pieces = tuple(Hull(piece.vertices * factor, piece.faces) for piece in part.pieces)
    closeness = part.closeness
    if closeness is not None:
        closeness = type(closeness)(*(float(width * factor.max()) for width in closeness))
    mass = part.inertia.mass * (1.0 if keeps_mass else float(np.prod(factor)))
    paint = part.paint and replace(part.paint, vertices=part.paint.vertices * factor)
    inertia = _scaled_inertia(part.inertia, factor, mass)
    return Part(part.name, mesh, pieces, inertia, part.rgba, closeness, paint)


def _scaled_inertia(inertia: MassProperties, factor: Array, mass: float) -> MassProperties:
    """Mass properties where every piece of matter moves from p to factor * p."""
    # Second moments of the mass about its centre scale with products of factors; the inertia follows of them.
    second = 0.5 * np.trace(inertia.inertia) * np.eye(3) - inertia.inertia
    second *= np.outer(factor, factor) * (mass / inertia.mass)
    return MassProperties(mass, inertia.centre * factor, np.trace(second) * np.eye(3) - second)
