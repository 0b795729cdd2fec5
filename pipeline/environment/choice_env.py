"""The environments: one choice, or several tries with their outcomes seen, over any back end."""

from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from ...arguments import check_whole_number
from ...errors import UnknownName
from .drawing import Painter
from .episode import Backend, Episode
from .reward import Reward
from .spaces import action_space, check_candidates, observation_space

__all__ = ["ChoiceEnv"]

Observation = dict[str, Any]


class ChoiceEnv(gymnasium.Env[Observation, np.int64]):
    """Choose among K candidate grasps; see docs/environment.md.

    Args:
        backend: where situations come from.
        candidates: K.
        tries: how many may be tried in an episode; with more than one, outcomes are part of what is seen.
        reward: what a try is worth.
        render_mode: None, `rgb_array` or `human`.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "human"], "render_fps": 1}

    def __init__(
        self,
        backend: Backend,
        *,
        candidates: int = 8,
        tries: int = 1,
        reward: Reward | None = None,
        render_mode: str | None = None,
    ):
        check_candidates(candidates)
        check_whole_number("tries", tries, least=1)
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise UnknownName(
                "render_mode", "", "render mode", str(render_mode), self.metadata["render_modes"]
            )
        self.render_mode = render_mode
        self._backend = backend
        self._count, self._tries = candidates, tries
        self._reward = reward or Reward()
        self._painter = Painter()
        self._episode: Episode | None = None
        self._left = 0
        self._shown = 0
        self._now: Observation = {}
        self.action_space = action_space(candidates)
        self.observation_space = observation_space(
            backend.features, backend.object_features, candidates, shows_tries=tries > 1
        )

    @property
    def backend(self) -> Backend:
        """Where situations come from."""
        return self._backend

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Draws a situation and what is hidden; the same seed draws the same, in any process."""
        super().reset(seed=seed, options=options)
        self._episode = episode = self._backend.draw(self.np_random, self._count)
        slots = episode.slots
        count = len(slots.candidates)
        rows = np.zeros((self._count, slots.candidates.shape[1]), dtype=np.float32)
        rows[:count] = slots.candidates
        mask = np.zeros(self._count, dtype=np.int8)
        mask[:count] = 1
        self._now = {"candidates": rows, "object": slots.object, "mask": mask}
        if self._tries > 1:
            self._now["tried"] = np.zeros(self._count, dtype=np.int8)
            self._now["margin"] = np.zeros(self._count, dtype=np.float32)
        self._left, self._shown = min(self._tries, count), 0
        if self.render_mode == "human":
            self.render()
        return self._seen(), {**slots.about, "candidates": slots.ids}

    def step(self, action: np.int64) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Tries a candidate.

        Raises:
            gymnasium.error.ResetNeeded: before a reset, or after the end of an episode.
            gymnasium.error.InvalidAction: an action outside the action space.
        """
        if self._episode is None or self._left == 0:
            raise gymnasium.error.ResetNeeded("the episode has ended: call reset() before step()")
        if not self.action_space.contains(action):
            raise gymnasium.error.InvalidAction(f"action must be in 0..{self._count - 1}, not {action!r}")
        slot = int(action)
        self._left -= 1
        if self._now["mask"][slot]:
            held, margin, outcome = self._episode.outcome(slot)
            reward = self._reward.of(held, margin)
            self._shown = slot
            self._note(slot, margin)
        else:
            held, margin, outcome, reward = False, -1.0, "invalid", self._reward.of_nothing
        if held:
            self._left = 0
        info: dict[str, Any] = {"held": held, "margin": margin, "outcome": outcome}
        if self._left == 0:
            info["conditions"] = self._episode.conditions()
        if self.render_mode == "human":
            self.render()
        return self._seen(), reward, self._left == 0, False, info

    def action_masks(self) -> NDArray[np.bool_]:
        """Valid actions (K,), as maskable policies ask for them."""
        if self._episode is None:
            raise gymnasium.error.ResetNeeded("call reset() before action_masks()")
        return self._now["mask"].astype(bool)

    def render(self) -> NDArray[np.uint8] | None:
        """The candidate that was tried last, before that the first one: a picture, or a window."""
        if self.render_mode is None:
            return None
        if self._episode is None:
            raise gymnasium.error.ResetNeeded("call reset() before render()")
        configuration = self._episode.configuration(self._shown)
        about = self._episode.slots.about
        caption = f"{about['object']}, {about['hand']}, candidate {self._shown}"
        if self.render_mode == "human":
            self._painter.show(configuration, caption)
            return None
        return self._painter.picture(configuration)

    def close(self) -> None:
        """Frees renderer and window."""
        self._painter.close()

    def _note(self, slot: int, margin: float) -> None:
        if self._tries > 1:
            self._now["tried"][slot], self._now["margin"][slot] = 1, margin
            self._now["mask"][slot] = 0

    def _seen(self) -> Observation:
        # Whoever sees something may keep it: nothing of it is used again.
        return {name: value.copy() for name, value in self._now.items()}
