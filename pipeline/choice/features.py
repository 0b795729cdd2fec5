"""What a policy sees of a candidate grasp: a vector of plain numbers, all of order one."""

import numpy as np
from numpy.typing import NDArray

from ...mjcf import HoldSettings, Squeeze
from ...mjcf.squeeze import grasp_statics
from ...objects import Task
from ...solver import Configuration
from .contact_measures import cone_cosines, cone_use

__all__ = ["LIMIT", "feature_names", "features"]

LIMIT = 10.0
"""Features are clipped to [-LIMIT, LIMIT]."""

_LENGTH_M = 0.1
_FORCE_N = 30.0
_CLEARANCE_M = 0.01
_PER_CONTACT = (
    *(f"point_{axis}" for axis in "xyz"),
    *(f"normal_{axis}" for axis in "xyz"),
    "cone_cosine",
    "squeeze_force",
    "cone_use",
)


def feature_names(task: Task) -> tuple[str, ...]:
    """Names of the features of a task's candidates, in order."""
    contacts = [f"contact_{i}_{name}" for i in range(len(task.contacts)) for name in _PER_CONTACT]
    return (
        *(f"joint_{name}" for name in task.hand.independent_names),
        *(f"object_{axis}" for axis in "xyz"),
        *(f"object_axis_{column}{axis}" for column in "xy" for axis in "xyz"),
        *(f"mass_centre_{axis}" for axis in "xyz"),
        *contacts,
        "clearance",
        "squeeze_effort",
        "load_factor",
    )


def features(
    configuration: Configuration, clearance_m: float, squeeze: Squeeze | None, settings: HoldSettings
) -> NDArray[np.float32]:
    """The features (n,) of a candidate, in the palm frame; those of the squeeze are 0 where there is none.

    - joints in [-1, 1] over their limits;
    - position of the object and of its centre of mass, per 0.1 m; its x and y axes;
    - a contact's point relative to the centre of mass, per 0.1 m, and its outward normal;
    - `cone_cosine`: cosine between the inward normal and the way to the middle of all contacts, over that of
      the friction cone's half angle: above 1 the way lies inside the cone;
    - `squeeze_force`: normal force of the squeeze, per 30 N;
    - `cone_use`: the largest share of the friction cone that the plan uses under any load, in [0, 1];
    - smallest distance between bodies, per 10 mm; the largest share of a servo's effort; the load factor.
    """
    state, obj = configuration.state, configuration.task.object
    limits = configuration.task.hand.limits
    middle, half = limits.mean(axis=1), 0.5 * np.ptp(limits, axis=1)
    joints = np.divide(state.q - middle, half, out=np.zeros(len(half)), where=half > 0)
    centre = state.R_palm_object @ obj.inertia.centre + state.p_palm_object
    statics = grasp_statics(configuration)
    values = [
        joints,
        state.p_palm_object / _LENGTH_M,
        state.R_palm_object[:, :2].T.ravel(),
        centre / _LENGTH_M,
        _contact_features(configuration, centre, squeeze, settings).ravel(),
        [clearance_m / _CLEARANCE_M],
        [0.0, 0.0]
        if squeeze is None
        else [float(np.abs(squeeze.efforts / statics.effort).max()), squeeze.load_factor],
    ]
    vector = np.concatenate([np.asarray(value, dtype=np.float64) for value in values])
    return np.clip(vector, -LIMIT, LIMIT).astype(np.float32)


def _contact_features(
    configuration: Configuration,
    centre: NDArray[np.float64],
    squeeze: Squeeze | None,
    settings: HoldSettings,
) -> NDArray[np.float64]:
    obj = configuration.task.object
    points = np.array([point.p_object for point in configuration.contact_points])
    normals = np.array([point.n_object for point in configuration.contact_points])
    mu = settings.sliding_friction(obj)
    force, use = np.zeros(len(points)), np.zeros(len(points))
    if squeeze is not None:
        force = squeeze.preload[:, 0]
        use = cone_use(squeeze, mu)
    return np.column_stack(
        [
            (points - centre) / _LENGTH_M,
            normals,
            cone_cosines(points, normals, mu),
            force / _FORCE_N,
            use,
        ]
    )
