"""Polynomial frames against forward kinematics."""

import numpy as np
import pytest
from holdfast.geometry.transforms import axis_rotation, pose
from holdfast.hands import Axis, Coupling, Hand, Link, forward_kinematics
from holdfast.solver.formulate.link_frames import ChainBuilder
from holdfast.solver.polynomial.system import SystemBuilder

X, Y, Z = np.eye(3)
OBLIQUE = np.array([2.0, -1.0, 2.0]) / 3.0


def axis(name, direction, lower=-1.0, upper=1.0, kind="revolute", coupling=None):
    return Axis(name, kind, np.array(direction), lower, upper, coupling, None)


@pytest.fixture(scope="module")
def odd_hand(upholding) -> Hand:
    """One chain with a slide, a universal joint, couplings of every kind, and axes nearly parallel."""
    inertia = upholding.hand.links[0].inertia
    rng = np.random.default_rng(0)

    def link(name, parent, axes, direction=OBLIQUE, turn=0.0):
        T = pose(axis_rotation(np.array(direction), turn), rng.normal(size=3) * 0.03)
        return Link(name, parent, T, tuple(axes), (), inertia)

    askew = np.array([np.sin(1e-7), np.cos(1e-7), 0.0])
    links = (
        Link("palm", -1, np.eye(4), (), (), inertia),
        link("carriage", 0, [axis("slide", OBLIQUE, -0.02, 0.03, "prismatic")], turn=0.7),
        link("base", 1, [axis("abduction", X), axis("flexion", Y, -0.5, 0.6)], turn=-0.4),
        link("double", 2, [axis("double", Y, -9, 9, coupling=Coupling("flexion", 2.0, 0.1))], Y, 0.3),
        link("reverse", 3, [axis("reverse", -Y, -9, 9, coupling=Coupling("flexion", -1.0))], Y, -0.8),
        link("askew", 4, [axis("askew", askew)], Y, 0.2),
        link("rigid", 5, []),
        link("telescope", 6, [axis("half", Z, -9, 9, "prismatic", Coupling("slide", -0.5, 0.01))], turn=1.0),
        link("tip", 7, [axis("tip", OBLIQUE, -3.0, 3.0)], turn=0.5),
        # A second branch, from the middle of the first.
        link("thumb", 2, [axis("thumb", Z, 2.0, 4.0)], turn=2.0),
        link("thumb tip", 9, [axis("thumb tip", Z, -9, 9, coupling=Coupling("thumb", 1.0, -2.5))], Z, 0.1),
    )
    return Hand("odd", links, {})


def inputs(chain: ChainBuilder, size: int, q: np.ndarray, unit_m: float) -> np.ndarray:
    x = np.zeros(size)
    for j, angle in chain.angles.items():
        (c,), (s,) = angle.cos.variables, angle.sin.variables
        x[c], x[s] = np.cos(q[j] / chain.divisors[j]), np.sin(q[j] / chain.divisors[j])
    for j, turn in chain.turns.items():
        (k,) = turn.variables
        x[k] = q[j]
    for j, slide in chain.slides.items():
        (k,) = slide.variables
        x[k] = q[j] / unit_m
    return x


def check(hand: Hand, values, seeds: int, unit_m: float = 0.05) -> None:
    builder = SystemBuilder()
    chain = ChainBuilder(builder, hand, hand.limits, unit_m)
    rng = np.random.default_rng(1)
    local = rng.normal(size=(len(hand.links), 3))
    points, directions, settled = [], [], []
    for i, p in enumerate(local):
        frame = chain.frame(i)
        points.append(frame.point(p * 0.03 / unit_m))
        directions.append(frame.direction(p))
        settled.append(frame.as_variables())
    system = builder.build()
    for _ in range(seeds):
        q = rng.uniform(*hand.limits.T)
        x = values(system, inputs(chain, system.size, q, unit_m))
        T = forward_kinematics(hand, hand.expand(q))
        for i, p in enumerate(local):
            point = np.array([c.evaluate(x) for c in points[i]]) * unit_m
            assert point == pytest.approx(T[i, :3, :3] @ p * 0.03 + T[i, :3, 3], abs=1e-13)
            direction = np.array([c.evaluate(x) for c in directions[i]])
            assert direction == pytest.approx(T[i, :3, :3] @ p, abs=1e-12)
            columns, origin = settled[i]
            assert (
                pytest.approx(T[i, :3, :3], abs=1e-12)
                == np.array([[c.evaluate(x) for c in v] for v in columns]).T
            )
            assert np.array([c.evaluate(x) for c in origin]) * unit_m == pytest.approx(T[i, :3, 3], abs=1e-13)
        assert max(abs(e.evaluate(x)) for e in (*system.equations, *system.redundant)) < 1e-12
        assert min(g.evaluate(x) for g in system.inequalities) > -1e-12
        assert np.all((system.lower <= x) & (x <= system.upper))


def test_frames_of_the_sa_hand_agree_with_forward_kinematics(upholding, values):
    check(upholding.hand, values, 20)


def test_frames_of_an_odd_hand_agree_with_forward_kinematics(odd_hand, values):
    check(odd_hand, values, 20)
    check(odd_hand, values, 2, unit_m=1.0)


def test_a_finger_of_parallel_joints_costs_no_product(upholding):
    builder = SystemBuilder()
    chain = ChainBuilder(builder, upholding.hand, upholding.hand.limits, 0.05)
    frame = chain.frame(upholding.hand.link_index("index_distal"))
    # Three independent angles, and sums for PIP and DIP, no more.
    assert len(chain.angles) == 3
    assert len(builder.names) == 2 * 3 + 2 * 2 + sum(
        name.startswith("index_abduction ") for name in builder.names
    )
    assert frame.angle is not None


def test_chains_share_the_joints_they_have_in_common(odd_hand):
    builder = SystemBuilder()
    chain = ChainBuilder(builder, odd_hand, odd_hand.limits, 0.05)
    assert chain.frame(2) is chain.frame(2)
    chain.frame(8)
    before = len(builder.equations)
    chain.frame(9)  # adds its own joint only
    assert len(builder.equations) == before + 1


def coupled_pair(inertia, *couplings) -> Hand:
    """A joint `a` and a chain behind it of joints that follow it, or one another."""
    free = Link("a", 0, np.eye(4), (axis("a", X, -0.8, 0.9),), (), inertia)
    links = [Link("palm", -1, np.eye(4), (), (), inertia), free]
    for i, coupling in enumerate(couplings):
        T = pose(axis_rotation(OBLIQUE, 0.3 * i), np.array([0.03, 0.01, 0.0]))
        moved = axis(f"b{i}", X if i % 2 else OBLIQUE, -9, 9, coupling=coupling)
        links.append(Link(f"b{i}", i + 1, T, (moved,), (), inertia))
    return Hand("h", tuple(links), {})


@pytest.mark.parametrize(
    "couplings",
    [
        [Coupling("a", 0.5)],
        [Coupling("a", 2.0 / 3.0, 0.2), Coupling("a", 0.75)],
        [Coupling("a", -1.25), Coupling("b0", 1.0 / 3.0, -0.4)],
        [Coupling("a", 22 / 25)],
        [Coupling("a", 1.05851325)],
        [Coupling("a", 0.87, 0.1), Coupling("a", -1.13, -0.2)],
        [Coupling("a", 1.0389), Coupling("b0", -0.8024, 0.3), Coupling("b1", 0.5)],
        [Coupling("a", 1.0), Coupling("a", 0.6667)],
    ],
    ids=["half", "two fractions", "chained", "22/25", "1.0585", "two decimals", "chain of decimals", "mixed"],
)
def test_couplings_agree_with_forward_kinematics(upholding, values, couplings):
    inertia = upholding.hand.links[0].inertia
    hand = coupled_pair(inertia, *couplings)
    check(hand, values, 10)


def planar_finger(inertia, *couplings) -> Hand:
    """Parallel joints in a row: `a`, `b`, and others, each of which follows one of these or another."""
    axes = [axis("a", Z, -0.5, 0.7), axis("b", Z, 0.0, 0.9)]
    axes += [axis(f"c{i}", Z, -9, 9, coupling=coupling) for i, coupling in enumerate(couplings)]
    T = pose(axis_rotation(Z, 0.2), np.array([0.03, 0.0, 0.002]))
    links = [Link("palm", -1, np.eye(4), (), (), inertia)]
    links += [Link(f"l{i}", i, T, (one,), (), inertia) for i, one in enumerate(axes)]
    return Hand("finger", tuple(links), {})


@pytest.mark.parametrize(
    "couplings",
    [
        [Coupling("b", 1.0585)],
        [Coupling("b", 0.87, 0.1), Coupling("b", 1.42)],
        [Coupling("a", 0.77, -0.1), Coupling("b", 1.13), Coupling("c1", 0.91)],
    ],
)
def test_a_finger_of_parallel_joints_adds_turns_up(upholding, values, couplings):
    hand = planar_finger(upholding.hand.links[0].inertia, *couplings)
    check(hand, values, 10)
    builder = SystemBuilder()
    chain = ChainBuilder(builder, hand, hand.limits, 0.05)
    chain.frame(len(hand.links) - 1)
    assert {hand.independent_names[j] for j in chain.turns} == {
        c.master for c in couplings if c.master in "ab"
    }


def test_turns_that_cancel_leave_a_link_as_it_is(upholding, values):
    """A parallelogram: `c0` turns back by what `b` has turned, if only by a number that is no fraction."""
    couplings = [Coupling("b", 1.0585), Coupling("b", -2.0585)]
    hand = planar_finger(upholding.hand.links[0].inertia, *couplings)
    check(hand, values, 10)
