"""Everything a hold test assumes, in one value that travels with its result."""

from dataclasses import dataclass
from math import radians
from typing import TypeAlias

from ..objects import ObjectModel

__all__ = ["Direction", "HoldSettings"]

Direction: TypeAlias = tuple[float, float, float]
_SIX: tuple[Direction, ...] = (
    (1.0, 0.0, 0.0),
    (-1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0),
    (0.0, -1.0, 0.0),
    (0.0, 0.0, 1.0),
    (0.0, 0.0, -1.0),
)


@dataclass(frozen=True)
class HoldSettings:
    """Assumptions of a hold test; the defaults are the preset `holdfast`.

    Attributes:
        preset: name of this set of values.
        friction: Coulomb coefficient between hand and object; None takes the object's.
        patch_radius_m: radius a of the patch in which a soft pad touches. The pad resists a torque of
            (2/3) friction a per newton about the contact normal (uniform pressure; Hertz's pressure gives
            0.59 in place of 2/3). 5 mm is what Hertz gives for a fingertip of radius 13 mm with a soft pad
            (0.8 MPa) that presses with 25 N on a bar of radius 9 mm. Others assume more: 5 mm of friction
            per newton in MuJoCo's defaults, 20 mm in DexGraspBench, against 2 mm here at friction 0.6.
        gravity: size of the load in m/s^2.
        directions: unit vectors in the palm frame along which gravity acts, one test each.
        hand_weight: whether the hand's links have weight too. False stands for a controller that compensates
            it, so that the servos work for the object alone (DexGraspBench loads the object alone, too).
        squeeze_s: time in which the servos' targets move from the grasp to the squeeze, without gravity.
        settle_s: time at rest after that, still without gravity.
        hold_s: time under gravity, per direction.
        sample_s: distance in time of the recorded samples.
        slip_limit_m: the object is held while its points of contact stay this close to where the squeeze
            left them, in the palm frame. Sag of the fingers counts as slip.
        rotation_limit_rad: and while it has turned by less than this. The squeeze, too, must not move the
            object by more than these two limits.
        planned_load: the squeeze is planned for this many times the weight: gravity sets in at once, and the
            object swings before it rests.
        planned_effort: the squeeze is planned within this share of every servo's largest effort.
        timestep_s: step of the simulation.
        impratio: MuJoCo's ratio of frictional to normal constraint impedance; above 1 slows creep.
        noslip_iterations: MuJoCo's extra passes against creep. 5 are enough for a straight pinch; pinches
            that lean on the edges of their friction cones turned by up to 1 deg/s with 5, and by less than
            0.02 deg/s with 20.
        contact_solref: time constant in s and damping ratio of contacts. With 5 ms, fingers that pinch the
            scalpel with 30 N sink in by 0.4 mm; with MuJoCo's 20 ms it would be several millimetres.
        contact_solimp: impedance of contacts, as MuJoCo's `solimp`.
    """

    preset: str = "holdfast"
    friction: float | None = None
    patch_radius_m: float = 0.005
    gravity: float = 9.81
    directions: tuple[Direction, ...] = _SIX
    hand_weight: bool = False
    squeeze_s: float = 0.5
    settle_s: float = 0.5
    hold_s: float = 2.0
    sample_s: float = 0.02
    slip_limit_m: float = 0.005
    rotation_limit_rad: float = radians(10.0)
    planned_load: float = 1.5
    planned_effort: float = 0.9
    timestep_s: float = 0.002
    impratio: float = 10.0
    noslip_iterations: int = 20
    contact_solref: tuple[float, float] = (0.005, 1.0)
    contact_solimp: tuple[float, float, float, float, float] = (0.95, 0.99, 0.001, 0.5, 2.0)

    def sliding_friction(self, obj: ObjectModel) -> float:
        """Coulomb coefficient between the hand and `obj`."""
        return obj.friction if self.friction is None else self.friction

    def torsional_friction(self, obj: ObjectModel) -> float:
        """Largest torque about the normal per normal force, in m."""
        return 2.0 / 3.0 * self.sliding_friction(obj) * self.patch_radius_m
