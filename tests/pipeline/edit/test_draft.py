"""A draft is a task in the making: what can't be keeps it as it was, and changes outdate what was solved."""

import numpy as np
import pytest
import trimesh
from holdfast.errors import InputError, UnknownName
from holdfast.objects import load_task
from holdfast.pipeline.edit import Draft, EditSource, surface_hit


def test_a_ray_hits_the_surface_where_it_first_meets_it() -> None:
    ball = trimesh.creation.icosphere(subdivisions=4, radius=0.05)
    rng = np.random.default_rng(0)
    for direction in rng.normal(size=(20, 3)):
        direction /= np.linalg.norm(direction)
        hit = surface_hit(ball, -0.3 * direction, direction)
        assert hit == pytest.approx(-0.05 * direction, abs=2e-4)
        assert surface_hit(ball, 0.3 * direction, direction) is None, "it lies behind"
    assert surface_hit(ball, np.array([0.06, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])) is None


def test_a_region_is_placed_sized_and_left_alone_where_it_does_not_fit(
    of_block: tuple[Draft, EditSource],
) -> None:
    draft, _ = of_block
    fit = draft.place(0, np.array([0.015, 0.01, 0.001]))
    assert fit.max_m < 1e-9 and fit.centre == pytest.approx([0.015, 0.01, 0.001])
    small = draft.pairs[0]
    assert small.object is not None and small.object.region.patch.unit_normal(0.5, 0.5) == pytest.approx(
        [1.0, 0.0, 0.0]
    )
    draft.resize(0, 0.004)
    corners = draft.pairs[0].object.region.patch.control_points[[0, 0, -1, -1], [0, -1, 0, -1]]
    assert np.linalg.norm(corners - fit.centre, axis=1) == pytest.approx([0.004] * 4)
    before = draft.pairs[0]
    with pytest.raises(InputError, match="too large here"):
        draft.resize(0, 0.03)
    with pytest.raises(InputError, match="from the surface"):
        draft.place(0, np.array([0.5, 0.0, 0.0]))
    assert draft.pairs[0] is before


def test_an_open_or_repeated_pair_makes_no_task() -> None:
    task = load_task("upholding")
    draft = Draft(task.hand, task.object, task)
    assert [c.object for c in draft.task().contacts] == [c.object for c in task.contacts]
    assert draft.task().test == task.test
    number = draft.add()
    with pytest.raises(InputError, match=r"contact 3: .* no place yet"):
        draft.task()
    draft.choose_hand(number, draft.pairs[0].hand.name)
    draft.choose_object(number, draft.pairs[0].object.name)
    with pytest.raises(InputError, match="stands twice"):
        draft.task()
    with pytest.raises(UnknownName, match="did you mean"):
        draft.choose_hand(number, "thumb/tp")
    draft.remove(number)
    draft.remove(1)
    with pytest.raises(InputError, match="at least one"):
        draft.remove(0)


def test_what_was_solved_is_outdated_by_a_change(of_block: tuple[Draft, EditSource]) -> None:
    draft, _ = of_block
    draft.place(0, np.array([0.015, 0.0, 0.0]))
    result = draft.solve(candidates=1, budget_s=60.0)
    assert draft.result is result and result[0].certified
    draft.resize(0, 0.005)
    assert draft.result is None
