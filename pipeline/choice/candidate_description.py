"""What describes a candidate by numbers that mean the same for every hand, and what is its hand's alone.

Points are taken from the centre of mass and turned into the object's frame, or made numbers that no frame
matters to, and summed up over the contacts: however many these are, there are as many features.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ...mjcf import HoldSettings, Squeeze, grasp_quality
from ...mjcf.squeeze import grasp_statics
from ...solver import Configuration
from .compliance import yielding
from .contact_measures import cone_cosines, cone_use, preload_use
from .feature import Feature, clipped
from .spring_trial import LARGEST_STRAIN, spring_strains

__all__ = ["FREE_FEATURES", "candidate_features", "candidate_specs"]

# A surface more slippery than it is said to be, by this share of its friction.
_SLIPPERY = 0.75
_STANDARD_GRAVITY = 9.81

FREE_FEATURES = (
    Feature("f_contacts", "1", 0, 8, words="number of contacts"),
    *(
        Feature(
            f"f_middle_{axis}", "m", -1, 1, words=f"{axis} of the contacts' middle, from the centre of mass"
        )
        for axis in "xyz"
    ),
    *(
        Feature(
            f"f_palm_{axis}", "1", -1, 1, words=f"{axis} of the way from the contacts' middle to the palm"
        )
        for axis in "xyz"
    ),
    Feature("f_middle_distance", "m", 0, 1, formula=-1, words="contacts' middle to the centre of mass"),
    Feature(
        "f_axis_distance", "m", 0, 1, words="centre of mass to the line that the contacts lie nearest to"
    ),
    Feature("f_spread", "m", 0, 1, words="largest distance between two contacts"),
    Feature("f_least_spread", "m", 0, 1, words="smallest distance between two contacts"),
    Feature("f_opposition", "1", 0, 1, formula=-1, words="length of the mean of the contacts' normals"),
    Feature(
        "f_cone_least", "1", -2, 2, formula=1, words="least cosine to the contacts' middle, over the cone's"
    ),
    Feature("f_cone_mean", "1", -2, 2, words="the same, mean over the contacts"),
    Feature("f_force_sum", "N", 0, 500, formula=-1, words="sum of the squeeze's normal forces"),
    Feature("f_force_least", "N", 0, 200, words="smallest of them"),
    Feature("f_force_most", "N", 0, 200, words="largest of them"),
    Feature("f_force_weights", "1", 0, 200, words="their sum, in weights of the object"),
    Feature("f_friction_use", "1", 0, 10, formula=-1, words="weight over what the normal forces rub with"),
    Feature(
        "f_twist_use", "1", 0, 50, formula=-1, words="its torque about the contacts' line over what resists"
    ),
    Feature(
        "f_lean_most", "1", 0, 1, formula=-1, words="largest share of a cone that the squeeze alone uses"
    ),
    Feature("f_lean_mean", "1", 0, 1, words="the same, mean over the contacts"),
    Feature("f_cone_use_most", "1", 0, 1, words="largest share of a cone that the plan uses under any load"),
    Feature("f_cone_use_mean", "1", 0, 1, words="the same, mean over the contacts"),
    Feature("f_yield_most", "m", 0, 0.02, words="how far a pad yields, at most"),
    Feature("f_spin_arm_least", "m", 0, 0.05, words="arm at which friction resists spin, at least"),
    Feature(
        "f_load_factor", "1", 0, 8, formula=1, words="multiple of the load that the squeeze is planned for"
    ),
    Feature("f_epsilon", "N", 0, 1, formula=1, words="Ferrari and Canny's measure"),
    Feature("f_volume_log", "1", -30, 0, formula=1, words="logarithm of the wrench hull's volume, base 10"),
    Feature("f_wrench_margin", "1", 0, 100, formula=1, words="multiple of the load within cones and efforts"),
    Feature("f_slippery_margin", "1", 0, 100, words=f"the same at {_SLIPPERY:g} times the friction"),
    Feature(
        "f_manipulability_log", "1", -12, 0, formula=1, words="logarithm of Yoshikawa's measure, base 10"
    ),
    Feature("f_sag", "m", 0, 0.1, formula=-1, words="displacement under the weight by servos and pads"),
    Feature("f_turn", "rad", 0, 5, words="turn under the weight at an arm of 10 mm, at most"),
    Feature("f_buckling", "1", 0, 20, formula=-1, words="what the squeeze's forces add to a turn"),
    Feature(
        "f_effort_share", "1", 0, 2, formula=-1, words="largest share of a servo's effort in the squeeze"
    ),
    Feature("f_clearance", "m", -0.001, 0.5, formula=1, words="smallest distance of bodies that don't touch"),
    Feature("f_opening", "m", 0, 0.1, words="by how much the fingers open before the grasp"),
    *(
        Feature(
            f"f_spring_{name}",
            "1",
            0,
            LARGEST_STRAIN,
            kind="trial",
            formula=-1,
            words=f"mean strain in a trial by springs, {words}; 1 is at the limit",
        )
        for name, words in (
            ("squeeze", "in the squeeze"),
            ("hold", "until it bears the load"),
            ("hold_2", "until it bears twice the load"),
        )
    ),
)
"""Features that mean the same for every hand."""


def candidate_specs(most_joints: int) -> tuple[Feature, ...]:
    """Features of `candidate_features` for hands with at most so many independent joints, in order."""
    own = (
        Feature("f_limit_distance", "1", 0, 1, kind="hand", words="nearest joint limit, in half ranges"),
        *(
            Feature(
                f"f_object_{axis}", "m", -1, 1, kind="hand", words=f"{axis} of the centre of mass in the palm"
            )
            for axis in "xyz"
        ),
        *(
            Feature(
                f"f_joint_{k:02d}",
                "1",
                -1.001,
                1.001,
                kind="hand",
                words=f"joint {k} of the hand in its range",
            )
            for k in range(most_joints)
        ),
    )
    return (*FREE_FEATURES, *own)


def candidate_features(
    configuration: Configuration,
    squeeze: Squeeze,
    *,
    clearance_m: float,
    opening_m: float,
    settings: HoldSettings,
    most_joints: int,
) -> NDArray[np.float32]:
    """Features (n,) of a candidate, as `candidate_specs` has them.

    Args:
        configuration: hand and object.
        squeeze: as planned, with what it carries.
        clearance_m: smallest distance between bodies that should not touch.
        opening_m: by how much the fingers open in the pregrasp.
        settings: what the squeeze was planned for.
        most_joints: how many joints there is room for; of a hand with fewer the rest are 0.
    """
    values = [
        *_places(configuration, settings),
        *_forces(configuration, squeeze, settings),
        *_measures(configuration, settings),
        *yielding(configuration, squeeze, settings),
        _effort_share(configuration, squeeze),
        clearance_m,
        opening_m,
        *spring_strains(configuration, squeeze, settings),
        *_hand(configuration, most_joints),
    ]
    return clipped(np.array(values), candidate_specs(most_joints))


def _points(configuration: Configuration) -> tuple[Array, Array]:
    """Contact points (n, 3) from the centre of mass and outward normals (n, 3), in the object's frame."""
    state = configuration.state
    R, p = state.R_palm_object, state.p_palm_object
    points = np.array([point.p_object for point in configuration.contact_points])
    normals = np.array([point.n_object for point in configuration.contact_points])
    return (points - p) @ R - configuration.task.object.inertia.centre, normals @ R


def _places(configuration: Configuration, settings: HoldSettings) -> list[float]:
    points, normals = _points(configuration)
    state = configuration.state
    middle = points.mean(axis=0)
    palm = -state.p_palm_object @ state.R_palm_object - configuration.task.object.inertia.centre - middle
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    cosines = cone_cosines(points, normals, settings.sliding_friction(configuration.task.object))
    return [
        float(len(points)),
        *middle.tolist(),
        *(palm / max(float(np.linalg.norm(palm)), 1e-9)).tolist(),
        float(np.linalg.norm(middle)),
        _axis_distance(points),
        float(apart.max()),
        float(apart[np.triu_indices(len(points), 1)].min(initial=apart.max())),
        float(np.linalg.norm(normals.mean(axis=0))),
        float(cosines.min()),
        float(cosines.mean()),
    ]


def _axis_distance(points: Array) -> float:
    """How far the centre of mass, the origin, is from the line through the points' middle that fits best."""
    middle = points.mean(axis=0)
    axis = np.linalg.svd(points - middle)[2][0]
    return float(np.linalg.norm(middle - (middle @ axis) * axis))


def _forces(configuration: Configuration, squeeze: Squeeze, settings: HoldSettings) -> list[float]:
    obj = configuration.task.object
    mu = settings.sliding_friction(obj)
    normal = np.maximum(squeeze.preload[:, 0], 0.0)
    weight = _STANDARD_GRAVITY * obj.inertia.mass
    torque = weight * _axis_distance(_points(configuration)[0])
    total = max(float(normal.sum()), 1e-9)
    spin = max(float(mu * normal @ squeeze.spin_arms_m), 1e-9)
    lean, use = preload_use(squeeze, mu), cone_use(squeeze, mu)
    return [
        float(normal.sum()),
        float(normal.min()),
        float(normal.max()),
        float(normal.sum()) / weight,
        weight / (mu * total),
        torque / spin,
        float(lean.max()),
        float(lean.mean()),
        float(use.max()),
        float(use.mean()),
        float(squeeze.yields_m.max()),
        float(squeeze.spin_arms_m.min()),
        squeeze.load_factor,
    ]


def _measures(configuration: Configuration, settings: HoldSettings) -> list[float]:
    quality = grasp_quality(configuration, settings=settings)
    mu = settings.sliding_friction(configuration.task.object)
    slippery = grasp_quality(configuration, settings=replace(settings, friction=_SLIPPERY * mu))
    return [
        quality.epsilon,
        float(np.log10(max(quality.volume, 1e-30))),
        quality.wrench_margin,
        slippery.wrench_margin,
        float(np.log10(max(quality.manipulability, 1e-12))),
    ]


def _effort_share(configuration: Configuration, squeeze: Squeeze) -> float:
    return float(np.abs(squeeze.efforts / grasp_statics(configuration).effort).max())


def _hand(configuration: Configuration, most_joints: int) -> list[float]:
    state, limits = configuration.state, configuration.task.hand.limits
    half = 0.5 * np.ptp(limits, axis=1)
    share = np.divide(state.q - limits.mean(axis=1), half, out=np.zeros(len(half)), where=half > 0.0)
    centre = state.R_palm_object @ configuration.task.object.inertia.centre + state.p_palm_object
    padded = np.zeros(most_joints)
    padded[: len(share)] = share[:most_joints]
    return [float(1.0 - np.abs(share).max()), *centre.tolist(), *padded.tolist()]
