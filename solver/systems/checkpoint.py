"""What the checkpoint of a polynomial system's search holds."""

import hashlib
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from ... import __version__
from ...arrays import Array
from ..certify import Ends, UniqueSolution
from ..polynomial import ExactPolynomial
from ..search import SearchState, Snapshot, pack, pack_state, unpack, unpack_state
from .worker import IsolatorSetup, SolutionBox, SystemBox

__all__ = ["fingerprint", "restore", "snapshot"]

SystemState = SearchState[SystemBox, SolutionBox]


def fingerprint(equations: Sequence[ExactPolynomial], ends: Ends, setup: IsolatorSetup) -> str:
    """Of everything that decides the result of a search: version, system, box, settings."""
    what: list[Any] = [
        __version__,
        [[(monomial, str(c)) for monomial, c in equation.items()] for equation in equations],
        [(str(low), str(high)) for low, high in ends],
        [setup.sigma, setup.order.value],
    ]
    return hashlib.sha256(json.dumps(what).encode()).hexdigest()


def snapshot(state: SystemState, known: Iterable[UniqueSolution], counters: dict[str, float]) -> Snapshot:
    """Where a search stands.

    Args:
        state: of the search.
        known: solutions that are accounted for.
        counters: further numbers to keep.
    """
    packed = pack_state(state, SystemBox)
    arrays = {
        **packed.arrays,
        **pack("solutions", SolutionBox, state.solutions),
        **pack("known", _FlatSolution, [_FlatSolution.of(solution) for solution in known]),
    }
    return Snapshot({**packed.numbers, "counters": counters}, arrays)


def restore(saved: Snapshot, state: SystemState) -> tuple[dict[str, float], list[UniqueSolution]]:
    """Puts a snapshot into a fresh state.

    Returns:
        The further numbers and the solutions that were kept.
    """
    unpack_state(saved, SystemBox, state)
    state.solutions = unpack("solutions", SolutionBox, saved.arrays)
    known = [flat.solution for flat in unpack("known", _FlatSolution, saved.arrays)]
    return dict(saved.numbers["counters"]), known


@dataclass(frozen=True, eq=False)
class _FlatSolution:
    """A unique solution with its boxes taken apart."""

    region_lower: Array
    region_upper: Array
    place_lower: Array
    place_upper: Array
    inside: bool | None

    @classmethod
    def of(cls, solution: UniqueSolution) -> "_FlatSolution":
        return cls(*solution.region, *solution.place, solution.inside)

    @property
    def solution(self) -> UniqueSolution:
        region, place = (self.region_lower, self.region_upper), (self.place_lower, self.place_upper)
        return UniqueSolution(region, place, self.inside)
