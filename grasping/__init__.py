"""From a configuration to a grasp that can be tested: strengthened, free of penetration, reachable, squeezed.

The steps, each a function of values alone:

    made = make_grasp(configuration)            # turns of strengthening and retraction, then the squeeze
    if isinstance(made, ReadyGrasp):
        trial = try_hold(made, margin=True)     # the hold test of its task, and more where it is asked for

What could not be done is a value too, a `Refusal` with its reason. Nothing here reads or writes files.
"""

from .clearing import Clearing, clear, strengthen_and_clear
from .extras import Extras, find_extras
from .make_grasp import make_grasp, squeeze_grasp
from .ready_grasp import ReadyGrasp, Refusal
from .starts import Starts, solve_for_starts, strongest_first
from .try_hold import Trial, try_hold

__all__ = [
    "Clearing",
    "Extras",
    "ReadyGrasp",
    "Refusal",
    "Starts",
    "Trial",
    "clear",
    "find_extras",
    "make_grasp",
    "solve_for_starts",
    "squeeze_grasp",
    "strengthen_and_clear",
    "strongest_first",
    "try_hold",
]
