"""What the page's 3D view is made from: one GLB of hand and object, and numbers that pose it."""

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...geometry import invert, perpendicular, rotation_from_quaternion, transform_points
from ...hands import forward_kinematics
from ...mjcf import HoldSettings
from ...mjcf.hand_folder import open_posture
from ...mjcf.hold import outcome_word
from ...mjcf.scene import SceneNode, task_glb, task_nodes
from ...objects import Task
from ...retraction import collision_model, compute_clearance, measure
from ...solver import State
from ..records import Direction, GraspRecord, RunRecord, to_approach, to_state
from .motions import recorded_trials

__all__ = ["APART", "deep_pairs", "scene_data", "scene_text"]

APART = "apart"
"""Name under which a run without grasps shows hand and object beside each other."""

# Digits behind the point of what is drawn: 10 um and 10 urad.
_DIGITS = 5
# Between the open hand and the object beside it.
_ROOM_M = 0.03
# Overlaps of two bodies that are shown, the deepest; the viewer's `MOST_SPOTS` has room for two pairs.
_MOST_PLACES = 4


def scene_data(task: Task, record: RunRecord, source: Path) -> dict[str, Any]:
    """The scene as plain data.

    Args:
        task: of the run.
        record: of the run; grasps that are none of the task's have no scene.
        source: where the record lies, for messages.
    """
    nodes = list(task_nodes(task))
    grasps = [_grasp(grasp, task, record, source) for grasp in record.grasps]
    if not record.grasps:
        grasps.append(_apart(task, nodes))
    data = base64.b64encode(task_glb(nodes)).decode()
    return {
        "glb": f"data:model/gltf-binary;base64,{data}",
        "nodes": {node.name: _node(node) for node in nodes},
        "links": _links(task),
        "friction": _friction(task, record),
        "grasps": [entry for entry in grasps if entry is not None],
    }


def scene_text(data: dict[str, Any]) -> str:
    """The scene as JSON for a data block of a page: nothing in it can end the block."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _node(node: SceneNode) -> dict[str, Any]:
    return {"kind": node.kind, "link": node.link, "moves": node.moves}


def _links(task: Task) -> list[dict[str, Any]]:
    """The kinematic tree: pose in the parent (rows of 4 x 4), and axes."""
    return [
        {
            "name": link.name,
            "parent": link.parent,
            "T": np.round(link.T_parent_link0, 7).ravel().tolist(),
            "axes": [
                {"along": np.round(axis.direction, 7).tolist(), "slides": axis.kind == "prismatic"}
                for axis in link.axes
            ],
        }
        for link in task.hand.links
    ]


def _friction(task: Task, record: RunRecord) -> float:
    friction = record.settings.get("hold.friction")
    settings = HoldSettings(friction=friction if isinstance(friction, float) and friction > 0.0 else None)
    return settings.sliding_friction(task.object)


def _grasp(grasp: GraspRecord, task: Task, record: RunRecord, source: Path) -> dict[str, Any] | None:
    """What poses hand and object in a grasp; None where the record is none of this task."""
    try:
        state = to_state(grasp, task, source)
        approach = None if grasp.approach is None else to_approach(grasp.approach, task.hand, source)
    except InputError:
        return None
    pose = [*grasp.object.position, *grasp.object.quaternion]
    waypoints = [] if approach is None else [task.hand.expand(q) for q in approach.waypoints]
    trials = _trials(grasp, task)
    return {
        "id": grasp.id,
        "q": _rounded(task.hand.expand(state.q)),
        "pose": _rounded(np.array(pose)),
        "approach": [_rounded(q) for q in waypoints],
        "trials": trials,
        "contacts": _contacts(grasp, task, state),
        "loads": _loads(grasp, task, state),
        "deep": deep_pairs(task, state),
        "blocking": _blocking(grasp, task),
    }


def _apart(task: Task, nodes: list[SceneNode]) -> dict[str, Any]:
    """The hand, open, and the object beside it: what a run without grasps shows."""
    q = task.hand.expand(open_posture(task.hand))
    T_palm_link = forward_kinematics(task.hand, q)
    hand = [
        transform_points(T_palm_link[node.link], np.asarray(node.mesh.vertices))
        for node in nodes
        if node.kind == "link" and node.link is not None
    ]
    points = np.concatenate([*hand, np.zeros((1, 3))])
    low, high = task.object.mesh.bounds
    # Along y, where the front view has it beside the hand and not behind it.
    position = 0.5 * (points.min(axis=0) + points.max(axis=0) - low - high)
    position[1] = points[:, 1].max() - low[1] + _ROOM_M
    return {
        "id": APART,
        "q": _rounded(q),
        "pose": [*_rounded(position), 1.0, 0.0, 0.0, 0.0],
        **{name: [] for name in ("approach", "trials", "contacts", "loads", "deep")},
        "blocking": None,
    }


def _trials(grasp: GraspRecord, task: Task) -> list[dict[str, Any]]:
    """The test in each direction of which a motion was recorded."""
    kind = "lift" if grasp.hold is None else grasp.hold.kind
    return [
        {
            "number": number,
            "name": name,
            "outcome": outcome_word(entry.outcome, kind) if entry.outcome else "",
            "held": entry.held,
            "gravity": _unit(entry),
            "rows": entry.motion,
            "slips": [[round(t, 4), round(1e3 * slip, 3)] for t, slip in entry.curve],
        }
        for number, name, entry in recorded_trials(grasp, task)
    ]


def _unit(entry: Direction) -> list[float]:
    gravity = np.array(entry.gravity)
    size = float(np.linalg.norm(gravity))
    return _rounded(gravity / size) if size > 0.0 else [0.0, 0.0, 0.0]


def _contacts(grasp: GraspRecord, task: Task, state: State) -> list[dict[str, Any]]:
    """Points, outward normals and forces of the squeeze in the object's frame, in m and N."""
    R, p = state.R_palm_object, state.p_palm_object
    squeeze = None if grasp.hold is None else grasp.hold.squeeze
    planned = [] if squeeze is None else squeeze.contact_forces
    found = []
    for i, contact in enumerate(grasp.contacts):
        outward = np.array(contact.normal)
        force = None
        if i < len(planned):
            frame = np.vstack([-outward, perpendicular(-outward)])
            force = _rounded(R.T @ (np.array(planned[i][:3]) @ frame))
        found.append(
            {
                "point": _rounded(R.T @ (np.array(contact.point) - p)),
                "normal": _rounded(R.T @ outward),
                "squeeze": force,
                "link": task.contacts[i].hand.link if i < len(task.contacts) else 0,
            }
        )
    return found


def _loads(grasp: GraspRecord, task: Task, state: State) -> list[list[list[float]]]:
    """For each direction and contact the force that was proved to balance the load, in the object's frame."""
    stable, n = None if grasp.evidence is None else grasp.evidence.stable, len(task.contacts)
    if stable is None or any(len(forces) != n + len(stable.wide) for forces in stable.forces):
        return []
    R = rotation_from_quaternion(np.array(grasp.object.quaternion))
    owners = np.array([*range(n), *(point.contact for point in stable.wide)])
    of_contact = np.array([owners == i for i in range(n)], dtype=float)
    return [[_rounded(R.T @ f) for f in of_contact @ np.array(forces)[:, :3]] for forces in stable.forces]


def deep_pairs(task: Task, state: State) -> list[dict[str, Any]]:
    """The pairs of bodies that sink in deeper than they may, with the depth in mm and the places."""
    return [
        {
            "bodies": _numbered((pair.a, pair.b), task),
            "names": [pair.a, pair.b],
            "depth": round(-1e3 * pair.distance_m, 3),
            "places": _places(task, state, number),
        }
        for number, pair in enumerate(compute_clearance(task, state).pairs)
        if not pair.is_clear and pair.distance_m < 0.0
    ]


def _places(task: Task, state: State, number: int) -> dict[str, list[list[float]]]:
    """Where a watched pair of bodies overlaps, by body and in its own frame: x, y, z and depth, all in m."""
    model = collision_model(task)
    gaps = measure(model.place(state), model.piece_pairs[model.pair_of == number])
    deepest = np.argsort(gaps.distance_m)[:_MOST_PLACES]
    deepest = deepest[gaps.distance_m[deepest] < 0.0]
    middles, depths = 0.5 * (gaps.p_a + gaps.p_b)[deepest], -gaps.distance_m[deepest]
    Ts_link = forward_kinematics(task.hand, task.hand.expand(state.q))
    links = {link.name: T for link, T in zip(task.hand.links, Ts_link, strict=True)}
    found = {}
    for name in model.name(model.pairs[number]):
        T = invert(links.get(name, state.T_palm_object))
        points = transform_points(T, middles)
        for body in _numbered((name,), task):
            found[body] = [_rounded(row) for row in np.column_stack([points, depths])]
    return found


def _blocking(grasp: GraspRecord, task: Task) -> dict[str, Any] | None:
    """The two bodies that end retraction, or the opening of the fingers."""
    pair, why = None, ""
    if grasp.clearance is not None and grasp.clearance.status == "failed":
        pair, why = grasp.clearance.worst_pair, "retraction"
    elif grasp.is_unreachable and grasp.approach is not None:
        pair, why = grasp.approach.blocking, "the opening of the fingers"
    return None if pair is None else {"bodies": _numbered(pair, task), "names": list(pair), "ends": why}


def _numbered(pair: tuple[str, ...], task: Task) -> list[str]:
    """Bodies as the nodes' names begin: `link_<i>` or `part_<i>`; others fall away."""
    links = {link.name: f"link_{i}" for i, link in enumerate(task.hand.links)}
    parts = {f"object/{part.name}": f"part_{i}" for i, part in enumerate(task.object.parts)}
    return [{**links, **parts}[name] for name in pair if name in links or name in parts]


def _rounded(values: Array) -> list[float]:
    found: list[float] = (np.round(values, _DIGITS) + 0.0).tolist()
    return found
