"""What is worth knowing about a verdict beside it; each thing costs several more simulations."""

from collections.abc import Sequence
from dataclasses import dataclass

from ..mjcf import (
    Agreement,
    Grasp,
    HoldSettings,
    Noise,
    Robustness,
    UsualSqueeze,
    find_margin,
    hold_probability,
    least_squeeze,
    shared_lift,
    verdict_agreement,
)

__all__ = ["Extras", "find_extras"]


@dataclass(frozen=True, eq=False)
class Extras:
    """More about a verdict.

    Attributes:
        margin: multiple of the load at which the grasp first fails; None where it was not asked for.
        least_squeeze: share of the squeeze that still holds; None where the margin was not asked for, or
            there is no such share.
        agreement: verdicts with other numerical settings; None where they were not asked for.
        robustness: verdicts with noise; None where they were not asked for.
    """

    margin: float | None = None
    least_squeeze: float | None = None
    agreement: Agreement | None = None
    robustness: Robustness | None = None


def find_extras(
    grasp: Grasp,
    *,
    held: bool,
    settings: HoldSettings | None = None,
    strains: Sequence[float] | None = None,
    margin: bool = False,
    agreement: bool = False,
    noise: Noise | None = None,
    usual: UsualSqueeze | None = None,
    pressed_N: float | None = None,
) -> Extras:
    """Finds what is asked for.

    Args:
        grasp: what was tried.
        held: the verdict.
        settings: of the test; None takes those that the squeeze was planned for.
        strains: of a lift that is held with these settings, how much of its limits each direction takes; None
            where that is not at hand, and simulated again.
        margin: whether to look for the load at which it first fails, and for the least squeeze that holds.
        agreement: whether to repeat the test with other numerical settings.
        noise: what to repeat it with, for the probability of passing; None for nothing.
        usual: the squeeze of a lift, as the test has made it; None where it is not at hand, and made again.
        pressed_N: the least force of a press, likewise.
    """
    lift = shared_lift(grasp, settings=settings, usual=usual) if margin or agreement else None
    found = None
    if margin:
        found = find_margin(
            grasp, settings=settings, strains=strains, lift=lift, held=held, pressed_N=pressed_N
        )
    least, weakest = None, None
    if found is not None and held:
        weakest = found.weakest or None
        least = least_squeeze(
            grasp, settings=settings, strains=strains, margin=found.value, weakest=weakest, lift=lift
        )
    agreeing = None
    if agreement:
        agreeing = verdict_agreement(grasp, held, settings=settings, weakest=weakest, lift=lift)
    return Extras(
        margin=None if found is None else found.value,
        least_squeeze=least,
        agreement=agreeing,
        robustness=None if noise is None else hold_probability(grasp, settings=settings, noise=noise),
    )
