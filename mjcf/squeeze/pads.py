"""The pads at the contacts of a grasp: how far they yield, and at which arm friction resists spin."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...geometry import Patch, perpendicular, region_curvature
from ...hands import Pad, forward_kinematics
from ...solver import Configuration
from ..settings import HoldSettings, spin_arm_of_patch

__all__ = ["ContactPads", "contact_pads"]

# Before any plan, contacts are thought to press with this force: arms grow with its fourth root only.
_USUAL_N = 10.0
# A contact that is planned with next to nothing still presses with something.
_LEAST_N = 0.5


@dataclass(frozen=True, eq=False)
class ContactPads:
    """The pads at the contacts of a task.

    Attributes:
        pad: of the hand.
        curvatures: (n, 2) relative principal curvatures of hand and object in 1/m.
        fixed_arm_m: arm of spin friction where the settings fix it; None where the pads decide.
        soft: whether the pads yield in the test.
    """

    pad: Pad
    curvatures: Array
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
        forces = np.full(n, _USUAL_N) if normals_N is None else np.maximum(normals_N, _LEAST_N)
        return self.pad.spin_arm_m(forces, self.curvatures)

    def largest_arms_m(self) -> Array:
        """What `spin_arms_m` (n,) can't exceed, whatever the forces."""
        arm_m = self.pad.largest_arm_m if self.fixed_arm_m is None else self.fixed_arm_m
        return np.full(len(self.curvatures), arm_m)


def contact_pads(configuration: Configuration, settings: HoldSettings) -> ContactPads:
    """The pads at the contacts of a configuration."""
    task, state = configuration.task, configuration.state
    radius_m = settings.patch_radius_m
    fixed_arm_m = None if radius_m is None else spin_arm_of_patch(radius_m)
    rotations = forward_kinematics(task.hand, configuration.joint_vector)[:, :3, :3]
    curvatures, first = [], 0
    for contact, point in zip(task.contacts, configuration.contact_points, strict=True):
        tangents = np.asarray(perpendicular(point.n_object))
        relative = np.zeros((2, 2))
        for region, R in (
            (contact.hand.region, rotations[contact.hand.link]),
            (contact.object.region, state.R_palm_object),
        ):
            across = tangents @ R
            relative += across @ region_curvature(region, state.params[first : first + 2]) @ across.T
            first += 2 if isinstance(region, Patch) else 0
        curvatures.append(np.linalg.eigvalsh(relative))
    return ContactPads(task.hand.pad, np.array(curvatures), fixed_arm_m, settings.soft_pads)
