"""Balance and clearance proved of grasps: how many, how fast, and whether anything false is ever proved.

Usage: ./run bench certified [TASK ...] [--count N] [--planted N] [--seed N] [--json FILE]

Of each task so many configurations are solved, made into grasps (strengthened, retracted, squeezed; nothing
is simulated) and certified. Counted are those that are certified stable, of those with a slack of 0.1 N by a
linear program with facets inside the cones, with the force points of wide contacts or without; those
certified clear, of those that are clear by FCL; and those
whose file the checker of `check-proof` accepts. Times are CPU time of one core.

Then unbalanced grasps are planted: friction, weight and pose are changed until a linear program with facets
outside the cones has no forces, and forces are handed in that balanced before, perturbed at random. And
intrusions: other pregrasps, from which a finger passes through something at a place that FCL looks at.
"""

import argparse
import json
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np
from holdfast.base.text.console import format_table
from holdfast.check_proof import check_grasp
from holdfast.evidence import WidePoint, certify_clear, certify_stable, find_evidence, grasp_form
from holdfast.evidence.contact_areas import ContactAreas
from holdfast.evidence.stable import certify_forces, find_forces
from holdfast.evidence.true_contacts import true_places
from holdfast.evidence.wide_points import find_wide_points
from holdfast.geometry import axis_rotation
from holdfast.grasping import ReadyGrasp, make_grasp
from holdfast.mjcf import HoldSettings, kind_of_test
from holdfast.mjcf.squeeze import contact_pads, grasp_statics
from holdfast.mjcf.squeeze.load_program import cone_edges
from holdfast.mjcf.squeeze.statics import Statics
from holdfast.objects import LiftTest, Task, load_task
from holdfast.pipeline.records import (
    GraspRecord,
    Hold,
    Squeeze,
    approach_record,
    as_written,
    to_json,
    to_solution,
    updated,
)
from holdfast.pipeline.run.stages import with_evidence
from holdfast.retraction import Approach, RetractionSettings, collision_model, measure
from holdfast.retraction.distance import lower_bounds
from holdfast.solver import Configuration, SolutionRadii, State, solution_radii, solve
from parts.nine_tasks import TASKS
from scipy.optimize import linprog

SLACK_N = 0.1
ARM = np.array([1.0, 1.0, 1.0, 100.0, 100.0, 100.0])


@dataclass
class Row:
    """Figures of one task; times in ms of CPU time, slacks in N."""

    task: str
    configurations: int = 0
    grasps: int = 0
    with_slack: int = 0
    stable: int = 0
    stable_of_these: int = 0
    slacks: list[float] = field(default_factory=list)
    stable_ms: list[float] = field(default_factory=list)
    clear: int = 0
    proved_clear: int = 0
    ways: int = 0
    proved_ways: int = 0
    wide: int = 0
    planes: list[int] = field(default_factory=list)
    clear_ms: list[float] = field(default_factory=list)
    checked: int = 0
    accepted: int = 0
    check_ms: list[float] = field(default_factory=list)
    unbalanced: int = 0
    unbalanced_proved: int = 0
    intrusions: int = 0
    intrusions_proved: int = 0
    reasons: dict[str, int] = field(default_factory=dict)


def least_slack(configuration: Configuration, settings: HoldSettings, arms_m: np.ndarray) -> float:
    """A slack in N that forces of a lift surely have, by facets in the cones; -inf where there are none.

    That is what a contact may lose: of several force points each has its share.
    """
    wide = contact_pads(configuration, settings).force_points()
    by_points = _least_slack(grasp_statics(configuration, settings), configuration, settings, arms_m)
    if by_points >= SLACK_N or len(wide.contact) == len(configuration.task.contacts):
        return by_points
    statics = grasp_statics(configuration, settings, wide)
    return max(by_points, _least_slack(statics, configuration, settings, arms_m))


def _least_slack(
    statics: Statics, configuration: Configuration, settings: HoldSettings, arms_m: np.ndarray
) -> float:
    owner = statics.force_points.contact
    n, mu = len(owner), settings.sliding_friction(configuration.task.object)
    directions = cone_edges(1.0, 1.0, 2)[1:].T
    inside = 0.985  # the hull of 162 directions reaches so far
    rows, limits = [], []
    for i in range(n):
        block = np.zeros((len(directions), 4 * n + 1))
        block[:, 4 * i + 1 : 4 * i + 4] = directions / (mu * np.array([1.0, 1.0, arms_m[owner[i]]])) / inside
        block[:, 4 * i], block[:, -1] = -1.0, 1.0 / (owner == owner[i]).sum()
        rows.append(block)
        limits.append(np.zeros(len(directions)))
    for sign in (1.0, -1.0):
        rows.append(np.column_stack([sign * statics.T, np.zeros(len(statics.T))]))
        limits.append(0.999 * statics.effort)
    return min(
        _largest(rows, limits, ARM[:, None] * statics.G, -ARM * weight)
        for weight in _weights(statics.mass, settings)
    )


def _largest(rows: list[np.ndarray], limits: list[np.ndarray], G: np.ndarray, b: np.ndarray) -> float:
    columns = G.shape[1] + 1
    bounds = [(None, None)] * (columns - 1) + [(None, 1e3)]
    found = linprog(
        -np.eye(columns)[-1], np.vstack(rows), np.concatenate(limits), np.column_stack([G, np.zeros(6)]), b,
        bounds=bounds, method="highs",
    )  # fmt: skip
    return -np.inf if found.status != 0 else float(-found.fun)


def _weights(mass: float, settings: HoldSettings) -> np.ndarray:
    weights = np.zeros((len(settings.directions), 6))
    weights[:, :3] = mass * settings.gravity * np.array(settings.directions)
    return weights


def is_balanced(configuration: Configuration, settings: HoldSettings, arms_m: np.ndarray) -> bool:
    """Whether forces in cones a little too wide balance every direction of a lift."""
    statics = grasp_statics(configuration, settings, contact_pads(configuration, settings).force_points())
    owner = statics.force_points.contact
    n, mu = len(owner), settings.sliding_friction(configuration.task.object)
    cone = cone_edges(mu, mu, 2, outside=True)
    edges = np.zeros((4 * n, n * cone.shape[1]))
    for i in range(n):
        block = cone.copy()
        block[3] *= arms_m[owner[i]]
        edges[4 * i : 4 * i + 4, i * cone.shape[1] : (i + 1) * cone.shape[1]] = block
    effort = statics.T @ edges / statics.effort[:, None]
    A_ub, b_ub = np.vstack([effort, -effort]), np.ones(2 * len(effort))
    for weight in _weights(statics.mass, settings):
        found = linprog(
            np.zeros(edges.shape[1]),
            A_ub,
            b_ub,
            ARM[:, None] * (statics.G @ edges),
            -ARM * weight,
            method="highs",
        )
        if found.status != 0:
            return False
    return True


def certify(row: Row, task: Task, count: int, seed: int) -> list[ReadyGrasp]:
    """Makes grasps of a task, and certifies them."""
    form = json.loads(json.dumps(grasp_form(task)))
    made = []
    for configuration in solve(task, candidates=count, seed=seed, budget_s=120.0).configurations:
        row.configurations += 1
        grasp = make_grasp(configuration)
        if isinstance(grasp, ReadyGrasp):
            made.append(grasp)
    if made:  # the first call builds tables
        certify_clear(made[0].configuration, made[0].approach)
        certify_stable(made[0].configuration, made[0].squeeze)
    for grasp in made:
        row.grasps += 1
        certify_one(row, grasp, form)
    return made


def certify_one(row: Row, grasp: ReadyGrasp, form: dict[str, object]) -> None:
    configuration, squeeze = grasp.configuration, grasp.squeeze
    started = time.process_time()
    stable = certify_stable(configuration, squeeze)
    row.stable_ms.append(1e3 * (time.process_time() - started))
    row.stable += bool(stable)
    if stable:
        row.slacks.append(stable.slack_N)
        row.wide += bool(stable.wide)
    if isinstance(configuration.task.test, LiftTest):
        has_slack = least_slack(configuration, squeeze.settings, squeeze.spin_arms_m) >= SLACK_N
    else:
        has_slack = bool(stable) and stable.slack_N >= SLACK_N
    row.with_slack += has_slack
    row.stable_of_these += has_slack and bool(stable)
    row.clear += 1  # or there would be no grasp
    row.ways += grasp.approach.reachable
    started = time.process_time()
    clear = certify_clear(configuration, grasp.approach)
    row.clear_ms.append(1e3 * (time.process_time() - started))
    if clear:
        row.proved_clear += 1
        row.proved_ways += clear.approach
        row.planes.append(len(clear.planes))
    record = written(grasp)
    if record["evidence"]["stable"] or record["evidence"]["clear"]:
        row.checked += 1
        started = time.process_time()
        check = check_grasp(record, form)
        row.check_ms.append(1e3 * (time.process_time() - started))
        row.accepted += check.accepted
        if not check.accepted:
            row.reasons[check.reason] = row.reasons.get(check.reason, 0) + 1
    for one in (stable, clear):
        if not one:
            row.reasons[str(one)] = row.reasons.get(str(one), 0) + 1


def written(grasp: ReadyGrasp) -> dict[str, object]:
    """The grasp's record with its evidence, as a file has it."""
    configuration, squeeze = grasp.configuration, grasp.squeeze
    task = configuration.task
    hold = Hold(
        preset=squeeze.settings.preset,
        settings=asdict(squeeze.settings),
        kind=kind_of_test(task),
        held=False,
        squeeze=Squeeze(targets={}, load_factor=squeeze.load_factor, spin_arms=squeeze.spin_arms_m.tolist()),
    )
    record = updated(
        GraspRecord.model_validate(to_solution(configuration, "g01").model_dump()),
        approach=approach_record(grasp.approach, task.hand),
        hold=hold,
    )
    found = find_evidence(task, as_written(configuration.state), squeeze=squeeze, approach=grasp.approach)
    return json.loads(json.dumps(to_json(with_evidence(record, found))))


def plant_unbalanced(row: Row, grasps: list[ReadyGrasp], count: int, rng: np.random.Generator) -> None:
    """Hands forces to grasps that nothing balances."""
    lifts = [grasp for grasp in grasps if isinstance(grasp.configuration.task.test, LiftTest)]
    for _ in range(20 * count):
        if row.unbalanced >= count or not lifts:
            return
        grasp = lifts[int(rng.integers(len(lifts)))]
        task, state, squeeze = grasp.configuration.task, grasp.configuration.state, grasp.squeeze
        mu = squeeze.settings.sliding_friction(task.object)
        settings = replace(
            squeeze.settings,
            friction=mu * rng.uniform(0.02, 1.0),
            gravity=9.81 * 10.0 ** rng.uniform(0.0, 2.0),
        )
        other = Configuration(task, _moved(state, rng), 0.0, None)
        if is_balanced(other, settings, squeeze.spin_arms_m):
            continue
        wide = _wide_points(task, other.state, settings) if rng.integers(2) else ()
        before = _wide_points(task, state, squeeze.settings) if wide else ()
        forces = find_forces(task, state, squeeze.settings, squeeze.spin_arms_m, before)
        guess = np.zeros((len(settings.directions), len(task.contacts) + len(wide), 4))
        if isinstance(forces, np.ndarray) and forces.shape == guess.shape:
            guess = forces
        guess = guess * rng.uniform(0.5, 5.0) + rng.normal(
            scale=10.0 ** rng.uniform(-9.0, 1.0), size=guess.shape
        )
        radii = solution_radii(grasp.configuration)
        row.unbalanced += 1
        row.unbalanced_proved += bool(
            certify_forces(task, other.state, radii, settings, squeeze.spin_arms_m, guess, wide)
        ) or isinstance(find_forces(task, other.state, settings, squeeze.spin_arms_m, wide), np.ndarray)


def _wide_points(task: Task, state: State, settings: HoldSettings) -> tuple[WidePoint, ...]:
    at = true_places(task, state, SolutionRadii(0.0, 0.0, 0.0, 0.0))
    return find_wide_points(ContactAreas(task, settings, at), state)


def _moved(state: State, rng: np.random.Generator) -> State:
    """Somewhere around: up to 0.1 rad, 3 mm and 0.3 of a patch."""
    size = SolutionRadii(0.1, 0.3, 3e-3, 0.3)
    axis = rng.normal(size=3)
    R = axis_rotation(axis / np.linalg.norm(axis), size.rotation * rng.uniform(-1.0, 1.0))
    return State(
        state.q + size.joints * rng.uniform(-1.0, 1.0, len(state.q)),
        R @ state.R_palm_object,
        state.p_palm_object + size.position * rng.uniform(-1.0, 1.0, 3),
        np.clip(state.params + size.parameters * rng.uniform(-1.0, 1.0, len(state.params)), 0.0, 1.0),
    )


def plant_intrusions(row: Row, grasps: list[ReadyGrasp], count: int, rng: np.random.Generator) -> None:
    """Asks for ways that pass through something."""
    for grasp, q, share in _ways(grasps, 20 * count, rng):
        if row.intrusions >= count:
            return
        configuration = grasp.configuration
        state = configuration.state
        there = State(q + share * (state.q - q), state.R_palm_object, state.p_palm_object, state.params)
        if room(configuration.task, there) > -1e-8:
            continue
        row.intrusions += 1
        way = Approach(True, 0.0, np.array([q, state.q]), None)
        row.intrusions_proved += bool(certify_clear(configuration, way))


def _ways(
    grasps: list[ReadyGrasp], count: int, rng: np.random.Generator
) -> Iterator[tuple[ReadyGrasp, np.ndarray, float]]:
    for _ in range(count if grasps else 0):
        grasp = grasps[int(rng.integers(len(grasps)))]
        limits = grasp.configuration.task.limits
        scale = 10.0 ** rng.uniform(-2.0, 0.0)
        q = np.clip(grasp.configuration.state.q + rng.normal(scale=scale, size=len(limits)), *limits.T)
        yield grasp, q, float(rng.uniform())


def room(task: Task, state: State) -> float:
    """FCL's least distance less what is allowed, over all pairs."""
    model, settings = collision_model(task), RetractionSettings()
    allowed = np.where(model.intended, settings.contact_depth_m, settings.depth_m) + model.stands_out_m
    placed = model.place(state)
    near = np.flatnonzero(lower_bounds(placed, model.piece_pairs) + allowed < 0.0)
    distances = measure(placed, model.piece_pairs[near]).distance_m
    return float((distances + allowed[near]).min(initial=np.inf))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tasks", nargs="*", default=list(TASKS))
    parser.add_argument("--count", type=int, default=16)
    parser.add_argument(
        "--planted", type=int, default=120, help="unbalanced ones, and intrusions, of each task"
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    rows = []
    for name in options.tasks:
        row = Row(name)
        rng = np.random.default_rng(options.seed)
        grasps = certify(row, load_task(name), options.count, options.seed)
        plant_unbalanced(row, grasps, options.planted, rng)
        plant_intrusions(row, grasps, options.planted, rng)
        rows.append(row)
        print(table([row]), flush=True)
    print(table(rows))
    if options.json:
        options.json.write_text(json.dumps([asdict(row) for row in rows], indent=1), "utf-8")


def table(rows: list[Row]) -> str:
    def most(values: list[float]) -> str:
        return f"{np.median(values):.0f}, {max(values):.0f}" if values else "-"

    head = (
        "task", "grasps", "slack >= 0.1 N", "of these stable", "stable", "by area", "ms", "clear", "proved",
        "ways",
        "proved", "ms", "accepted", "ms", "unbalanced proved", "intrusions proved",
    )  # fmt: skip
    body = [
        (
            row.task, str(row.grasps), str(row.with_slack), str(row.stable_of_these), str(row.stable),
            str(row.wide),
            most(row.stable_ms), str(row.clear), str(row.proved_clear), str(row.ways), str(row.proved_ways),
            most(row.clear_ms), f"{row.accepted} of {row.checked}", most(row.check_ms),
            f"{row.unbalanced_proved} of {row.unbalanced}", f"{row.intrusions_proved} of {row.intrusions}",
        )
        for row in rows
    ]  # fmt: skip
    return format_table(head, body)


if __name__ == "__main__":
    main()
