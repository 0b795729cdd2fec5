"""A squeeze that the object stands: the usual one, or where that moves it, another one that does not."""

from dataclasses import dataclass, replace

from ..mjcf import (
    FingerFirst,
    Grasp,
    HoldResult,
    HoldSettings,
    LessSpin,
    Lift,
    alternative_squeezes,
    fingers_first,
    hold_test,
    hold_test_if_passed,
    shared_lift,
    strain,
    with_less_spin,
)

__all__ = ["Leaning", "tried_squeeze"]


@dataclass(frozen=True)
class Leaning:
    """What a grasp that is held may lean on, as far as it was tried.

    Attributes:
        fingers: what becomes of the object where one finger arrives first; empty where that was not tried.
        spin: what becomes of it with less spin friction; None where that was not tried.
        is_chosen: whether the squeeze was chosen among others for what it stands.
    """

    fingers: tuple[FingerFirst, ...] = ()
    spin: LessSpin | None = None
    is_chosen: bool = False

    @property
    def is_known(self) -> bool:
        """Whether anything was tried."""
        return bool(self.fingers) or self.spin is not None

    def is_firm(self, result: HoldResult) -> bool:
        """Whether the squeeze hardly moves the object, and it stands all that was tried.

        The best of several looks better than it is, so one that was chosen has to leave room there, too.
        """
        stands = all(finger.kept for finger in self.fingers) and (self.spin is None or self.spin.held)
        is_due = self.is_chosen and result.kind == "lift"
        return (
            result.is_firm and stands and (not is_due or result.squeezed_within(result.settings.firm_share))
        )


def tried_squeeze(grasp: Grasp, *, settings: HoldSettings | None = None) -> tuple[Grasp, HoldResult, Leaning]:
    """The grasp with the squeeze that was chosen, its hold test, and what it may lean on.

    Other squeezes are only tried where the usual one itself moves the object too far, with all fingers
    together or with one of them first, or leans on spin friction: a load that is too much is no matter of the
    squeeze. They count if the grasp then is held firmly; or where the usual one fails, if it is held at all.
    Settings without `fingers_first` leave it at the test.
    """
    lift = shared_lift(grasp, settings=settings)
    result = hold_test(grasp, settings=settings, lift=lift)
    if not result.settings.fingers_first:
        return grasp, result, Leaning()
    leaning = Leaning()
    if result.held:
        leaning = Leaning(fingers_first(grasp, settings=result.settings, lift=lift))
        if leaning.is_firm(result) or not leaning.fingers:
            leaning = replace(leaning, spin=_spin(lift, result))
    if leaning.is_firm(result) if leaning.is_known else result.kept_place:
        return grasp, result, leaning
    chosen = _other_squeeze(grasp, result, leaning, lift)
    if chosen is not None:
        return chosen
    if leaning.fingers and leaning.spin is None:  # changes nothing any more, but is worth knowing
        leaning = replace(leaning, spin=_spin(lift, result))
    return grasp, result, leaning


def _other_squeeze(
    grasp: Grasp, usual: HoldResult, leaning: Leaning, lift: Lift | None
) -> tuple[Grasp, HoldResult, Leaning] | None:
    """The first other squeeze that is better than the usual one, and firm if there is any; None for none."""
    chosen: tuple[Grasp, HoldResult, Leaning] | None = None
    lost = [finger for finger in leaning.fingers if not finger.kept]
    lost.sort(key=lambda finger: -strain(finger.slip_m, finger.rotation_rad, usual.settings))
    suspects = [finger.finger for finger in lost]
    for squeeze in alternative_squeezes(grasp.configuration, grasp.squeeze):
        other = replace(grasp, squeeze=squeeze, known_approach=grasp.approach)
        must_be_firm = usual.held or chosen is not None
        other_lift = shared_lift(other, settings=usual.settings, other=lift)
        found = _held_if_better(other, usual.settings, suspects, must_be_firm=must_be_firm, lift=other_lift)
        if found is None:
            continue
        chosen = other, *found
        if found[1].is_firm(found[0]):
            break
    return chosen


def _spin(lift: Lift | None, result: HoldResult) -> LessSpin | None:
    """The test with less spin friction, of a lift."""
    return None if lift is None else with_less_spin(lift, result, result.settings)


def _held_if_better(
    grasp: Grasp, settings: HoldSettings, suspects: list[str], *, must_be_firm: bool, lift: Lift | None
) -> tuple[HoldResult, Leaning] | None:
    """Test and leaning of a grasp that is held, and where it must, firmly; None for another.

    The fingers that are suspected come first: another squeeze of the grasp did not stand them. Where none is,
    that squeeze itself moved the object too far, or leant on spin friction.
    """
    order: tuple[FingerFirst, ...] = ()
    # As soon as it is known, for the rest costs more.
    if must_be_firm and lift is not None and not (suspects or lift.squeezes_firmly(settings.firm_share)):
        return None
    if must_be_firm:  # a finger is lost sooner than a direction
        order = fingers_first(grasp, settings=settings, until_lost=True, suspects=suspects, lift=lift)
        if not all(finger.kept for finger in order):
            return None
    test = hold_test_if_passed(grasp, settings=settings, firmly=must_be_firm, lift=lift)
    if test is None:
        return None
    spin = _spin(lift, test)
    if must_be_firm and spin is not None and not spin.held:
        return None
    fingers = order if must_be_firm else fingers_first(grasp, settings=settings, lift=lift)
    leaning = Leaning(fingers, spin, is_chosen=True)
    return (test, leaning) if leaning.is_firm(test) or not must_be_firm else None
