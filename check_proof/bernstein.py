"""Bernstein functions: control points over a box, and planes below and above them."""

import numpy as np

from ..base.numeric.arrays import Array, Indices
from .box import Box
from .intervals import down, mul, up

__all__ = ["BernsteinGroup"]


class BernsteinGroup:
    """Functions x_k = f(x_i, x_j) in Bernstein form over the unit square, all of one degree."""

    def __init__(self, kij: list[Indices], nets: list[Array]):
        self.k, self.i, self.j = np.array(kij).T
        self.nets = np.array(nets)  # (m, d_i + 1, d_j + 1)
        self.degrees = self.nets.shape[1] - 1, self.nets.shape[2] - 1

    def nets_over(self, box: Box) -> tuple[Array, Array]:
        """The control points of the parts over a box, enclosed: their hull holds the functions' values."""
        net = self.nets, self.nets
        net = _restrict(net, box.lower[self.i], box.upper[self.i])
        net = net[0].swapaxes(1, 2), net[1].swapaxes(1, 2)
        net = _restrict(net, box.lower[self.j], box.upper[self.j])
        return net[0].swapaxes(1, 2), net[1].swapaxes(1, 2)

    def beside_planes(self, box: Box, which: Indices, a_i: Array, a_j: Array) -> tuple[Array, Array]:
        """Bounds (m,) over a box of f - a_i x_i - a_j x_j, for functions `which` and any slopes (m,).

        A linear function has its own values, evenly spaced, as control points; f's are taken less those.
        """
        lo, hi = (net[which] for net in self.nets_over(box))
        x = _abscissas(box.lower[self.i[which]], box.upper[self.i[which]], self.degrees[0])
        y = _abscissas(box.lower[self.j[which]], box.upper[self.j[which]], self.degrees[1])
        xl, xu = mul(a_i[:, None], a_i[:, None], *x)
        yl, yu = mul(a_j[:, None], a_j[:, None], *y)
        least = down(lo - up(xu[:, :, None] + yu[:, None, :]))
        most = up(hi - down(xl[:, :, None] + yl[:, None, :]))
        return least.min(axis=(1, 2)), most.max(axis=(1, 2))


def _abscissas(a: Array, b: Array, degree: int) -> tuple[Array, Array]:
    """Enclosures (m, degree + 1) of points evenly spaced from a to b (m,); of degree 0, all of [a, b]."""
    if degree == 0:
        return a[:, None], b[:, None]
    p = np.arange(degree + 1.0)
    low = down(down((degree - p) * a[:, None]) + down(p * b[:, None]))
    high = up(up((degree - p) * a[:, None]) + up(p * b[:, None]))
    return down(low / degree), up(high / degree)


def _restrict(net: tuple[Array, Array], start: Array, end: Array) -> tuple[Array, Array]:
    """Control points along axis 1 over [start, end]: point p is the blossom with p arguments at the end."""
    points = []
    degree = net[0].shape[1] - 1
    for p in range(degree + 1):
        lo, hi = net
        for step in range(degree):
            x = (end if step < p else start)[:, None, None]
            y = 1.0 - x
            al, au = mul(down(y), up(y), lo[:, :-1], hi[:, :-1])
            bl, bu = mul(x, x, lo[:, 1:], hi[:, 1:])
            lo, hi = down(al + bl), up(au + bu)
        points.append((lo, hi))
    return np.concatenate([lo for lo, _ in points], axis=1), np.concatenate([hi for _, hi in points], axis=1)
