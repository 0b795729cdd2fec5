"""Candidates among which the environment has one chosen, the numbers that describe them, and data of both."""

from .candidate_pool import Candidate, load_pool
from .choice_data import SPLITS, ChoiceData, SplitBy
from .dataset_folder import (
    ARRAYS_FILE,
    DATASET_FILE,
    SCHEMA_VERSION,
    load_dataset,
    shipped_dataset,
    write_arrays,
)
from .feature import Feature, FeatureKind, bounds, clipped
from .features import LIMIT, feature_names

__all__ = [
    "ARRAYS_FILE",
    "DATASET_FILE",
    "LIMIT",
    "SCHEMA_VERSION",
    "SPLITS",
    "Candidate",
    "ChoiceData",
    "Feature",
    "FeatureKind",
    "SplitBy",
    "bounds",
    "clipped",
    "feature_names",
    "load_dataset",
    "load_pool",
    "shipped_dataset",
    "write_arrays",
]
