"""All solutions: isolated ones counted by another method, covers that lose nothing."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.optimize
from holdfast.errors import InputError
from holdfast.geometry import Cap, PointRegion
from holdfast.geometry.transforms import rotation_exp
from holdfast.hands import forward_kinematics
from holdfast.objects import Contact, ObjectRegion, Task, load_task
from holdfast.pipeline.cli.main import main
from holdfast.solver import ContactManifold, State, Verdict, iterate, solve, solve_all
from holdfast.solver.formulate.formulate import formulate
from holdfast.solver.tasks.square import independent_parts, is_square

# These searches end by themselves; how long that takes is the machine's affair.
NO_LIMIT_S = 1e6
FINGERS = ("index/tip", "middle/tip", "ring/tip")


def touch_points(
    base: Task, regions: tuple[str, ...], seed: int, room_rad: float = 0.0
) -> tuple[Task, State]:
    """Points of a fixed object, each where a region's cap of a hand at a random pose would touch it."""
    rng = np.random.default_rng(seed)
    hand = base.hand
    limits = hand.limits + np.array([-room_rad, room_rad])
    q = rng.uniform(hand.limits[:, 0], hand.limits[:, 1])
    frames = forward_kinematics(hand, hand.expand(q))
    R, p = rotation_exp(rng.normal(size=3)), rng.normal(size=3) * 0.1
    contacts = []
    for name in regions:
        region = hand.regions[name]
        cap, T = region.region, frames[region.link]
        assert isinstance(cap, Cap)
        n = T[:3, :3] @ cap.axis + 0.2 * rng.normal(size=3)
        n /= np.linalg.norm(n)
        touch = T[:3, :3] @ cap.centre + T[:3, 3] + cap.radius * n
        point = PointRegion(R.T @ (touch - p), R.T @ -n, off_surface=True)
        contacts.append(Contact(region, ObjectRegion(f"at {name}", point)))
    T_palm_object = np.eye(4)
    T_palm_object[:3, :3], T_palm_object[:3, 3] = R, p
    task = replace(base, contacts=tuple(contacts), limits=limits, T_palm_object=T_palm_object)
    return task, State(q, R, p, np.zeros(0))


def count_by_many_starts(task: Task, contact: Contact, starts: int = 150) -> list[np.ndarray]:
    """Joint angles of one finger at which its cap touches the point, by least squares from random starts."""
    hand, rng = task.hand, np.random.default_rng(0)
    cap, point = contact.hand.region, contact.object.region
    assert isinstance(cap, Cap) and isinstance(point, PointRegion) and task.T_palm_object is not None
    R, p = task.T_palm_object[:3, :3], task.T_palm_object[:3, 3]
    normal, target = R @ point.normal, R @ point.point + p + cap.radius * (R @ point.normal)
    moves = hand.tree.moves[contact.hand.link]
    own = [j for j in range(len(hand.independent)) if (hand.coupling_matrix[moves][:, j] != 0.0).any()]

    def frame(x: np.ndarray) -> np.ndarray:
        q = np.zeros(len(hand.independent))
        q[own] = x
        return forward_kinematics(hand, hand.expand(q))[contact.hand.link]

    def miss(x: np.ndarray) -> np.ndarray:
        T = frame(x)
        return (T[:3, :3] @ cap.centre + T[:3, 3] - target) / 0.05

    lower, upper = task.limits[own].T
    found: list[np.ndarray] = []
    for _ in range(starts):
        run = scipy.optimize.least_squares(
            miss, rng.uniform(lower, upper), bounds=(lower, upper), xtol=1e-15, ftol=1e-15, gtol=1e-15
        )
        inside = (frame(run.x)[:3, :3] @ cap.axis) @ -normal >= np.cos(cap.half_angle_rad)
        new = all(np.abs(run.x - other).max() > 1e-4 for other in found)
        if np.abs(run.fun).max() < 1e-9 and inside and new:
            found.append(run.x)
    return found


@pytest.mark.parametrize("seed", range(3))
def test_three_fingertips_on_three_points_have_as_many_solutions_as_their_fingers_combine(
    upholding: Task, seed: int
) -> None:
    # Wider caps and limits than the hand's own, so that a point can be touched in more than one way.
    task, planted = touch_points(upholding, FINGERS, seed, room_rad=1.2)
    wide = [
        replace(
            c, hand=replace(c.hand, region=replace(c.hand.region, half_angle_rad=np.pi, off_surface=True))
        )
        for c in task.contacts
    ]
    task = replace(task, contacts=tuple(wide))
    cover = solve_all(task, budget_s=NO_LIMIT_S)
    counts = [len(count_by_many_starts(task, contact)) for contact in task.contacts]
    assert cover.verdict is Verdict.COMPLETE
    assert cover.isolated
    assert len(cover.configurations) == np.prod(counts)
    assert max(counts) > 1, "a case in which something can be lost"
    fingers = [j for j, name in enumerate(task.hand.independent_names) if name.split("_")[0] != "thumb"]
    nearest = min(np.abs(c.state.q - planted.q)[fingers].max() for c in cover.configurations)
    assert nearest < 1e-9
    for configuration in cover.configurations:
        assert configuration.certified
        assert configuration.certificate.radius < 1e-6
        assert configuration.residual_m < 1e-9
        assert ContactManifold(task).is_feasible(configuration.state)


def test_solutions_beyond_a_limit_or_a_cap_are_not_counted(upholding: Task) -> None:
    task, planted = touch_points(upholding, ("index/tip",), 1)
    assert len(solve_all(task, budget_s=NO_LIMIT_S).configurations) == 1
    j = upholding.hand.independent_names.index("index_flexion")
    limits = task.limits.copy()
    limits[j] = planted.q[j] + 1e-3, limits[j, 1]
    assert solve_all(replace(task, limits=limits), budget_s=NO_LIMIT_S).verdict is Verdict.INFEASIBLE
    contact = task.contacts[0]
    narrow = replace(contact.hand.region, half_angle_rad=0.01)
    task = replace(task, contacts=(replace(contact, hand=replace(contact.hand, region=narrow)),))
    assert solve_all(task, budget_s=NO_LIMIT_S).verdict is Verdict.INFEASIBLE


def test_fingers_on_a_fixed_object_are_parts_of_their_own(upholding: Task) -> None:
    task, _ = touch_points(upholding, FINGERS, 0)
    system = formulate(task).system
    assert [(len(rows), len(inputs)) for rows, inputs in independent_parts(system)] == [(6, 6)] * 3
    assert is_square(system)
    assert not is_square(formulate(upholding).system)
    # Four joints for three equations: the thumb can move, though the numbers may add up elsewhere.
    assert not is_square(formulate(touch_points(upholding, ("thumb/tip",), 0)[0]).system)


@pytest.fixture(scope="module")
def thumb(upholding: Task) -> Task:
    return touch_points(upholding, ("thumb/tip",), 1)[0]


def test_a_cover_of_a_curve_of_solutions_loses_none(thumb: Task) -> None:
    cover = solve_all(thumb, budget_s=NO_LIMIT_S, sigma=0.1)
    assert cover.verdict is Verdict.COMPLETE
    assert not cover.isolated and cover.open == 0
    assert cover.decided == pytest.approx(1.0)
    assert 0 < cover.certified_boxes == sum(box.certified for box in cover.cover)
    formulation = formulate(thumb)
    inputs = formulation.system.inputs
    lower = np.array([box.lower for box in cover.cover])
    upper = np.array([box.upper for box in cover.cover])
    assert np.all(upper - lower <= 0.1)
    assert cover.names == tuple(formulation.system.names[i] for i in inputs)
    found = 0
    rng = np.random.default_rng(4)
    manifold = ContactManifold(thumb)
    for _ in range(300):
        q = rng.uniform(thumb.limits[:, 0], thumb.limits[:, 1])
        T = thumb.T_palm_object
        state = manifold.project(State(q, T[:3, :3], T[:3, 3], np.zeros(0)))
        if state is None or not manifold.is_feasible(state):
            continue
        found += 1
        x = formulation.inputs_from_state(state)[inputs]
        assert np.any(np.all((lower <= x + 1e-12) & (x <= upper + 1e-12), axis=1)), "a solution was lost"
    assert found > 50
    # A certified box holds its own solution.
    for box, configuration in zip(cover.cover, cover.configurations, strict=False):
        x = formulation.inputs_from_state(configuration.state)[inputs]
        assert box.certified and np.all(box.lower <= x) and np.all(x <= box.upper)


def cover_data(cover: object) -> list[bytes]:
    return [b.lower.tobytes() + b.upper.tobytes() + bytes([b.certified]) for b in cover.cover]


def test_a_cover_is_the_same_when_it_is_shared_or_resumed(
    thumb: Task, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    alone = solve_all(thumb, budget_s=NO_LIMIT_S, sigma=0.2)
    path = tmp_path / "cover.checkpoint"
    steps: list[int] = []
    left = solve_all(
        thumb, sigma=0.2, checkpoint=path, should_stop=lambda: steps.append(1) or len(steps) > 60
    )
    assert left.verdict is Verdict.UNDECIDED and left.open > 0
    assert cover_data(
        solve_all(thumb, budget_s=NO_LIMIT_S, sigma=0.2, checkpoint=path, resume=True)
    ) == cover_data(alone)
    request.getfixturevalue("at_once")
    assert cover_data(solve_all(thumb, budget_s=NO_LIMIT_S, sigma=0.2, workers=2)) == cover_data(alone)


def test_open_boxes_belong_to_the_cover_of_a_search_that_was_stopped(upholding: Task) -> None:
    some = solve(upholding, candidates=5).configurations
    cover = solve_all(upholding, budget_s=0.5)
    assert cover.verdict is Verdict.UNDECIDED
    formulation = formulate(upholding)
    for configuration in some:
        x = formulation.inputs_from_state(configuration.state)[formulation.system.inputs]
        assert any(np.all(b.lower <= x) and np.all(x <= b.upper) for b in cover.cover)


def test_a_fixed_object_stays_where_it_is(upholding: Task) -> None:
    pose = solve(upholding, candidates=1).configurations[0].state.T_palm_object
    task = replace(upholding, T_palm_object=pose)
    with_some = next(s for s in iterate(task) if s.state.solutions)
    assert np.array_equal(with_some.state.solutions[0].state.T_palm_object, pose)


def test_derivatives_of_the_rows_that_fix_the_object(upholding: Task) -> None:
    rng = np.random.default_rng(0)
    T = np.eye(4)
    T[:3, :3] = rotation_exp(rng.normal(size=3))
    manifold = ContactManifold(replace(upholding, T_palm_object=T))
    state = State(
        upholding.limits.mean(axis=1), rotation_exp(rng.normal(size=3)), rng.normal(size=3), [0.5] * 4
    )
    J = manifold.linearise(state)[1]
    for k in range(manifold.n_tangent):
        step = 1e-6 * np.eye(manifold.n_tangent)[k]
        ends = [manifold.residual(manifold.retract(state, s * step)) for s in (1.0, -1.0)]
        assert (ends[0] - ends[1]) / 2e-6 == pytest.approx(J[:, k], abs=1e-7)


TASK = """\
name: touch
hand: sa
object: scalpel
object_pose: {position: [0.04, 0.03, 0.22], quaternion: QUATERNION}
contacts:
  - {hand: index/tip, object: {point: [0, 0, 0], normal: [-1, 0, 0], off_surface: true}}
"""


def test_the_command_finds_all(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "touch.yaml"
    path.write_text(TASK.replace("QUATERNION", "[1, 0, 0, 0]"), "utf-8")
    assert np.array_equal(load_task(str(path)).T_palm_object[:3, 3], [0.04, 0.03, 0.22])
    code = main(["solve", str(path), "--all", "--json", "-", "--quiet"])
    result = json.loads(capsys.readouterr().out)
    assert (code, result["verdict"]) in {(0, "complete"), (3, "infeasible")}
    assert result["isolated"] is True
    assert len(result["solutions"]) == (code == 0)
    path.write_text(TASK.replace("QUATERNION", "[1, 1, 0, 0]"), "utf-8")
    with pytest.raises(InputError, match=r"object_pose\.quaternion.*length 1"):
        load_task(str(path))


@pytest.mark.parametrize("option", ["--first", "--pure", "--proof=x", "--explain=1", "--order=best"])
def test_all_is_refused_beside_what_it_has_no_use_for(
    option: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["solve", "upholding", "--all", option]) == 2
    assert option.split("=")[0] in capsys.readouterr().err


def test_a_coupling_by_any_ratio_is_covered_where_its_finger_is_fixed(upholding):
    """Cosines of an angle are no polynomials in it: a cover that keeps the known solution, not a count."""
    links = tuple(
        replace(
            link,
            axes=tuple(
                replace(axis, coupling=replace(axis.coupling, ratio=0.87)) if axis.coupling else axis
                for axis in link.axes
            ),
        )
        for link in upholding.hand.links
    )
    hand = replace(upholding.hand, links=links)
    task, state = touch_points(replace(upholding, hand=hand, limits=hand.limits.copy()), ("index/tip",), 3)
    formulation = formulate(task)
    assert not is_square(formulation.system) and not formulation.system.is_algebraic
    found = solve_all(task, sigma=0.05, budget_s=NO_LIMIT_S)
    assert not found.isolated and found.verdict is not Verdict.INFEASIBLE
    x = formulation.inputs_from_state(state)[formulation.system.inputs]
    assert any(np.all(box.lower - 1e-12 <= x) and np.all(x <= box.upper + 1e-12) for box in found.cover)
    turns = [hand.independent_names[j] for j in formulation.turn_inputs]
    assert turns and set(turns) <= set(found.names)
