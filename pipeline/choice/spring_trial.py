"""A trial of a squeezed grasp with springs in place of a simulator: forces in balance, nothing that moves on.

Servos and pads are springs at the contacts, friction holds them until they slide, and the object goes where
all forces balance. So it goes through what a hold test goes through, under draws of its own: it stands a
little off when the fingers close, is squeezed, and bears a load in each direction of gravity. That takes a
hundredth of the time of as many tests, and is no verdict: contacts stay where they are on the hand but for a
roll, surfaces are flat but for the turn of their normals, and nothing has inertia.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...base.numeric.arrays import Array
from ...mjcf import HoldSettings, Squeeze
from ...mjcf.squeeze import contact_curvatures, grasp_statics
from ...objects import LiftTest, ObjectModel
from ...solver import Configuration
from .compliance import contact_compliance
from .draws import DrawRanges, draw

__all__ = ["LARGEST_STRAIN", "SpringStrains", "spring_strains"]

LARGEST_STRAIN = 2.0
"""What is lost is lost: strains count up to here."""

_DRAWS, _SEED = 24, 20210
_LOADS = (1.0, 2.0)
# Sweeps in which fingers push the object out of their way; stages of the squeeze, with steps of each; and
# steps under a load. Twice as many order grasps no better.
_SWEEPS, _STAGES, _STEPS, _LOADED_STEPS = 8, 6, 5, 30
# Share of the way to balance that is gone in a step, the largest step, and how far it goes in all.
_SHARE, _STEP_M, _STEP_RAD = 0.5, 0.002, 0.05
_FAR_M, _FAR_RAD = 0.05, 1.0
# Share of its slide that a contact makes in a step.
_SLIDING = 0.7
# What resists where no contact does, in N/m: of a free object the motion with the least kinetic energy.
_FREE_N_M = 30.0
# Surfaces flatter against each other than this, in 1/m, roll as if they were not; and the largest roll.
_LEAST_CURVATURE, _MOST_ROLL_M = 5.0, 0.004
_TOUCHING_N = 1e-6


class SpringStrains(NamedTuple):
    """Strains, means over the draws: the larger of slip and turn over their limits, at most `LARGEST_STRAIN`.

    Attributes:
        squeeze: while the hand closes and squeezes.
        hold: the larger one of this and that under the load, in the worst direction.
        hold_twice: the same under twice the load.
    """

    squeeze: float
    hold: float
    hold_twice: float


def spring_strains(configuration: Configuration, squeeze: Squeeze, settings: HoldSettings) -> SpringStrains:
    """Tries a grasp, the same for the same grasp; all 0 where a stand carries the object."""
    task = configuration.task
    if not isinstance(task.test, LiftTest):
        return SpringStrains(0.0, 0.0, 0.0)
    drawn = _draws(task.object)
    springs = _Springs(configuration, squeeze, settings)
    friction = settings.sliding_friction(task.object) * drawn[:, 1]
    start = springs.displaced(drawn[:, 5:8], drawn[:, 8:11])
    place, slid = springs.squeezed(start, friction)
    strains = [springs.strain(place - start, settings)]
    for load in _LOADS:
        loads = springs.weights(load * drawn[:, 0], drawn[:, 2:5], settings)
        count = loads.shape[1]
        held, of = np.repeat(place, count, axis=0), np.repeat(slid, count, axis=0)
        end = springs.loaded(held, of, np.repeat(friction, count), loads.reshape(-1, 6))
        worst = springs.strain(end - held, settings).reshape(-1, count).max(axis=1)
        strains.append(np.maximum(strains[0], worst))
    return SpringStrains(*(float(np.minimum(values, LARGEST_STRAIN).mean()) for values in strains))


@lru_cache(maxsize=8)
def _draws(obj: ObjectModel) -> Array:
    """Draws (D, 11) of an object, as `draws.CONDITIONS` has them: of all its grasps the same."""
    rng = np.random.default_rng(_SEED)
    return np.array([draw(rng, obj, DrawRanges()) for _ in range(_DRAWS)], dtype=np.float64)


class _Springs:
    """A grasp by springs.

    Motions (B, 6) of the object are from where the grasp has it, in the palm frame: a displacement of its
    centre of mass, and a turn as axis times angle.
    """

    def __init__(self, configuration: Configuration, squeeze: Squeeze, settings: HoldSettings):
        statics = grasp_statics(configuration, settings)
        obj = configuration.task.object
        self._count = statics.n_contacts
        self._G, self._forces = statics.G, squeeze.preload.reshape(-1)
        self._stiffness = np.linalg.inv(contact_compliance(statics, squeeze))
        self._own = np.diagonal(self._stiffness).reshape(self._count, 4)
        self._spin_arms = np.maximum(squeeze.spin_arms_m, 1e-4)
        self._inward, self._tangents = statics.frames[:, 0], statics.frames[:, 1:]
        self._arms: Array = statics.points - statics.centre
        self._mass, self._R = statics.mass, configuration.state.R_palm_object
        gyration_m2 = float(np.linalg.eigvalsh(obj.inertia.inertia).max()) / obj.inertia.mass
        self._mobility = np.array([1.0] * 3 + [1.0 / gyration_m2] * 3)
        whole = self._G @ self._stiffness @ self._G.T
        self._compliance = np.linalg.pinv(whole + 1e-6 * np.eye(6), hermitian=True)
        self._of_hand, self._of_object = np.moveaxis(contact_curvatures(configuration), 1, 0)
        principal, axes = np.linalg.eigh(self._of_hand + self._of_object)
        principal = np.maximum(principal, _LEAST_CURVATURE)
        self._rolling = np.einsum("nij,nj,nkj->nik", axes, 1.0 / principal, axes)

    def displaced(self, shifts_m: Array, turns: Array) -> Array:
        """Motions of an object that is shifted, and turned about the middle of the contacts."""
        return np.hstack([shifts_m - np.cross(turns, self._arms.mean(axis=0)), turns])

    def weights(self, masses: Array, centres_m: Array, settings: HoldSettings) -> Array:
        """Wrenches (D, directions, 6) of the weight, by factors of mass and offsets of its centre (D, 3)."""
        directions = np.array(settings.directions, dtype=np.float64)
        force = settings.gravity * self._mass * masses[:, None, None] * directions
        torque = np.cross((centres_m @ self._R.T)[:, None], force)
        return np.concatenate([force, torque], axis=2)

    def strain(self, motion: Array, settings: HoldSettings) -> Array:
        """How near to its limits a motion brings each object (B,); 1 is at the limit."""
        at_contacts = motion[:, None, :3] + np.cross(motion[:, None, 3:], self._arms)
        slip = np.linalg.norm(at_contacts, axis=2).max(axis=1) / settings.slip_limit_m
        limit = settings.rotation_limit_rad
        turn = np.zeros(len(motion)) if limit is None else np.linalg.norm(motion[:, 3:], axis=1) / limit
        return np.maximum(slip, turn)

    def squeezed(self, start: Array, friction: Array) -> tuple[Array, Array]:
        """Where objects are once the fingers have closed and press, and how far contacts have slid."""
        place = self._closed(start)
        slid = (place @ self._G).reshape(-1, self._count, 4)
        slid[:, :, 0] = 0.0  # fingers touch anew wherever the object is, but as deep as they go
        for stage in range(1, _STAGES + 1):
            for _ in range(_STEPS):
                forces, slid = self._pressed(place, slid, friction, stage / _STAGES)
                place = place + _bounded(self._towards_balance(self._wrench(place, forces), forces))
        return place, slid

    def loaded(self, place: Array, slid: Array, friction: Array, loads: Array) -> Array:
        """Where objects go from there under loads (B, 6)."""
        for _ in range(_LOADED_STEPS):
            forces, slid = self._pressed(place, slid, friction, 1.0)
            step = _bounded((self._wrench(place, forces) + loads) @ self._compliance)
            limits = np.array([_FAR_M] * 3 + [_FAR_RAD] * 3)
            place = np.clip(place + step, -limits, limits)
        return place

    def _closed(self, place: Array) -> Array:
        """Where fingers have pushed objects that were in their way, with no friction yet."""
        normals = self._G.reshape(6, self._count, 4)[:, :, 0].T
        for _ in range(_SWEEPS):
            for normal in normals:
                moves = self._mobility * normal
                depth = np.minimum(place @ normal, 0.0)
                place = place - (depth / (normal @ moves))[:, None] * moves
        return place

    def _pressed(self, place: Array, slid: Array, friction: Array, share: float) -> tuple[Array, Array]:
        """Forces (B, n, 4) of the contacts, and how far these have slid after it (B, n, 4).

        Args:
            place: motions of the objects.
            slid: how far contacts have slid before.
            friction: of each object (B,).
            share: of the squeeze's forces.
        """
        stretched = place @ self._G - slid.reshape(len(place), -1)
        wanted = (share * self._forces - stretched @ self._stiffness).reshape(-1, self._count, 4)
        normal = np.maximum(wanted[:, :, 0], 0.0)
        most = friction[:, None] * normal
        across = np.sqrt(
            wanted[:, :, 1] ** 2 + wanted[:, :, 2] ** 2 + (wanted[:, :, 3] / self._spin_arms) ** 2
        )
        kept = np.where(across > most, most / np.maximum(across, 1e-12), 1.0)
        forces = np.concatenate([normal[:, :, None], wanted[:, :, 1:] * kept[:, :, None]], axis=2)
        sliding = (forces - wanted) / self._own
        sliding[:, :, 0] = 0.0
        return forces, slid + _SLIDING * sliding

    def _wrench(self, place: Array, forces: Array) -> Array:
        """What the contacts' forces come to (B, 6), about the centre of mass, where surfaces have turned."""
        turn = place[:, None, 3:]
        moved = place[:, None, :3] + np.cross(turn, self._arms)
        across = np.einsum("nij,bnj->bni", self._tangents, moved)
        tilted = np.einsum("bnj,nj->bn", np.cross(turn, self._tangents[:, 0]), self._inward)
        leaning = np.einsum("bnj,nj->bn", np.cross(turn, self._tangents[:, 1]), self._inward)
        bent = np.einsum("nij,bnj->bni", self._of_object, across) - np.stack([tilted, leaning], axis=2)
        rolled = np.clip(np.einsum("nij,bnj->bni", self._rolling, bent), -_MOST_ROLL_M, _MOST_ROLL_M)
        lean = np.einsum("nij,bnj->bni", self._of_hand, rolled)
        inward = self._inward + np.einsum("nji,bnj->bni", self._tangents, lean)
        inward = inward / np.linalg.norm(inward, axis=2, keepdims=True)
        force = inward * forces[:, :, :1] + np.einsum("nji,bnj->bni", self._tangents, forces[:, :, 1:3])
        arms = self._arms + np.einsum("nji,bnj->bni", self._tangents, rolled) - place[:, None, :3]
        torque = np.cross(arms, force) + inward * forces[:, :, 3:]
        return np.concatenate([force.sum(axis=1), torque.sum(axis=1)], axis=1)

    def _towards_balance(self, wrench: Array, forces: Array) -> Array:
        """Motions that would bring balance by the contacts that touch alone."""
        touching = np.repeat(forces[:, :, 0] > _TOUCHING_N, 4, axis=1)
        G = self._G * touching[:, None, :]
        stiffness = G @ self._stiffness @ G.swapaxes(1, 2) + np.diag(_FREE_N_M / self._mobility)
        return np.asarray(np.linalg.solve(stiffness, wrench[:, :, None])[:, :, 0])


def _bounded(motion: Array) -> Array:
    """A step of the way."""
    step = _SHARE * motion
    largest = np.maximum(
        np.linalg.norm(step[:, :3], axis=1) / _STEP_M, np.linalg.norm(step[:, 3:], axis=1) / _STEP_RAD
    )
    return np.asarray(step / np.maximum(largest, 1.0)[:, None])
