"""Pruning of boxes: propagation, then linear programs where they pay; and the choice of where to split."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ..linear import Basis, Tightener, errors_by_factor
from ..polynomial import CanonicalForm
from ..proof import BoxTrace
from .branching import column_to_split, cut_value
from .hc4_canonical import Propagator

__all__ = ["Box", "Pruner", "Witnesses"]

# From a point of the relaxation and the sides of its box, all (n,): a solution (n,) proved to lie in the box.
Witnesses = Callable[[Array, Array, Array], Array | None]


@dataclass(frozen=True, eq=False)
class Box:
    """A box of all columns of a canonical form.

    Attributes:
        lower: (n,) lower ends.
        upper: (n,) upper ends.
        point: (n,) where a linear program last stood in the box, None before the first.
        path: which box of the tree: 0 for each split of which it is the half below, 1 for the half above.
        basis: of the last linear program over the box or one around it, from which the next one starts.
        witness: (n,) a solution that is proved to lie in the box, None where none is known.
    """

    lower: Array
    upper: Array
    point: Array | None = None
    path: str = ""
    basis: Basis | None = None
    witness: Array | None = None


class Pruner:
    """Narrows boxes of one system; what it removes is proved, in outward rounding, to hold nothing.

    Args:
        form: the system.
        inputs: its inputs.
        only_inputs: split inputs alone. Splits of other factors refute sooner, but where inputs alone were
            cut, Newton's method can stay inside.
    """

    def __init__(self, form: CanonicalForm, inputs: Indices, *, only_inputs: bool = False):
        self.form = form
        self._splittable = np.isin(np.arange(form.size), inputs) | (not only_inputs)
        self._only_inputs = only_inputs
        self._propagator = Propagator(form)
        self._tightener = Tightener(form)
        self._inputs = inputs

    @property
    def root(self) -> Box:
        """The initial box."""
        return Box(self.form.lower.copy(), self.form.upper.copy())

    @property
    def lps(self) -> int:
        """Linear programs solved so far."""
        return self._tightener.lps

    def prune(
        self, box: Box, *, tightened: int, trace: BoxTrace | None = None, witnesses: Witnesses | None = None
    ) -> Box | None:
        """A part of `box` that holds all its solutions, or None where it is proved to hold none.

        Args:
            box: the box; one with a witness is not empty, so propagation is enough for it.
            tightened: how many of the widest inputs get bounds from linear programs; 0 to propagate only.
            trace: is told the steps, for a proof.
            witnesses: asked after a box's first linear program; where it knows one, no bound is tightened.
        """
        lower, upper = box.lower.copy(), box.upper.copy()
        if not self._propagator.contract(lower, upper):
            return None
        if tightened == 0 or box.witness is not None:
            return replace(box, lower=lower, upper=upper)
        witness: Array | None = None

        def choose(point: Array) -> Indices:
            nonlocal witness
            witness = None if witnesses is None else witnesses(point, lower, upper)
            return self._most_wrong(point, lower, upper, tightened if witness is None else 0)

        basis = box.basis
        for _ in range(3):
            before = (upper - lower)[self._inputs]
            point = self._tightener.tighten(lower, upper, choose, trace, basis)
            if point is None or not self._propagator.contract(lower, upper):
                return None
            basis = self._tightener.basis
            after = (upper - lower)[self._inputs]
            # Another round only where this one made some input a good deal narrower.
            if witness is not None or not np.any(after < 0.7 * before):
                break
        return Box(lower, upper, point, box.path, basis, witness)

    def cut(self, box: Box) -> tuple[int, float]:
        """Column and value where `split` cuts: one of the columns that the relaxation gets most wrong.

        What matters in a box with a witness is to become small, so its widest input is halved.
        """
        k = self._widest_input(box) if box.witness is not None else self._branching_variable(box)
        lo, hi = box.lower[k], box.upper[k]
        middle = 0.5 * (lo + hi)
        if box.witness is None and box.point is not None:
            # Near the point, where the relaxation is to become exact, but never a sliver.
            middle = cut_value(lo, hi, box.point[k])
        return k, float(middle)

    def split(self, box: Box) -> tuple[Box, Box]:
        """Two halves, first the one with the witness, which the other loses, or else with the LP's point."""
        k, middle = self.cut(box)
        left_upper, right_lower = box.upper.copy(), box.lower.copy()
        left_upper[k] = right_lower[k] = middle
        left = replace(box, upper=left_upper, path=box.path + "0")
        right = replace(box, lower=right_lower, path=box.path + "1")
        towards = box.point if box.witness is None else box.witness
        first, second = (left, right) if towards is None or towards[k] <= middle else (right, left)
        return first, replace(second, witness=None)

    def _most_wrong(self, point: Array, lower: Array, upper: Array, count: int) -> Indices:
        """The variables whose products and functions the relaxation gets most wrong, at most so many."""
        score = self._errors(point, lower, upper)
        order = np.argsort(-score, kind="stable")[:count]
        return order[score[order] > 1e-6]

    def _errors(self, point: Array, lower: Array, upper: Array) -> Array:
        """How wrong the relaxation is at `point`, by column (n,) that can still be cut."""
        score = errors_by_factor(self.form, np.clip(point, lower, upper))
        score[upper - lower <= 1e-6] = 0.0
        return score

    def _branching_variable(self, box: Box) -> int:
        """One of the variables that the relaxation gets most wrong, else the widest input."""
        if box.point is not None:
            score = self._splittable * self._errors(box.point, box.lower, box.upper)
            if score.max(initial=0.0) > 1e-9:
                if self._only_inputs:
                    return int(np.argmax(score))
                return column_to_split(self.form, self._propagator, box.lower, box.upper, box.point, score)
        return self._widest_input(box)

    def _widest_input(self, box: Box) -> int:
        return int(self._inputs[np.argmax((box.upper - box.lower)[self._inputs])])
