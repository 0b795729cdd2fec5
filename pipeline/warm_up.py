"""Compiles the inner loops ahead of use: `python -m holdfast.pipeline.warm_up`.

The machine code is kept by numba beside the sources or in $NUMBA_CACHE_DIR; without this step the first run
of each command would compile what it needs, in 10 to 30 seconds.
"""

from dataclasses import replace

import numpy as np

from ..grasping import make_grasp
from ..mjcf import preset_settings
from ..objects import load_task
from ..solver import best_friction, solve, solve_system
from ..solver.polynomial import parse_polynomial

__all__ = ["main"]


def main() -> int:
    """Solves one small problem of each kind."""
    names = ("x", "y")
    texts = ("x^2 + y^2 - 1", "x - y^3")
    circle, cubic = (parse_polynomial(text, names, "warm-up", "equations") for text in texts)
    lower, upper = np.full(2, -2.0), np.full(2, 2.0)
    solve_system([circle, cubic], lower, upper)
    solve_system([circle], lower, upper, sigma=0.5)
    task = load_task("upholding")
    # More load than any grasp carries, so that it is strengthened.
    settings = replace(preset_settings("holdfast", task), planned_load=20.0)
    found = solve(task, candidates=2)
    assert found.spread is not None
    make_grasp(found.configurations[0], settings=settings)
    solve(task, candidates=1, pure=True, budget_s=0.1)
    best_friction(task)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
