"""What branch and prune does with a box of a task's system: a function of the box and the settings.

The settings include the number of inputs to tighten. Nothing that was found elsewhere, and nothing about
earlier boxes, has a say. So a subtree gives the same result in any process and in any order.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...base.numeric.arrays import Array
from ...objects import Task
from ..contacts import Configuration, State, search_locally
from ..contraction import Box, Pruner
from ..linear import relaxation_errors
from ..polynomial import CanonicalForm, canonical_form
from ..proof import BoxRecord, BoxTrace
from ..search import Outcome, SearchOrder, Subtree, SubtreeResult, search_subtree
from .certify import TaskCertifier

__all__ = ["TaskJobResult", "TaskSetup", "TaskWorker", "relaxation_error"]

# Local searches from the first box, each some 5 ms: where one lands, no linear program is needed.
_FIRST_STARTS = 16
# Inputs that are tightened in a small box that is neither refuted nor certified.
_LAST_TIGHTENED = 5


@dataclass(frozen=True, eq=False)
class TaskSetup:
    """What decides the result of every job.

    Attributes:
        task: the task.
        sigma: boxes with all inputs narrower than this are not split.
        seed: of the local search's starts.
        pure: no local search from boxes that can still be split.
        order: in which the boxes of a subtree are processed.
        traced: whether records for a proof are kept.
        cover: whether small boxes are to cover the solution set, which local searches leave alone.
    """

    task: Task
    sigma: float
    seed: int
    pure: bool
    order: SearchOrder
    traced: bool = False
    cover: bool = False

    @property
    def shared(self) -> tuple[object, ...]:
        """The task, to which every configuration refers, and which holds whole meshes."""
        return (self.task,)

    def new_worker(self) -> "TaskWorker":
        """A worker for this process, with all compiled code loaded, so that nothing waits for that."""
        worker = TaskWorker(self)
        worker.work(Subtree(worker.root, 0))
        return worker

    def give_up(self, job: Subtree[Box]) -> "TaskJobResult":
        """The result of a job that no process survived: the box is neither refuted nor split."""
        return TaskJobResult(SubtreeResult(processed=1, undecided=[job.region], decided=1.0), abandoned=1)


@dataclass
class TaskJobResult:
    """What became of a subtree of boxes.

    Attributes:
        subtree: what the search goes on with.
        lps: linear programs solved.
        probes: local searches.
        landed: those that ended on a solution.
        records: of the boxes that were refuted or split, for a proof.
        covered: small boxes, each with a certified configuration inside.
        abandoned: boxes given up because every process that worked on them died.
    """

    subtree: SubtreeResult[Box, Configuration] = field(default_factory=SubtreeResult)
    lps: int = 0
    probes: int = 0
    landed: int = 0
    records: list[BoxRecord] = field(default_factory=list)
    covered: list[Box] = field(default_factory=list)
    abandoned: int = 0


class TaskWorker:
    """Does the jobs of one search."""

    def __init__(self, setup: TaskSetup, certifier: TaskCertifier | None = None):
        self.setup = setup
        self.certifier = certifier or TaskCertifier(setup.task)
        self.formulation = self.certifier.formulation
        self.form: CanonicalForm = canonical_form(self.formulation.system)
        self.inputs = self.formulation.system.inputs
        self.key: Callable[[Box], float] | None = None
        if setup.order is SearchOrder.BEST_FIRST:
            self.key = lambda box: relaxation_error(self.form, box)
        self._turn = self.formulation.rotation_inputs
        self._pruner = self._new_pruner()
        self._result = TaskJobResult()

    def _new_pruner(self) -> Pruner:
        return Pruner(self.form, self.inputs, only_inputs=self.setup.pure and not self.setup.cover)

    @property
    def root(self) -> Box:
        """The initial box."""
        return self._pruner.root

    def work(self, job: Subtree[Box]) -> TaskJobResult:
        """Processes the first boxes of a subtree."""
        if self._pruner.lps:
            # A linear program starts from the last one's basis, which must not be that of another subtree.
            self._pruner = self._new_pruner()
        self._result = TaskJobResult()
        order, key = self.setup.order, self.key
        self._result.subtree = search_subtree(job, lambda box: self._process(box, job.context), order, key)
        self._result.lps = self._pruner.lps
        return self._result

    def _process(self, box: Box, tightened: int) -> Outcome[Box, Configuration]:
        """Prunes a box, looks for a configuration from within it, and splits it.

        Args:
            box: the box.
            tightened: how many inputs get bounds from linear programs.
        """
        trace = BoxTrace(self.form) if self.setup.traced else None
        witnesses = self._solution_within if self.setup.pure and not self.setup.cover else None
        pruned = self._pruner.prune(box, tightened=tightened, trace=trace, witnesses=witnesses)
        if pruned is None:
            self._record(box, trace, None)
            return Outcome()
        small = bool(np.all((pruned.upper - pruned.lower)[self.inputs] <= self.setup.sigma))
        if self.setup.cover:
            return self._cover(pruned) if small else Outcome(children=self._pruner.split(pruned))
        found = self._probe(pruned) if not self.setup.pure else self._certify_witness(pruned) if small else []
        if not small:
            self._record(box, trace, pruned)
            return Outcome(found, self._pruner.split(pruned))
        # A certified configuration inside a small box stands for the box; otherwise it stays undecided.
        stands = any(self._lies_within(configuration, pruned) for configuration in found)
        return Outcome(found, undecided=None if stands else pruned)

    def _cover(self, box: Box) -> Outcome[Box, Configuration]:
        """A small box: certified where a solution is proved inside, else what linear programs leave of it."""
        found = self._certify_inside(box)
        if found is None:
            narrowed = self._pruner.prune(box, tightened=_LAST_TIGHTENED)
            if narrowed is None:
                return Outcome()
            box = narrowed
            found = self._certify_inside(box)
        if found is None:
            return Outcome(undecided=box)
        self._result.covered.append(box)
        return Outcome([found])

    def _certify_inside(self, box: Box) -> Configuration | None:
        """A configuration that is proved to lie in the box: the one next to its middle, or none."""
        state = self.formulation.state_from_inputs(0.5 * (box.lower + box.upper), self.certifier.q_free)
        near = self.certifier.manifold.project(state)
        if near is None or not self.certifier.manifold.is_feasible(near):
            return None
        configuration = self.certifier.certify(near)
        return configuration if configuration.certified and self._lies_within(configuration, box) else None

    def _solution_within(self, point: Array, lower: Array, upper: Array) -> Array | None:
        """A solution (n,) proved to lie in the box, by Newton's method from a point of its relaxation."""
        n = self.formulation.system.size
        return self.certifier.solution_within(point[:n], lower[:n], upper[:n])

    def _certify_witness(self, box: Box) -> list[Configuration]:
        """The configuration of a small box's witness; without one yet, Newton starts from the middle."""
        witness = box.witness
        if witness is None:
            witness = self._solution_within(0.5 * (box.lower + box.upper), box.lower, box.upper)
        if witness is None:
            return []
        state = self.formulation.state_from_inputs(witness, self.certifier.q_free)
        configuration = self.certifier.certify(state)
        return [configuration] if configuration.certified else []

    def _record(self, box: Box, trace: BoxTrace | None, left: Box | None) -> None:
        """Keeps a box for the proof: split where `left` is cut, or empty."""
        if trace is not None:
            cut = self._pruner.cut(left) if left is not None else None
            self._result.records.append(BoxRecord(box.path, trace.steps, cut))

    def _probe(self, box: Box) -> list[Configuration]:
        """At most one certified configuration, by local searches from points of the box."""
        rng = np.random.default_rng([self.setup.seed, int("1" + box.path, 2)])
        for _ in range(1 if box.path else _FIRST_STARTS):
            found = self._probe_once(box, rng)
            if found:
                return found
        return []

    def _probe_once(self, box: Box, rng: np.random.Generator) -> list[Configuration]:
        reached = search_locally(self.certifier.manifold, self._start(box, rng))
        self._result.probes += 1
        if reached is None:
            return []
        self._result.landed += 1
        configuration = self.certifier.certify(reached)
        return [configuration] if configuration.certified else []

    def _start(self, box: Box, rng: np.random.Generator) -> State:
        """A state in the box: random in joints and parameters, near the LP's point in the object's turn."""
        x = rng.uniform(box.lower, np.maximum(box.upper, box.lower))
        if box.point is not None:
            x[self._turn] = 0.5 * (x[self._turn] + box.point[self._turn])
        return self.formulation.state_from_inputs(x, self.certifier.q_free)

    def _lies_within(self, configuration: Configuration, box: Box) -> bool:
        """Whether the solution that is proved lies in the box, as far as inputs go."""
        proved = configuration.certificate
        assert proved is not None
        return bool(
            np.all(proved.lower[self.inputs] >= box.lower[self.inputs])
            and np.all(proved.upper[self.inputs] <= box.upper[self.inputs])
        )


def relaxation_error(form: CanonicalForm, box: Box) -> float:
    """How far the box's point, or else its middle, is from satisfying products and functions, all in all."""
    x = 0.5 * (box.lower + box.upper) if box.point is None else np.clip(box.point, box.lower, box.upper)
    return float(relaxation_errors(form, x).sum())
