"""From forces to the multiple of a load: over all directions of a test, and all ways to turn the object."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import product
from math import inf

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import even_directions, rotation_exp, rotation_from_unit_quaternion
from .forces import CarriedForces, growing_forces
from .places import Places

__all__ = ["best_points", "least_multiple", "most_multiple"]

# Ways to turn the object in the palm that are looked at: any is within some 15 deg of one of them.
_TURNS, _SEED = 1000, 0
# And so many near the best of them, within these angles in turn.
_NEAR, _FINER = 100, (0.25, 0.08, 0.025)
# Choices of points that are all looked at; of more, a local search looks at some, in rounds; most need two.
_ALL, _ROUNDS = 100, 3
# Directions that are looked at: fineness, and after how many of them it is asked whether others matter.
_COUNTS = ((0, (4, 12)), (1, (42,)))
# Searches that begin elsewhere than in the middles.
_DRAWN = 8
# With so much friction no more is tried.
_MOST_FRICTION = 1.0
# Random steps at the end, and how far they go in parameters of a patch, from the first to the last.
_POLISHING, _REACHES = 150, (0.25, 0.02)


def least_multiple(forces: CarriedForces, weight_N: float) -> float:
    """The multiple of a weight that is carried however the object is turned: that of the worst direction."""
    return float(forces.along.min()) / weight_N


def most_multiple(
    forces: CarriedForces,
    weight_N: float,
    gravity: Array,
    R_object_palm: Array | None = None,
    *,
    refined: bool = False,
) -> float:
    """The multiple of a weight that is carried in every direction of a test, the object turned for the best.

    Args:
        forces: what the contacts can bring about.
        weight_N: of the object.
        gravity: (n, 3) unit vectors in the palm frame, each direction by itself.
        R_object_palm: (3, 3) where the object is held fixed; None where it may be turned.
        refined: whether to look for better ways to turn it near the best of those that are looked at.
    """
    if R_object_palm is not None:
        return forces.best_turn(_turned(R_object_palm[None], gravity))[1] / weight_N
    turns = _turns()
    best, carried = forces.best_turn(_everywhere(gravity.tobytes()))
    for share in _FINER if refined else ():
        turns = turns[best] @ _near(share)
        best, carried = forces.best_turn(_turned(turns, gravity))
    return carried / weight_N


def _turned(turns: Array, gravity: Array) -> Array:
    """Directions (n, g, 3) in the object's frame that loads along `gravity` (g, 3) push against."""
    turned = (turns.reshape(-1, 3) @ -gravity.T).reshape(len(turns), 3, -1)
    return np.ascontiguousarray(turned.swapaxes(1, 2))


@lru_cache(maxsize=4)
def _everywhere(gravity: bytes) -> Array:
    """The same for all ways to turn the object; `gravity` as the bytes of its (g, 3) floats."""
    return _turned(_turns(), np.frombuffer(gravity).reshape(-1, 3))


def best_points(
    places: Sequence[Places],
    centre: Array,
    mu: float,
    gravity: Array,
    *,
    R_object_palm: Array | None = None,
    enough_N: float = inf,
    polished: bool = True,
) -> list[Places]:
    """One point of each contact, so chosen that much is carried.

    Of two contacts all pairs of coarse points are looked at. Of more, each in turn takes its best coarse
    point until none does better, from the middles and from some other choices. Then each in turn takes its
    best of all points. Better choices may be missed. Where all of them carry nothing, points that are best
    with twice the friction stand in for them (with polishing only).

    Args:
        places: where each contact presses.
        centre: (3,) centre of mass of the object in m.
        mu: friction.
        gravity: as for `most_multiple`.
        R_object_palm: as for `most_multiple`.
        enough_N: weight in N with which the search ends once it is carried.
        polished: whether points beside those of the grid are looked at in the end.
    """

    def weight_N(chosen: tuple[int, ...], least: float) -> float:
        return weight_of([place.at(k) for place, k in zip(places, chosen, strict=True)], least)

    def weight_of(points: Sequence[Places], least: float) -> float:
        """The largest weight that points carry; anything up to `least` where it is no more than that."""
        carried = 0.0
        for fineness, counts in _COUNTS:  # few directions bound what many find
            for forces in growing_forces(points, centre, mu, even_directions(fineness), counts):
                carried = most_multiple(forces, 1.0, gravity, R_object_palm)
                if carried <= least:
                    return carried
        return carried

    def climb(best: _Best, tries: Iterator[tuple[int, ...]]) -> None:
        for tried in tries:
            if best.carried >= enough_N:
                return
            if (carried := weight_N(tried, best.carried)) > best.carried:
                best.chosen, best.carried = tried, carried

    every = [tuple(range(len(place.points))) for place in places]
    coarse = [place.coarse or all_points for place, all_points in zip(places, every, strict=True)]
    found = _Best(tuple(map(_middle, places)))
    for start in _starts(found.chosen, coarse):
        best = _Best(start, weight_N(start, 0.0))
        climb(best, product(*coarse) if _are_few(coarse) else _rounds(best, coarse))
        if best.carried > found.carried:
            found = best
        if found.carried >= enough_N:
            break
    climb(found, _rounds(found, every))
    points = [place.at(k) for place, k in zip(places, found.chosen, strict=True)]
    if found.carried >= enough_N or not polished:
        return points
    if not found.carried:
        if mu >= _MOST_FRICTION:
            return points
        # All points alike carry nothing; those that do with more friction are nearer to some that carry.
        points = best_points(
            places, centre, 2.0 * mu, gravity, R_object_palm=R_object_palm, enough_N=enough_N
        )
        found.carried = weight_of(points, 0.0)
    return points if found.carried >= enough_N else _polished(points, found.carried, weight_of)


def _polished(
    points: list[Places], carried: float, weight_of: Callable[[Sequence[Places], float], float]
) -> list[Places]:
    """Points that carry more, near these: all contacts move at once, by ever smaller steps."""
    rng = np.random.default_rng(_SEED)
    for reach in np.geomspace(*_REACHES, _POLISHING):
        steps = rng.normal(0.0, reach, (len(points), 2))
        tried = [point.moved(step) for point, step in zip(points, steps, strict=True)]
        if (value := weight_of(tried, carried)) > carried:
            points, carried = tried, value
    return points


@dataclass
class _Best:
    """Indices of points, one a contact, and the weight in N that they carry."""

    chosen: tuple[int, ...]
    carried: float = 0.0


def _are_few(choices: Sequence[Sequence[int]]) -> bool:
    return bool(np.prod([len(indices) for indices in choices]) <= _ALL)


def _starts(middles: tuple[int, ...], choices: Sequence[Sequence[int]]) -> Iterator[tuple[int, ...]]:
    """Where searches begin: the middles, and where these don't see all choices, some that are drawn."""
    yield middles
    if not _are_few(choices):
        rng = np.random.default_rng(_SEED)
        for _ in range(_DRAWN):
            yield tuple(int(rng.choice(indices)) for indices in choices)


def _rounds(best: _Best, choices: Sequence[Sequence[int]]) -> Iterator[tuple[int, ...]]:
    """In rounds, until one changes nothing, indices that differ from the best ones at one contact."""
    for _ in range(_ROUNDS):
        before = best.chosen
        for i, indices in enumerate(choices):
            for k in indices:
                yield (*best.chosen[:i], k, *best.chosen[i + 1 :])
        if best.chosen == before:
            return


def _middle(place: Places) -> int:
    return int(np.argmin(np.linalg.norm(place.points - place.points.mean(axis=0), axis=1)))


@cache
def _near(angle_rad: float) -> Array:
    """Rotations (n, 3, 3) by up to some angle, none at all the first."""
    drawn = np.random.default_rng(_SEED).normal(size=(_NEAR, 3))
    drawn *= angle_rad * np.linspace(0.0, 1.0, _NEAR)[:, None] / np.linalg.norm(drawn, axis=1, keepdims=True)
    turns = np.array([rotation_exp(vector) for vector in drawn])
    turns.setflags(write=False)
    return turns


@cache
def _turns() -> Array:
    """Rotations (n, 3, 3), drawn evenly."""
    drawn = np.random.default_rng(_SEED).normal(size=(_TURNS, 4))
    drawn /= np.linalg.norm(drawn, axis=1, keepdims=True)
    turns = np.ascontiguousarray(rotation_from_unit_quaternion(drawn))
    turns.setflags(write=False)
    return turns
