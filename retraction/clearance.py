"""The clearance table of a state: the signed distance of every pair of bodies that could meet."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..base.numeric.arrays import Array
from ..objects import Task
from ..solver import State
from .bodies import PlacedBodies
from .distance import lower_bounds, measure
from .pairs import CollisionModel, collision_model
from .settings import RetractionSettings, checked_settings

__all__ = [
    "Clearance",
    "PairClearance",
    "build_clearance",
    "compute_clearance",
    "compute_clearances",
    "deciding_clearance",
]

# The worst pair is nearly always nearer, so that few others need to be measured.
_REACH_M = 0.003

# A distance from which nothing of a hand is in the way; records and tables hold finite numbers alone.
_NOTHING_NEAR_M = 1.0


@dataclass(frozen=True)
class PairClearance:
    """Two bodies and the distance between them.

    Attributes:
        a: name of a link.
        b: name of another link, or `object/<part>`.
        distance_m: signed distance of the surfaces; negative where they overlap, by the depth.
        intended: whether the task asks the two to touch.
        required_m: least distance at which the pair counts as clear; negative where some depth is allowed.
        stands_out_m: the share of the allowed depth that is owed to convex pieces which stand out of the true
            surface at an intended contact.
    """

    a: str
    b: str
    distance_m: float
    intended: bool
    required_m: float
    stands_out_m: float = 0.0

    def __str__(self) -> str:
        return f"{self.a} and {self.b}: {_apart(self.distance_m)}"

    @property
    def allowed_depth_m(self) -> float:
        """Depth up to which the pair counts as clear; negative where a margin is asked for."""
        return -self.required_m

    @property
    def is_clear(self) -> bool:
        """Whether the pair is no deeper than it may be."""
        return self.distance_m >= self.required_m

    @property
    def touches(self) -> bool:
        """Whether the surfaces of an intended contact meet: they are no further apart than they may sink in.

        Where pieces stand out of the surface they may sink in deeper, but be no further apart.

        The regions of a contact meet in any solution; the shapes around them may still stand off.
        """
        return (
            self.intended and self.required_m <= self.distance_m <= self.allowed_depth_m - self.stands_out_m
        )


@dataclass(frozen=True, repr=False)
class Clearance:
    """All pairs of bodies of a task that are watched at one state.

    Attributes:
        pairs: links with links first, then links with parts of the object.
    """

    pairs: tuple[PairClearance, ...]

    def __str__(self) -> str:
        if self.worst is None:
            return f"clear; {len(self.pairs)} pairs"
        verdict = "clear" if self.is_clear else "not clear"
        return f"{verdict}; nearest of {len(self.pairs)} pairs: {self.worst}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"

    @cached_property
    def worst(self) -> PairClearance | None:
        """The pair with the least distance, intended contacts that are within their allowance set aside.

        None where no pair but such contacts is watched.
        """
        counted = [pair for pair in self.pairs if not (pair.intended and pair.is_clear)]
        return min(counted, key=lambda pair: pair.distance_m, default=None)

    @property
    def least_m(self) -> float:
        """Distance of the worst pair: room left where positive, depth to cure where negative.

        1 m where no pair counts, as of a gripper of one jaw that holds something.
        """
        return _NOTHING_NEAR_M if self.worst is None else self.worst.distance_m

    @cached_property
    def is_clear(self) -> bool:
        """Whether every pair is clear."""
        return all(pair.is_clear for pair in self.pairs)

    def __getitem__(self, names: tuple[str, str]) -> PairClearance:
        """The pair of two bodies by name, in either order; KeyError where it is not watched."""
        for pair in self.pairs:
            if names in ((pair.a, pair.b), (pair.b, pair.a)):
                return pair
        raise KeyError(names)


def compute_clearance(task: Task, state: State, *, settings: RetractionSettings | None = None) -> Clearance:
    """Signed distances of all watched pairs of bodies at a state, by FCL."""
    model = collision_model(task)
    placed = model.place(state)
    distances_m = _nearest_pieces(model, placed, lower_bounds(placed, model.piece_pairs))
    return build_clearance(model, distances_m, checked_settings(settings))


def deciding_clearance(task: Task, state: State, *, settings: RetractionSettings | None = None) -> Clearance:
    """`compute_clearance` without pairs that are clear and further apart than the worst one."""
    settings, model = checked_settings(settings), collision_model(task)
    placed = model.place(state)
    bounds = lower_bounds(placed, model.piece_pairs)
    for reach_m in (max(_REACH_M, settings.margin_m), np.inf):
        near = np.where(bounds <= reach_m, bounds, np.inf)
        distances_m = _nearest_pieces(model, placed, near)
        found = build_clearance(model, distances_m, settings, reach_m)
        if found.least_m < reach_m:
            break
    return found


def _nearest_pieces(model: CollisionModel, placed: PlacedBodies, bounds: Array) -> Array:
    """Distances (n,) of `model.piece_pairs`, but infinite for pairs that bounds show not to be the nearest.

    Of two bodies those pieces are measured first whose bound is least, then what may be nearer than these.

    Args:
        model: bodies and pairs.
        placed: where they are.
        bounds: (n,) no larger than the distances; of pairs that need not be measured, infinite.
    """
    pair_of = model.pair_of
    first = np.lexsort((bounds, pair_of))
    first = first[(np.diff(pair_of[first], prepend=-1) > 0) & (bounds[first] < np.inf)]
    distances_m = np.full(len(bounds), np.inf)
    distances_m[first] = measure(placed, model.piece_pairs[first]).distance_m
    found = np.full(len(model.pairs), np.inf)
    found[pair_of[first]] = distances_m[first]
    nearer = bounds < found[pair_of]
    nearer[first] = False
    distances_m[nearer] = measure(placed, model.piece_pairs[nearer]).distance_m
    return distances_m


def compute_clearances(
    task: Task, states: Iterable[State], *, settings: RetractionSettings | None = None
) -> list[Clearance]:
    """`compute_clearance` for many states of one task."""
    return [compute_clearance(task, state, settings=settings) for state in states]


def build_clearance(
    model: CollisionModel, distance_m: Array, settings: RetractionSettings, reach_m: float = np.inf
) -> Clearance:
    """The table from the signed distances (n,) of `model.piece_pairs`, the nearest pieces counting.

    Pairs of bodies that are further apart than `reach_m` are left out.
    """
    nearest = np.full(len(model.pairs), np.inf)
    np.minimum.at(nearest, model.pair_of, distance_m)
    return Clearance(
        tuple(
            PairClearance(
                *model.name(pair),
                distance,
                pair.intended,
                settings.required_m(pair.intended) - pair.stands_out_m,
                pair.stands_out_m,
            )
            for pair, distance in zip(model.pairs, nearest.tolist(), strict=True)
            if distance <= reach_m
        )
    )


def _apart(distance_m: float) -> str:
    """A signed distance in words."""
    return f"{1e3 * abs(distance_m):.3g} mm {'apart' if distance_m >= 0.0 else 'deep'}"
