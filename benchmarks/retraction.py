"""How many random solutions of a task collide, how many of those are cleared, and how long that takes.

Usage: retraction.py [TASK] [NUMBER OF CONFIGURATIONS]
"""

import sys
import time

import numpy as np
from holdfast.geometry.transforms import rotation_exp
from holdfast.objects import Task, load_task
from holdfast.retraction import RetractionFailure, compute_clearance, compute_clearance_by_mujoco, retract
from holdfast.solver import Configuration, ContactManifold, State, certify_state
from holdfast.solver.local_search import search_locally

SEED = 0


def random_configurations(task: Task, count: int) -> list[Configuration]:
    manifold = ContactManifold(task)
    rng = np.random.default_rng(SEED)
    found: list[Configuration] = []
    while len(found) < count:
        x = rng.uniform(manifold.lower, manifold.upper)
        R, p = rotation_exp(2.0 * rng.normal(size=3)), rng.uniform([0.0, -0.05, 0.1], [0.15, 0.05, 0.3])
        state = search_locally(manifold, State(x[: manifold.n_q], R, p, x[manifold.n_q :]))
        if state is not None:
            found.append(certify_state(manifold, state))
    return found


def main(name: str, count: int) -> None:
    task = load_task(name)
    manifold = ContactManifold(task)
    configurations = random_configurations(task, count)
    retract(configurations[0])  # code is compiled and bodies are built once
    outcomes, times = [], []
    for configuration in configurations:
        start = time.perf_counter()
        outcomes.append(retract(configuration))
        times.append(1e3 * (time.perf_counter() - start))
    moved = [o for o in outcomes if o.status != "clear"]
    cleared = [o for o in moved if o.status == "retracted"]
    failed = [o for o in outcomes if isinstance(o, RetractionFailure)]
    ends = [o.configuration.state for o in cleared]
    agree = sum(
        compute_clearance(task, state).is_clear == compute_clearance_by_mujoco(task, state).is_clear
        for state in [*ends, *(c.state for c in configurations)]
    )
    residual = max((np.abs(manifold.residual(state)).max() for state in ends), default=0.0)
    certified = sum(c.certified for c in configurations)
    print(f"{count} random solutions of {name}, {certified} certified, seed {SEED}")
    print(f"colliding before        {len(moved)}, deepest {-1e3 * min(o.before_m for o in outcomes):.1f} mm")
    print(f"cleared                 {len(cleared)}, by steps alone {sum(o.restarts == 0 for o in cleared)}")
    print(f"certified after         {sum(o.configuration.certified for o in cleared)}")
    print(f"residual after          {residual:.1e} m")
    print(f"FCL and MuJoCo agree    {agree} of {len(ends) + count} verdicts")
    median, p95, worst = np.percentile(times, [50, 95, 100])
    print(f"ms a configuration      median {median:.0f}, 95th percentile {p95:.0f}, longest {worst:.0f}")
    for outcome in failed:
        print(f"failed: {outcome}")


if __name__ == "__main__":
    main(
        sys.argv[1] if len(sys.argv) > 1 else "upholding",
        int(sys.argv[2]) if len(sys.argv) > 2 else 50,
    )
