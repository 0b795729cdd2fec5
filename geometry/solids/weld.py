"""Points that stand for the same corner made one."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

__all__ = ["weld"]


def weld(points: NDArray[np.float64], gap: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Points (n, 3) that are at most `gap` apart become their mean.

    Returns:
        The points left, and for each given point the index (n,) of the one that it became.
    """
    pairs = cKDTree(points).query_pairs(gap, output_type="ndarray")
    n = len(points)
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    count, label = connected_components(graph, directed=False)
    sums = np.zeros((count, 3))
    np.add.at(sums, label, points)
    return sums / np.bincount(label, minlength=count)[:, None], label.astype(np.int64)
