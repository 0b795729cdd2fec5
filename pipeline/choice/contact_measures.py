"""Measures of single contacts that describe a candidate, whatever the hand."""

import numpy as np

from ...base.numeric.arrays import Array
from ...mjcf import Squeeze

__all__ = ["cone_cosines", "cone_use", "preload_use"]


def cone_cosines(points: Array, normals: Array, mu: float) -> Array:
    """Cosines (n,) between inward normals and the ways to the middle of all contacts, over the cone's.

    Above 1 the way lies inside the friction cone.

    Args:
        points: (n, 3) in m.
        normals: (n, 3) outward unit normals of the object.
        mu: Coulomb coefficient.
    """
    inward = points.mean(axis=0) - points
    length = np.linalg.norm(inward, axis=1)
    cosine = np.divide(-(normals * inward).sum(axis=1), length, out=np.zeros(len(length)), where=length > 0)
    return cosine * np.sqrt(1.0 + mu**2)


def cone_use(squeeze: Squeeze, mu: float) -> Array:
    """The largest share (n,) of each contact's friction cone that the plan uses under any load, in [0, 1]."""
    return _use(squeeze.loaded, squeeze.spin_arms_m, mu).max(axis=0)


def preload_use(squeeze: Squeeze, mu: float) -> Array:
    """The share (n,) of each contact's friction cone that the squeeze alone uses, in [0, 1]."""
    return _use(squeeze.preload[None], squeeze.spin_arms_m, mu)[0]


def _use(vectors: Array, spin_arms_m: Array, mu: float) -> Array:
    limits = mu * np.column_stack([np.ones((len(spin_arms_m), 2)), spin_arms_m])
    across = np.linalg.norm(vectors[..., 1:] / limits, axis=-1)
    along = vectors[..., 0]
    return np.minimum(np.divide(across, along, out=np.ones_like(along), where=along > 1e-9), 1.0)
