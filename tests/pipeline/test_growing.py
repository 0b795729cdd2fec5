"""Contacts that are grown from pinches: other fingers are laid on the surface, and all touch at once."""

import numpy as np
import pytest
from holdfast.hands import load_hand
from holdfast.objects import ObjectModel, load_object
from holdfast.pipeline.suggest import searches
from holdfast.pipeline.suggest.growing import Growing
from holdfast.pipeline.suggest.surface import site_at
from holdfast.solver import State


@pytest.fixture(scope="module")
def can(tmp_path_factory) -> ObjectModel:
    path = tmp_path_factory.mktemp("can") / "can.yaml"
    path.write_text("{cylinder: {radius: 0.033, length: 0.12}, mass: 0.35, friction: 0.5}", "utf-8")
    return load_object(path)


def test_four_fingers_hold_a_can(can: ObjectModel) -> None:
    """Places and fingers that are drawn apart from each other reached none of it in minutes."""
    search = searches(load_hand("sa"), can, 4)[0]
    (found,) = search.more(1, budget_s=600.0, tries=30)
    links = [contact.hand.link for contact in found.task.contacts]
    assert len(set(links)) == 4
    assert found.configuration.certified


def test_fingers_are_laid_where_the_surface_is(can: ObjectModel) -> None:
    hand = load_hand("sa")
    tips = [region for region in hand.regions.values() if region.name.endswith("/tip")]
    thumb, index = (next(t for t in tips if t.name == f"{name}/tip") for name in ("thumb", "index"))
    across = [[0.033, 0.0, 0.0], [-0.033, 0.0, 0.0]]
    sites = [site_at(can, np.array(point), _face(can, point)) for point in across]
    near = State(hand.limits.mean(axis=1), np.eye(3), np.array([0.05, 0.0, 0.16]), np.zeros(0))
    grown = Growing(hand, can, tips, 0).grow(sites, (thumb, index), near, 3)
    assert grown is not None
    assert grown.regions[:2] == (thumb, index)
    assert len({region.link for region in grown.regions}) == 3
    point = grown.sites[2].point
    assert np.hypot(*point[:2]) == pytest.approx(0.033, abs=1e-3) or abs(point[2]) == pytest.approx(0.06)
    moved = np.flatnonzero(grown.state.q != near.q)
    held = hand.tree.moves[[thumb.link, index.link]].any(axis=0)
    assert len(moved)
    assert not held[hand.independent[moved]].any()
    lower, upper = hand.limits.T
    assert np.all((lower <= grown.state.q) & (grown.state.q <= upper))


def _face(obj: ObjectModel, point: list[float]) -> int:
    middles = obj.mesh.triangles_center
    return int(np.argmin(np.linalg.norm(middles - np.array(point), axis=1)))
