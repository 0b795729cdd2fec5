"""Which sites of an object go together: those that forces inside friction cones can hold it by."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from math import comb, hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ...geometry import even_directions, perpendicular
from ...hands import Hand
from ...mjcf import HoldSettings
from ...mjcf.squeeze import epsilon_and_volume, torque_length_m
from ...objects import ObjectModel
from ...objects.carrying import WANTED, Places, carried_forces, least_multiple, object_load, usual_fingertip
from .askew import askew_rad
from .surface import Site

__all__ = ["Combination", "PairLimits", "apart_m", "can_ever_carry", "rate", "screen"]

# Combinations of which the wrench hull is computed, a millisecond each; of more than so many, a sample is
# looked at.
_MOST_HULLS = 400
_MOST_DRAWN = 100_000
_EDGES = 8
# Of two combinations with all their sites this near to each other, the weaker one is left out.
_SAME_M = 0.015
_SAME_SHARE = 0.12
# Least share of a contact in the forces that balance: a finger with less is there for nothing.
_LEAST_SHARE = 0.08


@dataclass(frozen=True, eq=False)
class Combination:
    """Sites that the object can be held by.

    Attributes:
        sites: one for each contact.
        epsilon: Ferrari and Canny's measure at their middles, in N; above 0 is force closure.
        multiple: of the weight that they carry at their middles however the object is turned, at least, by
            whichever fingers; see `objects.carrying`.
    """

    sites: tuple[Site, ...]
    epsilon: float
    multiple: float

    @property
    def carries(self) -> bool:
        """Whether they carry what a squeeze is planned for."""
        return self.multiple >= WANTED

    @property
    def worth(self) -> float:
        """What they promise: their epsilon, less in proportion where they don't carry enough."""
        return self.epsilon * min(1.0, self.multiple / WANTED)

    @property
    def width_m(self) -> float:
        """How far two sites are apart along their normals; of more than two, 0."""
        points, normals = (np.array([getattr(s, name) for s in self.sites]) for name in ("point", "normal"))
        return float(_widths_m(points[None], normals[None])[0]) if len(points) == 2 else 0.0

    @cached_property
    def askew_rad(self) -> float:
        """How far two sites are from facing each other, at their best points; of more than two, 0."""
        if len(self.sites) != 2:
            return 0.0
        return askew_rad(self.sites[0], self.sites[1])


class PairLimits(NamedTuple):
    """What two contacts may be like for two regions of a hand to touch them.

    Attributes:
        widest_m: how far they may be apart along their normals.
        askew_rad: by how much they may miss to face each other.
    """

    widest_m: float = np.inf
    askew_rad: float = np.pi


_ANY_PAIR = (PairLimits(),)


def screen(
    hand: Hand,
    obj: ObjectModel,
    places: Sequence[Site],
    contacts: int,
    count: int,
    seed: int,
    *,
    limits: Sequence[PairLimits] = _ANY_PAIR,
) -> list[Combination]:
    """At most `count` combinations with force closure, no two alike.

    Those that carry what a squeeze is planned for come first, and of these and the others the strongest.

    Args:
        hand: the hand.
        obj: the object.
        places: sites to choose from.
        contacts: how many go together.
        count: how many combinations.
        seed: of the sample that is looked at where there are very many.
        limits: of two contacts, of which they have to be within one.
    """
    length = torque_length_m(obj)
    mu = HoldSettings().sliding_friction(obj)
    chosen = _promising(places, contacts, mu, length, seed, limits)
    return _unlike(rate(hand, obj, places, chosen), count, min(_SAME_M, _SAME_SHARE * obj.size_m))


def rate(
    hand: Hand, obj: ObjectModel, places: Sequence[Site], chosen: Iterable[tuple[int, ...]]
) -> list[Combination]:
    """Of some combinations those with force closure, what promises most first.

    Args:
        hand: the hand.
        obj: the object.
        places: sites.
        chosen: which of them go together, by their indices.
    """
    settings = HoldSettings()
    mu, mu_t = settings.sliding_friction(obj), settings.torsional_friction(obj)
    length = torque_length_m(obj)
    blocks = [_wrenches(site, obj.inertia.centre, mu, mu_t, length) for site in places]
    rated: list[Combination] = []
    load, tip = object_load(obj), usual_fingertip(hand)
    points = [Places(s.point[None], -s.normal[None], tip.force_N, tip.spin_arm_m) for s in places]
    for indices in chosen:
        epsilon, _ = epsilon_and_volume(np.column_stack([blocks[i] for i in indices]))
        if epsilon > 0.0:
            # What forces of sum 1 N resist in every direction, fingers resist that press with 1 N each.
            multiple = epsilon * tip.force_N / load.weight_N
            if multiple < WANTED:
                forces = carried_forces([points[i] for i in indices], load.centre, mu, even_directions(0))
                multiple = least_multiple(forces, load.weight_N)
            rated.append(Combination(tuple(places[i] for i in indices), epsilon, multiple))
    rated.sort(key=lambda combination: (not combination.carries, -combination.worth))
    return rated


def can_ever_carry(hand: Hand, obj: ObjectModel, contacts: int) -> bool:
    """Whether so many fingers are strong enough for an object, if all of them pushed against its weight."""
    load = object_load(obj)
    most_N = contacts * usual_fingertip(hand).force_N * hypot(1.0, load.friction)
    return most_N >= WANTED * load.weight_N


def _promising(
    places: Sequence[Site],
    contacts: int,
    mu: float,
    length: float,
    seed: int,
    limits: Sequence[PairLimits],
) -> Iterator[tuple[int, ...]]:
    """Combinations whose normal forces balance well enough to be worth a hull, the best of them."""
    points = np.array([site.point for site in places]).reshape(-1, 3)
    normals = np.array([site.normal for site in places]).reshape(-1, 3)
    drawn = _draw(len(places), contacts, seed)
    most_askew_rad = np.full(len(drawn), np.pi)
    if contacts == 2:
        # Askew by so much at most, for regions that can be so far apart.
        widths_m = _widths_m(points[drawn], normals[drawn])
        most_askew_rad = np.full(len(drawn), -np.inf)
        for one in limits:
            most_askew_rad[(widths_m <= one.widest_m) & (most_askew_rad < one.askew_rad)] = one.askew_rad
        # First what the bends alone rule out, which takes no time.
        bends = np.array([site.bend_rad for site in places])
        missed = _angle(normals[drawn[:, 0]], -normals[drawn[:, 1]]) - bends[drawn].sum(axis=1)
        fits = (most_askew_rad >= 0.0) & ((most_askew_rad >= np.pi) | (missed <= most_askew_rad))
        drawn, most_askew_rad = drawn[fits], most_askew_rad[fits]
    # What is missing in a balance of forces and torques has to be made up for by friction.
    imbalance = np.maximum(*_imbalance(points[drawn], normals[drawn], length))
    order = np.argsort(imbalance, kind="stable")
    found = 0
    for i in order[imbalance[order] <= mu]:
        chosen = tuple(int(site) for site in drawn[i])
        most_rad = float(most_askew_rad[i])
        if most_rad < np.pi and askew_rad(places[chosen[0]], places[chosen[1]], most_rad) > most_rad:
            continue
        yield chosen
        found += 1
        if found == _MOST_HULLS:
            return


def _angle(a: Array, b: Array) -> Array:
    """Angles between unit vectors (..., 3), in rad."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)))


def _widths_m(points: Array, normals: Array) -> Array:
    """Distances (m,) of pairs of sites (m, 2, 3) along their normals, the smaller one."""
    across = points[:, 1:] - points[:, :1]
    return np.asarray(np.abs(np.sum(across * normals, axis=2)).min(axis=1))


def _draw(n: int, contacts: int, seed: int) -> NDArray[np.int64]:
    """Combinations (m, contacts) of n sites: all of them, or a sample where they are many."""
    if comb(n, contacts) <= _MOST_DRAWN:
        return np.array(list(combinations(range(n), contacts)), dtype=np.int64).reshape(-1, contacts)
    rng = np.random.default_rng(seed)
    drawn = np.sort(rng.integers(n, size=(_MOST_DRAWN, contacts)), axis=1)
    return np.unique(drawn[np.all(np.diff(drawn, axis=1) > 0, axis=1)], axis=0)


def _imbalance(points: Array, normals: Array, length: float) -> tuple[Array, Array]:
    """What is left (m,) of forces along the normals that balance best, and of their torques by `length`.

    The forces have sum 1, and the least squares of what is left; infinite where one of them would pull or do
    nothing.
    """
    centred = points - points.mean(axis=1, keepdims=True)
    torques = np.cross(centred, normals) / length
    gram = normals @ normals.swapaxes(1, 2) + torques @ torques.swapaxes(1, 2)
    k = points.shape[1]
    shares = np.linalg.solve(gram + 1e-6 * np.eye(k), np.ones((len(gram), k, 1)))[..., 0]
    shares = shares / shares.sum(axis=1, keepdims=True)
    left = np.einsum("mk,mkd->md", shares, normals), np.einsum("mk,mkd->md", shares, torques)
    sound = shares.min(axis=1) >= _LEAST_SHARE
    force, torque = (np.where(sound, np.linalg.norm(x, axis=1), np.inf) for x in left)
    return force, torque


def _wrenches(site: Site, centre: Array, mu: float, mu_t: float, length: float) -> Array:
    """Wrenches (6, n) of unit normal force at a site: edges of the soft-finger cone, torques by `length`."""
    inward = -site.normal
    e1, e2 = perpendicular(inward)
    angles = 2.0 * np.pi * np.arange(_EDGES) / _EDGES
    forces = inward[:, None] + mu * (np.outer(e1, np.cos(angles)) + np.outer(e2, np.sin(angles)))
    forces = np.column_stack([forces, inward, inward])
    torques = np.cross(site.point - centre, forces.T).T
    torques[:, _EDGES:] += np.column_stack([mu_t * inward, -mu_t * inward])
    return np.vstack([forces, torques / length])


def _unlike(rated: list[Combination], count: int, same_m: float) -> list[Combination]:
    kept: list[Combination] = []
    for combination in rated:
        if all(apart_m(combination, other) > same_m for other in kept):
            kept.append(combination)
            if len(kept) == count:
                break
    return kept


def apart_m(a: Combination, b: Combination) -> float:
    """How far the sites of one are at most from the nearest of the other, in m."""
    p = np.array([site.point for site in a.sites])
    q = np.array([site.point for site in b.sites])
    return float(np.linalg.norm(p[:, None] - q[None], axis=2).min(axis=1).max())
