"""Branch and prune over any problem: the loop, its slices, workers and checkpoints."""

from .branch_and_prune import (
    Outcome,
    Part,
    SearchOrder,
    SearchState,
    Slice,
    begin_at,
    branch_and_prune,
    explore,
)
from .checkpoint import Arrays, Checkpoint, Snapshot, pack, pack_state, unpack, unpack_state
from .slices import Stopwatch, run_slices

__all__ = [
    "Arrays",
    "Checkpoint",
    "Outcome",
    "Part",
    "SearchOrder",
    "SearchState",
    "Slice",
    "Snapshot",
    "Stopwatch",
    "begin_at",
    "branch_and_prune",
    "explore",
    "pack",
    "pack_state",
    "run_slices",
    "unpack",
    "unpack_state",
]
