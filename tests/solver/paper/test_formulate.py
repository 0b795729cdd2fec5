"""The formulation of the paper: its counts, its equations at certified configurations, its dimension.

Tasks are planted: a state is drawn first, and each object region is laid against the hand at that state.
"""

import dataclasses
import importlib.util
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from holdfast.errors import HoldfastError
from holdfast.geometry import BezierPatch, Cap, Patch, PointRegion, Region
from holdfast.geometry.bernstein import bernstein
from holdfast.geometry.transforms import perpendicular, rotation_exp
from holdfast.hands import Axis, Hand, HandRegion, forward_kinematics
from holdfast.objects import Contact, ObjectRegion, Task
from holdfast.solver import ContactManifold, State, certify_state, solve
from holdfast.solver.certify.krawczyk import ExistenceTest
from holdfast.solver.enclosure.straight_line import StraightLineProgram
from holdfast.solver.formulate.formulate import formulate
from holdfast.solver.paper.formulate import PaperFormulation, formulate_paper
from holdfast.solver.polynomial.system import BernsteinFunction, PolynomialSystem

Array = np.ndarray
Side = tuple[str, Region]  # link and region

# With the motions of the whole that each leaves out of the printed d.
MOTIONS = {(False, False): 0, (False, True): 6, (True, False): 3, (True, True): 6}
VARIANTS = [{"eliminate_r": eliminate_r, "fix_palm": fix_palm} for eliminate_r, fix_palm in MOTIONS]


def name_variant(variant: dict[str, bool]) -> str:
    return "-".join(key for key, value in variant.items() if value) or "printed"


def cap(half_angle_deg: float, axis: tuple[float, float, float] = (0.14, 0.0, 0.99)) -> Cap:
    return Cap(
        np.array([0.02, 0.0, 0.0]),
        0.013,
        np.array(axis) / np.linalg.norm(axis),
        np.radians(half_angle_deg),
        True,
    )


PALM = Cap(np.array([0.00255, 0.0, 0.117]), 0.018, np.array([1.0, 0.0, 0.0]), 0.5 * np.pi, True)
# Links in contact and printed (n_v, n_e, d) of the nine tasks, Table 2.
NINE_TASKS: dict[str, tuple[list[Side], tuple[int, int, int]]] = {
    "upholding": ([("index_distal", cap(60)), ("thumb_distal", cap(60))], (219, 209, 17)),
    "handling": ([("middle_distal", cap(180)), ("thumb_distal", cap(60)), ("palm", PALM)], (243, 235, 16)),
    "incision": (
        [("middle_distal", cap(90)), ("index_distal", cap(90)), ("thumb_distal", cap(60)), ("palm", PALM)],
        (331, 324, 18),
    ),
    "lid lifting": ([("index_distal", cap(60)), ("thumb_distal", cap(60))], (219, 209, 17)),
    "service": (
        [("middle_distal", cap(90, (0, -1, 0))), ("index_medial", cap(90)), ("thumb_distal", cap(90))],
        (288, 278, 19),
    ),
    "transportation": (
        [("ring_distal", cap(90)), ("middle_distal", cap(90)), ("index_distal", cap(90)), ("palm", PALM)],
        (312, 305, 17),
    ),
    "tuning": ([("index_distal", cap(11.25, (0, -1, 0))), ("thumb_distal", cap(90))], (219, 209, 17)),
    "playing": (
        [("middle_distal", cap(90)), ("index_distal", cap(90)), ("thumb_distal", cap(90))],
        (307, 298, 19),
    ),
    "holding": (
        [("middle_distal", cap(90)), ("index_distal", cap(90)), ("thumb_distal", cap(90)), ("palm", PALM)],
        (331, 324, 18),
    ),
}


def quadratic_pad() -> Patch:
    """A domed 3 x 3 net on the pad of a distal link."""
    x, y = np.meshgrid([0.005, 0.018, 0.031], [-0.009, 0.0, 0.009], indexing="ij")
    dome = np.array([[0.010, 0.013, 0.010], [0.013, 0.018, 0.012], [0.008, 0.011, 0.009]])
    return Patch(BezierPatch(np.stack([x, y, dome], axis=-1)), off_surface=True)


def tangent_patch(point: Array, normal: Array, params: Array, degree: int) -> Patch:
    """A saddle of `degree` through the point at the given parameters, where it has the given normal."""
    t = np.linspace(0.0, 1.0, degree + 1)
    u, v = np.meshgrid(t - params[0], t - params[1], indexing="ij")
    a, b = perpendicular(normal)
    height = 0.1 * u * v + (0.2 * u * u - 0.1 * v * v if degree > 1 else 0.0)
    grid = point + 0.02 * (u[..., None] * a + v[..., None] * b + height[..., None] * normal)
    weights = np.linalg.inv(bernstein(degree, t))
    return Patch(BezierPatch(np.einsum("ia,jb,abk->ijk", weights, weights, grid)), off_surface=True)


@pytest.fixture
def plant(upholding: Task) -> Callable[..., tuple[Task, State]]:
    """A task with a state that solves it, from the hand's sides of its contacts."""

    def make(
        sides: list[Side], *, degree: int = 1, seed: int = 0, hand: Hand = upholding.hand
    ) -> tuple[Task, State]:
        rng = np.random.default_rng(seed)
        low, high = hand.limits.T
        q = rng.uniform(low + 0.1 * (high - low), high - 0.1 * (high - low))
        Ts = forward_kinematics(hand, hand.expand(q))
        R, p = rotation_exp(rng.normal(size=3)), rng.normal(size=3) * 0.1
        contacts, params = [], []
        for k, (name, region) in enumerate(sides):
            link = hand.link_index(name)
            if isinstance(region, Patch):
                on_hand = rng.uniform(0.2, 0.8, 2)
                point, normal = region.patch.evaluate(*on_hand), region.patch.unit_normal(*on_hand)
                params.append(on_hand)
            else:
                points, normals = region.sample(1, rng)
                point, normal = points[0], normals[0]
            T = Ts[link]
            on_object = rng.uniform(0.2, 0.8, 2)
            o = R.T @ (T[:3, :3] @ point + T[:3, 3] - p)
            patch = tangent_patch(o, -R.T @ T[:3, :3] @ normal, on_object, degree)
            params.append(on_object)
            contacts.append(Contact(HandRegion(f"h{k}", link, region), ObjectRegion(f"o{k}", patch)))
        task = dataclasses.replace(upholding, hand=hand, contacts=tuple(contacts), limits=hand.limits)
        configuration = certify_state(ContactManifold(task), State(q, R, p, np.concatenate(params)))
        assert configuration.certified
        return task, configuration.state

    return make


def residuals(system: PolynomialSystem, x: Array) -> Array:
    """Values of all equations, definitions and redundant ones included."""
    values = [p.evaluate(x) for p in (*system.equations, *system.redundant)]
    for k, value in system.definitions.items():
        if isinstance(value, BernsteinFunction):
            m, n = np.array(value.coefficients.shape) - 1
            values.append(bernstein(m, x[value.i]) @ value.coefficients @ bernstein(n, x[value.j]) - x[k])
        else:
            values.append(value.evaluate(x) - x[k])
    return np.array(values)


def rank(system: PolynomialSystem, x: Array, *, redundant: bool) -> int:
    """Numerical rank of the equations' derivatives by the inputs."""
    if redundant:
        system = dataclasses.replace(system, equations=system.equations + system.redundant)
    enclosure = StraightLineProgram(system).enclose(x, x)
    sizes = np.linalg.svd(0.5 * (enclosure.slope_lower + enclosure.slope_upper), compute_uv=False)
    assert np.all((sizes > 1e-5 * sizes[0]) | (sizes < 1e-11 * sizes[0]))
    return int(np.sum(sizes > 1e-8 * sizes[0]))


def check_solution(formulation: PaperFormulation, state: State) -> Array:
    """All equations hold to 1e-9, inside the initial box, with all inequalities."""
    x, system = formulation.inputs_from_state(state), formulation.system
    assert np.abs(residuals(system, x)).max() < 1e-9
    assert np.all(x >= system.lower)
    assert np.all(x <= system.upper)
    assert all(p.evaluate(x) >= 0.0 for p in system.inequalities)
    return x


@pytest.mark.parametrize("name", NINE_TASKS)
def test_counts_of_the_nine_tasks(name: str, plant: Callable[..., tuple[Task, State]]) -> None:
    sides, printed = NINE_TASKS[name]
    formulation = formulate_paper(plant(sides)[0])
    system = formulation.system
    assert len(system.names) == printed[0]
    sines = formulation.n_couplings
    assert len(system.definitions) + len(system.equations) + len(system.redundant) - sines == printed[1]
    assert (formulation.n_v, formulation.n_e, formulation.d) == printed
    n_joints = len({angle.child for angle in formulation.angles})
    n_revolute = 2 * n_joints - len(formulation.angles)
    # "As many redundant equations as joints and contacts": of the joints, only revolute ones have (9).
    assert len(system.redundant) == n_revolute + len(sides) + sines
    assert formulation.d == formulation.n_v - formulation.n_e + n_revolute + len(sides)


@pytest.mark.parametrize("variant", VARIANTS, ids=name_variant)
@pytest.mark.parametrize("name", ["upholding", "handling", "service", "holding"])
def test_a_certified_configuration_solves_every_equation(
    name: str, variant: dict[str, bool], plant: Callable[..., tuple[Task, State]]
) -> None:
    task, state = plant(NINE_TASKS[name][0])
    formulation = formulate_paper(task, **variant)
    x = check_solution(formulation, state)
    # The same point is a true solution of the paper's system as well, by its own Krawczyk test.
    assert ExistenceTest(StraightLineProgram(formulation.system)).prove(x) is not None


@pytest.mark.parametrize("name", NINE_TASKS)
def test_dimension_is_the_numerical_one(name: str, plant: Callable[..., tuple[Task, State]]) -> None:
    sides, printed = NINE_TASKS[name]
    task, state = plant(sides)
    for eliminate_r in (False, True):
        formulation = formulate_paper(task, eliminate_r=eliminate_r, fix_palm=True)
        x, system = formulation.inputs_from_state(state), formulation.system
        assert len(system.inputs) - rank(system, x, redundant=True) == printed[2] - 6
        assert rank(system, x, redundant=False) == len(system.equations)
        assert formulation.d == printed[2] - 6 == formulate(task).system.dimension


@pytest.mark.parametrize("variant", VARIANTS, ids=name_variant)
def test_dimension_of_each_variant(
    variant: dict[str, bool], plant: Callable[..., tuple[Task, State]]
) -> None:
    motions = MOTIONS[variant["eliminate_r"], variant["fix_palm"]]
    task, state = plant(NINE_TASKS["upholding"][0])
    formulation = formulate_paper(task, **variant)
    x, system = formulation.inputs_from_state(state), formulation.system
    assert formulation.d == 17 - motions
    assert len(system.inputs) - rank(system, x, redundant=True) == 17 - motions


def test_elimination_removes_three_variables_a_link(plant: Callable[..., tuple[Task, State]]) -> None:
    task, _ = plant(NINE_TASKS["incision"][0])
    whole, closed = formulate_paper(task), formulate_paper(task, eliminate_r=True)
    n_links = 12 + 1 - 3 + 2  # thumb base, thumb, index, middle, palm and object
    assert whole.n_v - closed.n_v == 3 * n_links
    assert whole.n_e - closed.n_e == 3 * (n_links - 1)
    assert not any(" r" in name for name in closed.system.names)
    # Loops of the four contacts: three closures of three components stand for (8), (10) and (15).
    assert max(len(p.variables) for p in closed.system.equations) > 30


@pytest.mark.parametrize("variant", VARIANTS, ids=name_variant)
@pytest.mark.parametrize("degree", [1, 2, 3])
def test_bezier_pads_on_the_hand_count_and_hold_as_caps_do(
    degree: int, variant: dict[str, bool], plant: Callable[..., tuple[Task, State]]
) -> None:
    pads: list[Side] = [("index_distal", quadratic_pad()), ("thumb_distal", quadratic_pad())]
    task, state = plant(pads, degree=degree)
    formulation = formulate_paper(task, **variant)
    x = check_solution(formulation, state)
    with_caps = formulate_paper(plant(NINE_TASKS["upholding"][0])[0], **variant)
    assert (formulation.n_v, formulation.n_e, formulation.d) == (with_caps.n_v, with_caps.n_e, with_caps.d)
    assert len(formulation.system.inputs) - rank(formulation.system, x, redundant=True) == formulation.d


def test_points_with_normals_need_no_variables(plant: Callable[..., tuple[Task, State]]) -> None:
    point = PointRegion(np.array([0.02, 0.0, 0.013]), np.array([0.0, 0.0, 1.0]), True)
    task, state = plant([("index_distal", point), ("thumb_distal", cap(90))], degree=2)
    formulation = formulate_paper(task)
    check_solution(formulation, state)
    assert (formulation.n_v, formulation.n_e, formulation.d) == (219 - 12, 209 - 10, 17 - 2)


def test_a_turned_object_or_a_joint_past_its_limit_is_no_solution(
    plant: Callable[..., tuple[Task, State]],
) -> None:
    task, state = plant(NINE_TASKS["upholding"][0])
    for variant in ({}, {"eliminate_r": True}):
        formulation = formulate_paper(task, **variant)
        turned = dataclasses.replace(
            state, R_palm_object=rotation_exp(np.array([0.01, 0.0, 0.0])) @ state.R_palm_object
        )
        assert np.abs(residuals(formulation.system, formulation.inputs_from_state(turned))).max() > 1e-3
        for j, name in enumerate(task.hand.independent_names):
            if not name.startswith(("index", "thumb")):
                continue
            for limit, step in zip(task.limits[j], (-0.01, 0.01), strict=True):
                q = np.array(state.q)
                q[j] = limit + step
                x = formulation.inputs_from_state(dataclasses.replace(state, q=q))
                c = formulation.variables[f"joint {name} c"]
                assert x[c] < formulation.system.lower[c], name
                q[j] = limit
                x = formulation.inputs_from_state(dataclasses.replace(state, q=q))
                assert x[c] >= formulation.system.lower[c], name


def test_equal_sines_tell_mirrored_angles_apart(plant: Callable[..., tuple[Task, State]]) -> None:
    """With cosines alone a distal angle mirrored about the middle of its limits would pass."""
    task, state = plant(NINE_TASKS["upholding"][0])
    hand = task.hand
    k = hand.joint_names.index("index_dip")
    axis = hand.axes[k]
    mirror = dataclasses.replace(
        axis, coupling=dataclasses.replace(axis.coupling, ratio=-1.0, offset=axis.lower + axis.upper)
    )
    formulation = formulate_paper(task)
    other = with_axes(hand, "index_distal", (mirror,))
    opposed = dataclasses.replace(formulation, task=dataclasses.replace(task, hand=other))
    x = opposed.inputs_from_state(state)
    couplings = formulation.system.equations, formulation.system.redundant
    broken = [
        sum(abs(p.evaluate(x)) > 1e-9 for p in group if _couples(formulation, p)) for group in couplings
    ]
    assert broken == [0, 1]
    # A hand that is coupled so solves the system written for it, with sines opposed.
    own = formulate_paper(opposed.task)
    coupled = [p for p in (*own.system.equations, *own.system.redundant) if _couples(own, p)]
    assert len(coupled) == 4
    assert max(abs(p.evaluate(own.inputs_from_state(state))) for p in coupled) < 1e-12


def _couples(formulation: PaperFormulation, polynomial: object) -> bool:
    """Whether an equation mentions vectors or cosines of two joints, as couplings alone do."""
    names = {formulation.system.names[i] for i in polynomial.variables}  # type: ignore[attr-defined]
    return len({name.split()[1] for name in names if name.startswith("joint ")}) == 2


def with_axes(hand: Hand, link_name: str, axes: tuple[Axis, ...]) -> Hand:
    """The hand with other axes on one link."""
    return dataclasses.replace(
        hand, links=tuple(dataclasses.replace(x, axes=axes) if x.name == link_name else x for x in hand.links)
    )


def test_a_fixed_link_adds_nothing(upholding: Task, plant: Callable[..., tuple[Task, State]]) -> None:
    stiff = with_axes(upholding.hand, "thumb_distal", ())
    task, state = plant(NINE_TASKS["upholding"][0], hand=stiff)
    for eliminate_r in (False, True):
        check_solution(formulate_paper(task, eliminate_r=eliminate_r), state)
    formulation = formulate_paper(task)
    # A link, a revolute joint and a coupling less; d loses nothing, for the joint was coupled.
    counts = (formulation.n_v, formulation.n_e, formulation.d)
    assert counts == (219 - 12 - 7, 209 - 6 - 13 - 1, 17)


def test_joints_that_the_paper_does_not_treat_are_refused(upholding: Task) -> None:
    hand = upholding.hand
    dip, medial, proximal = (
        hand.links[hand.link_index(f"index_{x}")] for x in ("distal", "medial", "proximal")
    )
    assert dip.axes[0].coupling is not None
    doubled = dataclasses.replace(dip.axes[0], coupling=dataclasses.replace(dip.axes[0].coupling, ratio=2.0))
    oblique = dataclasses.replace(proximal.axes[1], direction=np.array([0.6, 0.8, 0.0]))
    oblique = dataclasses.replace(oblique, direction=oblique.direction @ proximal.T_parent_link0[:3, :3])
    cases = [
        (medial, (dataclasses.replace(medial.axes[0], kind="prismatic"),), "index_medial: .* no prismatic"),
        (proximal, (proximal.axes[0], oblique), "index_proximal: .* must be perpendicular"),
        (dip, (doubled,), "joint index_dip: .* not at a ratio of 2"),
    ]
    for link, axes, message in cases:
        task = dataclasses.replace(upholding, hand=with_axes(hand, link.name, axes))
        with pytest.raises(HoldfastError, match=message):
            formulate_paper(task)


@pytest.fixture(scope="module")
def paper_tasks() -> ModuleType:
    path = Path(__file__).parents[3] / "benchmarks" / "parts" / "paper_tasks.py"
    spec = importlib.util.spec_from_file_location("paper_tasks", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def check_benchmark(task: Task, printed: tuple[int, int, int]) -> None:
    result = solve(task, candidates=1)
    assert result.configurations
    for eliminate_r in (False, True):
        formulation = formulate_paper(task, eliminate_r=eliminate_r)
        check_solution(formulation, result.configurations[0].state)
    whole = formulate_paper(task)
    assert (whole.n_v, whole.n_e, whole.d) == printed


def test_the_stand_ins_have_the_printed_counts_and_solutions(paper_tasks: ModuleType) -> None:
    for name, task in paper_tasks.stand_in_tasks().items():
        check_benchmark(task, paper_tasks.TABLE_2[name])


def test_the_published_tasks_have_the_printed_counts_and_solutions(
    paper_tasks: ModuleType, published_data: Path
) -> None:
    tasks = paper_tasks.load_paper_tasks(published_data / "paper_tasks.json")
    assert len(tasks) == 7
    for name, task in tasks.items():
        check_benchmark(task, paper_tasks.TABLE_2[name])


def test_a_missing_file_of_published_numbers_is_named(paper_tasks: ModuleType, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"nothing.json: the published numbers .* are not shipped"):
        paper_tasks.load_paper_tasks(tmp_path / "nothing.json")
