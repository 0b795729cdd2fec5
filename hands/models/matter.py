"""Shapes and masses of imported links: what the model says, mended where no body could be so."""

from dataclasses import replace

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...geometry import MassProperties, combined_mass, mass_properties, shape_mesh
from ..hand import Link
from ..placed import placed_shape
from .model_tree import ModelTree

__all__ = ["with_matter"]

# kg/m^3 of links to which the model gives no mass; MuJoCo takes the same for its geoms.
_DENSITY = 1000.0
_LEAST_MASS_KG = 1e-6
# The least radius of gyration that a link may have.
_LEAST_GYRATION_M = 1e-4
# Beyond these, figures are no hand's: most often millimetres were taken for metres.
_LARGEST_LENGTH_M = 10.0
_LARGEST_MASS_KG = 1e3
_LARGEST_SERVO = 1e9


def with_matter(
    link: Link, parts: list[tuple[int, Array]], tree: ModelTree, source: str, *, is_palm: bool
) -> Link:
    """The link with the shapes and masses of the bodies that went into it.

    Args:
        link: without shapes, and with a nominal mass.
        parts: bodies, each with its pose T_link_body (4, 4).
        tree: the model, whose notes take what was mended.
        source: the file, for error messages.
        is_palm: a palm does not move, and so needs no mass.

    Raises:
        InputError: figures that are no hand's.
    """
    shapes = tuple(placed_shape(shape, T) for body, T in parts for shape in tree.shapes(body))
    masses = [_placed_inertia(tree.inertia(body), T) for body, T in parts]
    masses = [mass for mass in masses if mass.mass > 0.0]
    inertia = combined_mass(masses) if masses else link.inertia
    if (not masses or inertia.mass < _LEAST_MASS_KG) and not is_palm:
        inertia = link.inertia
        if shapes:
            volume = sum(abs(shape_mesh(shape).volume) for shape in shapes)
            inertia = mass_properties(shapes, max(_DENSITY * volume, _LEAST_MASS_KG))
        tree.notes.append(
            f"{link.name}: the model gives it no mass; {inertia.mass:.2g} kg was taken"
            + (f", {_DENSITY:g} kg/m^3" if shapes else "")
        )
    link = replace(link, shapes=shapes, inertia=_sound(inertia))
    _check_sane(link, source)
    return link


def _check_sane(link: Link, source: str) -> None:
    """Refuses figures that are no hand's.

    Raises:
        InputError: naming the link and what is allowed.
    """
    field = f"import: body {link.name}"
    lengths = [link.T_parent_link0[:3, 3], link.inertia.centre]
    lengths += [corner for shape in link.shapes for corner in shape_mesh(shape).bounds]
    largest = float(np.abs(lengths).max())
    if not largest <= _LARGEST_LENGTH_M:
        raise InputError(
            source,
            field,
            f"reaches {largest:.3g} m, and no hand is larger than {_LARGEST_LENGTH_M:g} m; is it in mm "
            "(a mesh then needs scale 0.001)?",
        )
    if not link.inertia.mass <= _LARGEST_MASS_KG:
        raise InputError(
            source,
            field,
            f"weighs {link.inertia.mass:.3g} kg; at most {_LARGEST_MASS_KG:g} kg is allowed",
        )
    for axis in link.axes:
        if axis.coupling is not None and not 0.01 <= abs(axis.coupling.ratio) <= 100.0:
            raise InputError(
                source,
                f"import: joint {axis.name}",
                f"follows {axis.coupling.master!r} by the ratio {axis.coupling.ratio:g}; "
                "from 0.01 to 100 or from -100 to -0.01 is allowed",
            )
        if axis.coupling is not None and not abs(axis.coupling.offset) <= 10.0:
            raise InputError(
                source,
                f"import: joint {axis.name}",
                f"follows with the offset {axis.coupling.offset:g}; -10 to 10 (rad or m) is allowed",
            )
        servo = axis.actuator
        if (
            servo is not None
            and not max(servo.effort, servo.stiffness, servo.damping, servo.armature) <= _LARGEST_SERVO
        ):
            raise InputError(
                source, f"actuators.{axis.name}", f"has figures beyond {_LARGEST_SERVO:g}: {servo}"
            )


def _sound(inertia: MassProperties) -> MassProperties:
    """The mass with an inertia that a body can have: moments above zero, none larger than the others' sum."""
    moments, axes = np.linalg.eigh(0.5 * (inertia.inertia + inertia.inertia.T))
    least = inertia.mass * _LEAST_GYRATION_M**2
    if moments.min() >= least and moments[2] <= (moments[0] + moments[1]) * (1.0 + 1e-9):
        return inertia
    moments = np.maximum(moments, least)
    if moments[2] > moments[0] + moments[1]:
        moments[:] = moments.mean()
    return MassProperties(inertia.mass, inertia.centre, axes @ np.diag(moments) @ axes.T)


def _placed_inertia(inertia: MassProperties, T: Array) -> MassProperties:
    R = T[:3, :3]
    return MassProperties(inertia.mass, R @ inertia.centre + T[:3, 3], R @ inertia.inertia @ R.T)
