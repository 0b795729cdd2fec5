"""Newton's method on a box: the interval step, and a preconditioned expansion of second order."""

import numpy as np

from ...arrays import Array, Indices
from ...jit import compiled
from ..enclosure import Expansion
from ..interval import add, div, down, mul, power, sub, up

__all__ = ["newton_step", "taylor_step"]


@compiled
def newton_step(x: Array, lower: Array, upper: Array, solved: Indices, Y: Array, at: Expansion) -> int:
    """Preconditioned interval Newton by Gauss-Seidel on the variables `solved`, in place.

    Args:
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
            for e in range(m):
                if J_lower[e, j] != 0.0 or J_upper[e, j] != 0.0:
                    pl, pu = mul(Y[r, e], Y[r, e], J_lower[e, j], J_upper[e, j])
                    gl, gu = add(gl, gu, pl, pu)
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
def taylor_step(x: Array, lower: Array, upper: Array, solved: Indices, Y: Array, at: Expansion) -> int:
    """Preconditioned second-order expansion about x, solved for each variable in turn, in place.

    With d = X - x: Y f(x) + Y J(x) d + sum_jk (Y H(X)/2)_jk d_j d_k = 0 for every solution, where J holds at
    x alone and H over the box. Squares d_j^2 are taken as such, which an interval Newton step can't do.

    Returns:
        -1 empty, else 0.
    """
    k, m = Y.shape
    n = len(lower)
    f_lower, f_upper, J_lower, J_upper = at.f_lower, at.f_upper, at.J0_lower, at.J0_upper
    H_lower, H_upper = at.H_lower, at.H_upper
    for r in range(k):
        i = solved[r]
        cl, cu = 0.0, 0.0
        for e in range(m):
            pl, pu = mul(Y[r, e], Y[r, e], f_lower[e], f_upper[e])
            cl, cu = add(cl, cu, pl, pu)
        al, au, ql, qu = 0.0, 0.0, 0.0, 0.0
        for a in range(n):
            dal, dau = sub(lower[a], upper[a], x[a], x[a])
            gl, gu = 0.0, 0.0
            for e in range(m):
                if J_lower[e, a] != 0.0 or J_upper[e, a] != 0.0:
                    pl, pu = mul(Y[r, e], Y[r, e], J_lower[e, a], J_upper[e, a])
                    gl, gu = add(gl, gu, pl, pu)
            for b in range(a, n):
                hl, hu = 0.0, 0.0
                for e in range(m):
                    if H_lower[e, a, b] != 0.0 or H_upper[e, a, b] != 0.0:
                        pl, pu = mul(Y[r, e], Y[r, e], H_lower[e, a, b], H_upper[e, a, b])
                        hl, hu = add(hl, hu, pl, pu)
                if hl == 0.0 and hu == 0.0:
                    continue
                if a == b:
                    if a == i:
                        ql, qu = hl, hu
                        continue
                    sl, su = power(dal, dau, 2)
                    pl, pu = mul(hl, hu, sl, su)
                    cl, cu = add(cl, cu, pl, pu)
                    continue
                hl, hu = mul(2.0, 2.0, hl, hu)
                dbl, dbu = sub(lower[b], upper[b], x[b], x[b])
                if a == i:
                    pl, pu = mul(hl, hu, dbl, dbu)
                    gl, gu = add(gl, gu, pl, pu)
                elif b == i:
                    pl, pu = mul(hl, hu, dal, dau)
                    al, au = add(al, au, pl, pu)
                else:
                    sl, su = mul(dal, dau, dbl, dbu)
                    pl, pu = mul(hl, hu, sl, su)
                    cl, cu = add(cl, cu, pl, pu)
            if a == i:
                al, au = add(al, au, gl, gu)
            else:
                pl, pu = mul(gl, gu, dal, dau)
                cl, cu = add(cl, cu, pl, pu)
        # al d + q d^2 + c = 0 for d in D: first with q d^2 as a range, then d (a + q d) = -c.
        dl, du = sub(lower[i], upper[i], x[i], x[i])
        sl, su = power(dl, du, 2)
        pl, pu = mul(ql, qu, sl, su)
        bl, bu = add(cl, cu, pl, pu)
        if not (al <= 0.0 <= au):
            tl, tu = div(-bu, -bl, al, au)
            nl, nu = add(x[i], x[i], tl, tu)
            lower[i], upper[i] = max(lower[i], nl), min(upper[i], nu)
        elif not (bl <= 0.0 <= bu) and _split_division(x[i], al, au, -bu, -bl, lower, upper, i) < 0:
            return -1
        if lower[i] > upper[i]:
            return -1
        dl, du = sub(lower[i], upper[i], x[i], x[i])
        pl, pu = mul(ql, qu, dl, du)
        gl, gu = add(al, au, pl, pu)
        if not (gl <= 0.0 <= gu):
            tl, tu = div(-cu, -cl, gl, gu)
            nl, nu = add(x[i], x[i], tl, tu)
            lower[i], upper[i] = max(lower[i], nl), min(upper[i], nu)
            if lower[i] > upper[i]:
                return -1
    return 0


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
