"""Compares ways to choose among candidate grasps in the Gymnasium environment.

python examples/grasp_choice.py [EPISODES]
"""

import sys

import gymnasium
import holdfast.pipeline.env
import numpy as np
from holdfast.pipeline.choice.features import feature_names

episodes = int(sys.argv[1]) if len(sys.argv) > 1 else 100
env = gymnasium.make(holdfast.pipeline.env.ENV_ID, task="upholding")
names = feature_names(env.unwrapped.task)
point, normal = ([names.index(f"contact_0_{kind}_{axis}") for axis in "xyz"] for kind in ("point", "normal"))
rng = np.random.default_rng(0)


def least_twist(observation: dict[str, np.ndarray]) -> int:
    """The valid candidate whose weight twists the object least about the first contact's normal."""
    rows, gravity = observation["candidates"], observation["conditions"][2:]
    twist = np.abs(np.sum(np.cross(rows[:, point], gravity) * rows[:, normal], axis=1))
    return int(np.argmin(np.where(observation["mask"] == 1, twist, np.inf)))


policies = {
    "any candidate": lambda observation: rng.integers(len(observation["mask"])),
    "any valid candidate": lambda observation: rng.choice(np.flatnonzero(observation["mask"])),
    "the least twist": least_twist,
}
for name, choose in policies.items():
    rewards = []
    for seed in range(episodes):
        observation, _ = env.reset(seed=seed)
        rewards.append(env.step(int(choose(observation)))[1])
    sys.stdout.write(f"{name:20} holds in {np.mean(rewards):.0%} of {episodes} episodes\n")
