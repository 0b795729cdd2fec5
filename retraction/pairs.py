"""Which bodies of a task are kept apart, which may touch, and which are left out.

Left out are pairs that overlap by construction, told by four rules and no list of names:

- a link and its parent, which share a joint;
- links that overlap both with every joint at zero (or the limit next to it) and in the middle of its range;
- a link and its parent's parent that overlap slightly in much of their range, as the hulls of links about a
  knuckle do whose true shapes pass each other;
- links that an imported hand's own model keeps from touching.

The models for MuJoCo leave out the same pairs.

A pair whose contact lies where the object's convex pieces stand out of its true surface may sink in that much
deeper; it alone, and no deeper than the pieces stand out there.

A pair that merely can collide, such as the thumb and the palm, overlaps in some poses only and is kept. The
parts of the object are rigidly joined and left out among themselves, and so is what they stand on.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..base.numeric.arrays import Array, Indices
from ..geometry import Cap, Patch, PointRegion, Sphere, halton_points
from ..hands import Hand, forward_kinematics
from ..objects import Contact, Task, standing_out
from ..solver import State
from .bodies import Bodies, Body, PlacedBodies, build_piece, hand_bodies, object_bodies
from .distance import measure

__all__ = ["BodyPair", "CollisionModel", "collision_model", "overlapping_links"]

# Links about a knuckle are left out where they overlap in so much of their range, and nowhere deeper.
_OFTEN, _SHALLOW_M = 0.25, 0.006
_POSTURES = 32


@dataclass(frozen=True)
class BodyPair:
    """Two bodies that are watched.

    Attributes:
        a: index of the first body, always a link.
        b: index of the second body, a later link, a part of the object or its support.
        intended: whether the task asks these two to touch.
        stands_out_m: how far the object's pieces stand out of its true surface at the contacts of the two.
    """

    a: int
    b: int
    intended: bool
    stands_out_m: float = 0.0


@dataclass(frozen=True, eq=False)
class CollisionModel:
    """The bodies of a task, the pairs watched, and the pairs of their pieces.

    Attributes:
        task: the task.
        bodies: links first, then the object's parts, then its support.
        pairs: pairs of bodies that are watched.
        piece_pairs: (n, 2) pairs of pieces, grouped by pair of bodies.
        pair_of: (n,) the pair of bodies that each pair of pieces belongs to.
        touching: the pair of bodies (link, part of the object) that each contact asks to touch.
    """

    task: Task
    bodies: Bodies
    pairs: tuple[BodyPair, ...]
    piece_pairs: Indices
    pair_of: Indices
    touching: tuple[tuple[int, int], ...]

    def __repr__(self) -> str:
        count = f"{len(self.bodies.bodies)} bodies, {len(self.pairs)} pairs watched"
        return f"<{type(self).__name__} of {self.task.name}: {count}>"

    def place(self, state: State) -> PlacedBodies:
        """The bodies where a state puts them, in the palm frame."""
        hand = self.task.hand
        Ts_link = forward_kinematics(hand, hand.expand(state.q))
        n_parts = len(self.bodies.bodies) - len(Ts_link)
        return self.bodies.place(np.concatenate([Ts_link, np.tile(state.T_palm_object, (n_parts, 1, 1))]))

    @cached_property
    def intended(self) -> NDArray[np.bool_]:
        """Whether each pair of pieces (n,) belongs to an intended contact."""
        return np.array([pair.intended for pair in self.pairs])[self.pair_of]

    @cached_property
    def stands_out_m(self) -> Array:
        """As of the pairs of bodies, for each pair of pieces (n,)."""
        return np.array([pair.stands_out_m for pair in self.pairs])[self.pair_of]

    def name(self, pair: BodyPair) -> tuple[str, str]:
        """Names of the two bodies."""
        return self.bodies.bodies[pair.a].name, self.bodies.bodies[pair.b].name


@lru_cache(maxsize=16)
def collision_model(task: Task) -> CollisionModel:
    """The bodies and watched pairs of a task; the same object for the same task."""
    of_object = object_bodies(task)
    parts = of_object[: len(task.object.parts)]
    bodies = Bodies([*hand_bodies(task.hand), *of_object])
    n_links = len(task.hand.links)
    left_out = overlapping_links(task.hand)
    touching = tuple((c.hand.link, n_links + _carrier(c, parts)) for c in task.contacts)
    stands_out = _stands_out(task, touching)
    pairs = [BodyPair(a, b, False) for a, b in combinations(range(n_links), 2) if (a, b) not in left_out]
    pairs += [
        BodyPair(a, b, (a, b) in touching, stands_out.get((a, b), 0.0))
        for a in range(n_links)
        for b in range(n_links, len(bodies.bodies))
    ]
    piece_pairs, pair_of = _pairs_of_pieces(bodies, [(pair.a, pair.b) for pair in pairs])
    return CollisionModel(task, bodies, tuple(pairs), piece_pairs, pair_of, touching)


def _stands_out(task: Task, touching: tuple[tuple[int, int], ...]) -> dict[tuple[int, int], float]:
    """How far pieces stand out at the contacts of each pair of touching bodies; the least of several."""
    found: dict[tuple[int, int], float] = {}
    for contact, (link, body) in zip(task.contacts, touching, strict=True):
        part = task.object.parts[body - len(task.hand.links)]
        here_m = standing_out(part, contact.object.region)
        found[link, body] = min(here_m, found.get((link, body), here_m))
    return found


@lru_cache(maxsize=16)
def overlapping_links(hand: Hand) -> frozenset[tuple[int, int]]:
    """Pairs (a, b), a < b, of links that are left out by the rules above."""
    bodies = Bodies(hand_bodies(hand))
    lower, upper = hand.limits.reshape(-1, 2).T
    everything = list(combinations(range(len(hand.links)), 2))
    at_rest = np.array([np.clip(0.0, lower, upper), 0.5 * (lower + upper)])
    always = np.all(_distances_m(hand, bodies, everything, at_rest) < 0.0, axis=0)
    joined = {(link.parent, i) for i, link in enumerate(hand.links) if link.parent >= 0}
    about_knuckles = _passing_about_knuckles(hand, bodies, lower, upper)
    left_out = joined | about_knuckles | {everything[k] for k in np.flatnonzero(always)}
    return frozenset(left_out).union(hand.never_touching)


def _passing_about_knuckles(
    hand: Hand, bodies: Bodies, lower: Array, upper: Array
) -> frozenset[tuple[int, int]]:
    """Pairs of a link and its parent's parent that overlap slightly in much of their range."""
    parents = [link.parent for link in hand.links]
    pairs = [(parents[p], i) for i, p in enumerate(parents) if p >= 0 and parents[p] >= 0]
    if not pairs or not len(lower):
        return frozenset()
    # A sequence without random numbers, which spreads evenly over however many joints there are.
    shares = halton_points(_POSTURES, len(lower))
    distances_m = _distances_m(hand, bodies, pairs, lower + shares * (upper - lower))
    is_often = (distances_m < 0.0).mean(axis=0) >= _OFTEN
    is_shallow = distances_m.min(axis=0) >= -_SHALLOW_M
    return frozenset(pairs[k] for k in np.flatnonzero(is_often & is_shallow))


def _distances_m(hand: Hand, bodies: Bodies, pairs: list[tuple[int, int]], postures: Array) -> Array:
    """Signed distances (n_postures, n_pairs) of pairs of links, in m; inf for links without shapes."""
    piece_pairs, pair_of = _pairs_of_pieces(bodies, pairs)
    out = np.full((len(postures), len(pairs)), np.inf)
    for row, q in zip(out, postures, strict=True):
        gaps = measure(bodies.place(forward_kinematics(hand, hand.expand(q))), piece_pairs)
        np.minimum.at(row, pair_of, gaps.distance_m)
    return out


def _pairs_of_pieces(bodies: Bodies, pairs: list[tuple[int, int]]) -> tuple[Indices, Indices]:
    """Pairs of pieces (n, 2) of pairs of bodies, and the pair (n,) that each belongs to."""
    of_body = [np.flatnonzero(bodies.piece_body == i) for i in range(len(bodies.bodies))]
    rows, owners = [np.zeros((0, 2), dtype=np.int64)], [np.zeros(0, dtype=np.int64)]
    for k, (a, b) in enumerate(pairs):
        grid = np.array(np.meshgrid(of_body[a], of_body[b], indexing="ij")).reshape(2, -1).T
        rows.append(grid)
        owners.append(np.full(len(grid), k))
    return np.concatenate(rows), np.concatenate(owners)


def _carrier(contact: Contact, parts: list[Body]) -> int:
    """Index of the part of the object whose pieces come nearest to the surface of a contact's region."""
    region = contact.object.region
    match region:
        case Cap():
            point = region.centre + region.radius * region.axis
        case Patch():
            point = region.patch.evaluate(0.5, 0.5)
        case PointRegion():
            point = region.point
    dot = Body("point", None, (build_piece(Sphere(point, 1e-6)),))
    bodies = Bodies([dot, *parts])
    piece_pairs, part_of = _pairs_of_pieces(bodies, [(0, 1 + i) for i in range(len(parts))])
    gaps = measure(bodies.place(np.tile(np.eye(4), (len(bodies.bodies), 1, 1))), piece_pairs)
    depth = np.full(len(parts), np.inf)
    np.minimum.at(depth, part_of, gaps.distance_m)
    return int(np.argmin(np.abs(depth)))
