"""More contacts from fewer: where two fingers hold an object, others are laid on it.

Of places and fingers that are drawn apart from each other, three and more seldom go together; two nearly
always do. So a pinch that the solver has found is kept, and each further finger takes, of postures drawn
within its own joints' limits, the one that comes nearest to the surface with opposite normals. The places
where they come to lie make the task, and the posture is where its local search begins.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from ...base.machine.cancellation import Cancelled
from ...base.numeric.arrays import Array, Indices
from ...geometry import invert, transform_points
from ...hands import Hand, HandRegion, forward_kinematics
from ...objects import ObjectModel
from ...solver import State
from .cover import are_covered
from .reach import NORMAL_M, placed_middles
from .screen import Combination, rate
from .surface import Site, draw_surface, site_at
from .trying import Effort, solved_states, task_of

__all__ = ["PINCH", "Growing", "Grown", "grown_sets"]

PINCH = 2
"""Contacts that others are grown from."""

# Points of the surface that fingers are laid on, and postures of a finger.
_POINTS, _POSTURES = 4000, 400
# A finger that comes no nearer is not laid on: the local search, which moves all, seldom gets there then.
_NEAR_M = 0.025
# States of a pinch that are taken.
_STATES = 3
_EFFORT = Effort(candidates=_STATES, boxes=12, cleared=0, restarts=0)


@dataclass(frozen=True, eq=False)
class Grown:
    """Places that fingers seem to reach at once.

    Attributes:
        sites: the places.
        regions: of the hand, one for each.
        state: hand and object there, nearly; without parameters of contacts.
        misfit_m: of the finger that is farthest from its place.
    """

    sites: tuple[Site, ...]
    regions: tuple[HandRegion, ...]
    state: State
    misfit_m: float


@dataclass(frozen=True, eq=False)
class _Laid:
    """A finger on the surface: by how much it misses, and where; its joints."""

    misfit_m: float
    region: HandRegion
    point: int
    joints: Indices
    values: Array


class Growing:
    """The surface of an object, for fingers of a hand to be laid on.

    Args:
        hand: the hand.
        obj: the object.
        regions: of the hand that are laid on it.
        seed: of points and postures.
    """

    def __init__(self, hand: Hand, obj: ObjectModel, regions: Sequence[HandRegion], seed: int):
        self._hand, self._obj, self._regions = hand, obj, regions
        self._rng = np.random.default_rng(seed)
        points, faces = draw_surface(obj.mesh, _POINTS, self._rng)
        is_open = ~are_covered(obj, points)
        self._points, self._faces = points[is_open], faces[is_open]
        self._normals = np.asarray(obj.mesh.face_normals)[self._faces]
        self._tree = cKDTree(np.hstack([self._points, NORMAL_M * self._normals]))
        # Which independent joints move which links.
        self._moved = hand.tree.moves.astype(float) @ np.abs(hand.coupling_matrix) > 0.0

    def grow(
        self, sites: Sequence[Site], regions: Sequence[HandRegion], state: State, contacts: int
    ) -> Grown | None:
        """So many contacts from a few that touch, or None where the other fingers don't come near enough.

        Args:
            sites: places on the object.
            regions: of the hand that touch them.
            state: in which they do.
            contacts: how many there are to be.
        """
        held = [region.link for region in regions]
        still = self._moved[held].any(axis=0)
        laid: dict[int, _Laid] = {}
        for region in self._regions:
            joints = np.flatnonzero(self._moved[region.link] & ~still)
            if region.link in held or not len(joints):
                continue
            found = self._lay(region, joints, state)
            if region.link not in laid or found.misfit_m < laid[region.link].misfit_m:
                laid[region.link] = found
        chosen = self._apart(sorted(laid.values(), key=lambda one: one.misfit_m), contacts - len(sites))
        if len(chosen) < contacts - len(sites) or chosen[-1].misfit_m > _NEAR_M:
            return None
        q = np.array(state.q)
        for one in chosen:
            q[one.joints] = one.values
        added = [site_at(self._obj, self._points[one.point], int(self._faces[one.point])) for one in chosen]
        return Grown(
            (*sites, *added),
            (*regions, *(one.region for one in chosen)),
            replace(state, q=q, params=np.zeros(0)),
            chosen[-1].misfit_m,
        )

    def _lay(self, region: HandRegion, joints: Indices, state: State) -> _Laid:
        """The posture of one finger that comes nearest to the surface."""
        lower, upper = self._hand.limits[joints].T
        values = self._rng.uniform(lower, upper, size=(_POSTURES, len(joints)))
        drawn = np.repeat(state.q[None], _POSTURES, axis=0)
        drawn[:, joints] = values
        poses = np.array([forward_kinematics(self._hand, self._hand.expand(q)) for q in drawn])
        points, normals = placed_middles(poses, region)
        on_object = transform_points(invert(state.T_palm_object), points)
        misfits, nearest = self._tree.query(
            np.hstack([on_object, -NORMAL_M * (normals @ state.R_palm_object)])
        )
        best = int(np.argmin(misfits))
        return _Laid(float(misfits[best]), region, int(nearest[best]), joints, values[best])

    @staticmethod
    def _apart(laid: list[_Laid], count: int) -> list[_Laid]:
        """The best so many of which no two ask for the same joint."""
        chosen: list[_Laid] = []
        for one in laid:
            if len(chosen) < count and all(not np.isin(one.joints, other.joints).any() for other in chosen):
                chosen.append(one)
        return chosen


def grown_sets(
    hand: Hand,
    obj: ObjectModel,
    regions: Sequence[HandRegion],
    contacts: int,
    pinches: Sequence[tuple[Combination, tuple[HandRegion, ...]]],
    seed: int,
) -> Iterator[tuple[Combination, Grown] | None]:
    """Contacts with force closure that are grown from pinches; None where time is to be looked at.

    Args:
        hand: the hand.
        obj: the object.
        regions: of the hand that are laid on it.
        contacts: how many there are to be.
        pinches: places, and what touches them.
        seed: the same gives the same.
    """
    growing = Growing(hand, obj, regions, seed)
    for pinch, touching in pinches:
        task = task_of(hand, obj, pinch, touching)
        while True:
            try:
                states = solved_states(task, seed, _EFFORT)
                break
            except Cancelled:
                yield None
        for state in states[:_STATES]:
            grown = growing.grow(pinch.sites, touching, state, contacts)
            if grown is not None:
                for rated in rate(hand, obj, grown.sites, [tuple(range(contacts))]):
                    yield rated, grown
