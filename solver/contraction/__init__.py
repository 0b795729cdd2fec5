"""Contractors, which narrow a box without losing a solution, and where to split what is left."""

from .native import CERTIFIED, EMPTY, OPEN, contract_native, pivot_weights, smear
from .newton import newton_step
from .prune import Box, Pruner

__all__ = [
    "CERTIFIED",
    "EMPTY",
    "OPEN",
    "Box",
    "Pruner",
    "contract_native",
    "newton_step",
    "pivot_weights",
    "smear",
]
