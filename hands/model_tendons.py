"""What the tendons of a compiled model pull."""

import mujoco
from mujoco import mjtWrap

__all__ = ["pulled_joints"]


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
