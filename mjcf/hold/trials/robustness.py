"""The probability of passing the test when the object is not quite where the grasp has it."""

from dataclasses import dataclass, replace
from math import radians, sqrt

import numpy as np

from ....arguments import check_number, check_whole_number
from ....errors import InputError
from ....geometry import axis_rotation
from ...model import Grasp
from ...settings import HoldSettings
from ..checks import trial_settings
from ..hold import passes
from ..placement import Placement

__all__ = ["Noise", "Robustness", "hold_probability"]


@dataclass(frozen=True)
class Noise:
    """What is uncertain; each part is drawn evenly.

    Attributes:
        position_m: the object is shifted by up to this along each axis of the palm frame.
        angle_rad: and turned by up to this about any axis through the middle of the contact points.
        friction_share: friction is off by up to this share of itself.
        trials: number of draws.
        seed: of the draws.
    """

    position_m: float = 0.002
    angle_rad: float = radians(2.0)
    friction_share: float = 0.2
    trials: int = 10
    seed: int = 0

    def __post_init__(self) -> None:
        for name in ("position_m", "angle_rad", "friction_share"):
            check_number(f"Noise.{name}", getattr(self, name), least=0.0)
        if self.friction_share >= 1.0:
            raise InputError("Noise.friction_share", "", f"must be below 1, not {self.friction_share:g}")
        check_whole_number("Noise.trials", self.trials, least=1)
        check_whole_number("Noise.seed", self.seed, least=0)


@dataclass(frozen=True)
class Robustness:
    """How often a grasp passed.

    Attributes:
        noise: what was drawn.
        held: verdict of each draw.
    """

    noise: Noise
    held: tuple[bool, ...]

    def __str__(self) -> str:
        return f"held in {sum(self.held)} of {len(self.held)} trials with noise"

    @property
    def probability(self) -> float:
        """The share that passed."""
        return sum(self.held) / len(self.held)

    @property
    def standard_error(self) -> float:
        """Standard error of the probability, of a binomial with the rule of succession."""
        n = len(self.held)
        p = (sum(self.held) + 1.0) / (n + 2.0)
        return sqrt(p * (1.0 - p) / n)


def hold_probability(
    grasp: Grasp, *, settings: HoldSettings | None = None, noise: Noise | None = None
) -> Robustness:
    """Puts a grasp to its task's test again and again with noise; hand and squeeze stay as planned.

    Args:
        grasp: the grasp.
        settings: of the test; None takes what the squeeze was planned for.
        noise: None takes +-2 mm, +-2 deg and +-20 % of friction, ten times.
    """
    settings = trial_settings(grasp, settings)
    noise = noise or Noise()
    friction = settings.sliding_friction(grasp.configuration.task.object)
    held = []
    for trial in range(noise.trials):
        # A generator for each trial: more trials repeat the first ones.
        rng = np.random.default_rng([noise.seed, trial])
        placement = _draw(noise, rng)
        share = 1.0 + noise.friction_share * rng.uniform(-1.0, 1.0)
        held.append(passes(grasp, settings=replace(settings, friction=share * friction), placement=placement))
    return Robustness(noise, tuple(held))


def _draw(noise: Noise, rng: np.random.Generator) -> Placement:
    axis = rng.normal(size=3)
    turn = axis_rotation(axis / np.linalg.norm(axis), noise.angle_rad * rng.uniform(-1.0, 1.0))
    return Placement(noise.position_m * rng.uniform(-1.0, 1.0, size=3), turn)
