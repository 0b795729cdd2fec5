"""Why a task is infeasible: relaxations widen it, one at a time, and each claim is solved or refuted."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Patch
from holdfast.objects import Contact, ObjectRegion, Task, load_task
from holdfast.solver import Verdict
from holdfast.solver.tasks.explain import RelaxationKind, explain_infeasible, relaxations

from ..plates import plate_faces


def plate(half_thickness_m: float) -> Task:
    """`upholding` with the two faces of a plate in place of the scalpel's grips."""
    task = load_task("upholding")
    faces = map(ObjectRegion, ("below", "above"), plate_faces(half_thickness_m))
    return replace(task, contacts=tuple(map(Contact, (c.hand for c in task.contacts), faces)))


def test_every_contact_working_joint_and_region_is_relaxed_once() -> None:
    task = plate(0.13)
    listed = [(kind, name) for kind, name, _ in relaxations(task)]
    assert len(set(listed)) == len(listed)
    of = {kind: [name for k, name in listed if k is kind] for kind in RelaxationKind}
    assert of[RelaxationKind.CONTACT] == ["index/tip - below", "thumb/tip - above"]
    fingers = {name.split("_")[0] for name in of[RelaxationKind.LIMIT]}
    assert fingers == {"index", "thumb"}, "joints of fingers without a contact can't be the reason"
    assert len(of[RelaxationKind.LIMIT]) == 7
    assert set(of[RelaxationKind.REGION]) == {"index/tip", "below", "thumb/tip", "above"}


def test_relaxed_tasks_allow_all_that_the_task_allows_and_grow_step_by_step() -> None:
    task = plate(0.13)
    rng = np.random.default_rng(0)
    for kind, _, steps in relaxations(task):
        before = task
        for _, relaxed in steps:
            assert np.all(relaxed.limits[:, 0] <= before.limits[:, 0])
            assert np.all(relaxed.limits[:, 1] >= before.limits[:, 1])
            if kind is RelaxationKind.LIMIT:
                assert np.sum(np.any(relaxed.limits != task.limits, axis=1)) == 1
            if kind is RelaxationKind.REGION:
                for old, new in zip(task.contacts, relaxed.contacts, strict=True):
                    check_contains(new.object.region, old.object.region, rng)
            before = relaxed


def check_contains(larger: object, smaller: object, rng: np.random.Generator) -> None:
    """Points of the smaller patch lie on the larger one, at parameters inside the unit square."""
    if not isinstance(smaller, Patch) or larger is smaller:
        return
    assert isinstance(larger, Patch)
    fine = np.linspace(0.0, 1.0, 401)
    surface = larger.patch.evaluate(fine[:, None], fine[None, :]).reshape(-1, 3)
    size = np.ptp(surface, axis=0).max()
    for point in smaller.sample(5, rng)[0]:
        assert np.linalg.norm(surface - point, axis=1).min() < 3e-3 * size


def test_a_curved_patch_is_continued_along_its_own_surface() -> None:
    rng = np.random.default_rng(1)
    patch = BezierPatch(rng.normal(size=(4, 3, 3)))
    wider = patch.restrict((-0.25, 1.25), (-0.25, 1.25))
    u, v = rng.uniform(size=(2, 20))
    assert wider.evaluate((u + 0.25) / 1.5, (v + 0.25) / 1.5) == pytest.approx(
        patch.evaluate(u, v), abs=1e-12
    )


def test_a_plate_too_thick_is_possible_without_either_contact() -> None:
    seen: list[int] = []

    def after_the_contacts() -> bool:
        seen.append(1)
        return len(seen) > 2

    found = explain_infeasible(plate(0.13), budget_s=30.0, should_stop=after_the_contacts)
    assert [r.kind for r in found] == [RelaxationKind.CONTACT, RelaxationKind.CONTACT]
    assert all(r.verdict is Verdict.SOLVED for r in found)
    assert str(found[0]) == "possible without the contact of index/tip with below"
