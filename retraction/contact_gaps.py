"""How far the bodies of a contact are apart, beside the regions on them, which meet in any solution."""

import numpy as np

from ..solver import Configuration
from .distance import measure
from .pairs import collision_model

__all__ = ["contact_gaps"]


def contact_gaps(configuration: Configuration) -> tuple[float, ...]:
    """Signed distance in m between link and object part of each contact, in the order of the task.

    Negative where the two overlap, by the depth. The shapes are those that collide, measured by FCL: what the
    regions say does not enter.
    """
    model = collision_model(configuration.task)
    pairs = [(pair.a, pair.b) for pair in model.pairs]
    wanted = [pairs.index(pair) for pair in model.touching]
    rows = np.flatnonzero(np.isin(model.pair_of, wanted))
    found = measure(model.place(configuration.state), model.piece_pairs[rows]).distance_m
    return tuple(float(found[model.pair_of[rows] == k].min()) for k in wanted)
