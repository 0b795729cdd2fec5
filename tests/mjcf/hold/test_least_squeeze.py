"""The least squeeze: it holds, a little less does not, and harder work needs more."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from holdfast.mjcf import Grasp, HoldSettings, hold_test, least_squeeze
from holdfast.mjcf.hold.lift import Lift
from holdfast.mjcf.hold.result import Squeezed
from holdfast.mjcf.settings import Direction
from holdfast.objects import SIX

from ..conftest import squeezed

QUICK = HoldSettings(
    directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)),
    hold_s=0.5,
    timestep_s=0.004,
    noslip_iterations=0,
    impratio=1000.0,
)


def share_of(grasp: Grasp, share: float) -> Grasp:
    q = grasp.configuration.state.q
    squeeze = replace(grasp.squeeze, targets=q + share * (grasp.squeeze.targets - q))
    return replace(grasp, squeeze=squeeze, known_approach=grasp.approach)


def test_the_least_squeeze_holds_and_a_little_less_does_not(firm: Grasp) -> None:
    share = least_squeeze(firm, settings=QUICK)
    assert share is not None and 0.125 < share < 1.0
    assert hold_test(share_of(firm, share), settings=QUICK).held
    assert not hold_test(share_of(firm, 0.874 * share), settings=QUICK).held


def test_a_lighter_load_needs_less(firm: Grasp) -> None:
    whole = least_squeeze(firm, settings=QUICK)
    light = least_squeeze(firm, settings=replace(QUICK, gravity=0.5 * QUICK.gravity))
    assert whole is not None and light is not None and light < whole


def test_there_is_none_where_the_whole_squeeze_fails_or_a_stand_holds_the_object(firm: Grasp) -> None:
    assert least_squeeze(firm, settings=replace(QUICK, gravity=100.0)) is None
    assert least_squeeze(squeezed("playing"), settings=QUICK) is None


def shares_tried(monkeypatch: pytest.MonkeyPatch, needed: Callable[[Direction], float]) -> list[float]:
    """Squeezes hold in a direction from the share on that it needs; the shares that are tried, in turn."""
    shares: list[float] = []

    def squeeze(lift: Lift, share: float) -> None:
        shares.append(share)
        lift.go_back(Squeezed(np.zeros(1), np.array([share])))

    def holds(lift: Lift, direction: Direction) -> bool:
        return float(lift.squeezed.pose[0]) >= needed(direction)

    monkeypatch.setattr(Lift, "squeeze_partly", squeeze)
    monkeypatch.setattr(Lift, "holds", holds)
    monkeypatch.setattr(Lift, "keeps_place", lambda lift: True)
    return shares


@pytest.mark.parametrize(("margin", "most"), [(1.0, 6), (1.5, 4), (2.2, 4), (3.0, 7), (100.0, 7)])
def test_a_margin_says_where_to_look_and_not_what_is_found(
    margin: float, most: int, firm: Grasp, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a grasp that holds with half of its squeeze and more: each share is tried once at most."""
    tried = shares_tried(monkeypatch, lambda direction: 0.55)
    strains = [0.5] * len(QUICK.directions)
    assert least_squeeze(firm, settings=QUICK, strains=strains, margin=margin) == pytest.approx(0.5625)
    assert len(tried) == len(set(tried)) <= most
    tried.clear()
    assert least_squeeze(firm, settings=QUICK, strains=strains, margin=1.8) == pytest.approx(0.5625)
    assert tried == [0.5625, 0.5]


@pytest.mark.parametrize("decides", SIX)
def test_it_passes_in_the_directions_that_were_not_thought_to_decide(
    decides: Direction, firm: Grasp, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whichever needs most decides, and no share is squeezed twice."""
    tried = shares_tried(monkeypatch, lambda direction: 0.6 if direction == decides else 0.3)
    settings = replace(QUICK, directions=SIX)
    found = least_squeeze(firm, settings=settings, strains=[0.5] * 6, margin=2.0, weakest=SIX)
    assert found == 0.625 and len(tried) == len(set(tried))


def test_its_end_is_an_eighth(firm: Grasp) -> None:
    assert least_squeeze(firm, settings=replace(QUICK, gravity=0.01)) == pytest.approx(0.125)
