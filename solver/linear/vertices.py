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

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Mask
from ...base.numeric.simplex import AT_UPPER, Tableau, feasible_basis, minimise
from .vertex_bound import VertexBox, least_value, prepare, to_vertices
from .vertex_program import VertexProgram

__all__ = ["contract_by_vertices"]


@compiled
def _constraints(p: VertexProgram, box: VertexBox, A: Array, beta: Array, scales: Array) -> None:
    """Fills A (rows, columns), beta (rows,) >= 0 and the factors (rows,) that equations were multiplied by.

    Columns: weights of vertices, free variables and gaps as shares of their intervals.
    """
    lower, upper, ends, chords = box
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
            to_vertices(values, ends, p.atom_start[g], p.atom_start[g + 1] - p.atom_start[g])
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


@compiled
def _cost(p: VertexProgram, k: int, sign: float, cost: Array) -> None:
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


@compiled
def _touched(p: VertexProgram, t: Tableau, share: Array, done: Mask, close: float) -> None:
    """Marks in done (n, 2) the ends of the box that the program's point comes close to: no gain there.

    share: (n,) room for where the point is, as a share of each interval.
    """
    groups = len(p.atom_start) - 1
    share[:] = 0.0
    for r in range(len(t.basis)):
        q = t.basis[r]
        if q < p.group_place[groups]:
            g = 0
            while q >= p.group_place[g + 1]:
                g += 1
            for a in range(p.atom_start[g], p.atom_start[g + 1]):
                if p.atom_exponent[a] == 1 and (q - p.group_place[g]) & (1 << (a - p.atom_start[g])):
                    share[p.atom_variable[a]] += t.beta[r]
        elif q < p.power_place:
            share[p.free[q - p.group_place[groups]]] += t.beta[r]
    for i in range(len(p.free)):
        if t.status[p.group_place[groups] + i] == AT_UPPER:
            share[p.free[i]] = 1.0
    for k in range(len(share)):
        if share[k] <= close:
            done[k, 0] = True
        if share[k] >= 1.0 - close:
            done[k, 1] = True


@compiled
def _nearest_end(share: Array, done: Mask) -> tuple[int, int]:
    """The end of the box not done yet that the program's point is nearest to; -1 where all are done."""
    least, k, side = np.inf, -1, 0
    for j in range(len(share)):
        if not done[j, 0] and share[j] < least:
            least, k, side = share[j], j, 0
        if not done[j, 1] and 1.0 - share[j] < least:
            least, k, side = 1.0 - share[j], j, 1
    return k, side


@compiled
def contract_by_vertices(p: VertexProgram, lower: Array, upper: Array, close: float) -> bool:
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
    # The bounds are moved while the programs are those of the box as it was.
    ends, chords = np.empty((len(p.atom_variable), 2)), np.empty((len(p.power_variable), 3))
    box = VertexBox(lower.copy(), upper.copy(), ends, chords)
    if p.equations == 0 or not prepare(p, box):
        return True
    A, beta, scales = np.empty((rows, columns)), np.empty(rows), np.ones(rows)
    _constraints(p, box, A, beta, scales)
    if not np.isfinite(A).all():
        return True
    bounds = np.full(columns + rows, np.inf)
    bounds[p.group_place[groups] : columns] = 1.0
    basis, status = np.empty(rows, dtype=np.int64), np.empty(columns + rows, dtype=np.int64)
    inverse, cost, y = np.empty((rows, rows)), np.empty(columns + rows), np.empty(rows)
    tableau = Tableau(A, bounds, inverse, beta, basis, status, y)
    left = feasible_basis(tableau)
    if left > 1e-8:
        y *= scales
        return not least_value(p, box, -1, 1.0, y) > 0.0
    share = np.empty(n)
    done = np.zeros((n, 2), dtype=np.bool_)
    for k in range(n):
        done[k] = not upper[k] > lower[k]
    _touched(p, tableau, share, done, close)
    while True:
        k, side = _nearest_end(share, done)
        if k < 0:
            return True
        sign = 1.0 if side == 0 else -1.0
        _cost(p, k, sign, cost)
        start = sign * share[k]
        enough = close if side == 0 else close - 1.0
        minimise(tableau, cost, start, enough)
        _touched(p, tableau, share, done, close)
        if done[k, side]:
            continue
        done[k, side] = True
        y *= scales * (box.upper[k] - box.lower[k])
        bound = least_value(p, box, k, sign, y)
        if side == 0:
            lower[k] = max(lower[k], bound)
        else:
            upper[k] = min(upper[k], -bound)
        if lower[k] > upper[k]:
            return False
