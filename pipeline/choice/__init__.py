"""Candidates among which the environment has one chosen, the numbers that describe them, and data of both."""

from .candidate_features import FREE_FEATURES, candidate_features, candidate_specs
from .candidate_pool import Candidate, load_pool
from .choice_data import SPLITS, ChoiceData, SplitBy
from .dataset_folder import (
    ARRAYS_FILE,
    DATASET_FILE,
    SCHEMA_VERSION,
    SITUATIONS_FILE,
    load_dataset,
    read_head,
    shipped_dataset,
    write_arrays,
)
from .draws import CONDITIONS, DrawRanges, draw
from .feature import Feature, FeatureKind, bounds, clipped
from .features import LIMIT, feature_names
from .making import STRENGTHS, Made, make_candidates
from .object_features import OBJECT_FEATURES, object_features
from .situation import Situation, category, find_situation, task_of
from .stored_candidate import StoredCandidate, to_grasp
from .trial import TrialOutcome, try_under

__all__ = [
    "ARRAYS_FILE",
    "CONDITIONS",
    "DATASET_FILE",
    "FREE_FEATURES",
    "LIMIT",
    "OBJECT_FEATURES",
    "SCHEMA_VERSION",
    "SITUATIONS_FILE",
    "SPLITS",
    "STRENGTHS",
    "Candidate",
    "ChoiceData",
    "DrawRanges",
    "Feature",
    "FeatureKind",
    "Made",
    "Situation",
    "SplitBy",
    "StoredCandidate",
    "TrialOutcome",
    "bounds",
    "candidate_features",
    "candidate_specs",
    "category",
    "clipped",
    "draw",
    "feature_names",
    "find_situation",
    "load_dataset",
    "load_pool",
    "make_candidates",
    "object_features",
    "read_head",
    "shipped_dataset",
    "task_of",
    "to_grasp",
    "try_under",
    "write_arrays",
]
