"""A squeeze that the object stands: the usual one, or where that moves it, another one that does not."""

from dataclasses import replace

from ..mjcf import (
    FingerFirst,
    Grasp,
    HoldResult,
    HoldSettings,
    alternative_squeezes,
    fingers_first,
    hold_test,
    hold_test_if_passed,
    shared_lift,
)

__all__ = ["is_firm", "tried_squeeze"]


def is_firm(result: HoldResult, fingers: tuple[FingerFirst, ...]) -> bool:
    """Whether the squeeze hardly moves the object, and it stands every finger's arriving first."""
    return result.is_firm and all(finger.kept for finger in fingers)


def tried_squeeze(
    grasp: Grasp, *, settings: HoldSettings | None = None
) -> tuple[Grasp, HoldResult, tuple[FingerFirst, ...]]:
    """The grasp with the squeeze that was chosen, its hold test, and what each finger does that comes first.

    Other squeezes are only tried where the usual one itself moves the object too far, with all fingers
    together or with one of them first: a load that is too much is no matter of the squeeze. They count if the
    grasp then is held firmly; or where the usual one fails, if it is held at all. Settings
    without `fingers_first` leave it at the test.
    """
    lift = shared_lift(grasp, settings=settings)
    result = hold_test(grasp, settings=settings, lift=lift)
    if not result.settings.fingers_first:
        return grasp, result, ()
    fingers = fingers_first(grasp, settings=result.settings, lift=lift) if result.held else ()
    if is_firm(result, fingers) if fingers else result.kept_place:
        return grasp, result, fingers
    chosen = grasp, result, fingers
    lost = {finger.finger for finger in fingers if not finger.kept}
    for squeeze in alternative_squeezes(grasp.configuration, grasp.squeeze):
        other = replace(grasp, squeeze=squeeze, known_approach=grasp.approach)
        found = _held_if_better(other, result.settings, lost, must_be_firm=chosen[1].held)
        if found is None:
            continue
        chosen = other, *found
        if is_firm(*found):
            break
    return chosen


def _held_if_better(
    grasp: Grasp, settings: HoldSettings, suspects: set[str], *, must_be_firm: bool
) -> tuple[HoldResult, tuple[FingerFirst, ...]] | None:
    """Test and fingers of a grasp that is held, and where it must, stands every finger; None for another.

    The fingers that are suspected come first: another squeeze of the grasp did not stand them. Where none is,
    that squeeze itself moved the object too far.
    """
    order: tuple[FingerFirst, ...] = ()
    lift = shared_lift(grasp, settings=settings)
    if must_be_firm and not suspects and lift is not None:
        lift.squeeze()
        if not lift.result([]).is_firm:
            return None
    if must_be_firm:  # a finger is lost sooner than a direction
        order = fingers_first(grasp, settings=settings, until_lost=True, suspects=suspects, lift=lift)
        if not all(finger.kept for finger in order):
            return None
    test = hold_test_if_passed(grasp, settings=settings, firmly=must_be_firm, lift=lift)
    if test is None:
        return None
    return test, order if must_be_firm else fingers_first(grasp, settings=settings, lift=lift)
