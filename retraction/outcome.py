"""What a retraction ends with: a clear configuration, or the reason why there is none."""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from ..solver import Configuration, State
from .clearance import PairClearance

__all__ = [
    "ClearConfiguration",
    "FailureReason",
    "RetractionFailure",
    "RetractionOutcome",
    "RetractionStatus",
    "Route",
]


class RetractionStatus(StrEnum):
    """What became of a configuration; records have the values."""

    CLEAR = "clear"
    RETRACTED = "retracted"
    FAILED = "failed"


class FailureReason(StrEnum):
    """Why a configuration could not be made clear."""

    BLOCKED = "blocked"
    CERTIFICATE_LOST = "certificate lost"


class Route(StrEnum):
    """How a clear configuration was reached from the given one.

    - unmoved: it was clear as it came.
    - slid: by steps along the contacts none of which was deeper than the one before.
    - near: the same from a place that a push or a short walk along the contacts led to.
    - anew: by searching the contacts again from another place; it may lie in another component of the
      manifold.
    """

    UNMOVED = "unmoved"
    SLID = "slid"
    NEAR = "near"
    ANEW = "anew"


@dataclass(frozen=True, eq=False, repr=False)
class ClearConfiguration:
    """A configuration in which no pair of bodies is deeper than it may be.

    Attributes:
        configuration: the configuration; the very one that was given where it was clear.
        before_m: least signed distance before, as `Clearance.least_m` counts it: contacts set aside.
        after_m: the same after; equal to `before_m` where the configuration was clear.
        status: clear as it was given, or retracted into clearance.
        worst_pair: names of the two bodies that are nearest to each other after, contacts set aside.
        steps: accepted steps, over all descents.
        restarts: descents that failed before the one that ended clear.
        route: how it was reached.
        moved: how far it is from the given configuration: the largest of joint difference (rad), turn of the
            object (rad) and its shift over 0.1 m.
    """

    configuration: Configuration
    before_m: float
    after_m: float
    status: RetractionStatus
    worst_pair: tuple[str, str] | None
    steps: int = 0
    restarts: int = 0
    route: Route = Route.UNMOVED
    moved: float = 0.0

    def __str__(self) -> str:
        nearest = "" if self.worst_pair is None else f"; nearest: {' and '.join(self.worst_pair)}"
        room = f"{1e3 * self.after_m:.3g} mm of room"
        if self.status is RetractionStatus.CLEAR:
            return f"clear as given, {room}{nearest}"
        return f"retracted ({self.route.value}) from {-1e3 * self.before_m:.3g} mm deep, {room}{nearest}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"


@dataclass(frozen=True, eq=False, repr=False)
class RetractionFailure:
    """Why a configuration could not be made clear.

    Attributes:
        configuration: the configuration that was given.
        before_m: its least signed distance, contacts set aside.
        after_m: the greatest such distance reached.
        blocking: the pairs that are still too deep where the retraction came furthest, worst first.
        active_limits: joints, patch parameters and caps that are at their limits there.
        state: that place, on the contact manifold.
        reason: blocked where some pair stays too deep, certificate lost where a clear state was reached
            that could not be certified although the given configuration was.
        steps: accepted steps, over all descents.
    """

    configuration: Configuration
    before_m: float
    after_m: float
    blocking: tuple[PairClearance, ...]
    active_limits: tuple[str, ...]
    state: State
    reason: FailureReason
    steps: int

    @property
    def status(self) -> RetractionStatus:
        """As `ClearConfiguration.status`."""
        return RetractionStatus.FAILED

    @property
    def worst_pair(self) -> tuple[str, str] | None:
        """Names of the pair that blocks, None where none does."""
        return (self.blocking[0].a, self.blocking[0].b) if self.blocking else None

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"

    def __str__(self) -> str:
        if not self.blocking:
            return f"{self.reason} after {self.steps} steps"
        worst = self.blocking[0]
        at = f"; at their limits: {', '.join(self.active_limits)}" if self.active_limits else ""
        return (
            f"{self.reason} by {worst.a} and {worst.b}: {-1e3 * worst.distance_m:.3g} mm deep after "
            f"{self.steps} steps, allowed {1e3 * worst.allowed_depth_m:.3g} mm{at}"
        )


RetractionOutcome: TypeAlias = ClearConfiguration | RetractionFailure
