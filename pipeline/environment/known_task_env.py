"""`GraspChoiceEnv`: choose among the candidates of one task, under conditions that are seen.

**Episode.** One step long. K candidates are drawn without replacement from a pool of grasps that the solver,
retraction and the squeeze have made of the task (once; then it is read from a cache). Up to a quarter of
them may be invalid. Conditions are drawn that the squeezes were not planned for: the friction is the
object's times a factor out of `FRICTIONS`, the load is `WEIGHTS` times the task's, and gravity acts along
one of the six axes of the palm frame, all uniform and independent. The load is gravity where the test is a
lift, the friction of the hinge in a turn, the force that is asked for in a press; in these two gravity has
no say.

**Action.** `Discrete(K)`: the index of a candidate.

**Reward.** 1 where the hand holds the object under the episode's conditions in the MuJoCo hold test, else
0. An invalid candidate, one that penetrates or that no squeeze holds (`mask` 0), is not simulated: its
reward is 0 and `info["outcome"]` says `invalid`.

**Observation.** A dictionary: `candidates` (K, F) with the features that `features.features` documents, rows
of invalid candidates included where there is one, else zeros; `mask` (K,), 1 for valid candidates;
`conditions` (5,): the factors of friction and weight and the unit vector of gravity.

`info` holds the conditions by name and the candidates' ids (an empty text for an empty row); after the step
also the `outcome` in words and, where it was simulated, `slip` in m and `rotation` in rad.
"""

from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ...arguments import check_instance, check_path, check_whole_number
from ...base.machine.backend import configure
from ...errors import UnknownName
from ...mjcf import HoldResult, HoldSettings, hold_test
from ...mjcf.render import Studio
from ...objects import Task, load_task
from ..choice import LIMIT, Candidate, feature_names, load_pool
from .spaces import check_candidates

__all__ = ["FRICTIONS", "WEIGHTS", "GraspChoiceEnv"]

FRICTIONS = (0.6, 0.75, 0.9, 1.05)
"""Factors of the object's friction."""
WEIGHTS = (1.0, 1.5, 2.0, 2.5)
"""Factors of the load."""

_INVALID_SHARE = 4
_PICTURE = (480, 640)
Observation = dict[str, Any]


class GraspChoiceEnv(gymnasium.Env[Observation, np.int64]):
    """See the module's text.

    Args:
        task: a built-in task, the path of a task file, or a task.
        candidates: K.
        pool: grasps asked of the solver for the pool.
        pool_seed: seed of the pool, which is the same in all episodes.
        settings: of the hold test; None takes the defaults.
        cache: folder where the pool is kept; None takes the user's cache folder.
        render_mode: None or `rgb_array`, which shows the chosen grasp after a step, and the first valid
            candidate before it.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 1}

    def __init__(
        self,
        task: str | Path | Task = "upholding",
        *,
        candidates: int = 8,
        pool: int = 24,
        pool_seed: int = 0,
        settings: HoldSettings | None = None,
        cache: str | Path | None = None,
        render_mode: str | None = None,
    ):
        check_candidates(candidates)
        check_whole_number("pool", pool, least=1)
        check_whole_number("pool_seed", pool_seed, least=0)
        if settings is not None:
            check_instance("settings", settings, HoldSettings, "HoldSettings")
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise UnknownName(
                "render_mode", "", "render mode", str(render_mode), self.metadata["render_modes"]
            )
        configure()  # before anything imports MuJoCo, which settles on its renderer then
        self.task = task if isinstance(task, Task) else load_task(task)
        self.render_mode = render_mode
        self._studio = Studio(self.task)  # sets up its renderer with the first picture
        self._settings = settings or HoldSettings()
        self._pool_size = pool
        self._pool_seed = pool_seed
        self._cache = check_path("cache", cache) if cache is not None else None
        self._count = candidates
        self._results: dict[tuple[str, HoldSettings, float], HoldResult] = {}
        self._slots: tuple[Candidate | None, ...] = ()
        self._conditions = self._settings
        self._load = 1.0
        self._factors = (1.0, 1.0, 0.0, 0.0, 0.0)
        self._chosen: int | None = None
        width = len(feature_names(self.task))
        self._shape = (candidates, width)
        self.action_space = spaces.Discrete(candidates)
        self.observation_space: spaces.Space[Observation] = spaces.Dict(
            {
                "candidates": spaces.Box(-LIMIT, LIMIT, self._shape, np.float32),
                "mask": spaces.Box(0, 1, (candidates,), np.int8),
                "conditions": spaces.Box(-LIMIT, LIMIT, (5,), np.float32),
            }
        )

    @cached_property
    def pool(self) -> tuple[Candidate, ...]:
        """All grasps that candidates are drawn from; made or read when first needed."""
        return load_pool(
            self.task,
            size=self._pool_size,
            seed=self._pool_seed,
            settings=self._settings,
            folder=self._cache,
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Draws candidates and conditions; the same seed draws the same."""
        super().reset(seed=seed, options=options)
        self._slots = self._draw_candidates()
        self._draw_conditions()
        self._chosen = None
        return self._observation(), self._info()

    def step(self, action: np.int64) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Tries the chosen candidate and ends the episode.

        Raises:
            gymnasium.error.ResetNeeded: before a reset, or a second time after one.
            gymnasium.error.InvalidAction: an action outside the action space.
        """
        if not self._slots or self._chosen is not None:
            raise gymnasium.error.ResetNeeded("an episode is one step long: call reset() before step()")
        if not self.action_space.contains(action):
            raise gymnasium.error.InvalidAction(f"action must be in 0..{self._count - 1}, not {action!r}")
        self._chosen = int(action)
        candidate = self._slots[self._chosen]
        info = self._info()
        if candidate is None or not candidate.is_valid:
            return self._observation(), 0.0, True, False, info | {"outcome": "invalid"}
        result = self._result(candidate)
        info |= {
            "outcome": result.directions[0].outcome.value,
            "slip": result.slip_m,
            "rotation": result.rotation_rad,
        }
        return self._observation(), float(result.held), True, False, info

    def action_masks(self) -> NDArray[np.bool_]:
        """Valid actions (K,), as maskable policies ask for them."""
        return np.array([slot is not None and slot.is_valid for slot in self._slots])

    def render(self) -> NDArray[np.uint8] | None:
        """A picture (480, 640, 3) in mode `rgb_array`."""
        if self.render_mode is None:
            return None
        if not self._slots:
            raise gymnasium.error.ResetNeeded("call reset() before render()")
        shown = self._chosen if self._chosen is not None else int(np.argmax(self.action_masks()))
        candidate = self._slots[shown]
        if candidate is None:
            return np.zeros((*_PICTURE, 3), dtype=np.uint8)
        height, width = _PICTURE
        return self._studio.view(candidate.configuration, width=width, height=height)

    def close(self) -> None:
        """Frees the renderer."""
        self._studio.close()

    def _draw_candidates(self) -> tuple[Candidate | None, ...]:
        valid = [candidate for candidate in self.pool if candidate.is_valid]
        invalid = [candidate for candidate in self.pool if not candidate.is_valid]
        least = max(0, self._count - len(valid))
        most = max(least, self._count // _INVALID_SHARE)
        bad = min(int(self.np_random.integers(least, most + 1)), len(invalid))
        good = min(self._count - bad, len(valid))
        drawn: list[Candidate | None] = [
            *(valid[i] for i in self.np_random.choice(len(valid), good, replace=False)),
            *(invalid[i] for i in self.np_random.choice(len(invalid), bad, replace=False)),
        ]
        drawn += [None] * (self._count - len(drawn))
        return tuple(drawn[i] for i in self.np_random.permutation(self._count))

    def _draw_conditions(self) -> None:
        friction = float(self.np_random.choice(FRICTIONS))
        weight = float(self.np_random.choice(WEIGHTS))
        axis = int(self.np_random.integers(6))
        direction = [0.0, 0.0, 0.0]
        direction[axis // 2] = 1.0 if axis % 2 == 0 else -1.0
        x, y, z = direction
        self._factors = (friction, weight, x, y, z)
        self._load = weight
        self._conditions = replace(
            self._settings,
            friction=friction * self._settings.sliding_friction(self.task.object),
            directions=((x, y, z),),
        )

    def _result(self, candidate: Candidate) -> HoldResult:
        # Conditions come from a small set, so that what was simulated once is known for all episodes.
        key = (candidate.id, self._conditions, self._load)
        if key not in self._results:
            self._results[key] = hold_test(candidate.grasp, settings=self._conditions, load=self._load)
        return self._results[key]

    def _observation(self) -> Observation:
        rows = np.zeros(self._shape, dtype=np.float32)
        for i, slot in enumerate(self._slots):
            if slot is not None:
                rows[i] = slot.features
        return {
            "candidates": rows,
            "mask": self.action_masks().astype(np.int8),
            "conditions": np.array(self._factors, dtype=np.float32),
        }

    def _info(self) -> dict[str, Any]:
        friction, weight, *gravity = self._factors
        return {
            "friction_factor": friction,
            "weight_factor": weight,
            "gravity_direction": gravity,
            "candidates": [slot.id if slot is not None else "" for slot in self._slots],
        }
