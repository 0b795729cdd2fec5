"""Candidates among which the environment has one chosen, the numbers that describe them, and data of both.

What is asked for is imported then: whoever reads a data set need not wait for solver and simulator.
"""

from typing import TYPE_CHECKING

from ...base.machine.late_names import late_names

if TYPE_CHECKING:
    from .candidate_description import FREE_FEATURES, candidate_features, candidate_specs
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
    from .object_description import OBJECT_FEATURES, object_features
    from .situation import Situation, category, check_reference, find_situation, own_hand, task_of
    from .stored_candidate import StoredCandidate, to_grasp
    from .trial import try_under
    from .trial_outcome import TrialOutcome

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
    "check_reference",
    "clipped",
    "draw",
    "feature_names",
    "find_situation",
    "load_dataset",
    "load_pool",
    "make_candidates",
    "object_features",
    "own_hand",
    "read_head",
    "shipped_dataset",
    "task_of",
    "to_grasp",
    "try_under",
    "write_arrays",
]

_HOMES = {
    "candidate_description": (
        "FREE_FEATURES",
        "candidate_features",
        "candidate_specs",
    ),
    "candidate_pool": (
        "Candidate",
        "load_pool",
    ),
    "choice_data": (
        "SPLITS",
        "ChoiceData",
        "SplitBy",
    ),
    "dataset_folder": (
        "ARRAYS_FILE",
        "DATASET_FILE",
        "SCHEMA_VERSION",
        "SITUATIONS_FILE",
        "load_dataset",
        "read_head",
        "shipped_dataset",
        "write_arrays",
    ),
    "draws": (
        "CONDITIONS",
        "DrawRanges",
        "draw",
    ),
    "feature": (
        "Feature",
        "FeatureKind",
        "bounds",
        "clipped",
    ),
    "features": (
        "LIMIT",
        "feature_names",
    ),
    "making": (
        "STRENGTHS",
        "Made",
        "make_candidates",
    ),
    "object_description": (
        "OBJECT_FEATURES",
        "object_features",
    ),
    "situation": (
        "Situation",
        "category",
        "check_reference",
        "find_situation",
        "own_hand",
        "task_of",
    ),
    "stored_candidate": (
        "StoredCandidate",
        "to_grasp",
    ),
    "trial": ("try_under",),
    "trial_outcome": ("TrialOutcome",),
}

__getattr__, __dir__ = late_names(globals(), _HOMES)
