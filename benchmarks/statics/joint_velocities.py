"""Whether joint velocities would refute kinematic boxes in which friction, or servos, can't hold the load.

    ./run bench joint_velocities [--descents N] [--seed N] [--json FILE] [TASK ...]

A twist of the object and velocities of the joints refute a box for a direction of the load where, at every
place of the box, no contact force resists the motion of object against links, and the load's power is more
than the servos' efforts give. Boxes are those of branch and prune, by propagation, on the way down at random
to sizes of inputs of 0.8, 0.4, 0.2 and 0.1; and cubes about certified configurations of which a linear
program says that no forces within friction and efforts carry the weight. Counted is what could be refuted at
most: a linear program asks for one motion that does it at the middle of the box; then the place at which it
fails worst, of corners and points drawn from the box, is added, until none is found at which it fails, or no
motion is left. Twists are constant in the object's frame. Each is done with joints at rest as well, so that
links resist whatever the servos are. Nothing here proves anything; it says how much there would be to prove.
"""

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import highspy
import numpy as np
from holdfast.base.files.output_file import write_json
from holdfast.base.numeric.arrays import Array
from holdfast.base.numeric.highs import accept, new_highs
from holdfast.base.text.console import format_table
from holdfast.geometry import cone_edges
from holdfast.mjcf import HoldSettings
from holdfast.mjcf.squeeze import grasp_statics
from holdfast.objects import LiftTest, Task, load_task
from holdfast.solver import Configuration, solve
from holdfast.solver.contraction import Box, Pruner
from holdfast.solver.formulate import Formulation, formulate
from holdfast.solver.polynomial import canonical_form

TASKS = ("upholding", "service", "holding", "transportation")
SIZES = (0.8, 0.4, 0.2, 0.1)
HALF_WIDTHS = (0.2, 0.1, 0.05, 0.02)
# Places that are drawn from a box, and those of them that one motion is asked to refute at most.
_DRAWN, _MOST_PLACES = 60, 12
# A way down ends after so many boxes.
_MOST_BOXES = 400
# Torques count as forces at this arm, in m, and joint velocities by what their servos give.
_ARM_M = 0.05
# Power, as a share of the weight's along a unit velocity, that is more than rounding.
_NOTHING = 1e-6


@dataclass
class Count:
    """Boxes of a kind, and how many could be refuted at most.

    Attributes:
        boxes: that were looked at.
        at_rest: with twists alone.
        moving: with joint velocities, too.
    """

    boxes: int = 0
    at_rest: int = 0
    moving: int = 0


@dataclass(frozen=True)
class Place:
    """What forces do at one place of a box.

    Attributes:
        conditions: (k, 6 + n) power of each cone edge by a motion: the object's twist (a, w) about its centre
            of mass, in its frame, and velocities of the joints, each by what its servo gives.
        gravity: (d, 3) the load in N in each direction, in the object's frame.
    """

    conditions: Array
    gravity: Array


@dataclass
class Boxes:
    """Boxes of one task's system, and places in them."""

    task: Task
    rng: np.random.Generator
    settings: HoldSettings = field(default_factory=HoldSettings)

    def __post_init__(self) -> None:
        self.formulation: Formulation = formulate(self.task)
        self.form = canonical_form(self.formulation.system)
        self.inputs = self.formulation.system.inputs
        assert isinstance(self.task.test, LiftTest)
        self.loads = np.array(self.task.test.directions)
        mu, arm_m = self.settings.sliding_friction(self.task.object), self.task.hand.pad.largest_arm_m
        self.edges = cone_edges(mu, mu * arm_m, 1)
        limits = self.task.limits
        self.q_free = 0.5 * (limits[:, 0] + limits[:, 1])

    def descents(self, count: int) -> Iterator[tuple[float, Box]]:
        """Boxes that pruning leaves, each with the size that its inputs no longer have."""
        for _ in range(count):
            pruner = Pruner(self.form, self.inputs, only_inputs=True)
            path, sizes = [pruner.root], list(SIZES)
            for _ in range(_MOST_BOXES):
                if not path or not sizes:
                    break
                box = pruner.prune(path.pop(), tightened=0)
                if box is None:
                    continue
                widest = float((box.upper - box.lower)[self.inputs].max())
                while sizes and widest <= sizes[0]:
                    yield sizes.pop(0), box
                halves = list(pruner.split(box))
                self.rng.shuffle(halves)  # type: ignore[arg-type]
                path += halves

    def cube(self, configuration: Configuration, half_width: float) -> Box:
        """All inputs within so much of a configuration's."""
        x = self.formulation.inputs_from_state(configuration.state)
        lower, upper = self.form.lower.copy(), self.form.upper.copy()
        at = x[self.inputs]
        lower[self.inputs] = np.maximum(lower[self.inputs], at - half_width)
        upper[self.inputs] = np.minimum(upper[self.inputs], at + half_width)
        return Box(lower, upper)

    def drawn(self, box: Box, count: int) -> Iterator[Place]:
        """Places of a box, every second one a corner."""
        low, high = box.lower[self.inputs], box.upper[self.inputs]
        for k in range(count):
            shares = self.rng.uniform(size=len(low))
            yield self.at(low + (shares.round() if k % 2 else shares) * (high - low))

    def middle(self, box: Box) -> Place:
        """The middle of a box."""
        return self.at(0.5 * (box.lower + box.upper)[self.inputs])

    def at(self, inputs: Array) -> Place:
        """The place with these inputs, to which a rotation belongs that is near to what they say."""
        x = np.zeros(self.formulation.system.size)
        x[self.inputs] = inputs
        return self.place(
            Configuration(self.task, self.formulation.state_from_inputs(x, self.q_free), np.inf, None)
        )

    def place(self, configuration: Configuration) -> Place:
        """The conditions at a state, which need not solve the task."""
        statics = grasp_statics(configuration, self.settings)
        n, R = statics.n_contacts, configuration.state.R_palm_object
        G = (statics.G.reshape(6, n, 4) @ self.edges).reshape(6, -1)
        T = (statics.T.reshape(-1, n, 4) @ self.edges).reshape(len(statics.T), -1)
        G[3:] /= _ARM_M
        joints = -T / statics.effort[:, None]
        weight_N = statics.mass * self.settings.gravity
        return Place(np.vstack([R.T @ G[:3], R.T @ G[3:], joints]).T, weight_N * self.loads @ R)

    def refutable(self, box: Box, *, moving: bool) -> bool:
        """Whether one motion may refute a box, for some direction of the load."""
        others = list(self.drawn(box, _DRAWN))
        return any(self._refutable(self.middle(box), others, k, moving) for k in range(len(self.loads)))

    def lacking(self, configuration: Configuration) -> str:
        """What keeps a configuration from carrying the weight in every direction."""
        here = [self.place(configuration)]
        for kind, moving in (("friction", False), ("servos", True)):
            if any(largest_power(here, k, moving) is not None for k in range(len(self.loads))):
                return kind
        return "nothing"

    def _refutable(self, first: Place, others: list[Place], direction: int, moving: bool) -> bool:
        known = [first]
        for _ in range(_MOST_PLACES):
            motion = largest_power(known, direction, moving)
            if motion is None:
                return False
            excess = [_excess(motion, place, direction) for place in others]
            worst = int(np.argmin(excess)) if excess else 0
            if not excess or excess[worst] >= 0.0:
                return True
            known.append(others[worst])
        return True


def _excess(motion: Array, place: Place, direction: int) -> float:
    """What a motion has to spare at a place, by rows; below zero where it refutes nothing there."""
    twist, velocities = motion[:6], motion[6:]
    power = float(place.gravity[direction] @ twist[:3]) - float(np.abs(velocities).sum())
    powers = place.conditions @ motion
    tolerance = _NOTHING * float(np.linalg.norm(motion))
    return min(power, float(powers.min()) + tolerance)


def largest_power(places: list[Place], direction: int, moving: bool) -> Array | None:
    """The motion (6 + n,) of largest power of the load, beyond the servos', that no contact resists.

    Velocities of joints are split in two parts of one sign each; the servos' power is their sum. The last
    unknown of the program is the least power of the load at any place.

    Args:
        places: at which it should do so.
        direction: of the load.
        moving: whether joints move.

    Returns:
        None where no motion has any.
    """
    conditions = np.vstack([place.conditions for place in places])
    gravity = np.array([place.gravity[direction] for place in places])
    n = conditions.shape[1] - 6
    above = np.hstack([conditions, -conditions[:, 6:], np.zeros((len(conditions), 1))])
    below = np.zeros((len(gravity), above.shape[1]))
    below[:, :3], below[:, -1] = gravity, -1.0
    A = np.vstack([above, below])
    most = np.inf if moving else 0.0
    costs = np.concatenate([np.zeros(6), np.full(2 * n, -1.0), [1.0]])
    lower = np.concatenate([np.full(6, -1.0), np.zeros(2 * n), [-np.inf]])
    upper = np.concatenate([np.ones(6), np.full(2 * n, most), [np.inf]])
    columns, at = np.nonzero(A.T)
    starts = np.searchsorted(columns, np.arange(A.shape[1])).astype(np.int32)
    highs = new_highs()
    accept(
        highs.passModel(
            A.shape[1], len(A), len(at), int(highspy.MatrixFormat.kColwise),
            int(highspy.ObjSense.kMaximize), 0.0, costs, lower, upper, np.zeros(len(A)),
            np.full(len(A), np.inf), starts, at.astype(np.int32), A.T[columns, at],
            np.zeros(A.shape[1], dtype=np.int32),
        )
    )  # fmt: skip
    highs.run()
    if highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        raise SystemExit(f"a linear program ended as {highs.getModelStatus()}")
    x = np.array(highs.getSolution().col_value)
    power = float(highs.getInfo().objective_function_value)
    if power <= _NOTHING * float(np.linalg.norm(gravity[0])):
        return None
    return np.concatenate([x[:6], x[6 : 6 + n] - x[6 + n : -1]])


def counted(boxes: Boxes, box: Box, count: Count) -> None:
    """Adds a box to a count; what rest refutes, motion does."""
    at_rest = boxes.refutable(box, moving=False)
    count.boxes += 1
    count.at_rest += at_rest
    count.moving += at_rest or boxes.refutable(box, moving=True)


def measured(name: str, options: argparse.Namespace) -> dict[str, Count]:
    """Counts of a task by kind of box."""
    task, rng = load_task(name), np.random.default_rng(options.seed)
    boxes = Boxes(task, rng)
    counts: dict[str, Count] = {}
    for size, box in boxes.descents(options.descents):
        counted(boxes, box, counts.setdefault(f"search {size:g}", Count()))
    for configuration in solve(task, candidates=options.descents, seed=options.seed):
        kind = boxes.lacking(configuration)
        counts.setdefault(f"configurations that lack {kind}", Count()).boxes += 1
        if kind != "nothing":
            for half_width in HALF_WIDTHS:
                label = f"about such, {kind}, {half_width:g}"
                counted(boxes, boxes.cube(configuration, half_width), counts.setdefault(label, Count()))
    return counts


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", metavar="TASK", help=f"lifts ({', '.join(TASKS)})")
    parser.add_argument(
        "--descents", type=int, default=12, help="ways down, and configurations, of each task"
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, help="file for the figures")
    options = parser.parse_args()
    figures: dict[str, dict[str, dict[str, int]]] = {}
    rows = []
    for task in options.tasks or TASKS:
        counts = measured(task, options)
        figures[task] = {label: vars(count) for label, count in counts.items()}
        for label, count in counts.items():
            rows.append([task, label, str(count.boxes), str(count.at_rest), str(count.moving)])
            print("  ".join(rows[-1]), flush=True)
        if options.json:
            write_json(options.json, figures)
    print(format_table(["task", "boxes", "number", "refutable at rest", "with joint velocities"], rows))


if __name__ == "__main__":
    main()
