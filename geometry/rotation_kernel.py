"""Rotations (3, 3) in compiled loops, in place."""

import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array

__all__ = ["make_rotation", "turn_by"]

# Columns with a sine below this are taken as parallel.
_PARALLEL = 1e-7


@compiled
def turn_by(R: Array, w: Array) -> None:
    """R <- exp(w) R."""
    angle = np.sqrt(w[0] ** 2 + w[1] ** 2 + w[2] ** 2)
    # exp(w) = I + s K + v K^2 with K = skew(w).
    s, v = 1.0, 0.5
    if angle > 1e-6:
        s, v = np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle**2
    turned = np.empty((3, 3))
    for j in range(3):
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            along = w[0] * R[0, j] + w[1] * R[1, j] + w[2] * R[2, j]
            across = w[b] * R[c, j] - w[c] * R[b, j]
            turned[a, j] = R[a, j] + s * across + v * (w[a] * along - angle**2 * R[a, j])
    for a in range(3):
        for j in range(3):
            R[a, j] = turned[a, j]
    _straighten(R)


@compiled
def _straighten(R: Array) -> None:
    """A step of Newton's method for the nearest rotation: it squares the error that rounding has left."""
    gram, back = np.zeros((3, 3)), np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            for a in range(3):
                gram[i, j] += R[a, i] * R[a, j]
    for a in range(3):
        for j in range(3):
            back[a, j] = R[a, 0] * gram[0, j] + R[a, 1] * gram[1, j] + R[a, 2] * gram[2, j]
    for a in range(3):
        for j in range(3):
            R[a, j] = 1.5 * R[a, j] - 0.5 * back[a, j]


@compiled
def make_rotation(R: Array) -> None:
    """Makes R the rotation nearest to [c, d, c x d], where c and d are its first two columns.

    The third column of the polar factor is along n = c x d; the others are those of the polar factor of two
    vectors of the plane, which is (c + d x n, d + n x c), scaled.
    """
    n = np.empty(3)
    product, length = 0.0, 0.0
    for a in range(3):
        i, j = (a + 1) % 3, (a + 2) % 3
        n[a] = R[i, 0] * R[j, 1] - R[j, 0] * R[i, 1]
        length += n[a] ** 2
        product += R[a, 0] ** 2 + R[a, 1] ** 2
    if np.sqrt(length) <= _PARALLEL * product:
        _put_perpendicular(R, n)
        length = n[0] ** 2 + n[1] ** 2 + n[2] ** 2
    for a in range(3):
        n[a] /= np.sqrt(length)
    first, second = np.empty(3), np.empty(3)
    scale = 0.0
    for a in range(3):
        i, j = (a + 1) % 3, (a + 2) % 3
        first[a] = R[a, 0] + R[i, 1] * n[j] - R[j, 1] * n[i]
        second[a] = R[a, 1] + n[i] * R[j, 0] - n[j] * R[i, 0]
        scale += first[a] ** 2
    for a in range(3):
        R[a, 0], R[a, 1], R[a, 2] = first[a] / np.sqrt(scale), second[a] / np.sqrt(scale), n[a]
    _straighten(R)


@compiled
def _put_perpendicular(R: Array, n: Array) -> None:
    """Fills n (3,) with a vector perpendicular to the longer of R's first two columns, which are parallel.

    Where both are zero, the first becomes the first axis.
    """
    lengths = np.zeros(2)
    for a in range(3):
        for k in range(2):
            lengths[k] += R[a, k] ** 2
    if lengths[0] + lengths[1] == 0.0:
        R[0, 0] = 1.0
        lengths[0] = 1.0
    longer = 0 if lengths[0] >= lengths[1] else 1
    least = 0
    for a in range(3):
        if abs(R[a, longer]) < abs(R[least, longer]):
            least = a
    i, j = (least + 1) % 3, (least + 2) % 3
    n[least] = 0.0
    n[i], n[j] = -R[j, longer], R[i, longer]
