"""A task as plain data, for a checker that knows nothing of tasks."""

from typing import Any

import numpy as np

from ..geometry import Cap, Patch, Region
from ..hands import FLATTEST_PER_M, SHARPEST_PER_M
from ..mjcf import HoldSettings
from ..mjcf.model import payload
from ..mjcf.squeeze import TURN_SHARE, USUAL_N
from ..objects import LiftTest, PressTest, Task, TurnTest
from ..retraction import collision_model

__all__ = ["grasp_form"]

_LIMIT_ROOM = 1e-6


def grasp_form(task: Task) -> dict[str, Any]:
    """Hand, contacts, object, test and convex pieces, as `holdfast.check_proof.check_grasp` takes them."""
    hand, model = task.hand, collision_model(task)
    carried = payload(task, HoldSettings())
    links = [body.link for body in model.bodies.bodies]
    return {
        "links": [
            {
                "parent": link.parent,
                "rotation": link.T_parent_link0[:3, :3].tolist(),
                "position": link.T_parent_link0[:3, 3].tolist(),
                "slides": [axis.kind == "prismatic" for axis in link.axes],
            }
            for link in hand.links
        ],
        "directions": hand.tree.directions.tolist(),
        "drives": [
            (int(np.flatnonzero(row)[0]), float(row[np.flatnonzero(row)[0]]), float(offset))
            for row, offset in zip(hand.coupling_matrix, hand.coupling_offset, strict=True)
        ],
        "joint_reach": [max(abs(axis.lower), abs(axis.upper)) + _LIMIT_ROOM for axis in hand.axes],
        "names": list(hand.independent_names),
        "limits": task.limits.tolist(),
        "effort": [
            np.inf if servo is None else servo.effort
            for servo in (hand.axes[i].actuator for i in hand.independent)
        ],
        "contacts": [
            {
                "link": contact.hand.link,
                "hand": _region(contact.hand.region),
                "object": _region(contact.object.region),
                "least_cosine": float(np.cos(contact.align_within_rad)),
            }
            for contact in task.contacts
        ],
        "pose": None
        if task.T_palm_object is None
        else (task.T_palm_object[:3, :3].tolist(), task.T_palm_object[:3, 3].tolist()),
        "test": _test(task),
        "mass": carried.inertia.mass,
        "centre": carried.inertia.centre.tolist(),
        "friction": task.object.friction,
        "most": task.max_normal_force_N,
        "pad": {
            "modulus": hand.pad.modulus_Pa,
            "thickness": hand.pad.thickness_m,
            "flattest": FLATTEST_PER_M,
            "sharpest": SHARPEST_PER_M,
            "usual_force": USUAL_N,
            "turn_share": TURN_SHARE,
        },
        "pieces": [
            {
                "link": -1 if links[body] is None else links[body],
                "core": piece.core.tolist(),
                "radius": piece.radius,
            }
            for piece, body in zip(model.bodies.pieces, model.bodies.piece_body.tolist(), strict=True)
        ],
        "pairs": model.piece_pairs.tolist(),
        "intended": model.intended.tolist(),
        "stands_out": model.stands_out_m.tolist(),
    }


def _region(region: Region) -> dict[str, Any]:
    if isinstance(region, Patch):
        return {"kind": "patch", "net": region.patch.control_points.tolist()}
    if isinstance(region, Cap):
        return {
            "kind": "cap",
            "radius": region.radius,
            "point": region.centre.tolist(),
            "normal": region.axis.tolist(),
            "least_cosine": float(np.cos(region.half_angle_rad)),
        }
    return {
        "kind": "point",
        "radius": 0.0,
        "point": region.point.tolist(),
        "normal": region.normal.tolist(),
        "least_cosine": -1.0,
    }


def _test(task: Task) -> dict[str, Any]:
    match task.test:
        case LiftTest():
            return {"kind": "lift"}
        case TurnTest():
            return {
                "kind": "turn",
                "point": list(task.test.hinge_point),
                "axis": list(task.test.hinge_axis),
                "friction_torque": task.test.friction_torque_Nm,
            }
        case PressTest():
            return {"kind": "press", "contacts": list(task.test.contacts), "force": task.test.force_N}
