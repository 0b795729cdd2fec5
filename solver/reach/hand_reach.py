"""Whether a hand reaches parts of an object's regions: local search for it, and branch and prune against."""

import numpy as np

from ...base.numeric.arrays import Array
from ...objects import Task
from ..contacts import Configuration, ContactManifold, State, region_params, search_locally
from ..contraction import Box, Pruner
from ..polynomial import canonical_form
from ..proof import BoxRecord, BoxTrace
from ..tasks import TaskCertifier

__all__ = ["HandReach"]


class HandReach:
    """One task's contacts, with those on patches of the object kept to parts of these.

    Args:
        task: the task.
    """

    def __init__(self, task: Task):
        self._certifier = TaskCertifier(task)
        formulation = self._certifier.formulation
        self._form, self._inputs = canonical_form(formulation.system), formulation.system.inputs
        # Contacts on patches of the object, and where their parameters are among those of states.
        found = [(i, np.arange(at.start, at.stop)) for i, (_, at) in enumerate(region_params(task))]
        found = [(i, at) for i, at in found if len(at)]
        self._at = [at for _, at in found]
        self._pairs = [(i, formulation.param_inputs[at]) for i, at in found]

    @property
    def has_patches(self) -> bool:
        """Whether parts of regions are anything to it."""
        return bool(self._pairs)

    def certified(self, state: State) -> Configuration | None:
        """The configuration at a state, if it is proved."""
        configuration = self._certifier.certify(state)
        return configuration if configuration.certified else None

    def land(self, lower: Array, upper: Array, starts: int, seed: int) -> State | None:
        """A state that solves the task with contacts in these parts, as local search finds it.

        Args:
            lower: (2 n,) parameters of the n regions.
            upper: (2 n,)
            starts: so many are tried.
            seed: of the starts.
        """
        root, rng = self._part(lower, upper), np.random.default_rng(seed)
        manifold = self._within(lower, upper)
        formulation = self._certifier.formulation
        for _ in range(starts):
            x = rng.uniform(root.lower, np.maximum(root.upper, root.lower))
            start = formulation.state_from_inputs(x, self._certifier.q_free)
            landed = search_locally(manifold, start)
            if landed is not None:
                return landed
        return None

    def refute(self, lower: Array, upper: Array, most: int) -> tuple[list[BoxRecord] | None, int]:
        """The tree of at most so many boxes that shows that no contacts are in these parts, or None.

        With how many boxes were taken. By propagation alone: in parts so small a thousand boxes take as long
        as two linear programs.
        """
        pruner = Pruner(self._form, self._inputs)
        open_: list[Box] = [self._part(lower, upper)]
        records: list[BoxRecord] = []
        while open_:
            if len(records) + len(open_) > most:
                return None, len(records)
            box, trace = open_.pop(), BoxTrace(self._form)
            pruned = pruner.prune(box, tightened=0, trace=trace)
            records.append(BoxRecord(box.path, trace.steps, None if pruned is None else pruner.cut(pruned)))
            if pruned is not None:
                open_ += pruner.split(pruned)
        return records, len(records)

    def _part(self, lower: Array, upper: Array) -> Box:
        """The initial box with contacts in these parts."""
        box = Box(self._form.lower.copy(), self._form.upper.copy())
        for i, columns in self._pairs:
            part = slice(2 * i, 2 * i + 2)
            box.lower[columns] = np.maximum(box.lower[columns], lower[part])
            box.upper[columns] = np.minimum(box.upper[columns], upper[part])
        return box

    def _within(self, lower: Array, upper: Array) -> ContactManifold:
        """The contacts with the parameters of patches limited to these parts."""
        whole = self._certifier.manifold
        least, most = whole.lower.copy(), whole.upper.copy()
        for (i, _), at in zip(self._pairs, self._at, strict=True):
            least[whole.n_q + at], most[whole.n_q + at] = lower[2 * i : 2 * i + 2], upper[2 * i : 2 * i + 2]
        return whole.within(least, most)
