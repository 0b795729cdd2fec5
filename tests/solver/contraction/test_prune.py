"""Pruning keeps solutions, refutes what is empty, and splits without gaps."""

from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver import solve
from holdfast.solver.contraction.prune import Box, Pruner
from holdfast.solver.formulate.formulate import formulate
from holdfast.solver.linear.tighten import Tightener
from holdfast.solver.polynomial.canonical import CanonicalForm, canonical_form
from holdfast.solver.polynomial.polynomial import Polynomial
from holdfast.solver.polynomial.system import SystemBuilder


def planted(seed: int) -> tuple[CanonicalForm, np.ndarray, np.ndarray]:
    """Quadratic equations with a dyadic root; the form, its inputs, and the root with its products."""
    rng = np.random.default_rng(seed)
    n = 5
    root = rng.integers(-16, 17, n) / 8
    builder = SystemBuilder()
    variables = [builder.variable(f"x{i}", -3, 3) for i in range(n)]
    for _ in range(n - 1):
        value = Polynomial()
        for _ in range(4):
            i, j = rng.integers(0, n, 2)
            value = value + variables[i] * variables[j] * float(rng.integers(-4, 5)) + variables[i] * 0.5
        builder.equate(value - value.evaluate(root))
    system = builder.build()
    form = canonical_form(system)
    x = np.append(root, np.zeros(form.size - n))
    for k, i, j in form.products:
        x[k] = x[i] * x[j]
        assert Fraction(x[k]) == Fraction(x[i]) * Fraction(x[j])
    return form, system.inputs, x


def planted_on_patches(seed: int, exact) -> tuple[CanonicalForm, np.ndarray, np.ndarray]:
    """Equations of Bernstein functions with a dyadic root: as `planted`."""
    rng = np.random.default_rng(seed)
    root = rng.integers(0, 9, 4) / 8
    nets = [rng.integers(-8, 9, rng.integers(2, 5, 2)) / 4 for _ in range(6)]
    builder = SystemBuilder()
    parameters = [builder.variable(f"u{i}", 0.0, 1.0) for i in range(4)]
    pairs = [(0, 1), (2, 3), (0, 1), (2, 3), (0, 3), (1, 2)]
    values = [
        builder.bernstein(f"f{n}", parameters[i], parameters[j], net)
        for n, ((i, j), net) in enumerate(zip(pairs, nets, strict=True))
    ]
    x = np.append(root, np.zeros(6))
    for n, ((i, j), net) in enumerate(zip(pairs, nets, strict=True)):
        value = exact.bernstein(net, Fraction(root[i]), Fraction(root[j]))
        x[4 + n] = value
        assert Fraction(x[4 + n]) == value
    for n in (0, 2, 4):
        builder.equate(values[n] + values[n + 1] * 0.5 - (x[4 + n] + 0.5 * x[5 + n]))
    builder.equate(values[0] * parameters[2] - x[4] * x[2])
    system = builder.build()
    form = canonical_form(system)
    x = np.append(x, np.zeros(form.size - len(x)))
    for k, i, j in form.products:
        x[k] = x[i] * x[j]
        assert Fraction(x[k]) == Fraction(x[i]) * Fraction(x[j])
    return form, system.inputs, x


@pytest.fixture(params=[*(f"products {n}" for n in range(8)), *(f"functions {n}" for n in range(8))])
def rooted(request: pytest.FixtureRequest, exact) -> tuple[CanonicalForm, np.ndarray, np.ndarray]:
    """A form, its inputs, and a root of it."""
    kind, seed = request.param.split()
    return planted(int(seed)) if kind == "products" else planted_on_patches(int(seed), exact)


def holds(box: Box, x: np.ndarray) -> bool:
    return bool(np.all((box.lower <= x) & (x <= box.upper)))


def test_follows_a_root_down_the_tree(rooted):
    """Prune, split, go on with the half that holds the root: it is never lost, and boxes shrink to it."""
    form, inputs, root = rooted
    pruner = Pruner(form, inputs)
    box = pruner.root
    for step in range(60):
        assert holds(box, root)
        pruned = pruner.prune(box, tightened=(0, 2, 5)[step % 3])
        assert pruned is not None
        assert holds(pruned, root)
        assert np.all((box.lower <= pruned.lower) & (pruned.upper <= box.upper))
        if np.all((pruned.upper - pruned.lower)[inputs] < 1e-7):
            break
        halves = pruner.split(pruned)
        assert any(holds(half, root) for half in halves)
        box = next(half for half in halves if holds(half, root))
    assert pruner.lps > 0
    assert np.prod((box.upper - box.lower)[inputs]) < 1e-9


def test_random_boxes_with_the_root_keep_it(rooted):
    form, inputs, root = rooted
    pruner = Pruner(form, inputs)
    rng = np.random.default_rng(0)
    for _ in range(15):
        size = 10.0 ** rng.uniform(-9, 1, (2, form.size)) * (rng.uniform(size=(2, form.size)) < 0.9)
        box = Box(np.maximum(root - size[0], form.lower), np.minimum(root + size[1], form.upper))
        pruned = pruner.prune(box, tightened=4)
        assert pruned is not None
        assert holds(pruned, root)


def holds_point(box: Box, k: int) -> bool:
    return box.lower[k] <= box.point[k] <= box.upper[k]


def test_halves_cover_their_box():
    form, inputs, _ = planted(0)
    pruner = Pruner(form, inputs)
    box = pruner.prune(pruner.root, tightened=3)
    for _ in range(30):
        first, second = pruner.split(box)
        (k,) = np.flatnonzero((first.lower != second.lower) | (first.upper != second.upper))
        assert min(first.lower[k], second.lower[k]) == box.lower[k]
        assert max(first.upper[k], second.upper[k]) == box.upper[k]
        assert max(first.lower[k], second.lower[k]) == min(first.upper[k], second.upper[k])
        for half in (first, second):
            assert (half.upper - half.lower)[k] >= 0.29 * (box.upper - box.lower)[k]
        if box.point is not None and holds_point(box, k):
            assert first.lower[k] <= box.point[k] <= first.upper[k]
        box = second


def test_an_empty_box_is_refuted_by_linear_programs_where_propagation_is_blind():
    builder = SystemBuilder()
    x, y, z = (builder.variable(name, 0, 1) for name in "xyz")
    builder.equate(x + y - 1.0)
    builder.equate(y + z - 1.0)
    builder.equate(x + z - 1.0)
    builder.equate(x + y + z - 1.25)
    system = builder.build()
    pruner = Pruner(canonical_form(system), system.inputs)
    assert pruner.prune(pruner.root, tightened=0) is not None
    assert pruner.prune(pruner.root, tightened=3) is None


def test_linear_programs_tighten_what_propagation_can_not():
    builder = SystemBuilder()
    x, y = builder.variable("x", 0, 1), builder.variable("y", 0, 1)
    builder.equate(x + y - 1.0)
    builder.equate(x - y)
    form = canonical_form(builder.build())
    lower, upper = form.lower.copy(), form.upper.copy()
    point = Tightener(form).tighten(lower, upper, lambda _: np.array([0, 1]))
    assert point == pytest.approx([0.5, 0.5])
    assert lower == pytest.approx([0.5, 0.5], abs=1e-9)
    assert upper == pytest.approx([0.5, 0.5], abs=1e-9)
    assert holds(Box(lower, upper), np.array([0.5, 0.5]))


def test_certified_configurations_survive_pruning_of_the_grasp_system(upholding):
    formulation = formulate(upholding)
    form = canonical_form(formulation.system)
    pruner = Pruner(form, formulation.system.inputs)
    rng = np.random.default_rng(0)
    for configuration in solve(upholding, candidates=3).configurations:
        low, high = configuration.certificate.lower, configuration.certificate.upper
        n = len(low)
        box = pruner.root
        for _ in range(12):
            pruned = pruner.prune(box, tightened=4)
            assert pruned is not None
            assert np.all((pruned.lower[:n] <= high) & (low <= pruned.upper[:n]))
            # Cut off a random part that holds nothing of the certificate's box.
            lower, upper = pruned.lower.copy(), pruned.upper.copy()
            k = rng.choice(formulation.system.inputs, 6, replace=False)
            lower[k] = np.maximum(
                lower[k], low[k] - rng.uniform(0, 0.5, 6) * np.maximum(low[k] - lower[k], 0)
            )
            upper[k] = np.minimum(
                upper[k], high[k] + rng.uniform(0, 0.5, 6) * np.maximum(upper[k] - high[k], 0)
            )
            box = Box(lower, upper)


def test_a_witness_goes_with_its_half_and_spares_the_linear_programs():
    form, inputs, root = planted(0)
    pruner = Pruner(form, inputs)
    box = pruner.prune(pruner.root, tightened=3, witnesses=lambda point, lower, upper: root)
    assert box is not None
    assert pruner.lps == 1
    while np.any((box.upper - box.lower)[inputs] > 0.01):
        pruned = pruner.prune(box, tightened=3)
        assert pruned is not None
        assert holds(pruned, root)
        box, other = pruner.split(pruned)
        assert box.witness is not None
        assert other.witness is None
    assert pruner.lps == 1


def test_inputs_alone_are_split_where_that_is_asked_for():
    builder = SystemBuilder()
    x, y = builder.variable("x", -1, 1), builder.variable("y", -1, 1)
    s = builder.define("s", x + y)
    builder.equate(s * s - x * y - 0.3)
    system = builder.build()
    form = canonical_form(system)
    point = np.zeros(form.size)
    point[3:] = 1.0, 0.1  # the relaxation is most wrong about s^2, and then about x y
    box = Box(form.lower, form.upper, point)
    assert Pruner(form, system.inputs).cut(box)[0] == 2
    assert Pruner(form, system.inputs, only_inputs=True).cut(box)[0] in system.inputs
