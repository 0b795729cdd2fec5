"""Existence and uniqueness tests: what shows that a box holds a solution, or exactly one."""

from .closed_box import AskedBox, Ends, enclosure
from .interval_newton import Certifier, Interval, compile_kernels, is_within
from .known_solutions import KnownSolutions, UniqueSolution
from .krawczyk import ExistenceTest
from .newton_in_box import settle

__all__ = [
    "AskedBox",
    "Certifier",
    "Ends",
    "ExistenceTest",
    "Interval",
    "KnownSolutions",
    "UniqueSolution",
    "compile_kernels",
    "enclosure",
    "is_within",
    "settle",
]
