"""What the tendons and actuators of a compiled model pull."""

import mujoco
from mujoco import mjtTrn, mjtWrap

__all__ = ["gear_on_joint", "pulled_joints"]


def pulled_joints(model: mujoco.MjModel, tendon: int) -> dict[int, float] | None:
    """Length of a tendon per position of each of its joints; None for one that runs through space."""
    first, count = int(model.tendon_adr[tendon]), int(model.tendon_num[tendon])
    wraps = range(first, first + count)
    if any(model.wrap_type[w] != mjtWrap.mjWRAP_JOINT for w in wraps):
        return None
    pulls: dict[int, float] = {}
    for w in wraps:
        j = int(model.wrap_objid[w])
        pulls[j] = pulls.get(j, 0.0) + float(model.wrap_prm[w])
    return pulls


def gear_on_joint(m: mujoco.MjModel, a: int, j: int) -> float:
    """How actuator a acts on joint j alone; 0 where it does not."""
    target = int(m.actuator_trnid[a, 0])
    match m.actuator_trntype[a]:
        case mjtTrn.mjTRN_JOINT | mjtTrn.mjTRN_JOINTINPARENT:
            return float(m.actuator_gear[a, 0]) if target == j else 0.0
        case mjtTrn.mjTRN_TENDON:
            pulls = pulled_joints(m, target)
            return float(m.actuator_gear[a, 0]) * pulls[j] if pulls and set(pulls) == {j} else 0.0
    return 0.0
