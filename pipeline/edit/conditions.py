"""What a task asks besides its contacts, as fields of its file: limits, the kind of test, and the support."""

from typing import Any

import numpy as np
import trimesh

from ...geometry import PointRegion
from ...objects import SIX, LiftTest, ObjectModel, PhysicalTest, PressTest, TurnTest, sphere

__all__ = ["SIDES", "fields_of_test", "limit_fields", "support_fields", "support_on", "turn_about"]

SIDES = ("-z", "+z", "-y", "+y", "-x", "+x")
"""Sides of an object, in its own frame, that it may stand on, and axes that it may turn about."""


def support_on(mesh: trimesh.Trimesh, side: str) -> PointRegion:
    """The plane on which an object stands with one of `SIDES` down."""
    axis, sign = "xyz".index(side[1]), 1.0 if side[0] == "+" else -1.0
    point, up = np.array(mesh.bounds.mean(axis=0)), np.zeros(3)
    point[axis] = mesh.bounds[1 if sign > 0.0 else 0, axis]
    up[axis] = -sign
    return PointRegion(point, up)


def turn_about(obj: ObjectModel, axis: str, friction_torque_Nm: float, angle_deg: float) -> TurnTest:
    """The test that turns all of an object about one of `SIDES`, through its centre of mass."""
    direction = [0.0, 0.0, 0.0]
    direction["xyz".index(axis[1])] = 1.0 if axis[0] == "+" else -1.0
    x, y, z = (float(round(value, 9)) for value in obj.inertia.centre)
    dx, dy, dz = direction
    parts = tuple(part.name for part in obj.parts)
    return TurnTest(parts, (x, y, z), (dx, dy, dz), friction_torque_Nm, float(np.deg2rad(angle_deg)))


def support_fields(support: PointRegion) -> dict[str, list[float]]:
    """The field `support` of a task file."""
    return {"point": support.point.tolist(), "normal": support.normal.tolist()}


def limit_fields(names: tuple[str, ...], limits: np.ndarray, own: np.ndarray) -> dict[str, list[float]]:
    """The field `joint_limits` of a task file: joints whose limits are not the hand's own."""
    return {
        name: ends.tolist()
        for name, ends, usual in zip(names, limits, own, strict=True)
        if not np.array_equal(ends, usual)
    }


def fields_of_test(test: PhysicalTest) -> dict[str, Any]:
    """The field `test` of a task file."""
    match test:
        case LiftTest():
            named = {SIX: "six", sphere(): "sphere"}
            gravity = named.get(test.directions) or [list(direction) for direction in test.directions]
            parts = {"parts": list(test.parts)} if test.parts else {}
            return {"kind": "lift", **parts, "gravity": gravity}
        case PressTest():
            return {"kind": "press", "force": test.force_N, "contacts": list(test.contacts)}
        case TurnTest():
            return {
                "kind": "turn",
                "parts": list(test.parts),
                "hinge": {"point": list(test.hinge_point), "axis": list(test.hinge_axis)},
                "friction_torque": test.friction_torque_Nm,
                "angle_deg": float(np.rad2deg(test.angle_rad)),
            }
