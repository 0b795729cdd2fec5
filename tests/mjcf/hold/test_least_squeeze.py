"""The least squeeze: it holds, a little less does not, and harder work needs more."""

from dataclasses import replace

import pytest
from holdfast.mjcf import Grasp, HoldSettings, hold_test, least_squeeze
from holdfast.mjcf.hold.least_squeeze import _Shares

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


@pytest.mark.parametrize("margin", [1.0, 1.5, 3.0, 100.0])
def test_a_margin_says_where_to_look_and_not_what_is_found(
    margin: float, firm: Grasp, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a grasp that holds with half of its squeeze and more: each share is tried once at most."""
    tried: list[float] = []

    def is_held(_: object, share: float) -> bool:
        tried.append(share)
        return share >= 0.55

    monkeypatch.setattr(_Shares, "_is_held", is_held)
    strains = [0.5] * len(QUICK.directions)
    assert least_squeeze(firm, settings=QUICK, strains=strains, margin=margin) == pytest.approx(0.5625)
    assert len(tried) == len(set(tried)) <= 6
    tried.clear()
    assert least_squeeze(firm, settings=QUICK, strains=strains, margin=1.8) == pytest.approx(0.5625)
    assert tried == [0.5625, 0.5]


def test_its_end_is_an_eighth(firm: Grasp) -> None:
    assert least_squeeze(firm, settings=replace(QUICK, gravity=0.01)) == pytest.approx(0.125)
