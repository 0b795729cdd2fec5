"""What the checkpoint of a polynomial system's search holds."""

import hashlib
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from ... import __version__
from ...base.numeric.arrays import Array
from ..certify import Ends, UniqueSolution
from ..polynomial import FactoredPolynomial
from ..search import Snapshot, pack, unpack
from .case import Choice
from .found import CaseSolution
from .worker import SolutionBox, SystemSetup

__all__ = ["fingerprint", "restore", "snapshot"]


def fingerprint(equations: Sequence[FactoredPolynomial], ends: Ends, setup: SystemSetup) -> str:
    """Of everything that decides the result of a search: version, system, box, settings."""
    what: list[Any] = [
        __version__,
        [[[(m, str(c)) for m, c in factor.items()] for factor in equation] for equation in equations],
        [(str(low), str(high)) for low, high in ends],
        [setup.sigma, setup.order.value],
    ]
    return hashlib.sha256(json.dumps(what).encode()).hexdigest()


def snapshot(found: Sequence[SolutionBox], known: Iterable[CaseSolution]) -> Snapshot:
    """What a search of a system keeps beside the state of branch and prune.

    Args:
        found: boxes of the result.
        known: solutions that are accounted for.
    """
    flat = [_FlatSolution.of(solution) for solution in known]
    return Snapshot({}, {**pack("solutions", SolutionBox, found), **pack("known", _FlatSolution, flat)})


def restore(saved: Snapshot) -> tuple[list[SolutionBox], list[CaseSolution]]:
    """The boxes of the result and the solutions that were kept."""
    known = [flat.solution for flat in unpack("known", _FlatSolution, saved.arrays)]
    return unpack("solutions", SolutionBox, saved.arrays), known


@dataclass(frozen=True, eq=False)
class _FlatSolution:
    """A solution of a case with its boxes taken apart."""

    choice: Choice
    region_lower: Array
    region_upper: Array
    place_lower: Array
    place_upper: Array
    inside: bool | None

    @classmethod
    def of(cls, found: CaseSolution) -> "_FlatSolution":
        one = found.solution
        return cls(found.choice, *one.region, *one.place, one.inside)

    @property
    def solution(self) -> CaseSolution:
        region, place = (self.region_lower, self.region_upper), (self.place_lower, self.place_upper)
        return CaseSolution(self.choice, UniqueSolution(region, place, self.inside))
