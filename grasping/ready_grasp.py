"""A grasp that can be tested, and the reason why there is none."""

from dataclasses import dataclass
from functools import cached_property

from ..mjcf import (
    Grasp,
    HoldSettings,
    LoadLimit,
    NotHoldable,
    Quality,
    Squeeze,
    grasp_quality,
    load_limit,
)
from ..retraction import Approach, RetractionFailure
from ..solver import Configuration
from .clearing import Clearing

__all__ = ["ReadyGrasp", "Refusal"]


@dataclass(frozen=True, eq=False, repr=False)
class ReadyGrasp:
    """A configuration with a squeeze: all that the hand has to be told for the test.

    Attributes:
        grasp: configuration, squeeze and approach, as the simulation takes them.
        clearing: how it was freed of penetration; None where it was taken as it is.
    """

    grasp: Grasp
    clearing: Clearing | None = None

    @property
    def configuration(self) -> Configuration:
        """Where hand and object are when the contacts just touch."""
        return self.grasp.configuration

    @property
    def squeeze(self) -> Squeeze:
        """Targets of the servos."""
        return self.grasp.squeeze

    @property
    def approach(self) -> Approach:
        """The way on which the fingers close."""
        return self.grasp.approach

    @cached_property
    def quality(self) -> Quality:
        """Analytic measures of the configuration; found when first asked for, as no test needs them."""
        return grasp_quality(self.configuration, settings=self.squeeze.settings)

    def __repr__(self) -> str:
        return f"<{self}>"

    def __str__(self) -> str:
        configuration, load = self.configuration, self.squeeze.load_factor
        certified = "certified" if configuration.certified else "not certified"
        clearing = f", {self.clearing}" if self.clearing is not None else ""
        return f"grasp of {configuration.task.name}: {certified}{clearing}, carries {load:.2f} times its load"


@dataclass(frozen=True, eq=False, repr=False)
class Refusal:
    """Why a configuration did not become a grasp.

    Attributes:
        configuration: where hand and object are; clear where the squeeze is what is missing.
        reason: that retraction failed, or that no forces of the hand hold the object.
        settings: of the test that it was to be made for.
        clearing: how it was freed of penetration, or not; None where it was taken as it is.
    """

    configuration: Configuration
    reason: RetractionFailure | NotHoldable
    settings: HoldSettings
    clearing: Clearing | None = None

    @cached_property
    def quality(self) -> Quality | None:
        """Analytic measures of the configuration, found when first asked for; None where it is not clear."""
        if isinstance(self.reason, RetractionFailure):
            return None
        return grasp_quality(self.configuration, settings=self.settings)

    @cached_property
    def limit(self) -> LoadLimit | None:
        """What keeps squeezes from carrying the load, found when asked for; None where it is not clear."""
        if isinstance(self.reason, RetractionFailure):
            return None
        return load_limit(self.configuration, settings=self.settings)

    def __bool__(self) -> bool:
        """False: there is no grasp."""
        return False

    def __repr__(self) -> str:
        return f"<{self}>"

    def __str__(self) -> str:
        if isinstance(self.reason, RetractionFailure):
            return f"not clear: {self.reason}"
        return f"no squeeze: {self.reason.obstacle.value}"
