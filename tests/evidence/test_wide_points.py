"""Forces over the area of wide contacts: certified, checked, and refused where they may not act."""

import json
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from math import radians
from typing import Any

import numpy as np
import pytest
from holdfast.check_proof import check_grasp
from holdfast.check_proof.grasps import areas
from holdfast.check_proof.grasps.form import Form
from holdfast.check_proof.grasps.places import contacts_of, frames_of
from holdfast.check_proof.grasps.spans import Spans
from holdfast.evidence import CertifiedStable, NotCertified, certify_stable, grasp_form
from holdfast.evidence.contact_areas import ContactAreas
from holdfast.evidence.stable import certify_forces, find_forces
from holdfast.evidence.true_contacts import true_places
from holdfast.evidence.wide_points import find_wide_points
from holdfast.geometry import perpendicular, region_curvature
from holdfast.grasping import ReadyGrasp
from holdfast.mjcf.squeeze import contact_pads, grasp_statics
from holdfast.mjcf.squeeze.statics import ForcePoints
from holdfast.pipeline.records import GraspRecord
from holdfast.pipeline.report.scene import _loads
from holdfast.solver import SolutionRadii

from .records import written_grasp

Record = dict[str, Any]
EXACTLY = SolutionRadii(0.0, 0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def found(palm_grasp: ReadyGrasp) -> CertifiedStable:
    found = certify_stable(palm_grasp.configuration, palm_grasp.squeeze)
    assert isinstance(found, CertifiedStable)
    return found


@pytest.fixture(scope="module")
def form(palm_grasp: ReadyGrasp) -> Record:
    read: Record = json.loads(json.dumps(grasp_form(palm_grasp.configuration.task)))
    return read


@pytest.fixture(scope="module")
def record(palm_grasp: ReadyGrasp) -> Record:
    return written_grasp(palm_grasp)


def test_a_palm_carries_over_its_area(palm_grasp: ReadyGrasp, found: CertifiedStable) -> None:
    """Not as points; and what is certified balances by the project's own statics, inside its cones."""
    configuration, squeeze = palm_grasp.configuration, palm_grasp.squeeze
    task, settings = configuration.task, squeeze.settings
    assert isinstance(find_forces(task, configuration.state, settings, squeeze.spin_arms_m), NotCertified)
    assert len(found.wide) == 4 and {point.contact for point in found.wide} == {3}
    assert found.slack_N > 0.1 and "over their area" in str(found)
    inward = -configuration.contact_points[3].n_object
    offsets_m = [np.asarray(perpendicular(inward)) @ point.offset_m for point in found.wide]
    points = ForcePoints(
        np.array([0, 1, 2, 3, 3, 3, 3, 3]), np.vstack([np.zeros((4, 2)), np.array(offsets_m)])
    )
    statics = grasp_statics(configuration, settings, points)
    vectors = np.einsum("nij,knj->kni", statics.frames, found.forces[..., :3])
    torques = found.forces[..., 3]
    mu, arms_m = settings.sliding_friction(task.object), squeeze.spin_arms_m[points.contact]
    room = vectors[..., 0] - np.sqrt((vectors[..., 1:] ** 2).sum(axis=2) + (torques / arms_m) ** 2) / mu
    assert room.min() > 0.0 and (room @ statics.by_contact.T).min() >= found.slack_N - 1e-9
    flat = np.concatenate([vectors, torques[..., None]], axis=2).reshape(len(vectors), -1)
    weights = np.zeros((len(settings.directions), 6))
    weights[:, :3] = statics.mass * settings.gravity * np.array(settings.directions)
    assert np.abs(flat @ statics.G.T + weights).max() < 1e-9
    assert (np.abs(flat @ statics.T.T) / statics.effort).max() <= found.effort_share + 1e-9


def test_areas_are_those_that_squeezes_are_planned_with(palm_grasp: ReadyGrasp) -> None:
    """Along principal directions; the checker encloses the same curvature and the same yield."""
    configuration, settings = palm_grasp.configuration, palm_grasp.squeeze.settings
    task, state = configuration.task, configuration.state
    pads = contact_pads(configuration, settings)
    at = true_places(task, state, EXACTLY)
    around = ContactAreas(task, settings, at)
    checked = Form.read(json.loads(json.dumps(grasp_form(task))))
    frames = frames_of(checked, [Spans.of(x) for x in state.q])
    R, p, params = Spans.of(state.R_palm_object), Spans.of(state.p_palm_object), Spans.of(state.params)
    theirs = contacts_of(checked, frames, R, p, params)
    for i, point in enumerate(configuration.contact_points):
        area = around[i]
        tangents = np.asarray(perpendicular(-point.n_object))
        in_plane = tangents @ area.K.mid @ tangents.T
        assert np.abs(np.sort(np.linalg.eigvalsh(in_plane)) - np.sort(pads.curvatures[i])).max() < 1e-6
        assert area.yield_m == pytest.approx(pads.pad.yield_m(np.full(1, 10.0), pads.curvatures[i][None])[0])
        K = areas._curvature(checked, i, frames, R, params, theirs[i])
        assert np.all(K.lo <= area.K.upper) and np.all(area.K.lower <= K.hi)
        assert np.abs(K.middle - area.K.mid).max() < 1e-7
        assert areas._least_yield(checked.pad, K) == pytest.approx(area.yield_m, rel=1e-9)
    for point in find_wide_points(around, state):
        reach_m = np.linalg.norm(point.offset_m)
        assert reach_m <= pads.reaches_m()[point.contact].max() * (1.0 + 1e-9)


def test_curvature_in_balls_is_that_of_regions(palm_grasp: ReadyGrasp) -> None:
    """Over a ball of parameters it holds that of every one of them."""
    configuration = palm_grasp.configuration
    task, state = configuration.task, configuration.state
    size = 1e-5
    at = true_places(task, state, SolutionRadii(0.0, 0.0, 0.0, size))
    around = ContactAreas(task, palm_grasp.squeeze.settings, at)
    rng = np.random.default_rng(1)
    for i, contact in enumerate(task.contacts):
        area = around[i]
        for _ in range(5):
            params = state.params + size * rng.uniform(-1.0, 1.0, len(state.params))
            there = replace(configuration, state=replace(state, params=params))
            (n, first) = (
                -there.contact_points[i].n_object,
                sum(
                    2 * hasattr(side, "patch")
                    for c in task.contacts[:i]
                    for side in (c.hand.region, c.object.region)
                ),
            )
            K = np.zeros((3, 3))
            for region, turn in (
                (contact.hand.region, at.links.rotations.mid[contact.hand.link]),
                (contact.object.region, state.R_palm_object),
            ):
                K += turn @ region_curvature(region, params[first : first + 2]) @ turn.T
                first += 2 * hasattr(region, "patch")
            across = np.eye(3) - np.outer(n, n)
            assert np.all(np.abs(across @ K @ across - area.K.mid) <= area.K.rad + 1e-9)


def test_points_outside_prove_nothing(palm_grasp: ReadyGrasp, found: CertifiedStable) -> None:
    configuration, squeeze = palm_grasp.configuration, palm_grasp.squeeze
    point = found.wide[0]
    farther = replace(point, offset_m=tuple((1.001 * np.array(point.offset_m)).tolist()))
    elsewhere = replace(point, in_object=found.wide[1].in_object)
    outside = replace(
        point, in_object=replace(point.in_object, weights=(2.0,) * len(point.in_object.weights))
    )
    for wide, reason in (
        (farther, "outside its contact's area"),
        (elsewhere, "beside one of the bodies"),
        (outside, "beside one of the bodies"),
    ):
        refused = certify_forces(
            configuration.task,
            configuration.state,
            found.radii,
            squeeze.settings,
            squeeze.spin_arms_m,
            found.forces,
            (wide, *found.wide[1:]),
        )
        assert isinstance(refused, NotCertified) and reason in refused.reason


def test_the_less_an_object_may_turn_the_nearer_are_its_force_points(palm_grasp: ReadyGrasp) -> None:
    configuration = palm_grasp.configuration
    task, state = configuration.task, configuration.state
    at = true_places(task, state, EXACTLY)
    reaches = []
    for degrees in (0.5, 1.5, 10.0):
        settings = replace(palm_grasp.squeeze.settings, rotation_limit_rad=radians(degrees))
        wide = find_wide_points(ContactAreas(task, settings, at), state)
        reaches.append(max((np.linalg.norm(point.offset_m) for point in wide), default=0.0))
    assert reaches[0] < reaches[1] < reaches[2]


def test_the_checker_accepts_it(record: Record, form: Record, found: CertifiedStable) -> None:
    check = check_grasp(record, form)
    assert check.accepted, check.reason
    assert check.slack_N == pytest.approx(found.slack_N, rel=1e-6)


def test_a_report_draws_what_forces_of_a_contact_come_to(record: Record, palm_grasp: ReadyGrasp) -> None:
    configuration = palm_grasp.configuration
    read = GraspRecord.model_validate(record)
    drawn = np.array(_loads(read, configuration.task, configuration.state))
    forces = np.array(record["evidence"]["stable"]["forces"])[..., :3]
    R = configuration.state.R_palm_object
    assert drawn.shape == (len(forces), 4, 3)
    assert np.abs(drawn.sum(axis=1) - forces.sum(axis=1) @ R).max() < 1e-2


Change = Callable[[Record, list[Any]], None]


def _wide(key: str, change: Callable[[Any], Any]) -> Change:
    def tamper(stable: Record, wide: list[Any]) -> None:
        *names, last = key.split(".")
        at: Any = wide[0]
        for name in names:
            at = at[name]
        at[last] = change(at[last])

    return tamper


TAMPERS: dict[str, Change] = {
    "farther out": _wide("offset", lambda d: [1.01 * x for x in d]),
    "nearer": _wide("offset", lambda d: [0.5 * x for x in d]),
    "off by a micrometre": _wide("offset", lambda d: [d[0] + 1e-6, d[1] + 1e-6, d[2] + 1e-6]),
    "far away": _wide("offset", lambda d: [100.0 * x for x in d]),
    "not a number": _wide("offset", lambda d: [float("nan"), *d[1:]]),
    "an offset left out": _wide("offset", lambda d: d[:2]),
    "of another contact": _wide("contact", lambda i: 0),
    "of no contact": _wide("contact", lambda i: 4),
    "of a contact in words": _wide("contact", lambda i: "palm"),
    "another piece": _wide("object.piece", lambda k: k + 1),
    "a piece of the other body": lambda s, w: w[0].update(hand=w[0]["object"]),
    "no piece": _wide("hand.piece", lambda k: 10**6),
    "no vertices": _wide("hand.vertices", lambda v: []),
    "vertices of no piece": _wide("hand.vertices", lambda v: [10**6] * len(v)),
    "other vertices": _wide("object.vertices", lambda v: v[::-1]),
    "weights of more than one": _wide("hand.weights", lambda w: [2.0] * len(w)),
    "weights below zero": _wide("hand.weights", lambda w: [-x for x in w]),
    "weights left out": _wide("hand.weights", lambda w: w[1:]),
    "a point left out": lambda s, w: w.pop(),
    "all points left out": lambda s, w: s.pop("wide"),
    "a point twice": lambda s, w: w.append(w[0]),
    "points exchanged": lambda s, w: w.reverse(),
    "nothing at a point": lambda s, w: w.insert(0, None),
    "too many points": lambda s, w: w.extend(w * 50),
    "a force at a point off": lambda s, w: s["forces"][0][5].__setitem__(2, s["forces"][0][5][2] + 1.0),
    "a force at a point left out": lambda s, w: s["forces"][0].pop(),
}


@pytest.mark.parametrize("name", TAMPERS)
def test_tampered_points_are_refused(record: Record, form: Record, name: str) -> None:
    tampered = deepcopy(record)
    stable = tampered["evidence"]["stable"]
    TAMPERS[name](stable, stable["wide"])
    assert tampered != record
    for sealed in (True, False):
        check = check_grasp(tampered, form, sealed=sealed)
        assert not check.accepted and check.reason


@pytest.mark.parametrize("limit", ["less room to turn", "a thinner pad", "a stiffer pad", "a sharper object"])
def test_smaller_areas_are_refused(record: Record, form: Record, limit: str) -> None:
    changed, other = deepcopy(record), deepcopy(form)
    if limit == "less room to turn":
        changed["hold"]["settings"]["rotation_limit_rad"] *= 0.1
    elif limit == "a thinner pad":
        other["pad"]["thickness"] = 0.005
    elif limit == "a stiffer pad":
        other["pad"]["modulus"] *= 100.0
    else:
        other["pad"]["flattest"] = 200.0
    assert not check_grasp(changed, other, sealed=False).accepted
