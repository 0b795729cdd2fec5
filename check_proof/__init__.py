"""Checks proof logs that a task is infeasible, and what grasp files say was proved, in arithmetic of its own.

Nothing in this folder comes from the solver: no compiled code, no linear programming, none of its interval
functions. Whose system a log refutes is for the caller to say, who hands its form in as plain data. The
log holds hints only: where boxes were split, slopes of planes, and multipliers of inequalities. What follows
from them is worked out here, so a wrong hint can make a proof fail but never make a false one pass. A box
counts as empty only where it has been emptied here. A log of statics holds twists instead, which are tried in
whole numbers. docs/proof-log.md describes the format and the reasoning.
"""

from .check import ProofCheck, check_proof
from .grasps import GraspCheck, check_grasp
from .reading import CONFIGURATIONS, LOAD, STATICS, LogHead

__all__ = [
    "CONFIGURATIONS",
    "LOAD",
    "STATICS",
    "GraspCheck",
    "LogHead",
    "ProofCheck",
    "check_grasp",
    "check_proof",
]
