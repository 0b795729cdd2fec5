"""Newton's method on a box: the interval step, and a preconditioned expansion of second order."""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices
from ..enclosure import Expansion, NativeSystem
from ..interval import add, div, down, mul, power, sub, up

__all__ = ["newton_step", "taylor_step"]


@compiled
def newton_step(
    s: NativeSystem, x: Array, lower: Array, upper: Array, solved: Indices, Y: Array, at: Expansion
) -> int:
    """Preconditioned interval Newton by Gauss-Seidel on the variables `solved`, in place.

    Args:
        s: the system.
        x: (n,) expansion point in the box.
        lower: (n,) box.
        upper: (n,) box.
        solved: (k,) variables to solve for; the others are carried along as parameters.
        Y: (k, m) preconditioner.
        at: equations at x and slopes over the box.

    Returns:
        -1 empty; 1 where every solved variable fell strictly inside its own interval (with k = m: for all
        values of the others in the box there is exactly one solution in the box as it was); else 0.
    """
    k, m = Y.shape
    n = len(lower)
    f_lower, f_upper, J_lower, J_upper = at.f_lower, at.f_upper, at.J_lower, at.J_upper
    inside = True
    for r in range(k):
        i = solved[r]
        bl, bu = 0.0, 0.0
        for e in range(m):
            pl, pu = mul(Y[r, e], Y[r, e], f_lower[e], f_upper[e])
            bl, bu = add(bl, bu, pl, pu)
        al, au = 0.0, 0.0
        for j in range(n):
            gl, gu = 0.0, 0.0
            for u in range(s.user_start[j], s.user_start[j + 1]):
                e = s.user[u]
                if Y[r, e] != 0.0:
                    pl, pu = mul(Y[r, e], Y[r, e], J_lower[e, j], J_upper[e, j])
                    gl, gu = add(gl, gu, pl, pu)
            if gl == 0.0 == gu:
                continue
            if j == i:
                al, au = gl, gu
                continue
            dl, du = sub(lower[j], upper[j], x[j], x[j])
            pl, pu = mul(gl, gu, dl, du)
            bl, bu = add(bl, bu, pl, pu)
        # a (X_i - x_i) = -b
        if al <= 0.0 <= au:
            inside = False
            if not bl <= 0.0 <= bu and _split_division(x[i], al, au, -bu, -bl, lower, upper, i) < 0:
                return -1
            continue
        ql, qu = div(-bu, -bl, al, au)
        nl, nu = add(x[i], x[i], ql, qu)
        if not (nl > lower[i] and nu < upper[i]):
            inside = False
        lower[i], upper[i] = max(lower[i], nl), min(upper[i], nu)
        if lower[i] > upper[i]:
            return -1
    return 1 if inside else 0


@compiled
def taylor_step(
    s: NativeSystem, x: Array, lower: Array, upper: Array, solved: Indices, Y: Array, at: Expansion
) -> int:
    """Preconditioned second-order expansion about x, solved for each variable in turn, in place.

    With d = X - x: Y f(x) + Y J(x) d + sum_jk (Y H(X)/2)_jk d_j d_k = 0 for every solution, where J holds at
    x alone and H over the box. Squares d_j^2 are taken as such, which an interval Newton step can't do.

    Returns:
        -1 empty, else 0.
    """
    k, m = Y.shape
    for r in range(k):
        i = solved[r]
        # c + a d_i + q d_i^2 = 0.
        cl, cu = 0.0, 0.0
        for e in range(m):
            if Y[r, e] != 0.0:
                pl, pu = mul(Y[r, e], Y[r, e], at.f_lower[e], at.f_upper[e])
                cl, cu = add(cl, cu, pl, pu)
        al, au, ll, lu = _linear_part(s, x, lower, upper, i, Y[r], at)
        cl, cu = add(cl, cu, ll, lu)
        ql, qu, bl, bu, ll, lu = _curved_part(s, x, lower, upper, i, Y[r], at)
        cl, cu = add(cl, cu, ll, lu)
        al, au = add(al, au, bl, bu)
        if _solve_quadratic(x[i], i, (cl, cu), (al, au), (ql, qu), lower, upper) < 0:
            return -1
    return 0


@compiled
def _linear_part(
    s: NativeSystem, x: Array, lower: Array, upper: Array, i: int, y: Array, at: Expansion
) -> tuple[float, float, float, float]:
    """Of y (m,) J(x) d: the factor of d_i, and the sum of all else."""
    al, au, cl, cu = 0.0, 0.0, 0.0, 0.0
    for j in range(len(x)):
        gl, gu = 0.0, 0.0
        for u in range(s.user_start[j], s.user_start[j + 1]):
            e = s.user[u]
            if y[e] != 0.0:
                pl, pu = mul(y[e], y[e], at.J0_lower[e, j], at.J0_upper[e, j])
                gl, gu = add(gl, gu, pl, pu)
        if j == i:
            al, au = gl, gu
        elif gl != 0.0 or gu != 0.0:
            dl, du = sub(lower[j], upper[j], x[j], x[j])
            pl, pu = mul(gl, gu, dl, du)
            cl, cu = add(cl, cu, pl, pu)
    return al, au, cl, cu


@compiled
def _curved_part(
    s: NativeSystem, x: Array, lower: Array, upper: Array, i: int, y: Array, at: Expansion
) -> tuple[float, float, float, float, float, float]:
    """Of d (y H / 2) d: the factors of d_i^2 and of d_i, and the sum of all else."""
    ql, qu, al, au, cl, cu = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for p in range(len(s.pair)):
        a, b = s.pair[p]
        hl, hu = 0.0, 0.0
        for c in range(s.pair_start[p], s.pair_start[p + 1]):
            e = s.pair_user[c]
            if y[e] != 0.0:
                pl, pu = mul(y[e], y[e], at.H_lower[c], at.H_upper[c])
                hl, hu = add(hl, hu, pl, pu)
        if hl == 0.0 == hu:
            continue
        if a == b == i:
            ql, qu = hl, hu
            continue
        dl, du = sub(lower[a], upper[a], x[a], x[a])
        if a == b:
            sl, su = power(dl, du, 2)
            pl, pu = mul(hl, hu, sl, su)
            cl, cu = add(cl, cu, pl, pu)
            continue
        hl, hu = mul(2.0, 2.0, hl, hu)
        el, eu = sub(lower[b], upper[b], x[b], x[b])
        if a == i:
            pl, pu = mul(hl, hu, el, eu)
            al, au = add(al, au, pl, pu)
        elif b == i:
            pl, pu = mul(hl, hu, dl, du)
            al, au = add(al, au, pl, pu)
        else:
            sl, su = mul(dl, du, el, eu)
            pl, pu = mul(hl, hu, sl, su)
            cl, cu = add(cl, cu, pl, pu)
    return ql, qu, al, au, cl, cu


@compiled
def _solve_quadratic(
    x: float,
    i: int,
    c: tuple[float, float],
    a: tuple[float, float],
    q: tuple[float, float],
    lower: Array,
    upper: Array,
) -> int:
    """Narrows X_i by c + a d + q d^2 = 0 with d = X_i - x, in place; -1 where it becomes empty, else 0."""
    # First with q d^2 as a range, then d (a + q d) = -c.
    dl, du = sub(lower[i], upper[i], x, x)
    sl, su = power(dl, du, 2)
    pl, pu = mul(q[0], q[1], sl, su)
    bl, bu = add(c[0], c[1], pl, pu)
    if not a[0] <= 0.0 <= a[1]:
        tl, tu = div(-bu, -bl, a[0], a[1])
        nl, nu = add(x, x, tl, tu)
        lower[i], upper[i] = max(lower[i], nl), min(upper[i], nu)
    elif not bl <= 0.0 <= bu and _split_division(x, a[0], a[1], -bu, -bl, lower, upper, i) < 0:
        return -1
    if lower[i] > upper[i]:
        return -1
    dl, du = sub(lower[i], upper[i], x, x)
    pl, pu = mul(q[0], q[1], dl, du)
    gl, gu = add(a[0], a[1], pl, pu)
    if not gl <= 0.0 <= gu:
        tl, tu = div(-c[1], -c[0], gl, gu)
        nl, nu = add(x, x, tl, tu)
        lower[i], upper[i] = max(lower[i], nl), min(upper[i], nu)
    return -1 if lower[i] > upper[i] else 0


@compiled
def _split_division(
    x: float, al: float, au: float, bl: float, bu: float, lower: Array, upper: Array, i: int
) -> int:
    """Cuts X_i where a divisor holds zero and the dividend does not: two half lines around x."""
    # Quotients lie at or below q1 and at or above q2.
    if bl > 0.0:
        q1 = up(bl / al) if al < 0.0 else -np.inf
        q2 = down(bl / au) if au > 0.0 else np.inf
    else:
        q1 = up(bu / au) if au > 0.0 else -np.inf
        q2 = down(bu / al) if al < 0.0 else np.inf
    left = up(x + q1) if q1 > -np.inf else -np.inf
    right = down(x + q2) if q2 < np.inf else np.inf
    has_left, has_right = left >= lower[i], right <= upper[i]
    if not has_left and not has_right:
        return -1
    if not has_left:
        lower[i] = max(lower[i], right)
    elif not has_right:
        upper[i] = min(upper[i], left)
    return 0
