"""The checker of grasp files accepts what was proved, has the project's geometry, and is not fooled."""

import json
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.check_proof import GraspCheck, check_grasp
from holdfast.check_proof.grasps.clear import _bends, _lowest
from holdfast.check_proof.grasps.form import Form
from holdfast.check_proof.grasps.places import contacts_of, frames_of, turn_of_quaternion
from holdfast.check_proof.grasps.spans import Jets, Spans, unit
from holdfast.evidence import grasp_form
from holdfast.evidence.travel import bends
from holdfast.geometry import axis_rotation
from holdfast.grasping import ReadyGrasp, make_grasp
from holdfast.hands import joint_axes
from holdfast.objects import load_task
from holdfast.retraction import collision_model
from holdfast.solver import solve

from ..solver.jaws import block, frustum, grip, jaw
from .records import written_grasp

Written = list[tuple[ReadyGrasp, dict[str, Any], dict[str, Any]]]


@pytest.fixture(scope="module")
def written() -> Written:
    """Grasps with the task's form and their records; of each task those with both statements come first."""
    out = []
    for name in ("upholding", "handling", "tuning", "playing"):
        task = load_task(name)
        form = json.loads(json.dumps(grasp_form(task)))
        for configuration in solve(task, candidates=3, seed=5).configurations:
            grasp = make_grasp(configuration)
            if isinstance(grasp, ReadyGrasp):
                out.append((grasp, form, written_grasp(grasp)))
    return out


@pytest.fixture(scope="module")
def full(written: Written) -> tuple[ReadyGrasp, dict[str, Any], dict[str, Any]]:
    """A grasp of three contacts that is balanced, and clear all the way."""
    return next(
        one
        for one in written
        if len(one[2]["contacts"]) == 3
        and one[1]["test"]["kind"] == "lift"
        and one[2]["evidence"]["stable"]
        and one[2]["evidence"]["clear"]
        and one[2]["evidence"]["clear"]["approach"]
        and any(plane[0] >= 0 for plane in one[2]["evidence"]["clear"]["planes"])
    )


def test_what_was_proved_is_accepted(written: Written) -> None:
    stable = clear = 0
    for _, form, record in written:
        evidence = record["evidence"]
        assert evidence["clear"] is not None
        found = check_grasp(record, form)
        assert found.accepted and not found.reason, found.reason
        assert found.clear and found.approach == evidence["clear"]["approach"]
        if evidence["stable"] is not None:
            stable += 1
            assert found.slack_N == pytest.approx(evidence["stable"]["slack"], rel=1e-6)
        clear += 1
    assert stable >= 6 and clear >= 8


def test_places_are_those_of_the_project(written: Written) -> None:
    for grasp, form, record in written:
        task, state = grasp.configuration.task, grasp.configuration.state
        checked = Form.read(form)
        frames = frames_of(checked, [Spans.of(x) for x in state.q])
        links, origins, directions = joint_axes(task.hand, task.hand.expand(state.q))
        for mine, theirs in (
            (frames.rotations, links[:, :3, :3]),
            (frames.positions, links[:, :3, 3]),
            (frames.origins, origins),
            (frames.directions, directions),
        ):
            for spans, exact in zip(mine, theirs, strict=True):
                assert np.abs(spans.middle - exact).max() < 1e-13 and (spans.hi - spans.lo).max() < 1e-13
        R = turn_of_quaternion(Spans.of(np.array(record["object"]["quaternion"])))
        assert np.abs(R.middle - state.R_palm_object).max() < 1e-14
        contacts = contacts_of(checked, frames, R, Spans.of(state.p_palm_object), Spans.of(state.params))
        for mine, point in zip(contacts, grasp.configuration.contact_points, strict=True):
            assert np.abs(mine.p_object.middle - point.p_object).max() < 1e-13
            assert np.abs(mine.inward.middle + point.n_object).max() < 1e-12
        step = np.random.default_rng(1).normal(size=len(state.q))
        mine = _bends(checked, np.abs(step))
        theirs = bends(collision_model(task), step)
        assert np.all(mine >= theirs * (1.0 - 1e-9)) and np.all(mine <= theirs * (1.0 + 1e-9))


def test_slopes_are_those_of_differences() -> None:
    rng = np.random.default_rng(2)
    x = rng.normal(size=4)

    def f(v: Any) -> Any:
        cosine, sine = (v[0] * v[1]).cosine_and_sine()
        return unit(v[1:4] * cosine + v[0:3] * sine) * (v[3] * v[3] + 1.0).inverse().sqrt()

    jets = f(Jets(Spans.of(x), Spans.of(np.eye(4))))
    for k in range(4):
        h = 1e-6 * np.eye(4)[k]
        slope = (f(Spans.of(x + h)).middle - f(Spans.of(x - h)).middle) / 2e-6
        assert np.abs(jets.slopes.middle[k] - slope).max() < 1e-8


def test_the_lowest_value_is_below_the_parabola() -> None:
    rng = np.random.default_rng(3)
    start, end = rng.normal(size=(2, 400))
    bend = 10.0 ** rng.uniform(-6.0, 1.0, 400)
    s = np.linspace(0.0, 1.0, 999)[:, None]
    parabola = (start + (end - start) * s - 0.5 * bend * s * (1.0 - s)).min(axis=0)
    least = _lowest(start, end, bend)
    assert np.all(least <= parabola) and np.all(least >= parabola - 1e-3 * bend - 1e-14)


Tamper = Callable[[dict[str, Any]], None]


def _scaled(path: str, factor: float, shift: float = 0.0) -> Tamper:
    """A number, or the first of nested lists of numbers, at a dotted path."""

    def tamper(record: dict[str, Any]) -> None:
        *names, last = path.split(".")
        at: Any = record
        for name in names:
            at = at[int(name)] if isinstance(at, list) else at[name]
        key = int(last) if isinstance(at, list) else last
        at[key] = factor * at[key] + shift

    return tamper


def _set(path: str, value: Any) -> Tamper:
    def tamper(record: dict[str, Any]) -> None:
        *names, last = path.split(".")
        at: Any = record
        for name in names:
            at = at[int(name)] if isinstance(at, list) else at[name]
        at[int(last) if isinstance(at, list) else last] = value

    return tamper


def _joint(shift: float) -> Tamper:
    def tamper(record: dict[str, Any]) -> None:
        for name in record["joints"]:
            record["joints"][name] += shift

    return tamper


def _planes(change: Callable[[list[list[Any]]], list[Any]]) -> Tamper:
    def tamper(record: dict[str, Any]) -> None:
        clear = record["evidence"]["clear"]
        clear["planes"] = change(clear["planes"])

    return tamper


def _waypoint(shift: float) -> Tamper:
    def tamper(record: dict[str, Any]) -> None:
        place = record["approach"]["waypoints"][0]
        for name in place:
            place[name] += shift

    return tamper


def _drop(path: str) -> Tamper:
    def tamper(record: dict[str, Any]) -> None:
        *names, last = path.split(".")
        at: Any = record
        for name in names:
            at = at[name]
        del at[last]

    return tamper


TAMPERS: dict[str, Tamper] = {
    "more slack": _scaled("evidence.stable.slack", 1.001),
    "less slack": _scaled("evidence.stable.slack", 0.5),
    "no slack": _set("evidence.stable.slack", -1.0),
    "slack in words": _set("evidence.stable.slack", "much"),
    "less effort": _scaled("evidence.stable.effort_share", 0.9),
    "smaller error": _scaled("evidence.stable.error", 1e-3),
    "a force off by a micronewton": _scaled("evidence.stable.forces.0.0.0", 1.0, 1e-6),
    "a force off by a newton": _scaled("evidence.stable.forces.1.1.2", 1.0, 1.0),
    "a torque off": _scaled("evidence.stable.forces.0.2.3", 1.0, 1e-3),
    "a force of zero": _set("evidence.stable.forces.0.0", [0.0, 0.0, 0.0, 0.0]),
    "a load left out": lambda r: r["evidence"]["stable"]["forces"].pop(),
    "a contact left out": lambda r: r["evidence"]["stable"]["forces"][0].pop(),
    "loads exchanged": lambda r: r["evidence"]["stable"]["forces"].reverse(),
    "less friction": _set("hold.settings.friction", 0.05),
    "more friction": _set("hold.settings.friction", 3.0),
    "more gravity": _scaled("hold.settings.gravity", 1.01),
    "another direction": _set("hold.settings.directions.0", [0.6, 0.8, 0.0]),
    "a heavier object": _set("hold.settings.object_mass_kg", 5.0),
    "a longer arm": _scaled("hold.squeeze.spin_arms.0", 1.5),
    "no arm": _set("hold.squeeze.spin_arms.0", 0.0),
    "joints moved": _joint(1e-9),
    "the object moved": _scaled("object.position.1", 1.0, 1e-8),
    "the object turned": _scaled("object.quaternion.1", 1.0, 1e-8),
    "no rotation": _set("object.quaternion", [0.0, 0.0, 0.0, 0.0]),
    "a parameter moved": _scaled("parameters.0", 1.0, 1e-8),
    "a parameter off its patch": _set("parameters.0", 1.5),
    "a parameter left out": lambda r: r["parameters"].pop(),
    "a joint left out": lambda r: r["joints"].clear(),
    "radii too small": _set("evidence.radii.joints", 1e-18),
    "radii too large": _set("evidence.radii.position", 1e-2),
    "radii below zero": _set("evidence.radii.rotation", -1.0),
    "planes left out": _planes(lambda planes: []),
    "a step's planes left out": _planes(lambda planes: [p for p in planes if p[0] != planes[-1][0]]),
    "the grasp's planes left out": _planes(lambda planes: [p for p in planes if p[0] >= 0]),
    "planes turned round": _planes(lambda planes: [[*p[:3], -p[3], -p[4], -p[5]] for p in planes]),
    "planes without a normal": _planes(lambda planes: [[*p[:3], 0.0, 0.0, 0.0] for p in planes]),
    "planes of other pairs": _planes(lambda planes: [[*p[:2], 0, *p[3:]] for p in planes]),
    "planes of no pair": _planes(lambda planes: [[*p[:2], 10**9, *p[3:]] for p in planes]),
    "planes of the deepest stretch alone": _planes(
        lambda planes: [[p[0], (1 << 24) - 1, *p[2:]] for p in planes]
    ),
    "a way of a thousand places": lambda r: r["approach"].update(waypoints=r["approach"]["waypoints"] * 300),
    "friction below zero": _set("hold.settings.friction", -0.5),
    "gravity nowhere": _set("hold.settings.directions.0", [0.0, 0.0, 0.0]),
    "planes of no stretch": _planes(lambda planes: [[p[0], 0, *p[2:]] for p in planes]),
    "depth below zero": _set("evidence.clear.depth", -1.0),
    "contacts apart": _set("evidence.clear.contact_depth", -1e-4),
    "a margin": _set("evidence.clear.margin", 0.05),
    "the way moved": _waypoint(1.0),
    "the way's end moved": lambda r: r["approach"]["waypoints"].pop(),
    "no way": lambda r: r["approach"]["waypoints"].clear(),
    "no approach": _set("approach", None),
    "nothing proved": _set("evidence", {"stable": None, "clear": None, "reasons": []}),
    "no evidence": _drop("evidence"),
    "not a number": _set("evidence.stable.slack", float("nan")),
}


# These say something else that may be as true.
ANOTHER_STATEMENT = {"a longer arm"}


@pytest.mark.parametrize("name", TAMPERS)
def test_tampered_files_are_refused(
    full: tuple[ReadyGrasp, dict[str, Any], dict[str, Any]], name: str
) -> None:
    _, form, record = full
    tampered = deepcopy(record)
    TAMPERS[name](tampered)
    found = check_grasp(tampered, form)
    assert isinstance(found, GraspCheck) and not found.accepted and found.reason
    # Without the checksum what is left must still be true: another statement, if any.
    if name not in ANOTHER_STATEMENT:
        assert not check_grasp(tampered, form, sealed=False).accepted


@pytest.mark.parametrize("thing", [block, frustum])
def test_sliding_joints_and_flats_with_room(thing: Callable[[Path], Any], tmp_path: Path) -> None:
    """Flats on flats are proved with the room that tasks leave normals, and where these must be opposed."""
    for room in (None, 0.0):
        task = grip(jaw(tmp_path), thing(tmp_path), room)
        # A seed whose contacts balance as points: what is proved takes no account of the width of flats.
        (configuration, *_) = solve(task, candidates=1, seed=4).configurations
        grasp = make_grasp(configuration)
        assert isinstance(grasp, ReadyGrasp)
        record = written_grasp(grasp)
        assert record["evidence"]["stable"] and record["evidence"]["clear"]["approach"]
        form = json.loads(json.dumps(grasp_form(task)))
        found = check_grasp(record, form)
        assert found.accepted, found.reason
        # A jaw a little askew, whose alignment follows from nothing.
        side = form["contacts"][0]["hand"]
        which = "net" if side["kind"] == "patch" else "normal"
        turned = np.array(side[which]) @ axis_rotation(np.array([0.6, 0.8, 0.0]), 1e-5).T
        side[which] = turned.tolist()
        assert room is None or not check_grasp(record, form).accepted


def test_another_task_s_form_is_refused(written: Written) -> None:
    forms = {json.dumps(form, sort_keys=True): form for _, form, _ in written}
    for _, form, record in written[::4]:
        for other in forms.values():
            if other is not form and other != form:
                assert not check_grasp(record, other).accepted


def test_moved_patches_are_refused(full: tuple[ReadyGrasp, dict[str, Any], dict[str, Any]]) -> None:
    _, form, record = full
    for contact in range(3):
        for side in ("hand", "object"):
            moved = deepcopy(form)
            region = moved["contacts"][contact][side]
            if region["kind"] == "patch":
                region["net"] = np.add(region["net"], [0.0, 0.0, 1e-6]).tolist()
            else:
                region["point"] = np.add(region["point"], 1e-6).tolist()
            assert not check_grasp(record, moved).accepted
