"""Whether any forces at all could hold the object, wherever the test lets it go.

A grasp that passes its test ends it at rest: forces at its contacts, inside their friction cones and within
the servos' efforts, balance the load. Not in the place of the grasp, though. The squeeze may move the object
up to the limits of slip and rotation, and the load as far again. So a grasp is **not holdable** where no
forces carry the whole load even if

- each force acts anywhere in a ball of twice the limit of slip about its contact;
- each normal leans anywhere within twice the limit of rotation, as a cone that is wider by that angle has it;
- every servo gives all it has;
- each direction of gravity has forces of its own, which no squeeze needs to bring about.

Hulls that contain them stand for cones and balls, so rounding does not make the statement too strong. What it
leaves out: contacts that the task does not name, joints that lean on their limits, and contacts that slide
over curved skin or round an edge of the object to where normals differ by more than that. How often it is
contradicted is measured by `./run bench refusals`.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from math import atan, pi, tan

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from ..objects import LiftTest, PressTest, TurnTest
from ..solver import Configuration
from .load_programme import WRENCH_SCALE, cone_edges, hinge_torques, largest_load
from .settings import HoldSettings
from .statics import grasp_statics

__all__ = ["NotHoldable", "Obstacle", "why_not_holdable"]

Array = NDArray[np.float64]
# The squeeze and the load may each move the object up to its limits.
_TIMES_LIMIT = 2.0
_CONE_SUBDIVISIONS = 1
# Cones are not made wider than this.
_STEEPEST_RAD = 1.45
# Of the load, short of rounding.
_WHOLE = 1.0 - 1e-6


class Obstacle(Enum):
    """Why a grasp can't be held."""

    FRICTION = "no forces within the friction cones balance the load, even as far as the object may move"
    EFFORT = "the servos are too weak for the forces that would balance the load"
    REACH = "the fingers can't follow the turn with their contacts held"


@dataclass(frozen=True)
class NotHoldable:
    """No forces carry the whole load, in the grasp or anywhere the test lets the object go.

    Attributes:
        obstacle: why.
        load_factor: the largest share of the load that such forces could carry, below 1.
    """

    obstacle: Obstacle
    load_factor: float


def why_not_holdable(configuration: Configuration, settings: HoldSettings) -> NotHoldable | None:
    """What keeps any forces from carrying the load of the task's test; None where nothing does."""
    share = _Reach(configuration, settings, _TIMES_LIMIT).largest_share(limited=True)
    if share >= _WHOLE:
        return None
    # Which of the two it is, is asked of the grasp itself: far around it, strong servos could do much.
    free = _Reach(configuration, settings, 0.0).largest_share(limited=False)
    return NotHoldable(Obstacle.FRICTION if free < _WHOLE else Obstacle.EFFORT, share)


class _Reach:
    """All forces at the contacts of a grasp, as nonnegative shares of cone edges at unit normal force.

    Args:
        configuration: the grasp.
        settings: of the test.
        times: how many times the limits of slip and rotation contacts may be elsewhere and normals may lean.
    """

    def __init__(self, configuration: Configuration, settings: HoldSettings, times: float):
        self._configuration, self._settings = configuration, settings
        obj = configuration.task.object
        balls = times * settings.slip_limit_m * _around_unit_ball() if times > 0.0 else None
        self._statics = grasp_statics(configuration, settings, shifts_m=balls)
        limit = pi if settings.rotation_limit_rad is None else settings.rotation_limit_rad
        lean = min(atan(settings.sliding_friction(obj)) + times * limit, _STEEPEST_RAD)
        mu, mu_t = max(tan(lean), settings.sliding_friction(obj)), settings.torsional_friction(obj)
        cone = cone_edges(mu, mu_t, _CONE_SUBDIVISIONS, outside=True)
        edges = np.kron(np.eye(self._statics.n_contacts), cone)
        self._wrenches = self._statics.G @ edges
        self._effort = self._statics.T @ edges / self._statics.effort[:, None]

    def largest_share(self, *, limited: bool) -> float:
        """Largest share of the load up to 1, with or without the limits of effort."""
        effort = np.vstack([self._effort, -self._effort]) if limited else self._effort[:0]
        A_ub, b_ub = np.column_stack([effort, np.zeros(len(effort))]), np.ones(len(effort))
        share = 1.0
        for A_eq, more in self._loads():
            rows, sides = np.vstack([more, A_ub]), np.concatenate([np.zeros(len(more)), b_ub])
            share = min(share, largest_load(A_eq, rows, sides, 1.0))
        return share

    def _loads(self) -> Iterator[tuple[Array, Array]]:
        """For each load, rows that must be zero and rows that must be at most zero; its share comes last."""
        n = self._wrenches.shape[1]
        none = np.zeros((0, n + 1))
        match self._configuration.task.test:
            case LiftTest():
                for direction in self._settings.directions:
                    weight = np.zeros(6)
                    weight[:3] = self._statics.mass * self._settings.gravity * np.array(direction)
                    yield WRENCH_SCALE[:, None] * np.column_stack([self._wrenches, weight]), none
            case TurnTest() as test:
                torques = hinge_torques(self._wrenches, test, self._statics, self._configuration.state)
                yield np.append(torques, -test.friction_torque_Nm)[None] / test.friction_torque_Nm, none
            case PressTest() as test:
                count = len(self._configuration.task.contacts)
                pressing = np.repeat(np.eye(count), n // count, axis=1)[list(test.contacts)]
                yield none, np.column_stack([-pressing, np.full(len(pressing), test.force_N)])


def _around_unit_ball() -> Array:
    """Corners (12, 3) of an icosahedron that contains the unit ball."""
    corners = np.array(trimesh.creation.icosphere(subdivisions=0).vertices)
    return np.asarray(corners / -ConvexHull(corners).equations[:, -1].max())
