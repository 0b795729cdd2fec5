"""Analytic measures of a grasp, beside the simulated hold: what statics and kinematics say of it.

All contacts are soft fingers with the cone of the hold test,

    (f_1^2 + f_2^2) / mu^2 + (tau / mu_t)^2 <= f_n^2,

replaced by the hull of edges on it, 42 for the hull of wrenches and 162 for the margin; mu_t is that of the
hand's pads under a usual force. Torques are about the
centre of mass and divided by a length, the farthest distance of the object's surface from there, so that a
wrench has one unit and turning the object by a force at its far end counts as much as pushing it by the same.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from ...base.numeric.arrays import Array
from ...base.text.significant import significant
from ...hands import jacobian_from_axes, joint_axes
from ...objects import ObjectModel
from ...solver import Configuration
from ..model import check_configuration, checked_settings, payload
from ..settings import HoldSettings
from .load_program import LoadProgram, largest_load, load_program
from .pads import contact_pads
from .statics import grasp_statics

__all__ = ["Quality", "auc", "epsilon_and_volume", "grasp_quality", "manipulability", "torque_length_m"]

# Fineness of the cones: the hull of wrenches grows fast with their edges, a linear program doesn't.
_HULL_SUBDIVISIONS = 1
_FINE_SUBDIVISIONS = 2
# A margin beyond this says no more than that the grasp is strong.
_LARGEST_MARGIN = 100.0


@dataclass(frozen=True)
class Quality:
    """Measures of a grasp; each is larger for a better grasp.

    Attributes:
        epsilon: radius of the largest ball of wrenches about the origin that contacts with normal forces of
            sum 1 N resist, in N; 0 without force closure (Ferrari and Canny, ICRA 1992, criterion Q_1).
        volume: of all the wrenches that such contacts resist, in N^6; 0 where they are flat.
        wrench_margin: largest multiple of the task's load that forces within cones and efforts balance, at
            most 100: of the weight, in every direction of gravity, each by itself; of a hinge's friction; or
            of the force of a press.
        manipulability: over the contacts on links that move, the smallest sqrt(det(J J^T)) of the contact
            point's Jacobian J (3, n_independent), in m^3/rad^3 (Yoshikawa, IJRR 1985); 0 without any.
    """

    epsilon: float
    volume: float
    wrench_margin: float
    manipulability: float

    def __str__(self) -> str:
        return ", ".join(
            f"{name.replace('_', ' ')} {significant(value, 3)}" for name, value in self.as_record().items()
        )

    def as_record(self) -> dict[str, float]:
        """The measures by name."""
        return {
            "epsilon": self.epsilon,
            "volume": self.volume,
            "wrench_margin": self.wrench_margin,
            "manipulability": self.manipulability,
        }


def grasp_quality(configuration: Configuration, *, settings: HoldSettings | None = None) -> Quality:
    """The measures of a configuration, with the friction and the directions of the settings."""
    check_configuration(configuration)
    settings = checked_settings(settings)
    task = configuration.task
    obj = payload(task, settings)
    pads = contact_pads(configuration, settings)
    statics = grasp_statics(configuration, settings, pads.force_points())
    spin_arms_m = pads.spin_arms_m()
    coarse, fine = (
        load_program(statics, task, configuration.state, settings, subdivisions=n, spin_arms_m=spin_arms_m)
        for n in (_HULL_SUBDIVISIONS, _FINE_SUBDIVISIONS)
    )
    wrenches = statics.G @ coarse.edges
    wrenches[3:] /= torque_length_m(obj)
    epsilon, volume = epsilon_and_volume(wrenches)
    return Quality(epsilon, volume, _wrench_margin(fine), manipulability(configuration))


def torque_length_m(obj: ObjectModel) -> float:
    """Farthest distance of the object's surface from its centre of mass, in m."""
    return float(np.linalg.norm(obj.mesh.vertices - obj.inertia.centre, axis=1).max())


def epsilon_and_volume(wrenches: Array) -> tuple[float, float]:
    """Radius of the largest ball about the origin in the hull of `wrenches` (d, n), and the hull's volume.

    The radius is 0 where the origin is not inside; both are 0 where the hull is flat.
    """
    d, n = wrenches.shape
    scale = np.abs(wrenches).max(initial=0.0)
    if n <= d or np.linalg.matrix_rank(wrenches - wrenches.mean(axis=1, keepdims=True), 1e-9 * scale) < d:
        return 0.0, 0.0
    try:
        # Facets of cones that lie side by side are nearly in one plane. To merge them, as is usual, takes up
        # to three times as long as to shake the points by some 1e-9 of their size, and sometimes fails.
        hull = ConvexHull(wrenches.T, qhull_options="QJ")
    except QhullError:
        return 0.0, 0.0
    # Facets are n x + offset <= 0 inside: minus the offset is the origin's distance from each.
    return float(max(0.0, -hull.equations[:, -1].max())), float(hull.volume)


def manipulability(configuration: Configuration) -> float:
    """Smallest of Yoshikawa's measure over the contacts that joints move; see `Quality`."""
    hand = configuration.task.hand
    _, origins, directions = joint_axes(hand, configuration.joint_vector)
    measures = []
    for contact, point in zip(configuration.task.contacts, configuration.contact_points, strict=True):
        if not hand.tree.moves[contact.hand.link].any():
            continue
        J_p, _ = jacobian_from_axes(hand, origins, directions, contact.hand.link, point.p_hand)
        J = J_p @ hand.coupling_matrix
        measures.append(float(np.sqrt(max(0.0, np.linalg.det(J @ J.T)))))
    return min(measures, default=0.0)


def _wrench_margin(program: LoadProgram) -> float:
    """Smallest over the loads, each by itself, of the largest multiple within cones and efforts."""
    if not program.must_balance:
        return largest_load(program.rows.A_eq, program.rows.A_ub, program.rows.b_ub, _LARGEST_MARGIN)
    effort = np.vstack([program.effort, -program.effort])
    A_ub = np.column_stack([effort, np.zeros(len(effort))])
    rows = [np.column_stack([program.balance, load]) for load in program.loads]
    return min(largest_load(A_eq, A_ub, np.ones(len(A_ub)), _LARGEST_MARGIN) for A_eq in rows)


def auc(scores: Array, held: NDArray[np.bool_]) -> float | None:
    """Probability that a grasp that held scores above one that did not, ties counting half.

    1 predicts perfectly, 0.5 not at all; None where all held, or none.
    """
    good, bad = scores[held], scores[~held]
    if not (len(good) and len(bad)):
        return None
    above = np.sign(good[:, None] - bad[None, :])
    return float(0.5 + 0.5 * above.mean())
