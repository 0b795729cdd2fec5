"""The largest load: climbed to, refuted above, and what follows from other forces, masses and frictions."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.geometry import cone_edges, even_directions, perpendicular
from holdfast.objects import SIX, LiftTest, Task, load_task
from holdfast.solver.search import SearchOrder
from holdfast.solver.statics import best_load, why_no_load
from holdfast.solver.statics.load.climb import LoadClimber
from holdfast.solver.statics.load.point import carried_load
from holdfast.solver.statics.load.problem import load_problem
from holdfast.solver.statics.load.worker import LoadSetup
from holdfast.solver.statics.power import point_power
from holdfast.solver.statics.search import StaticsSearch
from holdfast.solver.statics.surface import point_and_normal
from scipy.optimize import linprog

from .twins import LIMITS, caps, pinch

FORCE_N = 30.0


def with_friction(task: Task, mu: float) -> Task:
    return replace(task, object=replace(task.object, friction=mu))


def heavier(task: Task, by: float) -> Task:
    parts = tuple(
        replace(part, inertia=replace(part.inertia, mass=by * part.inertia.mass))
        for part in task.object.parts
    )
    return replace(task, object=replace(task.object, parts=parts))


def pinched_N(mu: float, force_N: float) -> float:
    """Of points that face each other: how near a double cone, F high and 2 mu F wide, comes to its middle."""
    return 2.0 * mu * force_N / np.sqrt(1.0 + 4.0 * mu**2)


class Edges:
    """Contacts at points with cones of edges, whose wrenches a linear program adds up: an oracle."""

    def __init__(self, climber: LoadClimber, root: int, params: np.ndarray, *, outside: bool):
        problem = climber.problem
        blocks = []
        for (points, normals), (u, v), arm in zip(
            climber.chosen(root), params.reshape(-1, 2), problem.arms, strict=True
        ):
            p, n, _, _ = point_and_normal(points, normals, u, v)
            e = cone_edges(problem.friction, problem.friction * arm, 2, outside=outside)
            f = np.column_stack([n, *perpendicular(n)]) @ e[:3]
            blocks.append(np.vstack([f, np.cross(p, f.T).T + np.outer(n, e[3])]))
        self.wrenches, k = np.hstack(blocks), blocks[0].shape[1]
        self.shares = np.kron(np.eye(len(blocks)), np.ones(k))
        self.forces, self.weight = problem.forces_N, problem.weight_N

    def along(self, direction: np.ndarray) -> tuple[float, np.ndarray]:
        """The largest multiple along a direction, and a normal across which no more than that is carried."""
        column = np.append(-direction, np.zeros(3))[:, None]
        found = linprog(
            np.append(np.zeros(self.wrenches.shape[1]), -1.0),
            A_ub=np.hstack([self.shares, np.zeros((len(self.shares), 1))]),
            b_ub=self.forces,
            A_eq=np.hstack([self.wrenches, column]),
            b_eq=np.zeros(6),
            method="highs",
        )
        y = found.eqlin.marginals[:3]
        return -found.fun / self.weight, y / max(np.linalg.norm(y), 1e-300)

    def is_at_most(self, multiple: float, first: np.ndarray | None = None) -> bool:
        """Whether some direction is found along which no more is carried."""
        for start in [*([] if first is None else [first]), *even_directions(0)]:
            direction = start
            for _ in range(8):
                carried, normal = self.along(direction)
                if carried <= multiple:
                    return True
                direction = normal if normal @ direction > 0.0 else -normal
        return False


@pytest.mark.parametrize("mu", [0.3, pytest.param(1.5, marks=pytest.mark.slow)])
def test_two_points_that_face_each_other_are_known(mu):
    task = with_friction(pinch(0.0), mu)
    best = best_load(task, max_force_N=FORCE_N, gap=1e-3, budget_s=60.0)
    known = pinched_N(mu, FORCE_N) / (9.81 * task.object.inertia.mass)
    assert np.isclose(best.value, known, rtol=5e-4) and best.value <= known * (1.0 + 1e-9)
    assert known * (1.0 - 1e-12) <= best.bound <= known * 1.002 and best.gap <= 1e-3
    assert best.carries_nothing is False and f"with {FORCE_N:g} N a contact" in str(best)


@pytest.mark.parametrize("name", ["upholding", pytest.param("handling", marks=pytest.mark.slow)])
def test_value_and_bound_meet_and_no_sampled_points_beat_the_bound(name):
    task = load_task(name)
    best = best_load(task, budget_s=120.0)
    assert best.force_N == task.hand.rated_force_N == 30.0
    assert 0.0 < best.value <= best.bound and best.gap <= 0.02
    values, bounds = zip(*[(now.value, now.bound) for now in best.history], strict=True)
    assert list(values) == sorted(values) and list(bounds) == sorted(bounds, reverse=True)
    climber, rng = LoadClimber(load_problem(task)), np.random.default_rng(3)
    # Cones of edges outside carry more, those of edges inside less.
    outside = Edges(climber, best.example.root, best.example.params, outside=True)
    assert min(outside.along(d)[0] for d in even_directions(1)) >= best.value * (1.0 - 1e-6)
    inside = Edges(climber, best.example.root, best.example.params, outside=False)
    assert inside.is_at_most(best.bound)
    for _ in range(40):
        assert Edges(climber, *climber.random(rng), outside=False).is_at_most(best.bound)


@pytest.mark.parametrize("seed", range(3))
def test_what_points_carry_lies_between_cones_of_edges(seed):
    climber, rng = LoadClimber(load_problem(load_task("incision"))), np.random.default_rng(seed)
    point = climber.start(rng, 6)
    least, most, twist = climber.carried(*point)
    assert 0.0 < least <= most <= least * 1.001
    outside, inside = (Edges(climber, *point, outside=side) for side in (True, False))
    directions = [*even_directions(1), -twist[:3] / np.linalg.norm(twist[:3])]
    assert min(outside.along(d)[0] for d in directions) >= least * (1.0 - 1e-6)
    assert inside.is_at_most(most * (1.0 + 1e-6), directions[-1])
    # The descent never goes below what is carried, and mostly ends there.
    about, found = climber.least_twist(*point)
    assert least * (1.0 - 1e-6) <= about <= least * 1.2 and found[:3].any()


@pytest.mark.slow
def test_forces_scale_and_mass_divides():
    task = load_task("handling")
    usual = best_load(task, max_force_N=10.0, budget_s=120.0)
    stronger = best_load(task, max_force_N=25.0, budget_s=120.0)
    heavy = best_load(heavier(task, 4.0), max_force_N=10.0, budget_s=120.0)
    for other, factor in ((stronger, 2.5), (heavy, 0.25)):
        assert np.isclose(other.value, factor * usual.value, rtol=0.01)
        assert other.value <= factor * usual.bound and factor * usual.value <= other.bound


@pytest.mark.parametrize("name", sorted(LIMITS))
def test_below_the_least_friction_nothing_is_carried(name):
    below = best_load(with_friction(load_task(name), 0.97 * LIMITS[name]), budget_s=120.0)
    assert below.bound == below.value == below.gap == 0.0 and below.example is None
    assert "next to none of its weight" in str(below) and below.carries_nothing
    above = best_load(with_friction(load_task(name), 1.1 * LIMITS[name]), budget_s=120.0, gap=0.9)
    assert above.value > 0.0


def test_points_that_carry_nothing():
    maps = np.array([point_power(p, np.array([0.0, 0.0, 1.0])) for p in np.eye(3)[:2]])
    assert carried_load(maps, np.zeros(2), 0.5, np.ones(2)).least == 0.0
    best = best_load(pinch(0.5 * np.pi), max_force_N=FORCE_N, budget_s=20.0)
    assert best.value == 0.0 and best.example is None


@pytest.mark.slow
def test_caps_are_bounded_too():
    best = best_load(caps(0.3, 0.4), max_force_N=FORCE_N, gap=0.06, budget_s=120.0)
    assert 0.0 < best.value <= best.bound and best.gap <= 0.06
    # Points within both caps face each other over the middle: nothing carries more than these.
    known = pinched_N(0.6, FORCE_N) / (9.81 * load_task("upholding").object.inertia.mass)
    assert best.value <= known * 1.001


def test_which_directions_a_test_has():
    task = load_task("handling")
    problem = load_problem(task)
    assert np.isclose(problem.cosine, 1.0 / np.sqrt(3.0))
    wide = replace(task, test=LiftTest(directions=tuple(map(tuple, even_directions(1).tolist()))))
    assert 0.9 < load_problem(wide).cosine < 1.0
    for few in (SIX[:4], SIX[:1], ((0.0, 0.0, 1.0),) * 5, SIX[:5]):
        reason = why_no_load(replace(task, test=LiftTest(directions=few)))
        assert "few directions" in reason
    for name in ("service", "tuning", "playing"):
        assert why_no_load(load_task(name))
        with pytest.raises(InputError, match="nothing is said"):
            best_load(load_task(name))


def test_the_largest_force_must_be_known():
    task = load_task("handling")
    unrated = replace(task, hand=replace(task.hand, rated_force_N=None))
    with pytest.raises(InputError, match=r"--max-force"):
        best_load(unrated)
    assert load_problem(unrated, max_force_N=7.0).forces_N.tolist() == [7.0] * 3
    own = replace(task, max_normal_force_N=12.0)
    assert load_problem(own).forces_N.tolist() == [12.0] * 3


@pytest.mark.parametrize(
    "bad",
    [
        {"gap": 0.0}, {"gap": float("nan")}, {"seed": -1}, {"workers": 0}, {"max_force_N": 0.0},
        {"max_force_N": float("inf")}, {"budget_s": -1.0},
    ],
)  # fmt: skip
def test_arguments_that_cannot_be_used(bad):
    with pytest.raises(InputError):
        best_load(load_task("upholding"), **bad)


def search(**options) -> StaticsSearch:
    problem = load_problem(load_task("incision"))
    setup = LoadSetup(problem=problem, limit=56.0, known=1e9, order=SearchOrder.BEST_FIRST)
    return StaticsSearch(setup, **options)


def what(done: StaticsSearch) -> tuple[float, int, int]:
    """What a search has shown, and how far it went for that."""
    return done.shown, done.state.processed, done.state.depth


def until(count: int, one: StaticsSearch) -> StaticsSearch:
    one.finish(budget_s=120.0, enough=lambda: one.state.processed >= count)
    return one


@pytest.mark.slow
@pytest.mark.usefixtures("at_once")
def test_the_same_with_workers():
    assert what(until(40, search(workers=2))) == what(until(40, search()))


def test_the_same_after_a_checkpoint(tmp_path):
    path = tmp_path / "search.ckpt"
    until(15, search(checkpoint=path))
    assert what(until(40, search(checkpoint=path, resume=True))) == what(until(40, search()))


def test_best_goes_on_from_a_checkpoint(tmp_path):
    task, path = load_task("handling"), tmp_path / "best.ckpt"
    begun = best_load(task, checkpoint=path, should_stop=lambda: True)
    assert begun.progress.boxes > 0 and begun.gap > 0.02
    resumed = best_load(task, checkpoint=path, resume=True, budget_s=120.0)
    assert resumed.gap <= 0.02 and resumed.progress.boxes > begun.progress.boxes
    with pytest.raises(InputError, match="another task"):
        best_load(task, max_force_N=29.0, checkpoint=path, resume=True)


def test_sides_are_split_of_which_bounds_gain():
    """Four contacts on whole regions: a fifth above what is carried is refuted in few boxes.

    By how powers differ, thousands of boxes left the bound 50 % above it.
    """
    task = replace(load_task("incision"), test=LiftTest())
    found = best_load(task, max_force_N=30.0, gap=0.25, budget_s=120.0)
    assert found.gap <= 0.25 and found.value > 40.0
    assert found.progress.boxes < 1000
