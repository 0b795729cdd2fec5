"""Grasps of run folders as scenes that no engine's own format stands in: plain numbers, for JSON.

Nothing of the MuJoCo models is used: the hand, the object and the test come from the task that a grasp file
names, the rest from the file itself. Lengths in m, angles in rad, masses in kg, forces in N; poses in the
palm frame.
"""

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from holdfast.errors import InputError
from holdfast.geometry import (
    Box,
    Capsule,
    MassProperties,
    Shape,
    Sphere,
    combined_mass,
    pose,
    rotation_from_quaternion,
)
from holdfast.hands import Hand, Link
from holdfast.mjcf import HoldSettings
from holdfast.objects import LiftTest, PressTest, Task, TurnTest
from holdfast.pipeline.records import GraspFile, fingerprint, load_grasp_task, read_grasp, read_run
from holdfast.retraction import overlapping_links

Scene = dict[str, Any]


def scenes_of(folder: Path) -> list[Scene]:
    """The scenes of all grasps of a run folder that came to a test, best first."""
    paths = [folder / "grasps" / f"{grasp.id}.json" for grasp in read_run(folder / "run.json").grasps]
    scenes = (scene_of(path) for path in paths if path.exists())
    return [scene for scene in scenes if scene is not None]


def scene_of(path: Path) -> Scene | None:
    """The scene of a grasp file; None where it was not simulated.

    Raises:
        InputError: a file that can't be used, or whose task has changed since.
    """
    grasp = read_grasp(path)
    hold = grasp.hold
    if hold is None or hold.squeeze is None or not hold.directions or grasp.approach is None:
        return None
    task = load_grasp_task(grasp, path)
    if grasp.task_fingerprint and grasp.task_fingerprint != fingerprint(task):
        raise InputError(path, "task_fingerprint", f"task {task.name} has changed since")
    names = task.hand.independent_names
    squeeze = hold.squeeze
    settings = settings_of(hold.settings)
    R = rotation_from_quaternion(np.array(grasp.object.quaternion))
    T_palm_object = pose(R, np.array(grasp.object.position))
    return {
        "name": f"{path.parent.parent.name}/{grasp.id}",
        "task": task.name,
        "kind": hold.kind,
        "held": hold.held,
        "narrow": grasp.is_narrow,
        "near_miss": grasp.is_near_miss,
        "ours": _reason(grasp),
        "rule": squeeze.rule,
        "measures": measures_of(grasp),
        "modulus": task.hand.pad.modulus_Pa,
        **_hand(task.hand),
        **_object(task, settings),
        **_test(task, settings),
        "T_palm_object": T_palm_object.tolist(),
        "q": [grasp.joints[name] for name in names],
        "waypoints": [[place[name] for name in names] for place in grasp.approach.waypoints],
        "targets": [squeeze.targets[name] for name in names],
        "efforts": [squeeze.efforts[name] for name in names],
        "path": [[place[name] for name in names] for place in squeeze.path],
        "contacts": [
            {
                "link": contact.hand.link,
                "point": list(record.point),
                "normal": list(record.normal),
                "normal_force": force,
            }
            for contact, record, force in zip(
                task.contacts, grasp.contacts, squeeze.normal_forces, strict=True
            )
        ],
        "watched": _watched(task, grasp, T_palm_object, settings),
    }


def settings_of(written: dict[str, Any]) -> HoldSettings:
    """The settings as a file has them; what it doesn't name is as in the defaults."""
    known = {field.name for field in fields(HoldSettings)}
    values = {name: value for name, value in written.items() if name in known}
    for name, value in values.items():
        if isinstance(value, list):
            values[name] = tuple(
                tuple(entry) if isinstance(entry, (list, tuple)) else entry for entry in value
            )
    return HoldSettings(**values)


def _reason(grasp: GraspFile) -> str:
    hold = grasp.hold
    assert hold is not None
    if hold.held:
        return "held"
    return next((entry.outcome for entry in hold.directions if not entry.held), "moved in the squeeze")


def measures_of(grasp: GraspFile) -> dict[str, float | None]:
    """What a file records that may tell how surely a grasp holds: the more, the surer; None if unknown."""
    hold = grasp.hold
    assert hold is not None and hold.squeeze is not None
    squeeze, settings = hold.squeeze, settings_of(hold.settings)
    turn_limit_rad = settings.rotation_limit_rad or np.inf
    first = [
        np.inf
        if finger.slip is None or finger.rotation is None
        else max(finger.slip / settings.slip_limit_m, finger.rotation / turn_limit_rad)
        for finger in hold.fingers
    ]
    moved = None
    if squeeze.slip is not None:
        moved = max(squeeze.slip / settings.slip_limit_m, (squeeze.rotation or 0.0) / turn_limit_rad)
    spin = hold.less_spin
    spun = None
    if spin is not None:
        spun = max((spin.slip or 0.0) / settings.slip_limit_m, (spin.rotation or 0.0) / turn_limit_rad)
    worst = None
    if hold.held and first and spun is not None and squeeze.slip is not None:
        worst = max(*first, spun, squeeze.slip / settings.firm_limit_m)
    planned, found = np.array(squeeze.normal_forces), np.array(squeeze.simulated_forces)
    reached = None
    if len(found) == len(planned) and (planned > 0.0).any():
        reached = float((found[planned > 0.0] / planned[planned > 0.0]).min())
    forces = np.array(squeeze.contact_forces)
    leaning = None
    if len(forces) and (forces[:, 0] > 0.0).any():
        pressed = forces[forces[:, 0] > 0.0]
        leaning = float((np.hypot(pressed[:, 1], pressed[:, 2]) / pressed[:, 0]).max())
    return {
        "margin": hold.margin,
        "least squeeze": _negative(squeeze.least),
        "worst finger first": _negative(max(first) if first and max(first) < np.inf else None),
        "moved by squeeze": _negative(moved),
        "with less spin": _negative(spun),
        "worst of these": _negative(worst),
        "strain": _negative(hold.strain),
        "weakest contact": float(found.min()) if len(found) else None,
        "load factor": squeeze.load_factor,
        "force reached": reached,
        "use of friction": _negative(leaning),
        "sum of forces": _negative(float(planned.sum()) if len(planned) else None),
    }


def _negative(value: float | None) -> float | None:
    return None if value is None else -value


def _hand(hand: Hand) -> Scene:
    parents = {(link.parent, k) for k, link in enumerate(hand.links) if link.parent >= 0}
    apart = parents | set(overlapping_links(hand))
    return {
        "links": [_link(link) for link in hand.links],
        "coupling_matrix": hand.coupling_matrix.tolist(),
        "coupling_offset": hand.coupling_offset.tolist(),
        "not_touching": sorted([int(a), int(b)] for a, b in apart),
    }


def _link(link: Link) -> Scene:
    axes = []
    for axis in link.axes:
        servo, coupling = axis.actuator, axis.coupling
        axes.append(
            {
                "name": axis.name,
                "kind": axis.kind,
                "direction": axis.direction.tolist(),
                "lower": axis.lower,
                "upper": axis.upper,
                "actuator": None if servo is None else dict(vars(servo)),
                "coupling": None if coupling is None else dict(vars(coupling)),
            }
        )
    return {
        "name": link.name,
        "parent": link.parent,
        "T_parent": link.T_parent_link0.tolist(),
        "axes": axes,
        "shapes": [_shape(shape) for shape in link.shapes],
        "mass": _mass(link.inertia),
    }


def _shape(shape: Shape) -> Scene:
    match shape:
        case Sphere():
            return {"kind": "sphere", "centre": shape.centre.tolist(), "radius": float(shape.radius)}
        case Capsule():
            ends = {"start": shape.start.tolist(), "end": shape.end.tolist()}
            return {"kind": "capsule", **ends, "radius": float(shape.radius)}
        case Box():
            return {
                "kind": "box",
                "half_extents": shape.half_extents.tolist(),
                "T": shape.T_link_box.tolist(),
            }
        case _:
            return {"kind": "hull", "vertices": shape.vertices.tolist()}


def _mass(inertia: MassProperties, scale: float = 1.0) -> Scene:
    return {
        "mass": scale * inertia.mass,
        "centre": inertia.centre.tolist(),
        "inertia": (scale * inertia.inertia).tolist(),
    }


def _object(task: Task, settings: HoldSettings) -> Scene:
    parts = task.carried or task.object.parts
    inertia = (
        task.object.inertia
        if len(parts) == len(task.object.parts)
        else combined_mass(part.inertia for part in parts)
    )
    scale = 1.0 if settings.object_mass_kg is None else settings.object_mass_kg / inertia.mass
    return {
        "object": {
            "mass": _mass(inertia, scale),
            "shapes": [_shape(piece) for part in parts for piece in part.pieces],
        },
        "stand": [_shape(piece) for part in task.obstacles for piece in part.pieces] if task.carried else [],
        "friction": settings.sliding_friction(task.object),
    }


def _test(task: Task, settings: HoldSettings) -> Scene:
    scene: Scene = {
        "gravity": settings.gravity,
        "directions": [list(direction) for direction in settings.directions],
        "resting": list(settings.resting_direction),
        "hand_weight": settings.hand_weight,
        "must_touch": settings.must_touch,
        "slip_limit": settings.slip_limit_m,
        "rotation_limit": settings.rotation_limit_rad,
        "times": {
            name: getattr(settings, f"{name}_s")
            for name in ("close", "squeeze", "settle", "hold", "turn", "sample")
        },
    }
    match task.test:
        case TurnTest() as test:
            scene["hinge"] = {
                "point": list(test.hinge_point),
                "axis": list(test.hinge_axis),
                "friction": test.friction_torque_Nm,
                "angle": test.angle_rad,
            }
        case PressTest() as test:
            scene["press"] = {"contacts": list(test.contacts), "force": test.force_N}
        case LiftTest():
            pass
    return scene


def _watched(task: Task, grasp: GraspFile, T_palm_object, settings: HoldSettings) -> list[list[float]]:
    """Points in the object's frame whose displacement is the slip."""
    if settings.slip_of == "centre":
        return [_object(task, settings)["object"]["mass"]["centre"]]
    R, p = T_palm_object[:3, :3], T_palm_object[:3, 3]
    return [(R.T @ (np.array(contact.point) - p)).tolist() for contact in grasp.contacts]
