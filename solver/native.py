"""Polynomial systems of any degree contracted as they are, without lifting.

Contractors, all in outward-rounded arithmetic, none of which removes a solution:

- HC4 on sums of monomials: each equation is solved for each factor of each of its monomials;
- the interval Newton step with a preconditioned second-order expansion about the middle of the box;
- shaving: slices at the ends of a variable that the others prove empty are cut off.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .expression import ExactPolynomial
from .rounding import add, div, down, jit, mul, power, sub, up

__all__ = ["NativeSystem", "enclose_fraction", "native_system"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class NativeSystem(NamedTuple):
    """Equations as sums of interval coefficients times monomials.

    Attributes:
        term_start: (m + 1,) terms of each equation.
        c_lower: coefficients, lower ends.
        c_upper: coefficients, upper ends.
        factor_start: (terms + 1,) factors of each term.
        variable: variable of each factor.
        exponent: exponent of each factor, >= 1.
        user_start: (n + 1,) equations of each variable.
        user: equations, variable by variable.
    """

    term_start: Index
    c_lower: Array
    c_upper: Array
    factor_start: Index
    variable: Index
    exponent: Index
    user_start: Index
    user: Index


def enclose_fraction(value: Fraction) -> tuple[float, float]:
    """The two floats next to an exact number, equal where it is a float; infinite beyond all floats."""
    try:
        near = float(value)
    except OverflowError:
        largest = float(np.finfo(np.float64).max)
        return (largest, np.inf) if value > 0 else (-np.inf, -largest)
    exact = Fraction(near)
    if exact == value:
        return near, near
    return (
        (near, float(np.nextafter(near, np.inf)))
        if exact < value
        else (float(np.nextafter(near, -np.inf)), near)
    )


def native_system(equations: Sequence[ExactPolynomial], n: int) -> NativeSystem:
    """Packs exact equations in n variables."""
    terms = [list(eq.items()) for eq in equations]
    flat = [term for group in terms for term in group]
    ends = [enclose_fraction(c) for _, c in flat]
    users: list[list[int]] = [[] for _ in range(n)]
    for e, eq in enumerate(equations):
        for k in sorted({v for m in eq for v, _ in m}):
            users[k].append(e)
    return NativeSystem(
        _offsets([len(group) for group in terms]),
        np.array([lo for lo, _ in ends], dtype=np.float64),
        np.array([hi for _, hi in ends], dtype=np.float64),
        _offsets([len(m) for m, _ in flat]),
        np.array([v for m, _ in flat for v, _ in m], dtype=np.int64),
        np.array([e for m, _ in flat for _, e in m], dtype=np.int64),
        _offsets([len(u) for u in users]),
        np.array([e for u in users for e in u], dtype=np.int64),
    )


def _offsets(lengths: list[int]) -> Index:
    return np.concatenate([[0], np.cumsum(lengths, dtype=np.int64)]).astype(np.int64)


@jit
def root_interval(al, au, n, xl, xu):  # type: ignore[no-untyped-def]
    """Part of [xl, xu] whose n-th power may lie in [al, au], as a hull; empty as (inf, -inf)."""
    if n == 1:
        return max(al, xl), min(au, xu)
    if n % 2 == 0:
        if au < 0.0:
            return np.inf, -np.inf
        hi = _root_up(au, n)
        lo = _root_down(al, n) if al > 0.0 else 0.0
        low, high = max(-hi, xl), min(hi, xu)
        if low > -lo:
            low = max(low, lo)
        if high < lo:
            high = min(high, -lo)
        return low, high
    lo = _root_down(al, n) if al >= 0.0 else -_root_up(-al, n)
    hi = _root_up(au, n) if au >= 0.0 else -_root_down(-au, n)
    return max(lo, xl), min(hi, xu)


@jit
def _root_up(a, n):  # type: ignore[no-untyped-def]
    """At or above the n-th root of a >= 0: a float whose power, rounded down, is at least a."""
    if a == 0.0 or a == np.inf:
        return a
    r = a ** (1.0 / n)
    step = abs(r) * 1e-15 + 1e-300
    for _ in range(60):
        if power(r, r, n)[0] >= a:
            return r
        r += step
        step *= 2.0
    return np.inf


@jit
def _root_down(a, n):  # type: ignore[no-untyped-def]
    """At or below the n-th root of a >= 0."""
    if a == 0.0:
        return 0.0
    if a == np.inf:
        return 1.7e308 ** (1.0 / n)
    r = a ** (1.0 / n)
    step = abs(r) * 1e-15 + 1e-300
    for _ in range(60):
        if r <= 0.0 or power(r, r, n)[1] <= a:
            return max(r, 0.0)
        r -= step
        step *= 2.0
    return 0.0


@jit
def _revise(s, e, lower, upper, gain, terms, changed):  # type: ignore[no-untyped-def]
    """HC4 on one equation; number of changed variables, -1 where empty."""
    first, last = s.term_start[e], s.term_start[e + 1]
    m = last - first
    terms[0, 0] = 0.0
    terms[1, 0] = 0.0
    for t in range(m):
        vl, vu = s.c_lower[first + t], s.c_upper[first + t]
        for f in range(s.factor_start[first + t], s.factor_start[first + t + 1]):
            pl, pu = power(lower[s.variable[f]], upper[s.variable[f]], s.exponent[f])
            vl, vu = mul(vl, vu, pl, pu)
        terms[2, t], terms[3, t] = vl, vu
        terms[0, t + 1], terms[1, t + 1] = add(terms[0, t], terms[1, t], vl, vu)
    if terms[0, m] > 0.0 or terms[1, m] < 0.0:
        return -1
    count = 0
    bl, bu = 0.0, 0.0
    for t in range(m - 1, -1, -1):
        begin, end = s.factor_start[first + t], s.factor_start[first + t + 1]
        ol, ou = add(terms[0, t], terms[1, t], bl, bu)
        bl, bu = add(bl, bu, terms[2, t], terms[3, t])
        if begin == end:
            continue
        # The term must equal minus the sum of the others.
        rl, ru = max(-ou, terms[2, t]), min(-ol, terms[3, t])
        if rl > ru:
            return -1
        for f in range(begin, end):
            k = s.variable[f]
            wl, wu = s.c_lower[first + t], s.c_upper[first + t]
            for g in range(begin, end):
                if g != f:
                    pl, pu = power(lower[s.variable[g]], upper[s.variable[g]], s.exponent[g])
                    wl, wu = mul(wl, wu, pl, pu)
            if wl <= 0.0 <= wu and rl <= 0.0 <= ru:
                continue
            if wl == 0.0 and wu == 0.0:
                return -1
            ql, qu = div(rl, ru, wl, wu)
            lo, hi = root_interval(ql, qu, s.exponent[f], lower[k], upper[k])
            if lo > hi:
                return -1
            old = upper[k] - lower[k]
            lower[k], upper[k] = lo, hi
            if old - (hi - lo) > gain * old:
                changed[count] = k
                count += 1
    return count


@jit
def hc4(s, lower, upper, gain, max_rounds):  # type: ignore[no-untyped-def]
    """HC4 until nothing shrinks by the share `gain`; False where the box is proved empty."""
    m = len(s.term_start) - 1
    longest = 1
    for e in range(m):
        longest = max(longest, s.term_start[e + 1] - s.term_start[e])
    terms = np.empty((4, longest + 1))
    changed = np.empty(len(s.variable) + 1, dtype=np.int64)
    ring = np.arange(m)
    waiting = np.ones(m, dtype=np.bool_)
    head, count, visits = 0, m, 0
    while count > 0 and visits < max_rounds * m:
        e = ring[head]
        head = (head + 1) % m
        count -= 1
        waiting[e] = False
        visits += 1
        n = _revise(s, e, lower, upper, gain, terms, changed)
        if n < 0:
            return False
        for c in range(n):
            k = changed[c]
            for u in range(s.user_start[k], s.user_start[k + 1]):
                other = s.user[u]
                if not waiting[other]:
                    ring[(head + count) % m] = other
                    waiting[other] = True
                    count += 1
    return True


@jit
def values_and_slopes(s, lower, upper, value_lower, value_upper, J_lower, J_upper):  # type: ignore[no-untyped-def]
    """Enclosures of all equations (m,) and of their derivatives (m, n), term by term."""
    m = len(s.term_start) - 1
    J_lower[:] = 0.0
    J_upper[:] = 0.0
    for e in range(m):
        total_l, total_u = 0.0, 0.0
        for t in range(s.term_start[e], s.term_start[e + 1]):
            begin, end = s.factor_start[t], s.factor_start[t + 1]
            vl, vu = s.c_lower[t], s.c_upper[t]
            for f in range(begin, end):
                pl, pu = power(lower[s.variable[f]], upper[s.variable[f]], s.exponent[f])
                vl, vu = mul(vl, vu, pl, pu)
            total_l, total_u = add(total_l, total_u, vl, vu)
            for f in range(begin, end):
                k = s.variable[f]
                wl, wu = s.c_lower[t], s.c_upper[t]
                n = s.exponent[f]
                if n > 1:
                    pl, pu = power(lower[k], upper[k], n - 1)
                    wl, wu = mul(wl, wu, pl, pu)
                    wl, wu = mul(wl, wu, float(n), float(n))
                for g in range(begin, end):
                    if g != f:
                        pl, pu = power(lower[s.variable[g]], upper[s.variable[g]], s.exponent[g])
                        wl, wu = mul(wl, wu, pl, pu)
                J_lower[e, k], J_upper[e, k] = add(J_lower[e, k], J_upper[e, k], wl, wu)
        value_lower[e], value_upper[e] = total_l, total_u


@jit
def newton_step(x, lower, upper, solved, Y, f_lower, f_upper, J_lower, J_upper):  # type: ignore[no-untyped-def]
    """Preconditioned interval Newton by Gauss-Seidel on the variables `solved`, in place.

    Args:
        x: (n,) expansion point in the box.
        lower: (n,) box.
        upper: (n,) box.
        solved: (k,) variables to solve for; the others are carried along as parameters.
        Y: (k, m) preconditioner.
        f_lower: (m,) equations at x.
        f_upper: (m,)
        J_lower: (m, n) slopes over the box.
        J_upper: (m, n)

    Returns:
        -1 empty; 1 where every solved variable fell strictly inside its own interval (with k = m: for all
        values of the others in the box there is exactly one solution in the box as it was); else 0.
    """
    k, m = Y.shape
    n = len(lower)
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


@jit
def _split_division(x, al, au, bl, bu, lower, upper, i):  # type: ignore[no-untyped-def]
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


@jit
def shave(s, lower, upper, variables, slices, gain, scratch_l, scratch_u):  # type: ignore[no-untyped-def]
    """3B-CID: each variable is sliced, each slice contracted, and the hull of what is left is kept.

    Cuts from both ends until a slice survives; then the rest is taken as one more slice.
    """
    n = len(lower)
    for k in variables:
        width = upper[k] - lower[k]
        if width <= 1e-12 * max(1.0, abs(lower[k]), abs(upper[k])):
            continue
        start_l, start_u = lower[k], upper[k]
        hull_l, hull_u = np.full(n, np.inf), np.full(n, -np.inf)
        found = False
        edges_low, edges_high = 0, slices
        # From below.
        while edges_low < edges_high:
            a = start_l + width * (edges_low / slices)
            b = start_u if edges_low + 1 == slices else start_l + width * ((edges_low + 1) / slices)
            if _slice(s, lower, upper, k, a, b, gain, scratch_l, scratch_u):
                found = True
                for j in range(n):
                    hull_l[j], hull_u[j] = min(hull_l[j], scratch_l[j]), max(hull_u[j], scratch_u[j])
                edges_low += 1
                break
            edges_low += 1
        if not found:
            return False
        # From above.
        while edges_high > edges_low:
            a = start_l + width * ((edges_high - 1) / slices)
            b = start_u if edges_high == slices else start_l + width * (edges_high / slices)
            edges_high -= 1
            if _slice(s, lower, upper, k, a, b, gain, scratch_l, scratch_u):
                for j in range(n):
                    hull_l[j], hull_u[j] = min(hull_l[j], scratch_l[j]), max(hull_u[j], scratch_u[j])
                break
        if edges_high > edges_low:
            a = start_l + width * (edges_low / slices)
            b = start_l + width * (edges_high / slices)
            if _slice(s, lower, upper, k, a, b, gain, scratch_l, scratch_u):
                for j in range(n):
                    hull_l[j], hull_u[j] = min(hull_l[j], scratch_l[j]), max(hull_u[j], scratch_u[j])
        for j in range(n):
            lower[j], upper[j] = max(lower[j], hull_l[j]), min(upper[j], hull_u[j])
            if lower[j] > upper[j]:
                return False
    return True


@jit
def _slice(s, lower, upper, k, a, b, gain, out_l, out_u):  # type: ignore[no-untyped-def]
    out_l[:] = lower
    out_u[:] = upper
    out_l[k], out_u[k] = max(a, lower[k]), min(b, upper[k])
    if out_l[k] > out_u[k]:
        return False
    return hc4(s, out_l, out_u, gain, 3)


@jit
def curvatures(s, lower, upper, H_lower, H_upper):  # type: ignore[no-untyped-def]
    """Enclosures of half the second derivatives (m, n, n) of all equations over a box, term by term."""
    H_lower[:] = 0.0
    H_upper[:] = 0.0
    m = len(s.term_start) - 1
    for e in range(m):
        for t in range(s.term_start[e], s.term_start[e + 1]):
            begin, end = s.factor_start[t], s.factor_start[t + 1]
            for f in range(begin, end):
                for g in range(f, end):
                    n, o = s.exponent[f], s.exponent[g]
                    if f == g and n < 2:
                        continue
                    wl, wu = s.c_lower[t], s.c_upper[t]
                    for h in range(begin, end):
                        left = s.exponent[h]
                        if h == f:
                            left -= 1
                        if h == g:
                            left -= 1
                        if left > 0:
                            pl, pu = power(lower[s.variable[h]], upper[s.variable[h]], left)
                            wl, wu = mul(wl, wu, pl, pu)
                    # Half of the second derivative: on the diagonal n (n - 1) / 2, off it n o / 2 twice.
                    factor = 0.5 * n * (n - 1) if f == g else 0.5 * n * o
                    wl, wu = mul(wl, wu, factor, factor)
                    i, j = s.variable[f], s.variable[g]
                    H_lower[e, i, j], H_upper[e, i, j] = add(H_lower[e, i, j], H_upper[e, i, j], wl, wu)
                    if i != j:
                        H_lower[e, j, i], H_upper[e, j, i] = H_lower[e, i, j], H_upper[e, i, j]


@jit
def centre_slopes(x, lower, upper, J0_lower, J0_upper, H_lower, H_upper, J_lower, J_upper):  # type: ignore[no-untyped-def]
    """Narrows the slopes over a box by J(x) + H(X) (X - x), in place; x lies in the box."""
    m, n = J_lower.shape
    for e in range(m):
        for i in range(n):
            gl, gu = J0_lower[e, i], J0_upper[e, i]
            for j in range(n):
                # H holds half of the second derivatives.
                hl, hu = mul(2.0, 2.0, H_lower[e, i, j], H_upper[e, i, j])
                dl, du = sub(lower[j], upper[j], x[j], x[j])
                pl, pu = mul(hl, hu, dl, du)
                gl, gu = add(gl, gu, pl, pu)
            J_lower[e, i], J_upper[e, i] = max(J_lower[e, i], gl), min(J_upper[e, i], gu)


@jit
def taylor_step(x, lower, upper, solved, Y, f_lower, f_upper, J_lower, J_upper, H_lower, H_upper):  # type: ignore[no-untyped-def]
    """Preconditioned second-order expansion about x, solved for each variable in turn, in place.

    With d = X - x: Y f(x) + Y J(x) d + sum_jk (Y H(X)/2)_jk d_j d_k = 0 for every solution, where J holds at
    x alone and H over the box. Squares d_j^2 are taken as such, which an interval Newton step can't do.

    Returns:
        -1 empty, else 0.
    """
    k, m = Y.shape
    n = len(lower)
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
