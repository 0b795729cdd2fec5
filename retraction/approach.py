"""The approach to a grasp: a pregrasp with open fingers, and a way of closing them that touches nothing else.

Starting from the grasp, the fingers open in steps. Each is the smallest motion of the joints that takes every
touching point of the hand away from the object along the contact's normal, while no near pair of bodies comes
closer than it may: a quadratic program like that of retraction. Joints without a contact may give way. Each
step is a straight line in joint space that `sweep` proves clear, so the way back closes the fingers safely.
"""

from dataclasses import dataclass

import numpy as np

from ..base.machine.cancellation import give_up_if_asked
from ..base.numeric.arrays import Array, Indices
from ..geometry import invert
from ..hands import jacobian_from_axes, joint_axes
from ..solver import Configuration, ContactManifold, State
from .distance import lower_bounds, measure
from .jacobian import distance_jacobian
from .nearest import measure_quickly
from .pairs import CollisionModel, collision_model
from .qp import StepProblem, coordinate_scale, solve_step
from .settings import RetractionSettings
from .sweep import Obstruction, sweep

__all__ = ["Approach", "find_approach"]


# How far the fingers should open, and how far at least for the pregrasp to count as open.
_OPENING_M, _LEAST_OPENING_M = 0.015, 0.010
_STEP_M = 0.003
_MAX_STEPS = 20
# A step that is not clear is tried shorter.
_BACKTRACKS = (1.0, 0.5, 0.25)
_TRUST_M = 0.01
# Pairs nearer than this can come together within a step.
_REACH_M = 0.03
# Against the motion of 1 m: a metre of opening that is missing is worth this many metres of motion, squared.
_SLACK_WEIGHT = 1e3
# Steps keep a little off what they may come close to, for surfaces curve away from their tangents.
_EXTRA_M = 2e-5
# A point that no joint moves faster than this, in m per m of coordinates, can't be taken off the object.
_LEAST_SPEED = 1e-6


@dataclass(frozen=True, eq=False)
class Approach:
    """How the fingers get to a grasp, the object and the palm being in place.

    Attributes:
        reachable: whether the grasp is clear, the pregrasp open, and the way between them proved clear.
        opening_m: by how much each touching point was taken off the object along its contact's normal, the
            least of them; points that no joint moves, such as the palm's, do not count.
        waypoints: independent joints (n_waypoints, n_independent) from the pregrasp to the grasp, to be
            joined by straight lines; as far open as the fingers came, also where that is too little.
        blocking: names of the two bodies that stop the fingers from opening; None where nothing or a joint
            limit does.
    """

    reachable: bool
    opening_m: float
    waypoints: Array
    blocking: tuple[str, str] | None

    @property
    def pregrasp(self) -> Array:
        """Independent joints (n_independent,) at the start."""
        return self.waypoints[0]

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"

    def __str__(self) -> str:
        opened = f"the fingers open by {1e3 * self.opening_m:.3g} mm"
        if self.reachable:
            return f"reachable: {opened}, and the way is clear"
        why = "limits of joints" if self.blocking is None else " and ".join(self.blocking)
        return f"unreachable: {opened} only, stopped by {why}"


def find_approach(configuration: Configuration, *, settings: RetractionSettings | None = None) -> Approach:
    """Opens the fingers of a configuration as far as it can be proved that they touch nothing else.

    The way keeps to the depths that `settings` allow; its margin is asked of the grasp alone. Where the grasp
    itself sinks in deeper it is not reachable, and the bodies that do so must not sink in further on the way.
    """
    opener = _Opener(configuration, settings or RetractionSettings())
    state, way = configuration.state, [configuration.state.q]
    obstruction: Obstruction | None = None
    opened = opener.opened_m(state)
    for _ in range(_MAX_STEPS):
        give_up_if_asked()
        if opened.min(initial=np.inf) >= _OPENING_M:
            break
        following, obstruction = opener.step(state, opened)
        if following is None:
            break
        opened_next = opener.opened_m(following)
        if opened_next.min() < opened.min() + 1e-3 * _STEP_M:
            break
        state, opened = following, opened_next
        way.append(state.q)
    # Where no contact can be opened at all, as none is on a finger, there is nothing to close either.
    least = float(opened.min()) if len(opened) else 0.0
    reachable = opener.sunk is None and (not len(opened) or least >= _LEAST_OPENING_M)
    blocking = None if reachable else opener.sunk or opener.blocking(state, obstruction)
    return Approach(reachable, least, np.array(way[::-1]), blocking)


class _Opener:
    """Opens the fingers of one configuration step by step.

    Attributes:
        sunk: names of the two bodies that sink in deepest in the grasp itself; None where it is clear.
    """

    def __init__(self, configuration: Configuration, settings: RetractionSettings):
        self._model: CollisionModel = collision_model(configuration.task)
        self._manifold = ContactManifold(configuration.task)
        self._scale = coordinate_scale(self._manifold)
        self._hand = configuration.task.hand
        allowed_m = np.where(self._model.intended, settings.contact_depth_m, settings.depth_m)
        self._required = -allowed_m - self._model.stands_out_m
        self.sunk = self._allow_sunk(configuration.state)
        frames = self._frames(configuration.state)
        self._links = []
        normals, starts, local = [], [], []
        for contact, point in zip(configuration.task.contacts, configuration.contact_points, strict=True):
            J = self._speed(frames, contact.hand.link, point.p_hand, point.n_object)
            if np.abs(J).max() > _LEAST_SPEED:
                self._links.append(contact.hand.link)
                normals.append(point.n_object)
                starts.append(point.p_hand)
                local.append((invert(frames[0][contact.hand.link]) @ np.append(point.p_hand, 1.0))[:3])
        self._normals, self._starts, self._local = (
            np.array(rows).reshape(-1, 3) for rows in (normals, starts, local)
        )

    def _allow_sunk(self, state: State) -> tuple[str, str] | None:
        """Lets pairs that sink in deeper than they may stay so; the names of the deepest, if any."""
        placed, pairs = self._model.place(state), self._model.piece_pairs
        near = np.flatnonzero(lower_bounds(placed, pairs) < self._required)
        room = measure(placed, pairs[near]).distance_m - self._required[near]
        if room.min(initial=0.0) >= 0.0:
            return None
        sunk = room < 0.0
        self._required[near[sunk]] += room[sunk] - _EXTRA_M
        return self._model.name(self._model.pairs[self._model.pair_of[near[np.argmin(room)]]])

    def opened_m(self, state: State) -> Array:
        """How far (n,) each point that can be moved is from where it touched, along the normal."""
        points = self._points(self._frames(state))
        return np.einsum("ij,ij->i", points - self._starts, self._normals)

    def step(self, state: State, opened_m: Array) -> tuple[State | None, Obstruction | None]:
        """The state a step further open, if there is one, and what stood in the way of a longer step."""
        obstruction = None
        dq = self._direction(state, opened_m)
        if dq is None:
            return None, None
        for share in _BACKTRACKS:
            q = np.clip(state.q + share * dq, *self._manifold.task.limits.T)
            found = sweep(self._model, state, q, self._required)
            if found is None:
                return State(q, state.R_palm_object, state.p_palm_object, state.params), obstruction
            obstruction = found
        return None, obstruction

    def blocking(self, state: State, obstruction: Obstruction | None) -> tuple[str, str] | None:
        """The pair that was met, or that is at its limit where no step led further."""
        if obstruction is None:
            near, room, _ = self._near(state)
            if not len(near) or room.min() > _EXTRA_M:
                return None
            pair = int(near[np.argmin(room)])
        else:
            pair = obstruction.pair
        return self._model.name(self._model.pairs[self._model.pair_of[pair]])

    def _direction(self, state: State, opened_m: Array) -> Array | None:
        """The joint step (n_q,) of the quadratic program."""
        frames, n = self._frames(state), self._manifold.n_q
        points = self._points(frames)
        J_open = np.array(
            [self._speed(frames, *row) for row in zip(self._links, points, self._normals, strict=True)]
        )
        _, room, J_near = self._near(state)
        scale, n_slack = self._scale[:n], len(J_open)
        rows = np.vstack([J_open, J_near]) / scale
        slack = np.vstack([np.eye(n_slack), np.zeros((len(J_near), n_slack))])
        wanted = np.clip(_OPENING_M - opened_m, 0.0, _STEP_M)
        limits = self._manifold.task.limits - state.q[:, None]
        lower = np.concatenate(
            [
                np.maximum(-_TRUST_M, np.minimum(limits[:, 0], 0.0) * scale),
                np.zeros(n_slack),
                wanted,
                np.minimum(_EXTRA_M - room, 0.0),
            ]
        )
        upper = np.full(len(lower), np.inf)
        upper[:n] = np.minimum(_TRUST_M, np.maximum(limits[:, 1], 0.0) * scale)
        H = np.diag(np.concatenate([np.ones(n), np.full(n_slack, _SLACK_WEIGHT)]))
        A = np.hstack([rows, slack])
        return solve_step(StepProblem(H, A, lower, upper, np.zeros(len(lower), dtype=bool), scale))

    def _near(self, state: State) -> tuple[Indices, Array, Array]:
        """Pairs of pieces (k,) that are near each other, their room (k,) in m, and its derivatives by q."""
        placed = self._model.place(state)
        bounds = lower_bounds(placed, self._model.piece_pairs) - self._required
        near = np.flatnonzero(bounds < _REACH_M)
        gaps = measure_quickly(placed, self._model.piece_pairs[near])
        J = distance_jacobian(self._manifold, self._model, state, gaps)[:, : self._manifold.n_q]
        return near, gaps.distance_m - self._required[near], J

    def _frames(self, state: State) -> tuple[Array, Array, Array]:
        return joint_axes(self._hand, self._hand.expand(state.q))

    def _points(self, frames: tuple[Array, Array, Array]) -> Array:
        """The touching points (n, 3) of the fingers where they are now, in the palm frame."""
        T = frames[0][self._links]
        return np.einsum("nij,nj->ni", T[:, :3, :3], self._local) + T[:, :3, 3]

    def _speed(self, frames: tuple[Array, Array, Array], link: int, p: Array, n: Array) -> Array:
        """Speed (n_q,) of a point p of a link along n by each independent joint."""
        J_p, _ = jacobian_from_axes(self._hand, frames[1], frames[2], link, p)
        return n @ J_p @ self._hand.coupling_matrix
