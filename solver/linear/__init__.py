"""Linear relaxations of a box, solved by HiGHS or over vertices; bounds count as far as duals prove them."""

from .gaps import errors_by_factor, relaxation_errors
from .highs import Basis
from .tighten import Tightener
from .vertex_program import VertexProgram, vertex_program
from .vertices import contract_by_vertices

__all__ = [
    "Basis",
    "Tightener",
    "VertexProgram",
    "contract_by_vertices",
    "errors_by_factor",
    "relaxation_errors",
    "vertex_program",
]
