"""Worker processes that share the pieces of a long piece of work; one that dies costs only its piece."""

from .contract import SliceWorker
from .pool import WorkerPool, available_cores

__all__ = ["SliceWorker", "WorkerPool", "available_cores"]
