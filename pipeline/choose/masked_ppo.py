"""MaskablePPO of sb3-contrib: a policy that learns by trying, and may only take what is there.

One small network scores each candidate by itself, so that the order of the candidates has no say, and the
trained policy is a handful of matrices. An episode is one choice, answered by one draw of hidden conditions.
"""

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from ...base.numeric.arrays import Array, Mask
from ...errors import MissingBackend
from .heads import Layer, Network
from .training_set import TrainingSet

__all__ = ["train_masked_ppo"]

_WIDTH = 32
_EPISODES = 20_000
_RATE = 1e-3


def train_masked_ppo(data: TrainingSet) -> Network:
    """A network that scores candidates; its softmax is the policy that was trained.

    Raises:
        MissingBackend: sb3-contrib is not installed.
    """
    try:
        import torch  # an extra: only this policy needs it
        from sb3_contrib import MaskablePPO
    except (ImportError, OSError):
        raise MissingBackend("maskable_ppo is trained by sb3-contrib: pip install 'holdfast[rl]'") from None
    torch.set_num_threads(1)
    table = _Table(data)
    # Seeds torch, too.
    model = MaskablePPO(
        "MlpPolicy",
        table,
        n_steps=1024,
        batch_size=256,
        n_epochs=5,
        gamma=1.0,
        ent_coef=0.01,
        seed=data.seed,
        device="cpu",
        policy_kwargs={"net_arch": []},
    )
    nn = torch.nn
    count, width = table.shape
    scorer = [nn.Linear(width, _WIDTH), nn.Tanh(), nn.Linear(_WIDTH, 1)]
    policy = model.policy
    policy.action_net = nn.Sequential(nn.Unflatten(1, table.shape), *scorer, nn.Flatten())
    policy.value_net = nn.Sequential(
        nn.Unflatten(1, table.shape),
        nn.Linear(width, _WIDTH),
        nn.Tanh(),
        nn.Flatten(),
        nn.Linear(count * _WIDTH, 1),
    )
    policy.optimizer = torch.optim.Adam(policy.parameters(), lr=_RATE, eps=1e-5)
    model.lr_schedule = lambda remaining: _RATE * remaining
    model.learn(_EPISODES)
    return Network(
        mean=data.mean.tolist(),
        scale=data.scale.tolist(),
        layers=[
            Layer(
                weights=layer.weight.detach().double().numpy().tolist(),
                bias=layer.bias.detach().double().numpy().tolist(),
            )
            for layer in (scorer[0], scorer[2])
        ],
    )


class _Table(gymnasium.Env[Array, np.int64]):
    """Choices of a training set, one an episode.

    Attributes:
        shape: candidates of the largest situation, and inputs.
    """

    def __init__(self, data: TrainingSet):
        self._data = data
        self.shape = int(np.diff(data.first).max()), data.inputs.shape[1]
        size = self.shape[0] * self.shape[1]
        self.observation_space = spaces.Box(-np.inf, np.inf, (size,), np.float64)
        self.action_space = spaces.Discrete(self.shape[0])
        self._situation = 0

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        super().reset(seed=seed, options=options)
        self._situation = int(self.np_random.integers(len(self._data.first) - 1))
        return self._observation(), {}

    def step(self, action: np.int64) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        candidate = int(self._data.first[self._situation]) + int(action)
        draw = self.np_random.integers(self._data.held.shape[1])
        return self._observation(), float(self._data.held[candidate, draw]), True, False, {}

    def action_masks(self) -> Mask:
        """Where a candidate is (K,)."""
        first = self._data.first
        return np.arange(self.shape[0]) < first[self._situation + 1] - first[self._situation]

    def _observation(self) -> Array:
        first = self._data.first
        rows = self._data.standardised[first[self._situation] : first[self._situation + 1]]
        padded = np.zeros(self.shape)
        padded[: len(rows)] = rows
        return padded.ravel()
