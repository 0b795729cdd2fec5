"""Contraction of a box by linear programs over the vertices of its products.

A polynomial that is linear in each of its variables takes, at a point of a box, a convex combination of its
values at the vertices, and the same weights give the point itself. So for every solution of a system in the
box there are weights on the vertices that turn all equations to zero at once: linear conditions, over which
each variable is minimised and maximised. This is the convex hull of all products together, and so at least as
tight as the planes around each product alone; and it combines equations as no preconditioner does.

Powers of a variable are a chord and a gap, or where they are multiplied with others, variables of their own.
Monomials fall into groups without a common variable, so that few vertices are enough.

What the linear program says is not believed: each bound is computed again from its dual values, as the least
value of one combined polynomial over the box, with all roundings accounted for.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import Array, Indices, offsets
from ..interval import add, down, jit, mul, power, scale, sub, up
from ..polynomial import ExactPolynomial, enclose_fraction
from .simplex import AT_UPPER, feasible_basis, minimise

__all__ = ["VertexProgram", "contract_by_vertices", "least_value", "vertex_program"]


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


@jit
def _gap_of_convex(low_x, high_x, e, slope):  # type: ignore[no-untyped-def]
    """Range of x^e - slope x on [low_x, high_x], where x^e is convex."""
    high = -np.inf
    for x in (low_x, high_x):
        pl, pu = power(x, x, e)
        ql, qu = scale(x, slope, slope)
        high = max(high, sub(pl, pu, ql, qu)[1])
    # The tangent next to the lowest point lies below.
    t = (abs(slope) / e) ** (1.0 / (e - 1))
    t = min(max(t if slope > 0.0 else -t, low_x), high_x)
    pl, pu = power(t, t, e)
    ql, qu = scale(t, slope, slope)
    vl, vu = sub(pl, pu, ql, qu)
    pl, pu = power(t, t, e - 1)
    pl, pu = scale(float(e), pl, pu)
    dl, du = sub(pl, pu, slope, slope)
    xl, xu = sub(low_x, high_x, t, t)
    ql, qu = mul(dl, du, xl, xu)
    return add(vl, vu, ql, qu)[0], high


@jit
def _gap(low_x, high_x, e, slope):  # type: ignore[no-untyped-def]
    """Range of x^e - slope x on [low_x, high_x]."""
    if e % 2 == 0 or low_x >= 0.0:
        return _gap_of_convex(low_x, high_x, e, slope)
    if high_x <= 0.0:
        low, high = _gap_of_convex(-high_x, -low_x, e, slope)
        return -high, -low
    low, high = _gap_of_convex(0.0, -low_x, e, slope)
    low2, high2 = _gap_of_convex(0.0, high_x, e, slope)
    return min(-high, low2), max(-low, high2)


@jit
def _chord_slope(low_x, high_x, e):  # type: ignore[no-untyped-def]
    """(high_x^e - low_x^e) / (high_x - low_x) without the division, to rounding."""
    slope, product = 0.0, 1.0
    for _ in range(e):
        slope = slope * high_x + product
        product *= low_x
    return slope


@jit
def _prepare(p, lower, upper, ends, chords):  # type: ignore[no-untyped-def]
    """Ends (atoms, 2) of the atoms, and slope, least and largest gap (powers, 3) of the pure powers.

    Returns False where something isn't finite.
    """
    finite = True
    for a in range(len(p.atom_variable)):
        k = p.atom_variable[a]
        ends[a, 0], ends[a, 1] = power(lower[k], upper[k], p.atom_exponent[a])
        finite = finite and np.isfinite(ends[a, 0]) and np.isfinite(ends[a, 1])
    for j in range(len(p.power_variable)):
        low_x, high_x, e = lower[p.power_variable[j]], upper[p.power_variable[j]], p.power_exponent[j]
        slope = _chord_slope(low_x, high_x, e)
        low, high = _gap(low_x, high_x, e, slope)
        chords[j, 0], chords[j, 1], chords[j, 2] = slope, low, high
        finite = finite and np.isfinite(slope) and np.isfinite(low) and np.isfinite(high)
    return finite


@jit
def _to_vertices(values, ends, first, count):  # type: ignore[no-untyped-def]
    """Turns coefficients of products (2^count,) into values at the vertices, in place."""
    for b in range(count):
        low, high = ends[first + b, 0], ends[first + b, 1]
        stride = 1 << b
        for start in range(0, len(values), 2 * stride):
            for i in range(start, start + stride):
                c0, c1 = values[i], values[i + stride]
                values[i] = c0 + c1 * low
                values[i + stride] = c0 + c1 * high


@jit
def least_value(p, lower, upper, ends, chords, k, sign, y, y_sign):  # type: ignore[no-untyped-def]
    """A proved lower bound, over a box, of sign x_k - y_sign sum_e y_e f_e(x); k < 0: without x_k.

    Args:
        p: the program.
        lower: (n,) box.
        upper: (n,)
        ends: of `_prepare`.
        chords: of `_prepare`.
        k: a variable or -1.
        sign: 1 or -1.
        y: (rows,) any numbers.
        y_sign: 1 or -1.
    """
    constant = p.power_place + len(p.power_variable)
    cl, cu = np.zeros(constant + 1), np.zeros(constant + 1)
    if k >= 0:
        cl[p.home[k]] = cu[p.home[k]] = sign
    for e in range(len(p.term_start) - 1):
        if y[e] != 0.0:
            for t in range(p.term_start[e], p.term_start[e + 1]):
                q = p.place[t]
                pl, pu = scale(-y_sign * y[e], p.c_lower[t], p.c_upper[t])
                cl[q], cu[q] = add(cl[q], cu[q], pl, pu)
    total_l, total_u = cl[constant], cu[constant]
    for j in range(len(p.power_variable)):
        q, home = p.power_place + j, p.home[p.power_variable[j]]
        if cl[q] != 0.0 or cu[q] != 0.0:
            pl, pu = scale(chords[j, 0], cl[q], cu[q])
            cl[home], cu[home] = add(cl[home], cu[home], pl, pu)
            pl, pu = mul(cl[q], cu[q], chords[j, 1], chords[j, 2])
            total_l, total_u = add(total_l, total_u, pl, pu)
    groups = len(p.atom_start) - 1
    for i in range(len(p.free)):
        q = p.group_place[groups] + i
        pl, pu = mul(cl[q], cu[q], lower[p.free[i]], upper[p.free[i]])
        total_l, total_u = add(total_l, total_u, pl, pu)
    for g in range(groups):
        begin, end = p.group_place[g], p.group_place[g + 1]
        least = _least_at_vertices(cl[begin:end], cu[begin:end], ends, p.atom_start[g], p.atom_start[g + 1])
        total_l, total_u = add(total_l, total_u, least, least)
    return total_l if np.isfinite(total_l) else -np.inf


@jit
def _least_at_vertices(cl, cu, ends, first, last):  # type: ignore[no-untyped-def]
    """A lower bound of the least vertex value of a product form with interval coefficients (2^count,).

    Computed to nearest: each coefficient takes part in 2 count roundings on its way, so that the error is at
    most 2 count + 1 units of 2^-53 of the sum of all magnitudes; twice that is taken off.
    """
    count = last - first
    size = len(cl)
    middle = 0.5 * (cl + cu)
    weight = np.ones(size)
    room = 1.0
    for b in range(count):
        largest = max(abs(ends[first + b, 0]), abs(ends[first + b, 1]), 1e-30)
        room *= max(largest, 1.0)
        stride = 1 << b
        for i in range(stride):
            weight[i + stride] = weight[i] * largest
    magnitude, blur = 0.0, 0.0
    for i in range(size):
        if cl[i] != 0.0 or cu[i] != 0.0:
            magnitude += abs(middle[i]) * weight[i]
            blur += up(max(cu[i] - middle[i], middle[i] - cl[i])) * weight[i]
    error = (magnitude * (2 * count + 1) * 2.0**-52 + blur) * (1.0 + 1e-12) + 1e-300 * room
    _to_vertices(middle, ends, first, count)
    least = np.inf
    for i in range(size):
        # Not a number compares false: it must not pass for a large value.
        if not (middle[i] >= least):
            least = middle[i]
    return down(least - error) if np.isfinite(error) and np.isfinite(least) else -np.inf


@jit
def _constraints(p, lower, upper, ends, chords, A, beta, scales):  # type: ignore[no-untyped-def]
    """Fills A (rows, columns), beta (rows,) >= 0 and the factors (rows,) that equations were multiplied by.

    Columns: weights of vertices, free variables and gaps as shares of their intervals.
    """
    rows, columns = A.shape
    groups = len(p.atom_start) - 1
    n_equations = rows - groups
    A[:] = 0.0
    for e in range(n_equations):
        row = A[e]
        constant = 0.0
        for t in range(p.term_start[e], p.term_start[e + 1]):
            q, c = p.place[t], 0.5 * (p.c_lower[t] + p.c_upper[t])
            if q == columns:
                constant += c
            elif q >= p.power_place:
                j = q - p.power_place
                row[p.home[p.power_variable[j]]] += c * chords[j, 0]
                constant += c * chords[j, 1]
                row[q] = c * (chords[j, 2] - chords[j, 1])
            else:
                row[q] += c
        for i in range(len(p.free)):
            q, k = p.group_place[groups] + i, p.free[i]
            constant += row[q] * lower[k]
            row[q] *= upper[k] - lower[k]
        for g in range(groups):
            values = row[p.group_place[g] : p.group_place[g + 1]]
            _to_vertices(values, ends, p.atom_start[g], p.atom_start[g + 1] - p.atom_start[g])
            # Weights add up to one, so a value common to all vertices can be taken off and costs no digits.
            middle = 0.5 * (values[0] + values[-1])
            constant += middle
            values -= middle
        size = 0.0
        for q in range(columns):
            size = max(size, abs(row[q]))
        factor = 1.0 / size if size > 0.0 else 1.0
        if constant > 0.0:
            factor = -factor
        row *= factor
        beta[e] = -constant * factor
        scales[e] = factor
    for g in range(groups):
        A[n_equations + g, p.group_place[g] : p.group_place[g + 1]] = 1.0
        beta[n_equations + g] = 1.0


@jit
def _cost(p, k, sign, cost):  # type: ignore[no-untyped-def]
    """Cost (columns + rows,) of sign x_k in units of its width, up to a constant."""
    cost[:] = 0.0
    q = p.home[k]
    groups = len(p.atom_start) - 1
    if q >= p.group_place[groups]:
        cost[q] = sign
        return
    g = 0
    while q >= p.group_place[g + 1]:
        g += 1
    bit = q - p.group_place[g]
    for v in range(p.group_place[g + 1] - p.group_place[g]):
        if v & bit:
            cost[p.group_place[g] + v] = sign


@jit
def _touched(p, basis, beta, status, share, done, close):  # type: ignore[no-untyped-def]
    """Marks in done (n, 2) the ends of the box that the program's point comes close to: no gain there.

    share: (n,) room for where the point is, as a share of each interval.
    """
    groups = len(p.atom_start) - 1
    share[:] = 0.0
    for r in range(len(basis)):
        q = basis[r]
        if q < p.group_place[groups]:
            g = 0
            while q >= p.group_place[g + 1]:
                g += 1
            for a in range(p.atom_start[g], p.atom_start[g + 1]):
                if p.atom_exponent[a] == 1 and (q - p.group_place[g]) & (1 << (a - p.atom_start[g])):
                    share[p.atom_variable[a]] += beta[r]
        elif q < p.power_place:
            share[p.free[q - p.group_place[groups]]] += beta[r]
    for i in range(len(p.free)):
        if status[p.group_place[groups] + i] == AT_UPPER:
            share[p.free[i]] = 1.0
    for k in range(len(share)):
        if share[k] <= close:
            done[k, 0] = True
        if share[k] >= 1.0 - close:
            done[k, 1] = True


@jit
def _nearest_end(share, done):  # type: ignore[no-untyped-def]
    """The end of the box not done yet that the program's point is nearest to; -1 where all are done."""
    least, k, side = np.inf, -1, 0
    for j in range(len(share)):
        if not done[j, 0] and share[j] < least:
            least, k, side = share[j], j, 0
        if not done[j, 1] and 1.0 - share[j] < least:
            least, k, side = 1.0 - share[j], j, 1
    return k, side


@jit
def contract_by_vertices(p, lower, upper, close):  # type: ignore[no-untyped-def]
    """Contracts a box in place; False where it is proved empty.

    Args:
        p: the program.
        lower: (n,)
        upper: (n,)
        close: share of a width; a smaller gain isn't worth a program.
    """
    n = len(lower)
    groups = len(p.atom_start) - 1
    rows = len(p.term_start) - 1 + groups
    columns = p.power_place + len(p.power_variable)
    ends, chords = np.empty((len(p.atom_variable), 2)), np.empty((len(p.power_variable), 3))
    if p.equations == 0 or not _prepare(p, lower, upper, ends, chords):
        return True
    A, beta, scales = np.empty((rows, columns)), np.empty(rows), np.ones(rows)
    _constraints(p, lower, upper, ends, chords, A, beta, scales)
    if not np.isfinite(A).all():
        return True
    bounds = np.full(columns + rows, np.inf)
    bounds[p.group_place[groups] : columns] = 1.0
    basis, status = np.empty(rows, dtype=np.int64), np.empty(columns + rows, dtype=np.int64)
    inverse, cost, y = np.empty((rows, rows)), np.empty(columns + rows), np.empty(rows)
    left = feasible_basis(A, inverse, beta, bounds, basis, status, y)
    low, high = lower.copy(), upper.copy()
    if left > 1e-8:
        y *= scales
        return not least_value(p, low, high, ends, chords, -1, 1.0, y, 1.0) > 0.0
    share = np.empty(n)
    done = np.zeros((n, 2), dtype=np.bool_)
    for k in range(n):
        done[k] = not upper[k] > lower[k]
    _touched(p, basis, beta, status, share, done, close)
    while True:
        k, side = _nearest_end(share, done)
        if k < 0:
            return True
        sign = 1.0 if side == 0 else -1.0
        _cost(p, k, sign, cost)
        start = sign * share[k]
        enough = close if side == 0 else close - 1.0
        minimise(A, inverse, beta, bounds, basis, status, cost, y, start, enough)
        _touched(p, basis, beta, status, share, done, close)
        if done[k, side]:
            continue
        done[k, side] = True
        y *= scales * (high[k] - low[k])
        bound = least_value(p, low, high, ends, chords, k, sign, y, 1.0)
        if side == 0:
            lower[k] = max(lower[k], bound)
        else:
            upper[k] = min(upper[k], -bound)
        if lower[k] > upper[k]:
            return False
