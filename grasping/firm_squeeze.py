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
)

__all__ = ["tried_squeeze"]


def tried_squeeze(
    grasp: Grasp, *, settings: HoldSettings | None = None
) -> tuple[Grasp, HoldResult, tuple[FingerFirst, ...]]:
    """The grasp with the squeeze that was chosen, its hold test, and what each finger does that comes first.

    Other squeezes are only tried where the usual one itself moves the object too far, with all fingers
    together or with one of them first: a load that is too much is no matter of the squeeze. They count if the
    grasp then is held and stands every finger; or where the usual one fails, if it is held at all. Settings
    without `fingers_first` leave it at the test.
    """
    result = hold_test(grasp, settings=settings)
    if not result.settings.fingers_first:
        return grasp, result, ()
    fingers = fingers_first(grasp, settings=result.settings) if result.held else ()
    if all(finger.kept for finger in fingers) and result.kept_place:
        return grasp, result, fingers
    chosen = grasp, result, fingers
    for squeeze in alternative_squeezes(grasp.configuration, grasp.squeeze):
        other = replace(grasp, squeeze=squeeze, known_approach=grasp.approach)
        is_needed = chosen[1].held
        order = fingers_first(other, settings=result.settings, until_lost=is_needed)
        is_firm = all(finger.kept for finger in order)
        if is_needed and not is_firm:
            continue
        test = hold_test(other, settings=result.settings)
        if test.held and is_firm:
            return other, test, order
        if test.held and not chosen[1].held:
            chosen = other, test, order
    return chosen
