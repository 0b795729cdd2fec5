"""The linear programme behind a squeeze: its rows, for whoever solves or climbs it (see `squeeze`).

There is a state for the squeeze alone and one for each direction of gravity. The unknowns are the shares of
all cone edges in each state's contact vector, state by state, and last the load factor.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import trimesh
from numpy.typing import NDArray

from ..objects import ObjectModel
from .settings import HoldSettings
from .statics import Statics

__all__ = ["LoadProgramme", "load_programme"]

Array = NDArray[np.float64]
# Compliance of skin and structure beside that of the servos, in m/N: without it, a contact that no joint can
# move would be rigid. Torques count as forces at an arm of 10 mm, here and where rows are scaled.
_SKIN_COMPLIANCE = 1e-5
_ARM_M = 0.01
_WRENCH_SCALE = np.array([1.0, 1.0, 1.0, 1.0 / _ARM_M, 1.0 / _ARM_M, 1.0 / _ARM_M])


@dataclass(frozen=True, eq=False)
class LoadProgramme:
    """What the linear programme is made of; every cone edge has unit normal force.

    Attributes:
        edges: (4 n, n_edges) edges of all cones as columns.
        balance: (6, n_edges) force in N and scaled torque on the object by each edge.
        effort: (n_independent, n_edges) share of every servo's planned effort.
        yielding: (n_directions,) change of the sum of normal forces with the weight, in N.
        weights: (n_directions, 6) scaled wrenches of the weight, about the centre of mass.
    """

    edges: Array
    balance: Array
    effort: Array
    yielding: Array
    weights: Array

    @property
    def n_states(self) -> int:
        """Number of states."""
        return 1 + len(self.weights)

    @property
    def n_unknowns(self) -> int:
        """Number of unknowns."""
        return self.n_states * self.edges.shape[1] + 1

    def equations(self) -> Array:
        """Rows that must be zero: G f_0 = 0, G f + s w = 0, and sum f_n = sum f_0n + s dn."""
        loads, n = len(self.weights), self.edges.shape[1]
        balance = np.column_stack(
            [np.kron(np.eye(1 + loads), self.balance), np.concatenate([np.zeros(6), self.weights.ravel()])]
        )
        hardness = np.column_stack([-np.ones((loads, n)), np.kron(np.eye(loads), np.ones(n)), -self.yielding])
        return np.concatenate([balance, hardness])

    def efforts(self) -> Array:
        """Rows that must be at most one: |T f| over the planned efforts."""
        rows = np.kron(np.eye(self.n_states), np.vstack([self.effort, -self.effort]))
        return np.column_stack([rows, np.zeros(len(rows))])


def load_programme(
    statics: Statics, obj: ObjectModel, settings: HoldSettings, *, subdivisions: int
) -> LoadProgramme:
    """The programme of a grasp.

    Args:
        statics: linear maps of the grasp.
        obj: the object.
        settings: friction, gravity and share of the efforts.
        subdivisions: fineness of the cones: 1 gives each 42 edges, 2 gives 162, whose hull reaches 98.5 % of
            the cone.
    """
    cone = _cone_edges(settings.sliding_friction(obj), settings.torsional_friction(obj), subdivisions)
    edges = np.kron(np.eye(statics.n_contacts), cone).astype(float)
    weights = np.zeros((len(settings.directions), 6))
    weights[:, :3] = statics.mass * settings.gravity * np.array(settings.directions)
    return LoadProgramme(
        edges,
        _WRENCH_SCALE[:, None] * (statics.G @ edges),
        statics.T @ edges / (settings.planned_effort * statics.effort[:, None]),
        _elastic_response(statics, weights)[:, 0::4].sum(axis=1),
        weights * _WRENCH_SCALE,
    )


def _elastic_response(statics: Statics, loads: Array) -> Array:
    """Changes (k, 4 n) of the contact vector under wrenches `loads` (k, 6), all contacts sticking."""
    skin = _SKIN_COMPLIANCE * np.tile([1.0, 1.0, 1.0, 1.0 / _ARM_M**2], statics.n_contacts)
    C = (statics.T.T / statics.stiffness) @ statics.T + np.diag(skin)
    # df = -C^-1 G^T (G C^-1 G^T)^+ w; pseudo-inverse, because few contacts can't resist every load.
    spread = np.linalg.solve(C, statics.G.T)
    inverse = np.linalg.pinv((_WRENCH_SCALE[:, None] * statics.G) @ (spread * _WRENCH_SCALE), rcond=1e-9)
    return -(spread * _WRENCH_SCALE @ inverse @ (loads * _WRENCH_SCALE).T).T


def _cone_edges(mu: float, mu_t: float, subdivisions: int) -> Array:
    """Edges (4, k) of a soft-finger cone at unit normal force."""
    directions = _directions(subdivisions).T
    return np.vstack([np.ones(directions.shape[1]), np.diag([mu, mu, mu_t]) @ directions])


@cache
def _directions(subdivisions: int) -> Array:
    """Unit vectors (k, 3) spread over the sphere: two tangential forces and the torque about the normal."""
    directions = np.array(trimesh.creation.icosphere(subdivisions=subdivisions).vertices)
    directions.setflags(write=False)
    return directions
