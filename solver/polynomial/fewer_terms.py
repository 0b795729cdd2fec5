"""Equations combined with each other, exactly, where that leaves fewer terms."""

from collections import Counter, deque
from collections.abc import Sequence
from fractions import Fraction

from .exact import ExactPolynomial, Powers
from .factored import FactoredPolynomial

__all__ = ["with_fewer_terms"]

# Terms compared; a system of some hundred equations with a few terms each needs a small part of that.
_MOST_WORK = 1_000_000
# Bits of a coefficient; long chains of combinations make them ever longer.
_MOST_BITS = 2000


def with_fewer_terms(equations: Sequence[FactoredPolynomial]) -> list[FactoredPolynomial]:
    """Equations with the same common zeros and no more terms, in the same order.

    To an equation multiples of others are added that have no monomials but its own, the constant aside,
    while that cancels some of them. (Where others may come in for the ones that go, there are fewer terms
    still, but banded systems lose their strong diagonal: BroydenBanded-100 takes 55 boxes for 15.) Each step
    can be undone by its like, so no solution comes or goes. Chains of linear equations come out as
    good as solved, and a long sum that equations have in common is left in one of them. Products of
    several factors stay as they are, and so does an equation of which nothing would be left.
    """
    alone = [k for k, equation in enumerate(equations) if len(equation) == 1]
    rows = _Rows([equations[k][0] for k in alone])
    rows.reduce()
    out = list(equations)
    for k, row in zip(alone, rows.rows, strict=True):
        if row != equations[k][0]:
            out[k] = FactoredPolynomial.product([row])
    return out


class _Rows:
    """Polynomials that lose terms, and which of them have which monomial."""

    def __init__(self, polynomials: Sequence[ExactPolynomial]):
        self.rows = [ExactPolynomial(p) for p in polynomials]
        self._work = 0
        self._having: dict[Powers, set[int]] = {}
        for i in range(len(self.rows)):
            self._note(i)

    def _note(self, i: int) -> None:
        for monomial in self.rows[i]:
            self._having.setdefault(monomial, set()).add(i)

    def reduce(self) -> None:
        """Combines them until nothing is gained any more, or it has taken long enough."""
        waiting = dict.fromkeys(range(len(self.rows)))
        queue = deque(waiting)
        while queue and self._work < _MOST_WORK:
            i = queue.popleft()
            del waiting[i]
            if not self._shorten(i):
                continue
            for j in [i, *sorted(self._shared(i))]:
                if j not in waiting:
                    waiting[j] = None
                    queue.append(j)

    def _shared(self, i: int) -> Counter[int]:
        """How many monomials, other than the constant, each other row has in common with this one."""
        return Counter(j for monomial in self.rows[i] if monomial for j in self._having[monomial] if j != i)

    def _shorten(self, i: int) -> bool:
        """Adds the multiple of another row that cancels most terms; False where none is worth it."""
        row, best, gain = self.rows[i], (-1, Fraction(0)), 0
        shared = self._shared(i)
        self._work += shared.total() // 10
        for j, count in sorted(shared.items()):
            other = self.rows[j]
            if count < len(other) - (() in other):
                continue
            self._work += len(other)
            factors = Counter(-row[monomial] / c for monomial, c in other.items() if monomial in row)
            factor, cancelled = max(factors.items(), key=lambda item: item[1])
            less = cancelled - (() in other and () not in row)
            if gain < less < len(row):
                best, gain = (j, factor), less
        if gain == 0:
            return False
        new = ExactPolynomial(row)
        new.add(self.rows[best[0]], best[1])
        if any(max(c.numerator.bit_length(), c.denominator.bit_length()) > _MOST_BITS for c in new.values()):
            return False
        for monomial in row:
            self._having[monomial].discard(i)
        self.rows[i] = new
        self._note(i)
        return True
