"""How many pinches of the scalpel hold, what that depends on, and how long a test takes.

Pinches come from random starts on the contact manifold of `upholding`, free of penetration; nobody has chosen
them for strength. Usage: hold.py [NUMBER OF PINCHES]
"""

import sys
import time

import mujoco
import numpy as np
from holdfast.geometry.transforms import rotation_exp
from holdfast.mjcf import Grasp, HoldSettings, Squeeze, grasp_mjcf, hold_tests, plan_squeeze
from holdfast.objects import Task, load_task
from holdfast.solver import Configuration, ContactManifold, State

SEED = 0
CASES = {
    "preset": HoldSettings(),
    "friction 0.7": HoldSettings(friction=0.7),
    "friction 0.8": HoldSettings(friction=0.8),
    "patch radius 3 mm": HoldSettings(patch_radius_m=0.003),
    "patch radius 7.5 mm": HoldSettings(patch_radius_m=0.0075),
    "hand with weight": HoldSettings(hand_weight=True),
}


def is_clear(configuration: Configuration) -> bool:
    model = mujoco.MjModel.from_xml_string(grasp_mjcf(configuration))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return not data.ncon or float(data.contact.dist.min()) > -1e-4


def random_pinches(task: Task, count: int) -> list[Configuration]:
    manifold = ContactManifold(task)
    rng = np.random.default_rng(SEED)
    found: list[Configuration] = []
    while len(found) < count:
        q, params = rng.uniform(*task.limits.T), rng.uniform(size=manifold.n_params)
        R, p = rotation_exp(2.0 * rng.normal(size=3)), rng.uniform([0.0, -0.05, 0.1], [0.15, 0.05, 0.3])
        state = manifold.project(State(q, R, p, params), max_steps=50)
        if state is None or not manifold.is_feasible(state):
            continue
        configuration = Configuration(task, state, float(np.abs(manifold.residual(state)).max()), None)
        if is_clear(configuration):
            found.append(configuration)
    return found


def main(count: int) -> None:
    pinches = random_pinches(load_task("upholding"), count)
    print(f"{count} pinches without penetration, seed {SEED}")
    print(
        f"{'case':20} {'squeezed':>8} {'held':>5} {'plan s':>7} {'test s':>7}   (seconds a grasp, one core)"
    )
    for name, settings in CASES.items():
        start = time.perf_counter()
        plans = [plan_squeeze(pinch, settings) for pinch in pinches]
        planned = time.perf_counter()
        grasps = [Grasp(c, s) for c, s in zip(pinches, plans, strict=True) if isinstance(s, Squeeze)]
        held = sum(result.held for result in hold_tests(grasps, settings))
        tested = time.perf_counter()
        plan_s, test_s = (planned - start) / count, (tested - planned) / max(1, len(grasps))
        print(f"{name:20} {len(grasps):8d} {held:5d} {plan_s:7.3f} {test_s:7.3f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 40)
