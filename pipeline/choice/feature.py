"""What is said of a feature: its name, unit and bounds, and between which hands it may be compared."""

from dataclasses import dataclass
from typing import Any, Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError

__all__ = ["Feature", "FeatureKind", "bounds", "clipped"]

FeatureKind = Literal["free", "hand", "trial"]


@dataclass(frozen=True)
class Feature:
    """A number that describes a candidate or an object.

    Attributes:
        name: unique among the features of its kind of thing.
        unit: of the number, `1` where it has none.
        low: least value; what lies below is clipped.
        high: largest value; what lies above is clipped.
        kind: `free` of the hand's joints, so that hands can be compared and mixed, or of one `hand` alone;
            `trial` of what has been tried in some way, but is free of the hand's joints as well.
        formula: +1 or -1 where candidates would be ranked by it, larger or smaller first; else 0.
        words: a line for people.
    """

    name: str
    unit: str
    low: float
    high: float
    kind: FeatureKind = "free"
    formula: int = 0
    words: str = ""

    @property
    def is_formula(self) -> bool:
        """Whether a person would rank candidates by it: a measure, and nothing that was tried."""
        return self.formula != 0 and self.kind != "trial"

    def as_record(self) -> dict[str, Any]:
        """As plain data."""
        return {
            "name": self.name,
            "unit": self.unit,
            "low": self.low,
            "high": self.high,
            "kind": self.kind,
            "formula": self.formula,
            "words": self.words,
        }

    @classmethod
    def from_record(cls, record: dict[str, Any], source: str, field: str) -> Self:
        """From plain data of a file.

        Raises:
            InputError: something is missing, or is of another kind.
        """
        try:
            feature = cls(
                name=str(record["name"]),
                unit=str(record["unit"]),
                low=float(record["low"]),
                high=float(record["high"]),
                kind=record["kind"],
                formula=int(record["formula"]),
                words=str(record.get("words", "")),
            )
        except (KeyError, TypeError, ValueError):
            raise InputError(
                source, field, "must have name, unit, low, high, kind and formula of a feature"
            ) from None
        if feature.kind not in get_args(FeatureKind) or feature.formula not in (-1, 0, 1):
            raise InputError(source, field, "kind must be 'free', 'hand' or 'trial', and formula -1, 0 or 1")
        if not feature.low < feature.high:
            raise InputError(source, field, "low must be below high")
        return feature


def bounds(features: tuple[Feature, ...]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Least and largest values (n,) of features."""
    low = np.array([feature.low for feature in features], dtype=np.float32)
    return low, np.array([feature.high for feature in features], dtype=np.float32)


def clipped(values: NDArray[np.float64], features: tuple[Feature, ...]) -> NDArray[np.float32]:
    """Values (..., n) within the features' bounds, as they are kept and shown."""
    low, high = bounds(features)
    return np.clip(np.asarray(values, dtype=np.float32), low, high)
