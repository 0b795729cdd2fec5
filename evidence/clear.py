"""Certified clear: no two bodies sink in deeper than they may, wherever the solution is and on the way there.

Two convex pieces are at least so far apart as along any direction n: the least n . x of the one less the
greatest of the other. So a plane shows that they are apart, or no deeper than allowed, once all vertices of
their cores keep to its sides; with the vertices in balls, for every place that the true solution may have.

The way of the fingers is a straight line in joint space from waypoint to waypoint, and the same planes stand
still while the pieces move: on a stretch of the line the gap lies above the line between its values at the
ends, less what the ways of points can bend (`travel`). Stretches on which that is too little for some pair
are halved for it.

Most pairs are far apart along one of 13 directions. For the others the planes' normals are what the
statement holds; they come from distances in floats, and whatever they are, what they show is true.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..arguments import check_instance
from ..base.machine.cancellation import give_up_if_asked
from ..base.numeric.arrays import Array, Indices
from ..retraction import Approach, CollisionModel, RetractionSettings, collision_model, measure_quickly
from ..solver import Configuration, SolutionRadii, State, solution_radii
from ..solver.interval import Balls
from .not_certified import NotCertified
from .travel import bends, lowest_between
from .true_bodies import SLABS, TrueBodies, TrueScene
from .true_links import true_links

__all__ = ["CertifiedClear", "Plane", "certify_clear"]

# Stretches are halved so often at most.
_MOST_HALVINGS = 12
# Decimals of a normal: any normal is valid, and a plane askew by so little loses less than a micrometre.
_DECIMALS = 5
# Where a pair is deeper by more than this, no plane is looked for nearby.
_HOPELESS_M = 1e-7


@dataclass(frozen=True)
class Plane:
    """A plane that stands still between two pieces, on a stretch of the way or in the grasp.

    Attributes:
        step: of the approach, from 0; None in the grasp.
        cell: which stretch of the step: one bit a halving after a leading 1, so that 1 is the whole step, and
            2 and 3 are its halves; 1 in the grasp.
        pair: number of the pair of pieces in the collision model.
        normal: from the first piece to the second, of any length.
    """

    step: int | None
    cell: int
    pair: int
    normal: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class CertifiedClear:
    """The statement that nothing sinks in deeper than it may, with the planes that show it.

    Attributes:
        approach: whether it holds on the way from the pregrasp, too, or of the grasp alone.
        planes: for the pairs of pieces that the 13 common directions do not part.
        radii: how close to the state the true solution is; the way is as close to its waypoints.
        depth_m: how deep a pair that should not touch may sink in.
        contact_depth_m: how deep an intended contact may, beside what its pieces stand out.
        margin_m: distance asked for in the grasp between bodies that should not touch.
    """

    approach: bool
    planes: tuple[Plane, ...]
    radii: SolutionRadii
    depth_m: float
    contact_depth_m: float
    margin_m: float

    def __bool__(self) -> bool:
        """True: it is certified."""
        return True

    def __str__(self) -> str:
        where = "and on the way to it" if self.approach else "alone"
        return f"certified clear in the grasp {where}, {len(self.planes)} planes"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"


def certify_clear(
    configuration: Configuration,
    approach: Approach | None = None,
    *,
    state: State | None = None,
    retraction: RetractionSettings | None = None,
) -> CertifiedClear | NotCertified:
    """Looks for planes that show the grasp to be clear, and the way to it where that is reachable.

    Args:
        configuration: with its certificate of existence.
        approach: how the fingers get there; None for the grasp alone.
        state: about which everything is enclosed, such as the configuration's as it is written, where the
            approach ends; None for the configuration's own.
        retraction: what counts as clear in the grasp; on the way its margin is not asked for.
    """
    check_instance("configuration", configuration, Configuration, "a Configuration")
    state, settings = state or configuration.state, retraction or RetractionSettings()
    radii = solution_radii(configuration, state)
    if radii is None:
        return NotCertified("clear", "the contacts themselves are not certified")
    prover = _Prover(collision_model(configuration.task), state, radii)
    planes = prover.in_grasp(settings)
    way = approach.waypoints if approach is not None and approach.reachable else state.q[None]
    if not np.array_equal(way[-1], state.q):
        return NotCertified("clear", "the approach ends elsewhere")
    for step, (start, end) in enumerate(pairwise(way)):
        if isinstance(planes, NotCertified):
            break
        found = prover.on_step(step, start, end, settings)
        planes = found if isinstance(found, NotCertified) else planes + found
    if isinstance(planes, NotCertified):
        return planes
    return CertifiedClear(
        approach=len(way) > 1,
        planes=tuple(planes),
        radii=radii,
        depth_m=settings.depth_m,
        contact_depth_m=settings.contact_depth_m,
        margin_m=settings.margin_m,
    )


class _Prover:
    """Looks for planes about one state."""

    def __init__(self, model: CollisionModel, state: State, radii: SolutionRadii):
        self._model, self._state, self._radii = model, state, radii
        self._scene = TrueScene(
            model,
            Balls.within(state.R_palm_object, radii.rotation),
            Balls.within(state.p_palm_object, radii.position),
        )
        self._core_m = np.nextafter(model.bodies.radius[model.piece_pairs].sum(axis=1), np.inf)

    def in_grasp(self, settings: RetractionSettings) -> list[Plane] | NotCertified:
        """Planes for the grasp itself."""
        here = self._bodies(Balls.exact(self._state.q))
        required = (
            np.where(self._model.intended, settings.required_m(True), settings.required_m(False))
            - self._model.stands_out_m
        )
        least = here.slab_gaps(self._model.piece_pairs) - self._needs(required)
        pairs = np.flatnonzero(least.max(axis=1) < 0.0)
        _, normals = self._apart(self._state.q, pairs)
        short = here.gaps(self._model.piece_pairs[pairs], normals) < _need(
            required[pairs] + self._core_m[pairs], normals
        )
        if short.any():
            return self._failure("in the grasp", int(pairs[np.argmax(short)]))
        return [_plane(None, 1, pair, n) for pair, n in zip(pairs.tolist(), normals, strict=True)]

    def on_step(
        self, step: int, q_start: Array, q_end: Array, settings: RetractionSettings
    ) -> list[Plane] | NotCertified:
        """Planes for the line from one waypoint to the next."""
        allowed = np.where(self._model.intended, settings.contact_depth_m, settings.depth_m)
        line = _Line(self, q_start, q_end, -allowed - self._model.stands_out_m)
        everything = np.arange(len(self._model.piece_pairs))
        planes: list[Plane] = []
        # Stretches with the pairs that are open, and the normals that each had in the stretch around.
        pending = [(1, everything, np.zeros((len(everything), 3)))]
        while pending:
            give_up_if_asked()
            cell, pairs, before = pending.pop()
            open_ = line.least_by_slabs(cell, pairs) < 0.0
            pairs, before = pairs[open_], before[open_]
            if cell > 1:
                open_ = line.least(cell, pairs, before) < 0.0
                pairs = pairs[open_]
            if not len(pairs):
                continue
            distances, normals = self._apart(line.joints(cell), pairs)
            planes += [_plane(step, cell, pair, n) for pair, n in zip(pairs.tolist(), normals, strict=True)]
            open_ = line.least(cell, pairs, normals) < 0.0
            if not open_.any():
                continue
            short = distances < line.required[pairs] - _HOPELESS_M
            if short.any() or cell >= 1 << _MOST_HALVINGS:
                return self._failure("on the way", int(pairs[np.argmax(short if short.any() else open_)]))
            pending += [(2 * cell + half, pairs[open_], normals[open_]) for half in (0, 1)]
        return planes

    def _bodies(self, q: Balls) -> TrueBodies:
        q = Balls(q.mid, (q + Balls.within(np.zeros(q.shape), self._radii.joints)).rad)
        return self._scene.at(true_links(self._model.task.hand, q))

    def _needs(self, required: Array) -> Array:
        """Gaps (n, 26) of cores that are needed along `SLABS` and against them."""
        along = np.column_stack(
            [_need(required + self._core_m, np.tile(n, (len(required), 1))) for n in SLABS]
        )
        return np.hstack([along, along])

    def _apart(self, q: Array, pairs: Indices) -> tuple[Array, Array]:
        """About the distances (k,) of pairs, and rounded unit normals (k, 3) along which they are."""
        state = State(q, self._state.R_palm_object, self._state.p_palm_object, self._state.params)
        gaps = measure_quickly(self._model.place(state), self._model.piece_pairs[pairs])
        rounded = np.round(gaps.normals, _DECIMALS)
        # Pieces that touch may have none; any other is as good.
        rounded[~rounded.any(axis=1)] = SLABS[0]
        return gaps.distance_m, rounded

    def _failure(self, where: str, pair: int) -> NotCertified:
        a, b = self._model.name(self._model.pairs[self._model.pair_of[pair]])
        return NotCertified("clear", f"no plane was found between {a} and {b} {where}")


class _Line:
    """A step of the way, with the bodies at the ends of its stretches."""

    def __init__(self, prover: _Prover, q_start: Array, q_end: Array, required: Array):
        self._prover, self._start, self._end = prover, q_start, q_end
        self._pairs = prover._model.piece_pairs
        self.required = required
        self._needs = prover._needs(required)
        step = Balls.exact(q_end) - q_start
        self._bend = np.nextafter(bends(prover._model, step.most)[self._pairs].sum(axis=1), np.inf)
        self._placed: dict[float, TrueBodies] = {}

    def joints(self, cell: int) -> Array:
        """The joints (n_independent,) in the middle of a stretch."""
        first, last = _ends(cell)
        share = 0.5 * (first + last)
        return self._start + share * (self._end - self._start)

    def least_by_slabs(self, cell: int, pairs: Indices) -> Array:
        """Below what pairs (k,) have beyond what they need all along a stretch, by their best slab."""
        start, end = (
            self._at(share).slab_gaps(self._pairs[pairs]) - self._needs[pairs] for share in _ends(cell)
        )
        bend = self._bend_on(cell, pairs)
        lengths = np.nextafter(np.linalg.norm(SLABS, axis=1), np.inf)
        least = lowest_between(start, end, bend[:, None] * np.hstack([lengths, lengths]) * _ROUNDED)
        return np.asarray(least.max(axis=1))

    def least(self, cell: int, pairs: Indices, normals: Array) -> Array:
        """The same along normals (k, 3)."""
        if not len(pairs):
            return np.zeros(0)
        need = _need(self.required[pairs] + self._prover._core_m[pairs], normals)
        start, end = (self._at(share).gaps(self._pairs[pairs], normals) - need for share in _ends(cell))
        length = np.linalg.norm(normals, axis=1) * _ROUNDED
        return lowest_between(start, end, self._bend_on(cell, pairs) * length)

    def _bend_on(self, cell: int, pairs: Indices) -> Array:
        first, last = _ends(cell)
        return np.asarray(self._bend[pairs] * (last - first) ** 2)  # a power of two, so exact

    def _at(self, share: float) -> TrueBodies:
        if share not in self._placed:
            q = Balls.exact(self._start) * (1.0 - share) + Balls.exact(self._end) * share
            self._placed[share] = self._prover._bodies(q)
        return self._placed[share]


_ROUNDED = 1.0 + 1e-14


def _ends(cell: int) -> tuple[float, float]:
    """Shares of the step at which a stretch starts and ends."""
    depth = cell.bit_length() - 1
    first = cell - (1 << depth)
    return first / (1 << depth), (first + 1) / (1 << depth)


def _need(length_m: Array, normals: Array) -> Array:
    """Above length_m |n| (k,) for lengths (k,) of any sign and normals (k, 3)."""
    norm = (Balls.exact(normals) * normals).sum(axis=1).sqrt()
    return np.asarray((Balls.exact(np.nextafter(length_m, np.inf)) * norm).upper)


def _plane(step: int | None, cell: int, pair: int, normal: Array) -> Plane:
    x, y, z = normal.tolist()
    return Plane(step, cell, pair, (x, y, z))
