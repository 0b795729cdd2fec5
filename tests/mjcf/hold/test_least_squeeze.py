"""The least squeeze: it holds, a little less does not, and harder work needs more."""

from dataclasses import replace

import pytest
from holdfast.mjcf import Grasp, HoldSettings, hold_test, least_squeeze

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


def test_its_end_is_an_eighth(firm: Grasp) -> None:
    assert least_squeeze(firm, settings=replace(QUICK, gravity=0.01)) == pytest.approx(0.125)
