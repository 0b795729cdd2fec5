"""Whether any forces at all could hold the object, wherever the test lets it go.

A grasp that passes its test ends it at rest: forces at its contacts, inside their friction cones and within
the servos' efforts, balance the load. Not in the place of the grasp, though. The squeeze may move the object
up to the limits of slip and rotation, and the load as far again. So a grasp is **not holdable** where no
forces carry the whole load even if

- each force acts anywhere in a ball of twice the limit of slip about its contact, or more where it is wide;
- each link within the limit of slip of the object touches it there, too, whether the task names it or not;
- each normal leans anywhere within twice the limit of rotation, as a cone that is wider by that angle has it;
- every servo gives all it has;
- each direction of gravity has forces of its own, which no squeeze needs to bring about.

Hulls that contain them stand for cones and balls, so rounding does not make the statement too strong. A link
that the task does not name is no aim of the squeeze, which brings the object to it by the limit of slip, no
more. What the statement leaves out: links that the object only comes to touch farther on, under the load,
joints that lean on their limits, and contacts that slide over curved skin or round an edge of the object to
where normals differ by more than that. How often it is contradicted is measured by `./run bench refusals`.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cache
from math import atan, pi, tan

import numpy as np
import trimesh
from scipy.spatial import ConvexHull

from ...base.numeric.arrays import Array
from ...base.text.significant import significant
from ...geometry import cone_edges
from ...objects import LiftTest, PressTest, TurnTest
from ...solver import Configuration
from ..settings import HoldSettings
from .load_program import STEEPEST_RAD, hinge_torques, largest_load
from .pads import contact_pads
from .potential_contacts import potential_contacts
from .statics import WRENCH_SCALE, PointContact, contact_statics, task_contacts

__all__ = ["NotHoldable", "Obstacle", "why_not_holdable"]

# The squeeze and the load may each move the object up to its limits.
_TIMES_LIMIT = 2.0
_CONE_SUBDIVISIONS = 1
# Of the load, short of rounding.
_WHOLE = 1.0 - 1e-6


class Obstacle(Enum):
    """Why a grasp can't be held."""

    FRICTION = "no forces within the friction cones balance the load, even as far as the object may move"
    EFFORT = "the servos are too weak for the forces that would balance the load"
    REACH = "the fingers can't follow the turn with their contacts held"
    ROOM = "links run into something where the fingers follow the turn"


@dataclass(frozen=True)
class NotHoldable:
    """No forces carry the whole load, in the grasp or anywhere the test lets the object go.

    Attributes:
        obstacle: why.
        load_factor: the largest share of the load that such forces could carry, below 1.
    """

    obstacle: Obstacle
    load_factor: float

    def __str__(self) -> str:
        return f"not holdable: {self.obstacle.value} ({significant(self.load_factor, 3)} of the load)"


def why_not_holdable(configuration: Configuration, settings: HoldSettings) -> NotHoldable | None:
    """What keeps any forces from carrying the load of the task's test; None where nothing does."""
    share = _Reach(configuration, settings, _TIMES_LIMIT).largest_share(limited=True)
    if share < _WHOLE:  # any more contacts can only add to it
        share = _Reach(configuration, settings, _TIMES_LIMIT, anywhere=True).largest_share(limited=True)
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
        anywhere: whether links may touch the object wherever they are near it, too.
    """

    def __init__(
        self, configuration: Configuration, settings: HoldSettings, times: float, *, anywhere: bool = False
    ):
        self._configuration, self._settings = configuration, settings
        obj = configuration.task.object
        places = task_contacts(configuration)
        if anywhere:
            places += potential_contacts(configuration, settings.slip_limit_m)
        radii_m = np.full(len(places), times * settings.slip_limit_m)
        # A wide contact's force may be centred off its point, too.
        radii_m[: len(configuration.task.contacts)] += contact_pads(
            configuration, settings
        ).largest_reaches_m()
        contacts = [
            moved
            for place, radius_m in zip(places, radii_m.tolist(), strict=True)
            for moved in _around(place, radius_m)
        ]
        self._links = np.array([contact.link for contact in contacts])
        self._statics = contact_statics(configuration, settings, contacts)
        limit = pi if settings.rotation_limit_rad is None else settings.rotation_limit_rad
        lean = min(atan(settings.sliding_friction(obj)) + times * limit, STEEPEST_RAD)
        arm_m = configuration.task.hand.pad.largest_arm_m if settings.patch_radius_m is None else None
        mu, mu_t = max(tan(lean), settings.sliding_friction(obj)), settings.torsional_friction(obj, arm_m)
        cone = cone_edges(mu, mu_t, _CONE_SUBDIVISIONS, outside=True)
        self._wrenches = _by_edges(self._statics.G, cone)
        self._effort = _by_edges(self._statics.T, cone) / self._statics.effort[:, None]

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
                contacts = self._configuration.task.contacts
                wanted = np.array([contacts[k].hand.link for k in test.contacts])
                # The test counts all force of a link, wherever it touches.
                of_edge = np.repeat(self._links, n // len(self._links))
                pressing = (of_edge == wanted[:, None]).astype(float)
                yield none, np.column_stack([-pressing, np.full(len(pressing), test.force_N)])


def _by_edges(by_vector: Array, cone: Array) -> Array:
    """What contact vectors do, (m, 4 n), as what each contact's cone edges (4, k) do, (m, n k)."""
    rows = len(by_vector)
    return np.asarray((by_vector.reshape(rows, -1, 4) @ cone).reshape(rows, -1))


def _around(contact: PointContact, radius_m: float) -> list[PointContact]:
    """The contact at places whose hull contains a ball about it."""
    return [contact.moved(shift) for shift in radius_m * _around_unit_ball()] if radius_m > 0.0 else [contact]


@cache
def _around_unit_ball() -> Array:
    """Corners (12, 3) of an icosahedron that contains the unit ball."""
    corners = np.array(trimesh.creation.icosphere(subdivisions=0).vertices)
    return np.asarray(corners / -ConvexHull(corners).equations[:, -1].max())
