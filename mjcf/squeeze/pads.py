"""The pads at the contacts of a grasp: how far they yield, how friction resists spin, how wide they are.

A contact is wide where its pressure can be centred elsewhere than at its point. Where one of two surfaces
turns by an angle against the other, the place where they are nearest moves by the angle over their relative
curvature: so on a palm, a flat or a shallow dome the force goes where balance asks for it, while on a
fingertip it stays. It can't leave the patch in which the surfaces touch (`Pad.patch_m`), nor go farther than
it does while the object turns by half of what the test allows.

Where the hand is flat along a direction its curvature does not say where it ends. There the patch ends with
the link's shape, as it is a little below its surface: a fingertip with a flat pad is no wider than it is.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import pi

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ...geometry import length_below_surface, perpendicular, region_curvature
from ...hands import Pad, forward_kinematics
from ...objects import Task
from ...solver import Configuration, State, region_params
from ..settings import HoldSettings, spin_arm_of_patch
from .statics import ForcePoints

__all__ = ["TURN_SHARE", "USUAL_N", "ContactPads", "contact_curvatures", "contact_pads"]

USUAL_N = 10.0
"""Before any plan, contacts are thought to press with this force: arms grow with its fourth root only."""

TURN_SHARE = 0.5
"""Of the rotation that the test allows, how much the object may turn for forces to go where they should."""

# A contact that is planned with next to nothing still presses with something.
_LEAST_N = 0.5
# Contacts whose forces reach less far are points.
_LEAST_REACH_M = 0.003
# What bends less than so is flat: its curvature says nothing of where it ends.
_FLAT_PER_M = 1.0
# How far below its surface a pad is asked how wide it is: about what it yields by.
_BELOW_M = 5e-4


@dataclass(frozen=True, eq=False)
class ContactPads:
    """The pads at the contacts of a task.

    Attributes:
        pad: of the hand.
        curvatures: (n, 2) relative principal curvatures of hand and object in 1/m.
        directions: (n, 2, 2) in rows the principal directions they belong to, along the tangents that
            `Statics.frames` have.
        edges_m: (n, 2, 2) how far the hand goes on along each of `directions`, forth and back; infinite where
            it is curved there.
        turn_rad: by how much the object may turn for forces to be centred off a contact's point.
        fixed_arm_m: arm of spin friction where the settings fix it; None where the pads decide.
        soft: whether the pads yield in the test.
    """

    pad: Pad
    curvatures: Array
    directions: Array
    edges_m: Array
    turn_rad: float
    fixed_arm_m: float | None
    soft: bool

    def yields_m(self, normals_N: Array) -> Array:
        """How far each pad yields (n,) under its normal force (n,); 0 where the test has no soft pads."""
        return float(self.soft) * self.pad.yield_m(normals_N, self.curvatures)

    def spin_arms_m(self, normals_N: Array | None = None) -> Array:
        """Arm (n,) of spin friction under normal forces (n,); under a usual force where they aren't known."""
        n = len(self.curvatures)
        if self.fixed_arm_m is not None:
            return np.full(n, self.fixed_arm_m)
        forces = np.full(n, USUAL_N) if normals_N is None else np.maximum(normals_N, _LEAST_N)
        return self.pad.spin_arm_m(forces, self.curvatures, self.edges_m)

    def reaches_m(self, normals_N: Array | None = None) -> Array:
        """How far from a contact's point its force may be centred, (n, 2) along `directions`, in m."""
        n = len(self.curvatures)
        forces = np.full(n, USUAL_N) if normals_N is None else np.maximum(normals_N, _LEAST_N)
        rolled_m = self.turn_rad / np.maximum(self.curvatures, 1e-9)
        patches_m = self.pad.patch_m(forces, self.curvatures, self.edges_m)
        reaches: Array = np.minimum(np.minimum(patches_m, self.edges_m.min(axis=2)), rolled_m)
        return reaches

    def largest_reaches_m(self) -> Array:
        """What forces of a contact can't exceed of `reaches_m` (n,), whatever they are; 0 for points."""
        rolled_m = self.turn_rad / np.maximum(self.curvatures.min(axis=1), 1e-9)
        reaches_m = np.minimum(self.pad.thickness_m, rolled_m)
        return np.where(reaches_m < _LEAST_REACH_M, 0.0, reaches_m)

    def force_points(self, normals_N: Array | None = None) -> ForcePoints:
        """Where forces act: at each contact, and at the ends of the axes along which it is wide."""
        points = ForcePoints.at_contacts(len(self.curvatures))
        contact, offsets_m = [points.contact], [points.offsets_m]
        for i, reaches_m in enumerate(self.reaches_m(normals_N)):
            for reach_m, direction in zip(reaches_m, self.directions[i], strict=True):
                if reach_m >= _LEAST_REACH_M:
                    contact.append(np.array([i, i]))
                    offsets_m.append(reach_m * np.array([direction, -direction]))
        return ForcePoints(np.concatenate(contact), np.concatenate(offsets_m))

    def largest_arms_m(self) -> Array:
        """What `spin_arms_m` (n,) can't exceed, whatever the forces."""
        arm_m = self.pad.largest_arm_m if self.fixed_arm_m is None else self.fixed_arm_m
        return np.full(len(self.curvatures), arm_m)


def contact_pads(configuration: Configuration, settings: HoldSettings) -> ContactPads:
    """The pads at the contacts of a configuration."""
    radius_m = settings.patch_radius_m
    fixed_arm_m = None if radius_m is None else spin_arm_of_patch(radius_m)
    curvatures, directions, edges_m = _surfaces(configuration.task, configuration.state)
    limit = settings.rotation_limit_rad
    return ContactPads(
        pad=configuration.task.hand.pad,
        curvatures=curvatures,
        directions=directions,
        edges_m=edges_m,
        turn_rad=TURN_SHARE * (pi if limit is None else limit),
        fixed_arm_m=fixed_arm_m,
        soft=settings.soft_pads,
    )


# Measures, plans and other squeezes ask in turn for the same few states.
@lru_cache(maxsize=32)
def _surfaces(task: Task, state: State) -> tuple[Array, Array, Array]:
    """Curvatures, directions and edges of `ContactPads` at a state; not to be changed."""
    configuration = Configuration(task, state, 0.0, None)
    curvatures, directions, flat = [], [], []
    for of_hand, of_object in contact_curvatures(configuration):
        principal, axes = np.linalg.eigh(of_hand + of_object)
        curvatures.append(principal)
        directions.append(axes.T)
        flat.append(np.einsum("ki,ij,kj->k", axes.T, of_hand, axes.T) < _FLAT_PER_M)
    edges_m = _edges_m(configuration, np.array(directions), np.array(flat))
    found = np.array(curvatures), np.array(directions), edges_m
    for array in found:
        array.setflags(write=False)
    return found


def _edges_m(configuration: Configuration, directions: Array, flat: NDArray[np.bool_]) -> Array:
    """How far the hand's shapes go on from each contact (n, 2, 2), see `ContactPads`."""
    task = configuration.task
    poses = forward_kinematics(task.hand, configuration.joint_vector)
    edges_m = np.full((*flat.shape, 2), np.inf)
    for i in np.flatnonzero(flat.any(axis=1)):
        point, link = configuration.contact_points[i], task.contacts[i].hand.link
        R, p = poses[link, :3, :3], poses[link, :3, 3]
        where = task.hand.links[link].shapes, (point.p_hand - p) @ R, point.n_hand @ R
        tangents = np.asarray(perpendicular(-point.n_object)) @ R
        for k in np.flatnonzero(flat[i]):
            along = directions[i, k] @ tangents
            edges_m[i, k] = [length_below_surface(*where, sign * along, _BELOW_M) for sign in (1.0, -1.0)]
    return edges_m


def contact_curvatures(configuration: Configuration) -> Array:
    """Curvature (n, 2, 2, 2) in 1/m of the hand and of the object at each contact, positive where it bulges.

    Each is a form over the tangents that `Statics.frames` have.
    """
    task, state = configuration.task, configuration.state
    rotations = forward_kinematics(task.hand, configuration.joint_vector)[:, :3, :3]
    found = []
    for contact, point, params in zip(
        task.contacts, configuration.contact_points, region_params(task), strict=True
    ):
        tangents = np.asarray(perpendicular(-point.n_object))
        for region, R, where in (
            (contact.hand.region, rotations[contact.hand.link], params[0]),
            (contact.object.region, state.R_palm_object, params[1]),
        ):
            across = tangents @ R
            found.append(across @ region_curvature(region, state.params[where]) @ across.T)
    return np.array(found).reshape(-1, 2, 2, 2)
