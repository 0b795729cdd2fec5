"""A polynomial system prepared for linear programs over vertices; `vertices.py` says what these are."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...base.numeric.arrays import Array, Indices, offsets
from ..polynomial import ExactPolynomial, enclose_fraction

__all__ = ["VertexProgram", "vertex_program"]

_MOST_ATOMS = 9  # of a group: 2^9 vertices
_MOST_ENTRIES = 60_000  # of the matrix and the inverse of its basis


class VertexProgram(NamedTuple):
    """A system prepared for linear programs over vertices.

    A place is where a monomial has its coefficient: first the groups, each with a place for every product of
    its atoms (bit b of the place in the group: atom b is a factor), which is also a vertex (bit b: atom b at
    its upper end); then variables that are in no group; then pure powers; last the constant.

    Attributes:
        equations: number of equations; none where the system doesn't lend itself to this.
        term_start: (rows + 1,) terms of each row: equations, then an identity for each power that is an atom.
        place: place of each term.
        c_lower: coefficient of each term, lower ends.
        c_upper: coefficient of each term, upper ends.
        atom_start: (groups + 1,) atoms of each group.
        atom_variable: variable of each atom.
        atom_exponent: its exponent.
        group_place: (groups + 1,) first place of each group; the last is that of the free variables.
        free: variables in no group, in the order of their places.
        power_place: first place of pure powers.
        power_variable: variable of each.
        power_exponent: its exponent, >= 2.
        home: (n,) place of each variable.
    """

    equations: int
    term_start: Indices
    place: Indices
    c_lower: Array
    c_upper: Array
    atom_start: Indices
    atom_variable: Indices
    atom_exponent: Indices
    group_place: Indices
    free: Indices
    power_place: int
    power_variable: Indices
    power_exponent: Indices
    home: Indices


Factor = tuple[int, int]  # variable, exponent


def vertex_program(equations: Sequence[ExactPolynomial], n: int) -> VertexProgram:
    """Prepares exact equations in n variables."""
    groups = _groups(equations)
    atoms = [atom for group in groups for atom in group]
    powers = sorted(
        {m[0] for eq in equations for m in eq if len(m) == 1 and m[0][1] > 1} | {a for a in atoms if a[1] > 1}
    )
    group_place = [0]
    places: dict[tuple[Factor, ...], int] = {}
    bits: dict[Factor, int] = {}
    for group in groups:
        for b, atom in enumerate(group):
            bits[atom] = group_place[-1] + (1 << b)
        group_place.append(group_place[-1] + (1 << len(group)))
    group_of = {atom: g for g, group in enumerate(groups) for atom in group}
    free = [k for k in range(n) if (k, 1) not in bits]
    power_place = group_place[-1] + len(free)
    for (k, e), place in bits.items():
        if e == 1:
            places[((k, 1),)] = place
    places |= {((k, 1),): group_place[-1] + i for i, k in enumerate(free)}
    places |= {(p,): power_place + i for i, p in enumerate(powers)}
    places[()] = power_place + len(powers)

    def place_of(monomial: tuple[Factor, ...]) -> int:
        if monomial not in places:
            start = group_place[group_of[monomial[0]]]
            places[monomial] = start + sum(bits[f] - start for f in monomial)
        return places[monomial]

    rows = [[(place_of(m), enclose_fraction(c)) for m, c in eq.items()] for eq in equations]
    rows += [[(bits[a], (1.0, 1.0)), (places[(a,)], (-1.0, -1.0))] for a in atoms if a[1] > 1]
    n_rows, n_columns = len(rows) + len(groups), power_place + len(powers)
    fits = (
        all(len(group) <= _MOST_ATOMS for group in groups) and n_rows * (n_columns + n_rows) <= _MOST_ENTRIES
    )
    if not fits:
        return vertex_program([], 0)
    terms = [term for row in rows for term in row]
    return VertexProgram(
        len(equations),
        offsets([len(row) for row in rows]),
        _integers([place for place, _ in terms]),
        np.array([low for _, (low, _) in terms], dtype=np.float64),
        np.array([high for _, (_, high) in terms], dtype=np.float64),
        offsets([len(group) for group in groups]),
        _integers([k for k, _ in atoms]),
        _integers([e for _, e in atoms]),
        _integers(group_place),
        _integers(free),
        power_place,
        _integers([k for k, _ in powers]),
        _integers([e for _, e in powers]),
        _integers([places[((k, 1),)] for k in range(n)]),
    )


def _groups(equations: Sequence[ExactPolynomial]) -> list[list[Factor]]:
    """Powers of variables that are multiplied with others, grouped so that no product crosses groups."""
    groups: list[set[Factor]] = []
    for monomial in {m for eq in equations for m in eq if len(m) > 1}:
        joined = set(monomial)
        apart = []
        for group in groups:
            if group & joined:
                joined |= group
            else:
                apart.append(group)
        groups = [*apart, joined]
    return sorted(sorted(group) for group in groups)


def _integers(values: Sequence[int]) -> Indices:
    return np.array(values, dtype=np.int64)
