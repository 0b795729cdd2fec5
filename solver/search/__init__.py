"""Branch and prune over any problem: the loop, and sessions with worker processes, budget and checkpoint."""

from .branch_and_prune import (
    Outcome,
    SearchOrder,
    SearchState,
    Subtree,
    SubtreeResult,
    begin_at,
    branch_and_prune,
    check_order,
    one_by_one,
    search_subtree,
)
from .checkpoint import Arrays, Checkpoint, Snapshot, is_part, pack, unpack
from .result import Progress, SearchResult, Verdict
from .session import Session, Stopwatch

__all__ = [
    "Arrays",
    "Checkpoint",
    "Outcome",
    "Progress",
    "SearchOrder",
    "SearchResult",
    "SearchState",
    "Session",
    "Snapshot",
    "Stopwatch",
    "Subtree",
    "SubtreeResult",
    "Verdict",
    "begin_at",
    "branch_and_prune",
    "check_order",
    "is_part",
    "one_by_one",
    "pack",
    "search_subtree",
    "unpack",
]
