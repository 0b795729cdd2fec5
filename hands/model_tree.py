"""What MuJoCo compiled, read as plain values: bodies, joints, couplings, servos and shapes of a hand."""

from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np
import trimesh
from mujoco import mjtEq, mjtGeom, mjtJoint, mjtObj

from ..arrays import Array
from ..errors import InputError, UnknownName
from ..geometry import Box, Capsule, Hull, MassProperties, Shape, Sphere, pose, rotation_from_quaternion
from .hand import Actuator, Coupling
from .model_text import ModelText
from .placed import placed_shape

__all__ = ["ModelJoint", "ModelTree", "compile_model"]

_KINDS: dict[int, Literal["revolute", "prismatic"]] = {
    int(mjtJoint.mjJNT_HINGE): "revolute",
    int(mjtJoint.mjJNT_SLIDE): "prismatic",
}
# A cylinder becomes a prism of so many sides that touches it from within: 0.5 % of the radius at most.
_CYLINDER_SIDES = 32


@dataclass(frozen=True, eq=False)
class ModelJoint:
    """A joint of a model.

    Attributes:
        name: as in the model.
        kind: revolute (rad) or prismatic (m).
        axis: unit vector (3,) in the body's frame.
        anchor: a point (3,) of the axis in the body's frame, in m.
        zero: position at which the body stands as the model places it.
        limits: lower and upper, None where the model has none.
        servo: the model's own position actuator, None where it has none.
    """

    name: str
    kind: Literal["revolute", "prismatic"]
    axis: Array
    anchor: Array
    zero: float
    limits: tuple[float, float] | None
    servo: Actuator | None


def compile_model(text: ModelText, source: str) -> "ModelTree":
    """Compiles a model with MuJoCo.

    Raises:
        InputError: with what MuJoCo says is wrong.
    """
    try:
        spec = mujoco.MjSpec.from_string(text.xml, assets=text.meshes)
        spec.compiler.fusestatic = False
        # Published inertias are often rounded so that no body could have them.
        spec.compiler.balanceinertia = True
        return ModelTree(spec.compile(), source)
    except (ValueError, RuntimeError, mujoco.FatalError) as error:
        raise InputError(source, "import", f"MuJoCo can't compile the model: {error}") from None


class ModelTree:
    """The bodies of a compiled model by number; body 0 is the world."""

    def __init__(self, model: mujoco.MjModel, source: str):
        self._model = model
        self._source = source
        self.n_bodies = int(model.nbody)
        self.parents = [int(parent) for parent in model.body_parentid]
        self.body_names = [self._name(mjtObj.mjOBJ_BODY, i, "body") for i in range(model.nbody)]
        self.joint_names = [self._name(mjtObj.mjOBJ_JOINT, i, "joint") for i in range(model.njnt)]

    def _name(self, kind: mjtObj, i: int, what: str) -> str:
        return mujoco.mj_id2name(self._model, kind, i) or f"{what}_{i}"

    def palm(self, name: str | None) -> int:
        """Number of the body called `name`, or of the only one that stands on the world.

        Raises:
            InputError: no such body, or several to choose from.
        """
        if name is not None:
            if name not in self.body_names[1:]:
                raise UnknownName(self._source, "palm", "body", name, self.body_names[1:])
            return self.body_names.index(name)
        roots = [i for i in range(1, self.n_bodies) if self.parents[i] == 0]
        if len(roots) != 1:
            raise InputError(self._source, "palm", "is required: several bodies stand on the world, or none")
        return roots[0]

    def carried(self, palm: int) -> list[int]:
        """The palm and all bodies that it carries, parents first."""
        kept = [palm]
        for i in range(palm + 1, self.n_bodies):  # MuJoCo numbers parents first, a finger's bodies in a row
            if self.parents[i] in kept:
                kept.append(i)
        return kept

    def T_parent_body(self, body: int) -> Array:
        """Pose (4, 4) of a body in its parent with all joints at their zero."""
        return _pose(self._model.body_pos[body], self._model.body_quat[body])

    def joints(self, body: int) -> list[ModelJoint]:
        """Joints of a body, the one next to the parent first.

        Raises:
            InputError: a joint that is neither hinge nor slide.
        """
        first, count = int(self._model.body_jntadr[body]), int(self._model.body_jntnum[body])
        return [self._joint(j) for j in range(first, first + count)]

    def _joint(self, j: int) -> ModelJoint:
        m, name = self._model, self.joint_names[j]
        kind = int(m.jnt_type[j])
        if kind not in _KINDS:
            word = "ball" if kind == int(mjtJoint.mjJNT_BALL) else "free"
            raise InputError(
                self._source,
                f"import: joint {name}",
                f"is a {word} joint; only hinges and slides can be imported",
            )
        limits = tuple(m.jnt_range[j].tolist()) if m.jnt_limited[j] else None
        effort = float(np.abs(m.jnt_actfrcrange[j]).min()) if m.jnt_actfrclimited[j] else None
        return ModelJoint(
            name,
            _KINDS[kind],
            np.array(m.jnt_axis[j]),
            np.array(m.jnt_pos[j]),
            float(m.qpos0[m.jnt_qposadr[j]]),
            limits,
            self._servo(j, effort),
        )

    def _servo(self, j: int, joint_effort: float | None) -> Actuator | None:
        """The position actuator of joint j, where the model has one with a limit of its effort."""
        m, dof = self._model, int(self._model.jnt_dofadr[j])
        for a in np.flatnonzero(m.actuator_trnid[:, 0] == j):
            kp, bias = float(m.actuator_gainprm[a, 0]), m.actuator_biasprm[a]
            on_joint = m.actuator_trntype[a] == mujoco.mjtTrn.mjTRN_JOINT
            limited = float(np.abs(m.actuator_forcerange[a]).min()) if m.actuator_forcelimited[a] else None
            effort = limited or joint_effort
            if on_joint and kp > 0.0 and bias[1] == -kp and effort:
                damping = float(m.dof_damping.ravel()[dof] - bias[2])
                if damping > 0.0:
                    return Actuator(effort, kp, damping, float(m.dof_armature[dof]))
        return None

    def couplings(self, kept: set[int]) -> dict[str, Coupling]:
        """Couplings by the name of the joint that follows, among the bodies `kept`.

        Raises:
            InputError: a constraint that closes a loop, or a coupling that is no straight line.
        """
        out: dict[str, Coupling] = {}
        for e in range(self._model.neq):
            if not self._model.eq_active0[e] or not self._touches(e, kept):
                continue
            field = f"import: equality {e}"
            if self._model.eq_type[e] != mjtEq.mjEQ_JOINT:
                raise InputError(
                    self._source,
                    field,
                    "closes a loop (connect, weld, tendon); only couplings of joints are known",
                )
            follower, master = int(self._model.eq_obj1id[e]), int(self._model.eq_obj2id[e])
            coefficients = self._model.eq_data[e, :5]
            if master < 0 or np.any(coefficients[2:] != 0.0) or coefficients[1] == 0.0:
                raise InputError(
                    self._source, field, "couples joints by something else than offset + ratio * position"
                )
            zero, zero_master = (
                float(self._model.qpos0[self._model.jnt_qposadr[j]]) for j in (follower, master)
            )
            ratio = float(coefficients[1])
            offset = float(coefficients[0]) + zero - ratio * zero_master
            out[self.joint_names[follower]] = Coupling(self.joint_names[master], ratio, offset)
        return out

    def _touches(self, e: int, kept: set[int]) -> bool:
        """Whether equality e concerns a body that is kept; what can't be told does."""
        m = self._model
        ids = [int(m.eq_obj1id[e]), int(m.eq_obj2id[e])]
        match m.eq_type[e]:
            case mjtEq.mjEQ_JOINT:
                bodies = [int(m.jnt_bodyid[j]) for j in ids if j >= 0]
            case mjtEq.mjEQ_CONNECT | mjtEq.mjEQ_WELD:
                sites = m.eq_objtype[e] == mjtObj.mjOBJ_SITE
                bodies = [int(m.site_bodyid[i]) if sites else i for i in ids]
            case _:
                return True
        return any(body in kept for body in bodies)

    def inertia(self, body: int) -> MassProperties:
        """Mass properties of a body in its own frame."""
        m = self._model
        R = rotation_from_quaternion(m.body_iquat[body])
        return MassProperties(
            float(m.body_mass[body]), m.body_ipos[body], R @ np.diag(m.body_inertia[body]) @ R.T
        )

    def shapes(self, body: int) -> list[Shape]:
        """The geoms of a body that collide, in its own frame.

        Raises:
            InputError: a kind of geom that is no convex body.
        """
        m = self._model
        first, count = int(m.body_geomadr[body]), int(m.body_geomnum[body])
        return [
            placed_shape(self._shape(g), _pose(m.geom_pos[g], m.geom_quat[g]))
            for g in range(first, first + count)
            if m.geom_contype[g] or m.geom_conaffinity[g]
        ]

    def _shape(self, g: int) -> Shape:
        size, kind = self._model.geom_size[g], self._model.geom_type[g]
        end = np.array([0.0, 0.0, size[1]])
        match kind:
            case mjtGeom.mjGEOM_SPHERE:
                return Sphere(np.zeros(3), float(size[0]))
            case mjtGeom.mjGEOM_CAPSULE:
                return Capsule(-end, end, float(size[0]))
            case mjtGeom.mjGEOM_BOX:
                return Box(np.eye(4), np.array(size))
            case mjtGeom.mjGEOM_CYLINDER:
                return Hull.from_points(
                    trimesh.creation.cylinder(size[0], 2.0 * size[1], sections=_CYLINDER_SIDES).vertices
                )
            case mjtGeom.mjGEOM_ELLIPSOID:
                return Hull.from_points(trimesh.creation.icosphere(subdivisions=3).vertices * size)
            case mjtGeom.mjGEOM_MESH:
                mesh = int(self._model.geom_dataid[g])
                start, count = int(self._model.mesh_vertadr[mesh]), int(self._model.mesh_vertnum[mesh])
                return Hull.from_points(self._model.mesh_vert[start : start + count])
        body = self.body_names[int(self._model.geom_bodyid[g])]
        raise InputError(
            self._source,
            f"import: body {body}",
            "has a plane, height field or signed distance field that collides",
        )


def _pose(position: Array, quaternion: Array) -> Array:
    return pose(rotation_from_quaternion(np.array(quaternion)), np.array(position))
