"""Grasps as a USD scene: the object at rest and the hand around it, a time code a grasp."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import trimesh

from ...base.numeric.arrays import Array
from ...errors import MissingBackend
from ...geometry import invert, shape_mesh
from ...hands import forward_kinematics
from ...objects import Task
from ..records import GraspRecord, to_state

__all__ = ["usd_text"]


def usd_text(grasps: Sequence[tuple[GraspRecord, Task]], source: str) -> str:
    """The text of a .usda stage in m, z up, whose world is the object's frame.

    `/World/object` is the object's mesh and `/World/hand/<link>` the links with theirs, posed at time code i
    as in grasp i; nothing is between grasps. `/World/hand` has attributes `grasp` (its name) and
    `joint:<name>` (rad or m) with the same time codes. Characters that USD allows in no name become `_`.

    Args:
        grasps: at least one, each with its task; hand and object are the same in all.
        source: the file that they come from, for messages.

    Raises:
        InputError: a record is no grasp of its task.
        MissingBackend: the package usd-core is not installed.
    """
    try:
        from pxr import Sdf, Tf, Usd, UsdGeom
    except ImportError:
        raise MissingBackend("writing USD needs the package usd-core: pip install 'holdfast[usd]'") from None
    task = grasps[0][1]
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    stage.SetStartTimeCode(0.0)
    stage.SetEndTimeCode(len(grasps) - 1.0)
    stage.SetTimeCodesPerSecond(1.0)
    stage.SetInterpolationType(Usd.InterpolationTypeHeld)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/World").GetPrim())
    _add_mesh(stage, "/World/object", task.object.mesh)
    hand = UsdGeom.Xform.Define(stage, "/World/hand").GetPrim()
    places = []
    for k, link in enumerate(task.hand.links):
        # The number keeps names apart that USD can't tell.
        path = f"/World/hand/link_{k}_{Tf.MakeValidIdentifier(link.name)}"
        places.append(UsdGeom.Xform.Define(stage, path).AddTransformOp())
        for i, shape in enumerate(link.shapes):
            _add_mesh(stage, f"{path}/shape_{i}", shape_mesh(shape))
    name = hand.CreateAttribute("grasp", Sdf.ValueTypeNames.String)
    joints = [
        hand.CreateAttribute(f"joint:{Tf.MakeValidIdentifier(joint)}", Sdf.ValueTypeNames.Double)
        for joint in task.hand.joint_names
    ]
    for i, (record, own) in enumerate(grasps):
        state = to_state(record, own, source)
        q = own.hand.expand(state.q)
        name.Set(record.id, float(i))
        for attribute, position in zip(joints, q.tolist(), strict=True):
            attribute.Set(position, float(i))
        T_object_palm = invert(state.T_palm_object)
        for place, T in zip(places, forward_kinematics(own.hand, q), strict=True):
            place.Set(_matrix(T_object_palm @ T), float(i))
    text: str = stage.GetRootLayer().ExportToString()
    return text


def _matrix(T: Array) -> Any:
    """A transform as USD has it, whose vectors are rows."""
    from pxr import Gf

    return Gf.Matrix4d(*T.T.ravel().tolist())


def _add_mesh(stage: Any, path: str, mesh: trimesh.Trimesh) -> None:
    from pxr import UsdGeom, Vt

    prim = UsdGeom.Mesh.Define(stage, path)
    points = np.asarray(mesh.vertices, dtype=np.float32)
    prim.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
    prim.CreateFaceVertexCountsAttr([3] * len(mesh.faces))
    prim.CreateFaceVertexIndicesAttr(np.asarray(mesh.faces, dtype=int).ravel().tolist())
    prim.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    prim.CreateExtentAttr([points.min(axis=0).tolist(), points.max(axis=0).tolist()])
