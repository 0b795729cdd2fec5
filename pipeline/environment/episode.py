"""What an environment asks of a back end: situations of choice, and what becomes of each candidate."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..choice import Feature, TrialOutcome

if TYPE_CHECKING:
    from ...solver import Configuration

__all__ = ["Backend", "Episode", "Slots"]


@dataclass(frozen=True, eq=False)
class Slots:
    """What an episode shows before anything is tried.

    Attributes:
        candidates: (n, F) features of those on offer, at most K.
        object: (O,) features of the object.
        ids: (n,) their names.
        about: object, hand and task by name.
    """

    candidates: NDArray[np.float32]
    object: NDArray[np.float32]
    ids: list[str]
    about: dict[str, Any]


class Episode(Protocol):
    """A situation with hidden conditions."""

    @property
    def slots(self) -> Slots:
        """What is on offer."""

    def outcome(self, slot: int) -> TrialOutcome:
        """What becomes of a candidate."""

    def conditions(self) -> dict[str, float]:
        """What was hidden, by name."""

    def configuration(self, slot: int) -> "Configuration | None":
        """Hand and object of a candidate, for pictures; None where that is not kept."""


class Backend(Protocol):
    """Where situations come from."""

    @property
    def features(self) -> tuple[Feature, ...]:
        """Of candidates."""

    @property
    def object_features(self) -> tuple[Feature, ...]:
        """Of objects."""

    def draw(self, rng: np.random.Generator, count: int) -> Episode:
        """An episode with at most `count` candidates; the same for generators in the same state."""
