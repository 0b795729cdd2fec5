"""Presolve: fixed and related variables of a polynomial system are put into everything else, exactly.

A variable x is *fixed* where its interval is a point or its definition a constant. It is *related* where a
definition or a linear equation says x = scale y + shift, or where it is defined like another one up to scale
and shift. Then x is replaced wherever it occurs, and stays as a definition that nothing uses: so the system
keeps its variables, and enclosures and certificates speak of all of them. Rows that this leaves without
content, and those that say what another row says, are dropped.

Coefficients are floats, taken as exact numbers. A variable that can't be replaced without rounding stays.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import comb, isfinite

from ...base.numeric.arrays import Array
from .affine_relations import (
    Affine,
    affine_definitions,
    fixed_inputs,
    proportional,
    related_inputs,
)
from .canonical import count_products
from .exact import collected, enclose_fraction
from .polynomial import Monomial, Polynomial
from .system import Definition, PolynomialSystem, TrigFunction, bound_polynomial, bounds_itself

__all__ = ["presolve"]

_FALSE = Polynomial.constant(1.0)
# Coefficients of redundant rows, which are sums of products of numbers around 1, are rounding below this.
_ROUNDING = 1e-13


class _CannotReplace(Exception):
    """A coefficient would have to be rounded, or a function to change its kind."""


def presolve(system: PolynomialSystem) -> PolynomialSystem:
    """The same system with fixed and affinely related variables replaced.

    Variables keep their numbers, and the set of solutions stays the same. A replaced variable is defined by
    what it is equal to; equations and inputs may become fewer, products never more. A contradiction becomes
    the equation 1 = 0. Presolving once more changes nothing.
    """
    if any(equation.terms == _FALSE.terms for equation in system.equations):
        return system
    work = _System.of(system)
    before = None
    # What one pass could not replace may be possible after what it has replaced.
    while work is not before and not work.contradicts:
        before, work = work, _with_ties_replaced(work)
    if work.contradicts:
        return replace(system, equations=(*system.equations, _FALSE))
    return work.result(system)


def _with_ties_replaced(system: "_System") -> "_System":
    """The system after one attempt at each relation; the same object where none could be replaced."""
    tried: set[Affine] = set()
    while not system.contradicts:
        relation = next((relation for relation in _relations(system) if relation not in tried), None)
        if relation is None:
            break
        tried.add(relation)
        system = _replaced(system, relation)
    return system


@dataclass(frozen=True, eq=False)
class _System:
    """A system under work; `replaced` are the definitions of variables that occur nowhere else."""

    lower: Array
    upper: Array
    definitions: dict[int, Definition]
    replaced: dict[int, Polynomial]
    equations: tuple[Polynomial, ...]
    redundant: tuple[Polynomial, ...]
    inequalities: tuple[Polynomial, ...]
    contradicts: bool = False

    @classmethod
    def of(cls, system: PolynomialSystem) -> "_System":
        used = _variables(
            *system.definitions.values(), *system.equations, *system.redundant, *system.inequalities
        )
        replaced = {
            k: d
            for k, d in system.definitions.items()
            if k not in used and isinstance(d, Polynomial) and d.degree <= 1 and len(d.variables) <= 1
        }
        definitions = {k: d for k, d in system.definitions.items() if k not in replaced}
        return cls(
            system.lower, system.upper, definitions, replaced,
            system.equations, system.redundant, system.inequalities,
        )  # fmt: skip

    def result(self, system: PolynomialSystem) -> PolynomialSystem:
        """The finished system, without repeated rows."""
        equations = _without_repeats(self.equations)
        return replace(
            system,
            lower=self.lower,
            upper=self.upper,
            definitions={**self.definitions, **self.replaced},
            equations=equations,
            redundant=_without_repeats(self._beyond_rounding(), equations),
            inequalities=_without_repeats(self.inequalities, signed=True),
        )

    def _beyond_rounding(self) -> list[Polynomial]:
        """The redundant rows but for those that are rounding alone.

        Columns of a rotation are perpendicular up to rounding: what is left of that where all else cancels,
        such as 4e-16 x y = 0, is true of no solution.
        """
        return [row for row in self.redundant if max(map(abs, row.terms.values()), default=0.0) > _ROUNDING]

    def is_input(self, x: int) -> bool:
        return x not in self.definitions and x not in self.replaced

    @property
    def rows(self) -> list[Polynomial]:
        """Everything that may need products."""
        defined = [d for d in self.definitions.values() if isinstance(d, Polynomial)]
        return [*defined, *self.equations, *self.redundant, *self.inequalities]


def _variables(*parts: Definition) -> set[int]:
    return {i for p in parts for i in p.variables}


def _relations(system: _System) -> Iterator[Affine]:
    yield from fixed_inputs(system.lower, system.upper, system.is_input)
    yield from affine_definitions(system.definitions)
    yield from related_inputs(system.equations, system.is_input)


def _without_repeats(
    rows: Sequence[Polynomial], others: Sequence[Polynomial] = (), *, signed: bool = False
) -> tuple[Polynomial, ...]:
    """The rows but for zero and multiples of an earlier row or one of the others; positive ones if signed."""
    seen: dict[frozenset[Monomial], list[Polynomial]] = {}
    for row in others:
        seen.setdefault(frozenset(row.terms), []).append(row)
    kept = []
    for row in rows:
        alike = seen.setdefault(frozenset(row.terms), [])
        if row.terms and not any(_is_multiple(row, other, signed) for other in alike):
            alike.append(row)
            kept.append(row)
    return tuple(kept)


def _is_multiple(p: Polynomial, q: Polynomial, signed: bool) -> bool:
    """Whether p is a multiple of q, which has the same monomials; a positive one if signed."""
    pairs = [(c, q.terms[m]) for m, c in p.terms.items()]
    if not pairs or p.degree == 0:
        return False
    first = pairs[0]
    positive = first[0] * first[1] > 0.0 or not signed
    return positive and all(proportional(*pair, *first) for pair in pairs[1:])


def _replaced(system: _System, relation: Affine) -> _System:
    """The system with a variable replaced everywhere, or as it was where that can't be done exactly."""
    x, scale, y, shift, source = relation
    try:
        value = _polynomial({(y,): scale, (): shift})
        after = replace(
            system,
            definitions={k: _in_definition(d, relation) for k, d in system.definitions.items() if k != x},
            replaced={**{k: _inserted(d, relation) for k, d in system.replaced.items()}, x: value},
            equations=tuple(_inserted(e, relation) for k, e in enumerate(system.equations) if k != source),
            redundant=tuple(_inserted(e, relation) for e in system.redundant),
            inequalities=tuple(_inserted(e, relation) for e in system.inequalities),
        )
    except _CannotReplace:
        return system
    if _needs_more_products(system, after):
        return system
    return _without_constants(_bounded(after, relation, system), system)


def _needs_more_products(before: _System, after: _System) -> bool:
    """Whether products of three or more factors come to be shared less; those of two never do."""
    if max((row.degree for row in before.rows), default=0) < 3:
        return False
    return count_products(after.rows) > count_products(before.rows)


def _bounded(system: _System, relation: Affine, before: _System) -> _System:
    """The system with the interval of x carried over to y; a fixed x gets its point."""
    x, scale, y, shift, _ = relation
    low, high = system.lower[x], system.upper[x]
    lower, upper = system.lower.copy(), system.upper.copy()
    if not scale:
        outside = not low <= shift <= high  # floats and fractions compare exactly
        lower[x] = upper[x] = float(shift)
        return replace(system, lower=lower, upper=upper, contradicts=system.contradicts or outside)
    defined_as = before.definitions.get(x)
    if isinstance(defined_as, Polynomial) and bounds_itself(x, defined_as, before.lower, before.upper):
        return system  # the interval says nothing
    ends = [(Fraction(float(end)) - shift) / scale if isfinite(end) else None for end in (low, high)]
    below, above = ends if scale > 0 else ends[::-1]
    if below is not None:
        lower[y] = max(lower[y], enclose_fraction(below)[0])
    if above is not None:
        upper[y] = min(upper[y], enclose_fraction(above)[1])
    empty = bool(lower[y] > upper[y])
    image = [scale * Fraction(float(end)) + shift for end in (lower[y], upper[y]) if isfinite(end)]
    if len(image) == 2 and low <= min(image) and max(image) <= high:
        # Now the interval of y says it all; with room for rounding, that of x is never in the way.
        around = bound_polynomial(system.replaced[x], lower, upper)
        lower[x], upper[x] = min(low, around[0]), max(high, around[1])
    return replace(system, lower=lower, upper=upper, contradicts=system.contradicts or empty)


def _without_constants(system: _System, before: _System) -> _System:
    """Rows that have become constant say nothing, or that there is no solution.

    A constant that was there before may be the rounding of what cancelled in it, and is left alone.
    """
    old = {id(row) for row in (*before.equations, *before.redundant, *before.inequalities)}

    def is_new(row: Polynomial) -> bool:
        return row.degree == 0 and id(row) not in old

    false = any(is_new(e) and e.terms for e in system.equations)
    false |= any(is_new(g) and g.terms.get((), 0.0) < 0.0 for g in system.inequalities)
    return replace(
        system,
        equations=tuple(e for e in system.equations if not is_new(e)),
        redundant=tuple(e for e in system.redundant if not is_new(e)),
        inequalities=tuple(g for g in system.inequalities if not is_new(g)),
        contradicts=system.contradicts or false,
    )


def _in_definition(definition: Definition, relation: Affine) -> Definition:
    if isinstance(definition, Polynomial):
        return _inserted(definition, relation)
    if relation.x not in definition.variables:
        return definition
    if isinstance(definition, TrigFunction):
        return _of_another(definition, relation)
    if relation.scale != 1 or relation.shift != 0:
        raise _CannotReplace
    i, j = (relation.y if k == relation.x else k for k in (definition.i, definition.j))
    return replace(definition, i=i, j=j)


def _of_another(function: TrigFunction, relation: Affine) -> TrigFunction:
    """The same function of y, x being scale y + shift, if its ratio stays above zero and nothing rounds."""
    ratio = Fraction(function.ratio) * relation.scale
    offset = Fraction(function.ratio) * relation.shift + Fraction(function.offset)
    ends = enclose_fraction(ratio), enclose_fraction(offset)
    if ratio <= 0 or any(low != high for low, high in ends):
        raise _CannotReplace
    return TrigFunction(relation.y, function.kind, ends[0][0], ends[1][0])


def _inserted(polynomial: Polynomial, relation: Affine) -> Polynomial:
    """The polynomial with x replaced; the same object where x does not occur."""
    if not any(relation.x in monomial for monomial in polynomial.terms):
        return polynomial
    return _polynomial(collected(_expanded(polynomial, relation)))


def _expanded(polynomial: Polynomial, relation: Affine) -> Iterator[tuple[Monomial, Fraction]]:
    """Terms by the binomial theorem, where x = scale y + shift."""
    for monomial, c in polynomial.terms.items():
        degree = monomial.count(relation.x)
        rest = tuple(i for i in monomial if i != relation.x)
        for power in range(degree + 1 if relation.scale else 1):
            factor = comb(degree, power) * relation.scale**power * relation.shift ** (degree - power)
            yield tuple(sorted((*rest, *[relation.y] * power))), Fraction(c) * factor


def _polynomial(terms: dict[Monomial, Fraction]) -> Polynomial:
    """The polynomial with these coefficients, if all of them are floats."""
    out = {m: enclose_fraction(c) for m, c in terms.items()}
    if any(low != high for low, high in out.values()):
        raise _CannotReplace
    return Polynomial({m: low for m, (low, _) in out.items()})
