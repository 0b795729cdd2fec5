"""Points that fill a cube evenly, without random numbers."""

import numpy as np

from ..base.numeric.arrays import Array

__all__ = ["halton_points"]


def halton_points(count: int, dimensions: int) -> Array:
    """Points (count, dimensions) of Halton's sequence, each coordinate in (0, 1): from the second one on.

    Coordinate j of point i is the number i written in the base of the j-th prime, mirrored at the point. (The
    first point of the sequence would be the origin.) Written out here because the library that has it takes
    as long to import as all else that a short command needs.
    """
    out = np.zeros((count, dimensions))
    for j, base in enumerate(_primes(dimensions)):
        left, share = np.arange(1, count + 1), 1.0 / base
        while left.any():
            out[:, j] += (left % base) * share
            left = left // base
            share /= base
    return out


def _primes(count: int) -> list[int]:
    found: list[int] = []
    number = 2
    while len(found) < count:
        if all(number % prime for prime in found):
            found.append(number)
        number += 1
    return found
