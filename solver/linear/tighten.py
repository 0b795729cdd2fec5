"""Bounds of variables from linear programs over the relaxation of a box, each one proved."""

from collections.abc import Callable

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ..polynomial import CanonicalForm
from ..proof import BoxTrace
from .highs import Basis, LinearProgram, LpStatus
from .relaxation import Relaxation

__all__ = ["Tightener"]

# A vertex within this share of the width from an end shows that next to nothing can be gained there.
_NEAR = 0.02
_BASIC = 1  # as HiGHS numbers the statuses of a basis


class Tightener:
    """Tightens boxes of one canonical form."""

    def __init__(self, form: CanonicalForm):
        self._relaxation = Relaxation(form)
        self._program = LinearProgram(form.size)
        self._size = form.size
        self._entries = np.zeros(0, dtype=np.int64)  # of the last program in a basis with all names

    @property
    def lps(self) -> int:
        """Linear programs solved so far."""
        return self._program.solved

    @property
    def basis(self) -> Basis | None:
        """The basis of the last linear program, its rows by their names: (n + n_names,)."""
        last = self._program.basis
        if last is None:
            return None
        # A facet that this box doesn't have is as good as one that is not tight.
        named = np.full(self._size + self._relaxation.n_names, _BASIC, dtype=np.int8)
        named[self._entries] = last
        return named

    def tighten(
        self,
        lower: Array,
        upper: Array,
        choose: Callable[[Array], Indices],
        trace: BoxTrace | None = None,
        basis: Basis | None = None,
    ) -> Array | None:
        """Moves bounds in place.

        Args:
            lower: (n,) lower ends of all columns of the form.
            upper: (n,) upper ends.
            choose: the columns to tighten, in order, given a point (n,) of the relaxation.
            trace: is told what proves each bound.
            basis: to start from (n + n_names,).

        Returns:
            A point (n,) of the relaxation (approximate), or None where the box is proved empty.
        """
        rows, names = self._relaxation.build(lower, upper)
        self._entries = np.concatenate([np.arange(self._size), self._size + names])
        # Facets come and go, so there may be too many basic entries or too few; HiGHS makes up for that.
        self._program.load(rows, lower, upper, None if basis is None else basis[self._entries])
        if trace is not None:
            trace.relaxed(lower, upper, rows)
        status = self._program.minimise(None)
        if status is LpStatus.INFEASIBLE and self._program.proved_infeasible():
            if trace is not None:
                trace.refuted(self._program.certificate)
            return None
        if status is not LpStatus.OPTIMAL:
            return 0.5 * (lower + upper)  # nothing can be concluded; the box is split as it is
        first = self._program.point
        seen_low, seen_high = first.copy(), first.copy()
        for j in choose(first):
            room = _NEAR * (upper[j] - lower[j])
            for sign in (1.0, -1.0):
                near = seen_low[j] - lower[j] if sign > 0 else upper[j] - seen_high[j]
                if near <= room or self._program.minimise(int(j), sign) is not LpStatus.OPTIMAL:
                    continue
                bound = sign * self._program.proved_bound()
                if trace is not None and sign * bound > (lower[j] if sign > 0 else -upper[j]):
                    trace.bounded(int(j), sign, self._program.certificate)
                if sign > 0:
                    lower[j] = max(lower[j], bound)
                else:
                    upper[j] = min(upper[j], bound)
                if lower[j] > upper[j]:
                    return None
                point = self._program.point
                seen_low, seen_high = np.minimum(seen_low, point), np.maximum(seen_high, point)
        return first
