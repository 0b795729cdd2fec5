"""What is known of an object before it is grasped."""

import numpy as np
from numpy.typing import NDArray

from ...objects import ObjectModel
from .feature import Feature, clipped

__all__ = ["OBJECT_FEATURES", "object_features"]

OBJECT_FEATURES = (
    Feature("o_mass", "kg", 0.0, 10.0, words="mass, as it is said to be"),
    Feature("o_friction", "1", 0.0, 2.0, words="Coulomb coefficient, as it is said to be"),
    Feature("o_size", "m", 0.0, 2.0, words="diagonal of the bounding box"),
    *(
        Feature(f"o_extent_{k}", "m", 0.0, 2.0, words=f"side {k} of the bounding box, the longest first")
        for k in (1, 2, 3)
    ),
    *(
        Feature(f"o_gyration_{k}", "m", 0.0, 1.0, words=f"radius of gyration {k}, the largest first")
        for k in (1, 2, 3)
    ),
    Feature("o_convexity", "1", 0.0, 1.0, words="volume of the mesh over that of its convex hull"),
)
"""Features of `object_features`, in order."""


def object_features(obj: ObjectModel) -> NDArray[np.float32]:
    """Features (n,) of an object, none of which depends on how its frame is turned by right angles."""
    inertia = obj.inertia
    extents = np.sort(np.ptp(obj.mesh.bounds, axis=0))[::-1]
    moments = np.sort(np.linalg.eigvalsh(inertia.inertia))[::-1]
    gyration = np.sqrt(np.maximum(moments, 0.0) / inertia.mass)
    hull = float(obj.mesh.convex_hull.volume)
    convexity = abs(float(obj.mesh.volume)) / hull if hull > 0.0 else 1.0
    values = [inertia.mass, obj.friction, obj.size_m, *extents, *gyration, convexity]
    return clipped(np.array(values), OBJECT_FEATURES)
