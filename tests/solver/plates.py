"""The faces of a plate, which two fingers hold, or are proved not to reach."""

import numpy as np
from holdfast.geometry import BezierPatch, Patch


def plate_faces(half_thickness_m: float) -> tuple[Patch, Patch]:
    """Opposite faces, 40 mm square, of a plate that no object has: the lower and the upper one."""
    w, h = 0.02, half_thickness_m
    bottom = [[[-w, w, -h], [-w, -w, -h]], [[w, w, -h], [w, -w, -h]]]
    top = [[[-w, -w, h], [-w, w, h]], [[w, -w, h], [w, w, h]]]
    lower, upper = (Patch(BezierPatch(np.array(net)), off_surface=True) for net in (bottom, top))
    return lower, upper
