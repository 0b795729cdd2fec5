"""The job that finds out more about a grasp that has its verdict: measures, proofs, what it would hold."""

from dataclasses import dataclass, field

from ...evidence import Evidence, find_evidence
from ...grasping import Extras, find_extras
from ...mjcf import Grasp, HoldResult, HoldSettings, Quality, UsualSqueeze, grasp_quality, strain
from ...retraction import Approach
from ...solver import Configuration
from ..records import Hold
from .crew import CrewSetup

__all__ = ["FindExtras", "FoundExtras", "HandedOn", "strains_of"]


@dataclass(frozen=True, eq=False)
class FoundExtras:
    """More about a grasp.

    Attributes:
        quality: its analytic measures; None where every process that looked for them was lost.
        evidence: what was proved of it beside the verdict; likewise.
        extras: margin and agreement; None where it has not passed its test, or likewise.
    """

    quality: Quality | None
    evidence: Evidence | None
    extras: Extras | None


@dataclass(frozen=True, eq=False)
class HandedOn:
    """What a test leaves for those who measure more of the grasp.

    Attributes:
        usual: the squeeze of a lift.
        pressed_N: the least force of a press.
    """

    usual: UsualSqueeze | None = None
    pressed_N: float | None = None

    @classmethod
    def by(cls, result: HoldResult) -> "HandedOn":
        """What a result leaves."""
        return cls(result.usual, result.pressed_N)


@dataclass(frozen=True, eq=False)
class FindExtras:
    """Analytic measures and evidence of a grasp, and margin and agreement where it has passed its test.

    Attributes:
        configuration: where hand and object are, as the grasp's record has it.
        approach: how the fingers get there, likewise; None where that is not known.
        tried: the grasp as its record has it; None where no squeeze was found.
        held: whether it has passed its test.
        strains: how much of its limits each direction of gravity takes; None where the test is no lift.
        handed: what its test left to go on from; nothing in a run that was resumed, which finds the same.
    """

    configuration: Configuration
    approach: Approach | None
    tried: Grasp | None
    held: bool
    strains: tuple[float, ...] | None = None
    handed: HandedOn = field(default_factory=HandedOn)

    def work(self, setup: CrewSetup) -> FoundExtras:
        """Measures it, and simulates what it takes."""
        quality = grasp_quality(self.configuration, settings=setup.hold)
        evidence = find_evidence(
            setup.task,
            self.configuration.state,
            squeeze=None if self.tried is None else self.tried.squeeze,
            approach=self.approach,
            retraction=setup.retraction,
        )
        if self.tried is None or not self.held:
            return FoundExtras(quality, evidence, None)
        extras = find_extras(
            self.tried,
            held=True,
            settings=setup.hold,
            strains=self.strains,
            margin=True,
            agreement=True,
            usual=self.handed.usual,
            pressed_N=self.handed.pressed_N,
        )
        return FoundExtras(quality, evidence, extras)

    def given_up(self, setup: CrewSetup) -> FoundExtras:
        """Nothing is known beside the verdict."""
        return FoundExtras(None, None, None)


def strains_of(hold: Hold, settings: HoldSettings) -> tuple[float, ...] | None:
    """How much of its limits each direction takes, by the record of a lift that was held; else None."""
    if hold.kind != "lift" or len(hold.directions) != len(settings.directions):
        return None
    return tuple(strain(entry.slip or 0.0, entry.rotation or 0.0, settings) for entry in hold.directions)
