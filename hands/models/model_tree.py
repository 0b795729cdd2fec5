"""What MuJoCo compiled, read as plain values: bodies, joints, couplings, servos and shapes of a hand."""

import re
import warnings
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal

import mujoco
import numpy as np
import trimesh
from mujoco import mjtGeom, mjtJoint, mjtObj

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...geometry import (
    Box,
    Capsule,
    Hull,
    MassProperties,
    Shape,
    Sphere,
    axis_rotation,
    mass_properties,
    pose,
    rotation_from_quaternion,
    transform_points,
)
from ..hand import Actuator
from ..placed import placed_shape
from .contacts import never_touching
from .couplings import ModelCouplings
from .linkages import closes_loop
from .sane import check_compiled
from .tendons import gear_on_joint
from .text import MissingMesh, ModelText, without_unknown

__all__ = ["IMPORTED_KINDS", "ModelJoint", "ModelTree", "compile_model"]

IMPORTED_KINDS: dict[int, Literal["revolute", "prismatic"]] = {
    int(mjtJoint.mjJNT_HINGE): "revolute",
    int(mjtJoint.mjJNT_SLIDE): "prismatic",
}
# Lower bounds that only serve to compile: what a body at the bound really weighs is found from its shapes.
_NO_MASS_KG = 1e-9
_NO_INERTIA = 1e-14
# Attributes that MuJoCo does not know: a file with more of them is of another program.
_MOST_UNKNOWN = 20
# What to do about ball joints of a model that has loops.
_WITHOUT_RODS = (
    ". Of rods that drive a finger import a copy of the model without them and the loops they close, where "
    "the finger hangs on hinges of its own and these have the motors"
)
# A jaw turns by so much at most, and most of that to one side: the share of its turn by which lower and upper
# limit differ.
_JAW_RAD, _JAW_ASKEW = 2.6, 0.5
# What a scene stands on.
_GROUND = (int(mjtGeom.mjGEOM_PLANE), int(mjtGeom.mjGEOM_HFIELD))
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
    told = list[str]()
    # MuJoCo's own handler would write a log into the current folder.
    usual = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(told.append)
    try:
        spec, unknown = _parsed(text)
        is_in_degrees = bool(spec.compiler.degree)
        spec.compiler.fusestatic = False
        # Published inertias are often rounded so that no body could have them.
        spec.compiler.balanceinertia = True
        # A body without mass is refused by MuJoCo where it moves; those at the bound are told apart below.
        spec.compiler.boundmass = max(spec.compiler.boundmass, _NO_MASS_KG)
        spec.compiler.boundinertia = max(spec.compiler.boundinertia, _NO_INERTIA)
        files = {mesh.name: mesh.file for mesh in spec.meshes}
        without = [geom for geom in spec.geoms if files.get(geom.meshname) in text.missing]
        for geom in without:
            geom.density = 0.0  # a stand-in weighs nothing, unless the model says what the geom weighs
        with warnings.catch_warnings():
            # About texture coordinates and the like; what matters is an error.
            warnings.simplefilter("ignore", UserWarning)
            model = spec.compile()
    except (ValueError, RuntimeError, mujoco.FatalError) as error:
        words = str(error)
        for plain, path in text.mesh_paths.items():
            words = re.sub(rf"\b{re.escape(Path(plain).stem)}\b(\.\w+)?", path.name, words)
        raise InputError(
            source, "import", f"MuJoCo can't compile the model: {' '.join(words.split())}"
        ) from None
    finally:
        mujoco.set_mju_user_warning(usual)
    check_compiled(model, source)
    remarks = (f"MuJoCo remarks: {' '.join(words.split())[:300]}" for words in told)
    missing = {int(geom.id): text.missing[files[geom.meshname]] for geom in without}
    left_out = [f"attributes that MuJoCo does not know, left out: {', '.join(unknown)}"] if unknown else []
    notes = (*text.notes, *left_out, *remarks)
    return ModelTree(model, source, text, missing, notes, is_in_degrees=is_in_degrees)


def _parsed(text: ModelText) -> tuple[mujoco.MjSpec, list[str]]:
    """The model as MuJoCo reads it, and the attributes that it does not know, which were left out."""
    xml, unknown = text.xml, list[str]()
    while True:
        try:
            return mujoco.MjSpec.from_string(xml, include=text.models, assets=text.meshes), unknown
        except ValueError as error:
            mended = without_unknown(xml, str(error)) if len(unknown) < _MOST_UNKNOWN else None
            if mended is None:
                raise
            xml = mended[0]
            unknown.append(mended[1])


class ModelTree:
    """The bodies of a compiled model by number; body 0 is the world.

    Attributes:
        notes: what was mended or left out so far, for people to read.
        is_in_degrees: whether its angles were read as degrees.
        says_angle: whether the model says in what unit they are.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        source: str,
        text: ModelText,
        missing: dict[int, MissingMesh],
        notes: tuple[str, ...],
        *,
        is_in_degrees: bool,
    ):
        self._model = model
        self._source = source
        self._stand_ins, self._locked = text.stand_ins, text.locked
        self._missing = missing
        self.notes = list(notes)
        self.is_in_degrees = is_in_degrees
        self.says_angle = text.says_angle
        self._drawn_only: frozenset[int] = frozenset()
        # Hulls take time, and several ask for the same.
        self._shapes: dict[int, list[tuple[Shape, trimesh.Trimesh | None]]] = {}
        self.n_bodies = int(model.nbody)
        self.parents = [int(parent) for parent in model.body_parentid]
        self.body_names = [self._name(mjtObj.mjOBJ_BODY, i, "body") for i in range(model.nbody)]
        self.joint_names = [self._name(mjtObj.mjOBJ_JOINT, i, "joint") for i in range(model.njnt)]

    def _name(self, kind: mjtObj, i: int, what: str) -> str:
        return mujoco.mj_id2name(self._model, kind, i) or f"{what}_{i}"

    def kinds(self, body: int) -> set[int]:
        """MuJoCo's kinds of the joints of a body, of which `IMPORTED_KINDS` can be imported."""
        first, count = int(self._model.body_jntadr[body]), int(self._model.body_jntnum[body])
        return {int(kind) for kind in self._model.jnt_type[first : first + count]}

    def travel_m(self, body: int) -> float:
        """How far the slides of a body move it, in m; those without limits not at all."""
        m = self._model
        own = [j for j in self._numbers(body) if m.jnt_type[j] == mjtJoint.mjJNT_SLIDE and m.jnt_limited[j]]
        return float(sum(m.jnt_range[j, 1] - m.jnt_range[j, 0] for j in own))

    def is_a_jaws(self, body: int) -> bool:
        """Whether a body's joint moves as that of a jaw: wrists turn further, or as far either way."""
        m = self._model
        for j in self._numbers(body):
            lower, upper = (float(end) for end in m.jnt_range[j])
            turn = upper - lower
            if m.jnt_type[j] != mjtJoint.mjJNT_HINGE or not m.jnt_limited[j] or not 0.0 < turn <= _JAW_RAD:
                return False
            if abs(lower + upper) < _JAW_ASKEW * turn:
                return False
        return True

    def carried(self, palm: int) -> list[int]:
        """The palm and all bodies that it carries, parents first; the world carries none that floats."""
        kept = [palm]
        for i in range(palm + 1, self.n_bodies):  # MuJoCo numbers parents first, a finger's bodies in a row
            if self.parents[i] in kept:
                if palm == 0 and int(mjtJoint.mjJNT_FREE) in self.kinds(i):
                    self.notes.append(f"{self.body_names[i]}: floats freely, and was left out")
                    continue
                kept.append(i)
        return kept

    def T_placed(self, body: int) -> Array:
        """Pose (4, 4) of a body in its parent as the model places it."""
        return _pose(self._model.body_pos[body], self._model.body_quat[body])

    def T_parent_body(self, body: int) -> Array:
        """Pose (4, 4) of a body in its parent with all joints at their zero.

        Joints that stand still in a linkage are where they stand, once the couplings were asked for.
        """
        T = self.T_placed(body)
        still = self.couplings.linkages.still
        for j in self._numbers(body):
            if j in still:
                T = T @ self._moved(self._joint(j), still[j])
        return T

    @property
    def turns_rad(self) -> list[float]:
        """How far the hinges of the model that have limits turn."""
        m = self._model
        hinges = np.flatnonzero((m.jnt_type == mjtJoint.mjJNT_HINGE) & (m.jnt_limited != 0))
        return [float(turn) for turn in np.ptp(m.jnt_range[hinges], axis=1)]

    def joints(self, body: int) -> list[ModelJoint]:
        """Joints of a body, the one next to the parent first.

        Those whose limits are equal are none, nor are those that stand still in a linkage, once the
        couplings were asked for.

        Raises:
            InputError: a joint that is neither hinge nor slide.
        """
        still = self.couplings.linkages.still
        return [self._joint(j) for j in self._numbers(body) if j not in still]

    def _numbers(self, body: int) -> range:
        first, count = int(self._model.body_jntadr[body]), int(self._model.body_jntnum[body])
        return range(first, first + count)

    @staticmethod
    def _moved(joint: ModelJoint, position: float) -> Array:
        """Pose (4, 4) of a body with a joint at a position, in itself with the joint at its zero."""
        way = position - joint.zero
        if joint.kind == "prismatic":
            return pose(np.eye(3), way * joint.axis)
        turn = axis_rotation(joint.axis, way)
        return pose(turn, joint.anchor - turn @ joint.anchor)

    def _joint(self, j: int) -> ModelJoint:
        m, name = self._model, self.joint_names[j]
        kind = int(m.jnt_type[j])
        if kind not in IMPORTED_KINDS:
            word = "ball" if kind == int(mjtJoint.mjJNT_BALL) else "free"
            loops = any(closes_loop(m, e) for e in range(m.neq))
            raise InputError(
                self._source,
                f"import: joint {name}",
                f"is a {word} joint; only hinges and slides can be imported"
                + (_WITHOUT_RODS if word == "ball" and loops else ""),
            )
        limits = tuple(m.jnt_range[j].tolist()) if m.jnt_limited[j] else None
        limits = self.couplings.linkages.limits.get(j, limits)
        effort = float(np.abs(m.jnt_actfrcrange[j]).min()) if m.jnt_actfrclimited[j] else None
        return ModelJoint(
            name,
            IMPORTED_KINDS[kind],
            np.array(m.jnt_axis[j]),
            np.array(m.jnt_pos[j]),
            float(m.qpos0[m.jnt_qposadr[j]]),
            limits,
            self._servo(j, effort),
        )

    def _servo(self, j: int, joint_effort: float | None) -> Actuator | None:
        """The position actuator of joint j, where the model has one with a limit of its effort.

        An actuator acts through its gear, and a tendon with one joint through the joint's coefficient too:
        what it pushes is gear * force, and it sees gear * position. The tightest limit counts.
        """
        m, dof = self._model, int(self._model.jnt_dofadr[j])
        for a in range(m.nu):
            gear = abs(gear_on_joint(m, a, j))
            kp, bias = float(m.actuator_gainprm[a, 0]), m.actuator_biasprm[a]
            if not gear or kp <= 0.0 or bias[1] != -kp:
                continue
            limits = [joint_effort] if joint_effort is not None else []
            if m.actuator_forcelimited[a]:
                limits.append(gear * float(np.abs(m.actuator_forcerange[a]).min()))
            damping = float(m.dof_damping.ravel()[dof] - gear**2 * bias[2])
            if limits and min(limits) > 0.0 and damping > 0.0:
                return Actuator(min(limits), gear**2 * kp, damping, float(m.dof_armature[dof]))
        return None

    @cached_property
    def efforts(self) -> dict[str, float]:
        """Limits of the joints' own effort by name, where the model has one."""
        m = self._model
        return {
            name: float(np.abs(m.jnt_actfrcrange[j]).min())
            for j, name in enumerate(self.joint_names)
            if m.jnt_actfrclimited[j]
        }

    @cached_property
    def couplings(self) -> ModelCouplings:
        """How the model couples joints, and which of them stand still."""
        found = ModelCouplings(self._model, self._source, self.joint_names)
        for name, position in self._locked.items():
            found.linkages.still[self.joint_names.index(name)] = position
        return found

    def never_touching(self, kept: list[int]) -> list[tuple[int, int]]:
        """Pairs of the bodies `kept` that the model keeps from touching by excludes or by bits."""
        return never_touching(self._model, {body: self._colliding(body) for body in kept})

    def inertia(self, body: int) -> MassProperties:
        """Mass properties of a body in its own frame; without mass where the model has none."""
        m = self._model
        if m.body_mass[body] <= 2.0 * _NO_MASS_KG:
            return MassProperties(0.0, np.zeros(3), np.zeros((3, 3)))
        if self.body_names[body] in self._stand_ins and (shapes := self.shapes(body)):
            even = mass_properties(shapes, float(m.body_mass[body]))
            return MassProperties(even.mass, np.array(m.body_ipos[body]), even.inertia)
        R = rotation_from_quaternion(m.body_iquat[body])
        return MassProperties(
            float(m.body_mass[body]), m.body_ipos[body], R @ np.diag(m.body_inertia[body]) @ R.T
        )

    def shapes(self, body: int) -> list[Shape]:
        """The geoms of a body that collide, in its own frame.

        Raises:
            InputError: a kind of geom that is no convex body.
        """
        return [shape for shape, _ in self._shapes_and_meshes(body)]

    def meshes(self, body: int) -> list[trimesh.Trimesh | None]:
        """The surface of each of a body's shapes that is the hull of a mesh, in its frame; None of others."""
        return [mesh for _, mesh in self._shapes_and_meshes(body)]

    def _shapes_and_meshes(self, body: int) -> list[tuple[Shape, trimesh.Trimesh | None]]:
        if body not in self._shapes:
            self._shapes[body] = [self._placed(g) for g in self._colliding(body) if not self._is_flat(g)]
        return self._shapes[body]

    def _placed(self, g: int) -> tuple[Shape, trimesh.Trimesh | None]:
        """The shape of a geom in its body's frame, and the mesh whose hull it is."""
        m = self._model
        T = _pose(m.geom_pos[g], m.geom_quat[g])
        shape = placed_shape(self._shape(g), T)
        if m.geom_type[g] != mjtGeom.mjGEOM_MESH:
            return shape, None
        mesh = int(m.geom_dataid[g])
        start, count = int(m.mesh_faceadr[mesh]), int(m.mesh_facenum[mesh])
        faces = np.array(m.mesh_face[start : start + count], dtype=np.int64)
        if len(np.unique(faces)) < int(m.mesh_vertnum[mesh]):  # faces were left out, and the hull has all
            return shape, None
        return shape, trimesh.Trimesh(transform_points(T, self._vertices(g)), faces, process=False)

    def _is_flat(self, g: int) -> bool:
        """Whether a geom is a mesh that lies in a plane, as drawn labels do: it has no hull."""
        if self._model.geom_type[g] != mjtGeom.mjGEOM_MESH:
            return False
        points = self._vertices(g)
        spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        return bool(spread[-1] <= 1e-6 * spread[0])

    def _vertices(self, g: int) -> Array:
        """Vertices (n, 3) of a geom that is a mesh."""
        mesh = int(self._model.geom_dataid[g])
        start, count = int(self._model.mesh_vertadr[mesh]), int(self._model.mesh_vertnum[mesh])
        return np.asarray(self._model.mesh_vert[start : start + count], dtype=float)

    def _geoms(self, body: int) -> range:
        first, count = int(self._model.body_geomadr[body]), int(self._model.body_geomnum[body])
        return range(first, first + count)

    def _colliding(self, body: int) -> list[int]:
        """The geoms of a body that collide, or all where none of the hand does; a floor is left out."""
        m = self._model
        geoms = list(self._geoms(body))
        if body == 0:
            geoms = [g for g in geoms if int(m.geom_type[g]) not in _GROUND]
        if body in self._drawn_only:
            return geoms
        return [g for g in geoms if m.geom_contype[g] or m.geom_conaffinity[g] or g in self._in_pairs]

    @cached_property
    def _in_pairs(self) -> set[int]:
        """Geoms that collide by an explicit pair."""
        return {int(g) for g in (*self._model.pair_geom1, *self._model.pair_geom2)}

    def check_meshes(self, kept: list[int]) -> None:
        """Refuses missing meshes of the bodies `kept` that collide; of others they are told.

        Raises:
            InputError: with the first of the meshes, and which others are missing.
        """
        needed = {
            mesh.name: mesh.why
            for body in kept
            for g in self._colliding(body)
            if (mesh := self._missing.get(g))
        }
        if needed:
            why, others = next(iter(needed.values())), ", ".join(list(needed)[1:])[:300]
            raise InputError(
                why.source, why.field, why.allowed + (f"; missing too: {others}" if others else "")
            )
        if self._missing:
            names = ", ".join(dict.fromkeys(mesh.name for mesh in self._missing.values()))[:300]
            self.notes.append(f"the hand does without meshes that can't be had: {names}")

    def collide_as_drawn(self, kept: list[int]) -> bool:
        """Lets the bodies `kept` collide by what they draw, where none has a geom that collides.

        Returns:
            Whether any of them collides now.
        """
        if not any(self._colliding(body) for body in kept) and any(self._geoms(body) for body in kept):
            self._drawn_only = frozenset(kept)
            self._shapes.clear()
            self.notes.append("no geom of the model collides: what it draws collides, as convex hulls")
        return any(self._colliding(body) for body in kept)

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
                return Hull.from_points(self._vertices(g))
        body = self.body_names[int(self._model.geom_bodyid[g])]
        raise InputError(
            self._source,
            f"import: body {body}",
            "has a plane, height field or signed distance field that collides",
        )


def _pose(position: Array, quaternion: Array) -> Array:
    return pose(rotation_from_quaternion(np.array(quaternion)), np.array(position))
