"""What MuJoCo made of a model's numbers, refused where no hand has such ones.

Numbers that are each finite in the file need not be so in the model: lengths are squared, scales multiply,
and quaternions and axes are brought to length 1. Masses and lengths are looked at where they are used.
"""

import mujoco
import numpy as np
from mujoco import mjtGeom, mjtObj

from ...base.numeric.arrays import Array
from ...errors import InputError

__all__ = ["check_compiled"]

# In units of the SI; nothing of a hand comes near, and squares of it are far from the end of the range.
_LARGEST = 1e12
_SMALLEST_M = 1e-7
_UNIT_TOLERANCE = 1e-6
_ARRAYS = {
    mjtObj.mjOBJ_BODY: ("body_pos", "body_quat", "body_ipos", "body_iquat"),
    mjtObj.mjOBJ_GEOM: ("geom_pos", "geom_quat", "geom_size"),
    mjtObj.mjOBJ_JOINT: ("jnt_pos", "jnt_axis", "jnt_range", "jnt_actfrcrange", "jnt_stiffness"),
    mjtObj.mjOBJ_ACTUATOR: (
        *("actuator_gainprm", "actuator_biasprm", "actuator_gear"),
        *("actuator_forcerange", "actuator_ctrlrange"),
    ),
    mjtObj.mjOBJ_TENDON: ("tendon_range", "tendon_actfrcrange"),
    mjtObj.mjOBJ_EQUALITY: ("eq_data",),
}
_UNIT = ("body_quat", "body_iquat", "geom_quat", "jnt_axis")
# Counted otherwise: by position, by degree of freedom, by corner of a mesh, by what a tendon goes through.
_NAMELESS = ("qpos0", "dof_damping", "dof_armature", "dof_frictionloss", "mesh_vert", "wrap_prm")
# How many sizes a shape has.
_N_SIZES = {
    mjtGeom.mjGEOM_SPHERE: 1,
    mjtGeom.mjGEOM_CAPSULE: 2,
    mjtGeom.mjGEOM_CYLINDER: 2,
    mjtGeom.mjGEOM_ELLIPSOID: 3,
    mjtGeom.mjGEOM_BOX: 3,
}


def check_compiled(model: mujoco.MjModel, source: str) -> None:
    """Refuses numbers that are not finite or beyond all measure, directions without length, dots for shapes.

    Args:
        model: as MuJoCo compiled it.
        source: of the model, for messages.

    Raises:
        InputError: naming the part of the model.
    """
    for kind, arrays in _ARRAYS.items():
        for array in arrays:
            for i, values in enumerate(np.asarray(getattr(model, array))):
                _check(values, array, source, _field(model, kind, i, array))
    for array in _NAMELESS:
        _check(np.asarray(getattr(model, array)), array, source, f"import: {array}")
    for i, kind in enumerate(model.geom_type):
        sizes = model.geom_size[i, : _N_SIZES.get(mjtGeom(kind), 0)]
        if np.any(sizes < _SMALLEST_M):
            field = _field(model, mjtObj.mjOBJ_GEOM, i, "geom_size")
            raise InputError(source, field, f"is {sizes.min():.3g} m; at least {_SMALLEST_M:g} is allowed")


def _field(model: mujoco.MjModel, kind: mjtObj, i: int, array: str) -> str:
    what, quantity = array.split("_", 1)
    word = {"jnt": "joint", "eq": "equality"}.get(what, what)
    return f"import: {word} {mujoco.mj_id2name(model, kind, i) or i}: {quantity}"


def _check(values: Array, array: str, source: str, field: str) -> None:
    # Compared this way round, NaN fails too.
    wrong = values[~(np.abs(values) <= _LARGEST)]
    if wrong.size:
        raise InputError(source, field, f"is {wrong.flat[0]:.3g}, and must be a number up to {_LARGEST:g}")
    if array in _UNIT and abs(float(np.linalg.norm(values)) - 1.0) > _UNIT_TOLERANCE:
        raise InputError(source, field, "has no direction: its numbers are too small or too large")
