"""Existence and uniqueness tests: what shows that a box holds a solution, or exactly one."""

from .closed_box import ClosedBox, Ends, enclosure
from .interval_newton import Certifier, compile_kernels
from .known_solutions import KnownSolutions, UniqueSolution
from .krawczyk import ExistenceTest
from .newton_in_box import solve_in_box

__all__ = [
    "Certifier",
    "ClosedBox",
    "Ends",
    "ExistenceTest",
    "KnownSolutions",
    "UniqueSolution",
    "compile_kernels",
    "enclosure",
    "solve_in_box",
]
