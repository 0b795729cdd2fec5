"""Everything a hold test assumes, in one value that travels with its result."""

from dataclasses import dataclass
from math import radians

from ..objects import ObjectModel

__all__ = ["HoldSettings"]

Direction = tuple[float, float, float]
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
        patch_radius_m: radius a of the patch in which a soft pad touches. It can resist a torque of
            (2/3) friction a per newton of normal force about the contact normal (uniform pressure; Hertz's
            pressure gives 0.59 in place of 2/3).
        gravity: size of the load in m/s^2.
        directions: unit vectors in the palm frame along which gravity acts, one test each.
        hand_weight: whether the hand's own links have weight too. False stands for a controller that
            compensates it, as other benchmarks assume; the servos then work for the object alone.
        squeeze_s: time in which the joint targets move from the grasp to the squeeze, without gravity.
        settle_s: time at rest after that, still without gravity.
        hold_s: time under gravity, per direction.
        sample_s: distance of the recorded samples in time.
        slip_limit_m: the object is held while its centre of mass and its contact points stay this close to
            where the squeeze left them, in the palm frame.
        rotation_limit_rad: and while it has turned by less than this.
        planned_load: the squeeze is planned for this many times the weight, because gravity sets in at once.
        planned_friction: the squeeze is planned with this share of the friction, as a reserve against slip.
        planned_effort: the squeeze is planned within this share of every servo's largest effort.
        timestep_s: step of the simulation.
        impratio: MuJoCo's ratio of frictional to normal constraint impedance; above 1 slows creep.
        noslip_iterations: MuJoCo's extra solver passes that suppress creep (see `hold`).
        contact_solref: time constant in s and damping ratio of contacts. A time constant of 5 ms keeps a
            light object that is pinched hard from sinking into the fingers by millimetres.
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
    planned_load: float = 2.0
    planned_friction: float = 0.95
    planned_effort: float = 0.8
    timestep_s: float = 0.002
    impratio: float = 10.0
    noslip_iterations: int = 5
    contact_solref: tuple[float, float] = (0.005, 1.0)
    contact_solimp: tuple[float, float, float, float, float] = (0.95, 0.99, 0.001, 0.5, 2.0)

    def sliding_friction(self, obj: ObjectModel) -> float:
        """Coulomb coefficient between the hand and `obj`."""
        return obj.friction if self.friction is None else self.friction

    def torsional_friction(self, obj: ObjectModel) -> float:
        """Largest torque about the normal per normal force, in m."""
        return 2.0 / 3.0 * self.sliding_friction(obj) * self.patch_radius_m
