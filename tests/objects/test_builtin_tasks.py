"""The built-in tasks: the nine of the paper twice, with published regions and with our own."""

import time
from pathlib import Path

import holdfast.objects
import numpy as np
import pytest
from holdfast.geometry import Cap, Patch
from holdfast.objects import LiftTest, PressTest, TurnTest, builtin_tasks, load_object, load_task
from holdfast.objects.object_file import read_object
from holdfast.retraction import ClearConfiguration, retract
from holdfast.solver import Verdict, solve

DATA = Path(holdfast.objects.__file__).parent / "data"
NINE = {
    "upholding": ("scalpel", 2, LiftTest),
    "handling": ("scalpel", 3, LiftTest),
    "incision": ("scalpel", 4, LiftTest),
    "lid_lifting": ("teapot", 2, LiftTest),
    "service": ("teapot", 3, LiftTest),
    "transportation": ("teapot", 4, LiftTest),
    "tuning": ("guitar", 2, TurnTest),
    "playing": ("guitar", 3, PressTest),
    "holding": ("guitar", 4, LiftTest),
}
NEVER_PUBLISHED = {"playing", "holding"}
PUBLISHED = [name for name in NINE if name not in NEVER_PUBLISHED]
MOVED = {"lid_lifting": ["lid"], "tuning": ["key_3"], "playing": []}


def test_all_nine_are_there_twice():
    names = set(builtin_tasks())
    assert set(NINE) <= names
    assert {name for name in names if name.startswith("paper/")} == {f"paper/{name}" for name in PUBLISHED}


@pytest.mark.parametrize("name", NINE)
def test_objects_contacts_and_tests(name):
    obj, contacts, kind = NINE[name]
    for task in [load_task(name)] + ([load_task(f"paper/{name}")] if name in PUBLISHED else []):
        assert task.object.name.removesuffix("_real") == obj
        assert len(task.contacts) == contacts
        assert isinstance(task.test, kind)
        moved = MOVED.get(name, [part.name for part in task.object.parts])
        assert [part.name for part in task.carried] == moved


@pytest.mark.parametrize("name", builtin_tasks())
def test_a_task_is_found_by_its_object_too(name):
    task = load_task(name)
    assert load_task(f"{task.object.name}/{name}") is task
    # Run folders of different tasks have different names.
    assert task.name == name.replace("/", "_")


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_tasks_are_the_published_ones(name, published_tasks):
    (published,) = [task for task in published_tasks if task["task"].replace(" ", "_") == name]
    task = load_task(f"paper/{name}")
    assert task.hand.name == "sa" and np.array_equal(task.limits, task.hand.limits)
    for contact, expected in zip(task.contacts, published["contacts"], strict=True):
        cap, given = contact.hand.region, expected["cap"]
        assert isinstance(cap, Cap)
        assert task.hand.links[contact.hand.link].name == expected["hand_link"].replace(" ", "_")
        assert 1e3 * cap.centre == pytest.approx(given["centre_mm"], abs=1e-9)
        assert 1e3 * cap.radius == pytest.approx(given["radius_mm"])
        assert cap.axis == pytest.approx(np.array(given["axis"]) / np.linalg.norm(given["axis"]))
        assert np.rad2deg(cap.half_angle_rad) == pytest.approx(given["half_angle_deg"])
        patch = contact.object.region
        assert isinstance(patch, Patch)
        net = expected["object_patch_mm"]["control_points"]
        assert 1e3 * patch.patch.control_points == pytest.approx(np.array(net), abs=1e-9)


@pytest.mark.parametrize("name", sorted(set(NINE) - {"upholding"}))
def test_plain_tasks_use_named_regions_on_the_surfaces(name):
    """Regions of the hand's own file, which lie on its links, and free-form patches on the object."""
    task = load_task(name)
    flat = {"bottom_palm"}  # the teapot stands on it
    for contact in task.contacts:
        assert contact.hand is task.hand.regions[contact.hand.name]
        patch = contact.object.region
        assert patch is task.object.regions[contact.object.name]
        assert isinstance(patch, Patch)
        assert contact.object.name in flat or max(patch.patch.degree) >= 2


@pytest.mark.slow
@pytest.mark.parametrize("name", [*NINE, *(f"paper/{name}" for name in PUBLISHED)])
def test_every_task_has_certified_grasps(name):
    result = solve(load_task(name), candidates=4, budget_s=120.0)
    assert result.verdict is Verdict.SOLVED
    assert all(configuration.certified for configuration in result.configurations)
    # Published regions need not lie on our bodies: a cap on the hand, up to 13 mm inside its link.
    if name in NINE:
        outcomes = [retract(configuration) for configuration in result.configurations]
        assert all(isinstance(outcome, ClearConfiguration) for outcome in outcomes)


@pytest.mark.parametrize("name", sorted({load_task(name).object.name for name in builtin_tasks()}))
def test_built_in_objects_load_fast(name):
    """Built anew, and once more from what is cached; processor time, as the machine may be busy."""
    load_object(name)
    started = time.process_time()
    read_object(DATA / f"{name}.yaml")
    assert time.process_time() - started < 1.5
