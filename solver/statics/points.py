"""Points of a problem's regions, and what forces there do along twists."""

import numpy as np

from ...base.numeric.arrays import Array
from .charts import Chart
from .power import point_power
from .problem import StaticsProblem
from .surface import point_and_normal

__all__ = ["RegionPoints", "point_maps"]


class RegionPoints:
    """The points of one problem, each by a root and its parameters.

    Attributes:
        problem: the problem.
    """

    def __init__(self, problem: StaticsProblem):
        self.problem = problem
        self._nets = [[_middle_nets(chart) for chart in charts] for charts in problem.charts]

    def nets(self, contact: int, number: int) -> tuple[Array, Array]:
        """Float control points of points and normals, of one chart of a contact."""
        return self._nets[contact][number]

    def chosen(self, root: int) -> list[tuple[Array, Array]]:
        """Float control points of points and normals, of the charts of a root."""
        return [nets[k] for nets, k in zip(self._nets, self.problem.choices[root], strict=True)]

    def random(self, rng: np.random.Generator) -> tuple[int, Array]:
        """A root and parameters of points anywhere."""
        root = int(rng.integers(len(self.problem.choices)))
        return root, rng.uniform(size=2 * self.problem.n_contacts)

    def maps(self, root: int, params: Array) -> Array:
        """The maps (n, 8, 6) of all contacts at their points, with unit normals; see `power`."""
        pairs = zip(self.chosen(root), params.reshape(-1, 2), strict=True)
        places = [point_and_normal(points, normals, u, v)[:2] for (points, normals), (u, v) in pairs]
        return point_maps(*(np.array(part) for part in zip(*places, strict=True)))


def point_maps(points: Array, inward: Array) -> Array:
    """The maps (n, 8, 6) of contacts at points (n, 3), in `UNIT_M` from the centre of mass; see `power`.

    Args:
        points: (n, 3)
        inward: unit normals (n, 3).
    """
    return np.array([point_power(p, n) for p, n in zip(points, inward, strict=True)])


def _middle_nets(chart: Chart) -> tuple[Array, Array]:
    points = np.ascontiguousarray(0.5 * (chart.points[0] + chart.points[1]))
    return points, np.ascontiguousarray(0.5 * (chart.normals[0] + chart.normals[1]))
