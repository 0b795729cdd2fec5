"""Candidates among which the environment has one chosen, the numbers that describe them, and data of both."""

from .candidate_features import FREE_FEATURES, candidate_features, candidate_specs
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
from .object_features import OBJECT_FEATURES, object_features

__all__ = [
    "ARRAYS_FILE",
    "DATASET_FILE",
    "FREE_FEATURES",
    "LIMIT",
    "OBJECT_FEATURES",
    "SCHEMA_VERSION",
    "SPLITS",
    "Candidate",
    "ChoiceData",
    "Feature",
    "FeatureKind",
    "SplitBy",
    "bounds",
    "candidate_features",
    "candidate_specs",
    "clipped",
    "feature_names",
    "load_dataset",
    "load_pool",
    "object_features",
    "shipped_dataset",
    "write_arrays",
]
