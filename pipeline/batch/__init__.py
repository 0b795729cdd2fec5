"""Batches: any number of tasks and meshes, run one by one wherever there is room, killed and gone on with."""

from .batch_folder import BatchFolder
from .in_folder import InFolder
from .item import Item, items_of, read_list
from .outcome import Outcome, RunOutcome
from .run_batch import BatchResult, run_batch

__all__ = [
    "BatchFolder",
    "BatchResult",
    "InFolder",
    "Item",
    "Outcome",
    "RunOutcome",
    "items_of",
    "read_list",
    "run_batch",
]
