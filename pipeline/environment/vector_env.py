"""Many environments over a table at once, in NumPy alone."""

from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ...arguments import check_whole_number
from ...errors import InputError, UnknownName
from .reward import Reward
from .spaces import action_space, check_candidates, observation_space
from .table import Table

__all__ = ["TableVectorEnv"]

Observation = dict[str, NDArray[Any]]


class TableVectorEnv(gymnasium.vector.VectorEnv[Observation, NDArray[np.int64], NDArray[Any]]):
    """What `ChoiceEnv` is over a table, for `num_envs` at once; one generator draws for all of them.

    Args:
        table: the back end.
        num_envs: how many.
        candidates: K.
        tries: how many may be tried in an episode.
        reward: what a try is worth.
        autoreset_mode: when an episode that has ended gives way to the next: `NextStep` (the next action is
            not looked at), `SameStep` (what was seen last is in `info["final_obs"]`), or `Disabled` (then
            `reset(options={"reset_mask": ended})` does it).
    """

    def __init__(
        self,
        table: Table,
        num_envs: int = 1,
        *,
        candidates: int = 8,
        tries: int = 1,
        reward: Reward | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
    ):
        for name, value in (("num_envs", num_envs), ("tries", tries)):
            check_whole_number(name, value, least=1)
        check_candidates(candidates)
        try:
            self._mode = AutoresetMode(autoreset_mode)
        except ValueError:
            known = [mode.value for mode in AutoresetMode]
            raise UnknownName("autoreset_mode", "", "mode", str(autoreset_mode), known) from None
        self.metadata = {"autoreset_mode": self._mode}
        self.num_envs, self.render_mode = num_envs, None
        self._table, self._tries, self._count = table, tries, candidates
        self._reward = reward or Reward()
        self.single_action_space = action_space(candidates)
        self.single_observation_space = observation_space(
            table.features, table.object_features, candidates, shows_tries=tries > 1
        )
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        data = table.data
        self._starts, self._sizes = data.starts[:-1], data.sizes
        self._widest = max(candidates, int(self._sizes.max()))
        self._objects = data.object_features[data.object_index[self._starts]]
        # One row more, of zeros, stands for no candidate.
        self._features = np.vstack([data.features, np.zeros_like(data.features[:1])])
        self._held = data.held[:, :, table.load_index]
        self._margin = data.margin[:, :, table.load_index]
        self._group = np.zeros(num_envs, dtype=np.int64)
        self._draw = np.zeros(num_envs, dtype=np.int64)
        self._rows = np.full((num_envs, candidates), -1, dtype=np.int64)
        self._tried = np.zeros((num_envs, candidates), dtype=np.int8)
        self._seen = np.zeros((num_envs, candidates), dtype=np.float32)
        self._left = np.zeros(num_envs, dtype=np.int64)
        self._begun = False

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begins episodes everywhere, or where `options["reset_mask"]` (num_envs,) is true."""
        super().reset(seed=seed, options=options)
        which = np.ones(self.num_envs, dtype=bool)
        if options is not None and options.get("reset_mask") is not None:
            which = np.asarray(options["reset_mask"])
            if which.shape != (self.num_envs,) or which.dtype != np.bool_ or not which.any():
                raise InputError(
                    "reset_mask", "", f"must be {self.num_envs} booleans, at least one of them true"
                )
            if not self._begun and not which.all():
                raise InputError("reset_mask", "", "must be all true at first")
        self._begun = True
        self._begin(which)
        return self._observation(), {}

    def step(
        self, actions: NDArray[np.int64]
    ) -> tuple[Observation, NDArray[Any], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Tries a candidate in each environment.

        Raises:
            gymnasium.error.ResetNeeded: before a reset, or where an ended episode was not reset.
            gymnasium.error.InvalidAction: actions outside the action space.
        """
        actions = np.asarray(actions)
        if not self._begun:
            raise gymnasium.error.ResetNeeded("call reset() before step()")
        whole = np.can_cast(actions.dtype, np.int64, "safe")
        if not whole or not self.action_space.contains(actions.astype(np.int64, copy=False)):
            raise gymnasium.error.InvalidAction(
                f"actions must be {self.num_envs} numbers in 0..{self._count - 1}"
            )
        ended = self._left == 0
        if ended.any() and self._mode is AutoresetMode.DISABLED:
            raise gymnasium.error.ResetNeeded("reset the episodes that have ended before step()")
        rewards, held, margins = self._try(actions, ~ended)
        terminated = (self._left == 0) & ~ended
        infos: dict[str, Any] = {"held": held, "margin": margins}
        if self._mode is AutoresetMode.NEXT_STEP and ended.any():
            self._begin(ended)
        elif self._mode is AutoresetMode.SAME_STEP and terminated.any():
            infos |= self._final(terminated, held, margins)
            self._begin(terminated)
        return self._observation(), rewards, terminated, np.zeros(self.num_envs, dtype=bool), infos

    def action_masks(self) -> NDArray[np.bool_]:
        """Valid actions (num_envs, K)."""
        return (self._rows >= 0) & (self._tried == 0)

    def _begin(self, which: NDArray[np.bool_]) -> None:
        """New episodes: as `Table.draw` draws them, for all at once."""
        rng, count = self.np_random, int(which.sum())
        groups = rng.integers(len(self._starts), size=count)
        sizes = self._sizes[groups]
        order = rng.random((count, self._widest))
        order[np.arange(self._widest) >= sizes[:, None]] = 2.0  # behind all candidates
        places = np.argsort(order, axis=1)[:, : self._count]
        there = places < sizes[:, None]
        self._group[which] = groups
        self._draw[which] = rng.integers(self._held.shape[1], size=count)
        self._rows[which] = np.where(there, self._starts[groups][:, None] + places, -1)
        self._tried[which], self._seen[which] = 0, 0.0
        self._left[which] = np.minimum(self._tries, there.sum(axis=1))

    def _try(
        self, actions: NDArray[np.int64], active: NDArray[np.bool_]
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.float32]]:
        """Rewards, and what became of the candidates; nothing where an episode has ended before."""
        every = np.arange(self.num_envs)
        rows = self._rows[every, actions]
        valid = active & (rows >= 0) & (self._tried[every, actions] == 0)
        held = valid & self._held[rows, self._draw]
        margins = np.where(valid, self._margin[rows, self._draw], np.where(active, -1.0, 0.0)).astype(
            np.float32
        )
        worth = held.astype(float) if self._reward.kind == "held" else margins.astype(float)
        rewards = np.where(active, np.where(valid, worth - self._reward.cost, self._reward.of_nothing), 0.0)
        self._tried[every[valid], actions[valid]] = 1
        self._seen[every[valid], actions[valid]] = margins[valid]
        self._left[active] -= 1
        self._left[held] = 0
        return rewards, held, margins

    def _final(
        self, ended: NDArray[np.bool_], held: NDArray[np.bool_], margins: NDArray[np.float32]
    ) -> dict[str, Any]:
        """What was seen last where an episode has ended, in the form of Gymnasium's vector environments."""
        now = self._observation()
        final_obs = np.empty(self.num_envs, dtype=object)
        for k in np.flatnonzero(ended):
            final_obs[k] = {name: values[k].copy() for name, values in now.items()}
        final_info = {
            "held": held & ended,
            "_held": ended,
            "margin": np.where(ended, margins, 0.0),
            "_margin": ended,
        }
        return {"final_obs": final_obs, "_final_obs": ended, "final_info": final_info, "_final_info": ended}

    def _observation(self) -> Observation:
        one_try = self._tries == 1
        mask = (self._rows >= 0) if one_try else self.action_masks()
        seen: Observation = {
            "candidates": self._features[self._rows],
            "object": self._objects[self._group],
            "mask": mask.astype(np.int8),
        }
        if not one_try:
            seen |= {"tried": self._tried.copy(), "margin": self._seen.copy()}
        return seen
