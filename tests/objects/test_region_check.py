"""Regions of contacts that lie off their bodies or face inwards: refused from files and from Python."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
import yaml
from holdfast.errors import InputError
from holdfast.geometry import BezierPatch, Patch, PointRegion
from holdfast.hands import HandRegion, load_hand
from holdfast.objects import (
    Contact,
    ObjectRegion,
    Task,
    builtin_objects,
    builtin_tasks,
    fit_patch,
    load_object,
    load_task,
    object_placement,
)

BALL = {"name": "ball", "sphere": {"radius": 0.03}, "mass": 0.1, "friction": 0.8}
BAR = {"name": "bar", "box": {"half_extents": [0.01, 0.05, 0.01]}, "mass": 0.1, "friction": 0.8}
TOP = [[[-0.008, -0.02, 0.01], [-0.008, 0.02, 0.01]], [[0.008, -0.02, 0.01], [0.008, 0.02, 0.01]]]
BELOW = [[[x, y, -z] for x, y, z in row] for row in TOP[::-1]]


def lifted(net, by):
    return np.add(net, [0.0, 0.0, by]).tolist()


def write(folder, top, thumb="thumb/tip", obj=BAR):
    """A task that pinches the bar, whose upper region is `top`."""
    described = {**obj, "regions": {"top": top, "below": {"bezier": BELOW}}}
    (folder / "bar.yaml").write_text(yaml.safe_dump(described))
    contacts = [{"hand": "index/tip", "object": "top"}, {"hand": thumb, "object": "below"}]
    path = folder / "pinch.yaml"
    path.write_text(
        yaml.safe_dump({"name": "pinch", "hand": "sa", "object": "bar.yaml", "contacts": contacts})
    )
    return path


FAULTS = {
    "in the air": (
        {"bezier": lifted(TOP, 0.003)},
        ("3 mm off the surface of bar", "at most 0.5 mm", "move it"),
    ),
    "sunk": ({"bezier": lifted(TOP, -0.003)}, ("3 mm off the surface of bar",)),
    "turned": ({"bezier": TOP[::-1]}, ("turned inwards", "180 deg", "rows in the reverse order")),
    "a cap in the air": (
        {"cap": {"centre": [0, 0, 0.012], "radius": 0.002, "axis": [0, 0, 1], "half_angle_deg": 20}},
        ("off the surface of bar",),
    ),
    "a point turned": ({"point": [0, 0, 0.01], "normal": [0, 0, -1]}, ("turned inwards", "turn its normal")),
}


@pytest.mark.parametrize("case", FAULTS)
def test_a_region_off_its_object_is_refused_in_a_file_and_goes_through_where_meant(tmp_path, case):
    top, words = FAULTS[case]
    with pytest.raises(InputError) as caught:
        load_task(write(tmp_path, top))
    message = str(caught.value)
    assert "pinch.yaml: contacts.0.object: region 'top'" in message and "\n" not in message
    for word in (*words, "`off_surface: true`"):
        assert word in message
    task = load_task(write(tmp_path, {**top, "off_surface": True}))
    assert task.contacts[0].object.region.off_surface
    # The object alone can be loaded, so that it can be looked at.
    write(tmp_path, top)
    assert "top" in load_object(tmp_path / "bar.yaml").regions


def test_four_tenths_of_a_millimetre_are_allowed(tmp_path):
    assert load_task(write(tmp_path, {"bezier": lifted(TOP, 4e-4)})).name == "pinch"


@pytest.mark.parametrize(
    ("cap", "words"),
    [
        (
            {"centre": [0.0253, 0, 0.003], "radius": 0.013, "axis": [0, 0, 1], "half_angle_deg": 20},
            "off the surface",
        ),
        (
            {"centre": [0.0253, 0, 0.026], "radius": 0.013, "axis": [0, 0, -1], "half_angle_deg": 5},
            "turned inwards",
        ),
    ],
)
def test_a_region_off_its_link_is_refused_in_a_file_and_goes_through_where_meant(tmp_path, cap, words):
    thumb = {"link": "thumb_distal", "cap": cap}
    with pytest.raises(
        InputError, match=f"contacts.1.hand: region 'thumb_distal/inline' .*{words}.*thumb_distal"
    ):
        load_task(write(tmp_path, {"bezier": TOP}, thumb))
    assert load_task(write(tmp_path, {"bezier": TOP}, {**thumb, "off_surface": True})).name == "pinch"


def test_the_field_is_a_truth_value(tmp_path):
    with pytest.raises(InputError, match=r"regions.top.off_surface: .*boolean"):
        load_task(write(tmp_path, {"bezier": TOP, "off_surface": "allowed"}))
    with pytest.raises(InputError, match="did you mean 'off_surface'"):
        load_task(write(tmp_path, {"bezier": TOP, "off_surfaces": True}))


@pytest.mark.parametrize(
    ("height", "turned", "words"), [(0.003, False, "3 mm off"), (0.0, True, "turned inwards")]
)
def test_the_same_in_python(tmp_path, height, turned, words):
    write(tmp_path, {"bezier": TOP})
    bar = load_object(tmp_path / "bar.yaml")
    net = np.array(lifted(TOP, height))[:: -1 if turned else 1]
    for given in (
        net,
        BezierPatch(net),
        Patch(BezierPatch(net)),
        ObjectRegion("here", Patch(BezierPatch(net))),
    ):
        with pytest.raises(InputError, match=rf"Task: contacts.0.object: region '.*' .*{words}"):
            Task(hand="sa", object=bar, contacts={"index/tip": given})
    meant = Patch(BezierPatch(net), off_surface=True)
    assert Task(hand="sa", object=bar, contacts={"index/tip": meant}).contacts[0].object.region is meant


def test_the_same_for_regions_of_the_hand_in_python(tmp_path):
    write(tmp_path, {"bezier": TOP})
    hand, bar = load_hand("sa"), load_object(tmp_path / "bar.yaml")
    tip = hand.regions["index/tip"]
    moved = replace(tip.region, centre=np.add(tip.region.centre, [0, 0, 0.003]))
    below = ObjectRegion("top", bar.regions["top"])
    with pytest.raises(
        InputError, match=r"contacts.0.hand: region 'index/off' lies .* mm off the surface of link"
    ):
        Task(hand=hand, object=bar, contacts=[Contact(HandRegion("index/off", tip.link, moved), below)])


@pytest.mark.parametrize("subdivisions", [2, 3])
def test_patches_fitted_to_a_mesh_pass(subdivisions):
    """The fit measures itself against the facets by code of its own."""
    mesh = trimesh.creation.icosphere(subdivisions=subdivisions, radius=0.04)
    fit = fit_patch(mesh, np.array([0.03, 0.02, 0.01]), 0.008)
    ball = load_object(mesh)
    placement = object_placement(ball, Patch(fit.patch))
    assert placement.off_m <= placement.farthest_m <= 1.05 * fit.max_m
    assert placement.normal_rad <= fit.normal_rad
    assert Task(hand="sa", object=ball, contacts={"index/tip": fit.patch}).object is ball


def test_the_surface_is_that_of_every_part(tmp_path):
    parts = {
        "pot": {"cylinder": {"radius": 0.04, "length": 0.08}, "mass": 0.4},
        "knob": {"sphere": {"radius": 0.05}, "mass": 0.1},
    }
    path = tmp_path / "pot.yaml"
    path.write_text(yaml.safe_dump({"name": "pot", "parts": parts, "friction": 0.5}))
    pot = load_object(path)
    on_the_knob = PointRegion(np.array([0.05, 0, 0]), np.array([1.0, 0, 0]))
    assert object_placement(pot, on_the_knob).off_m < 1e-4


@pytest.mark.parametrize(
    "name",
    [*builtin_objects(), *(f"family:{f}:{s}" for f in ("bottle", "box", "cylinder") for s in (0, 5, 91))]
    + [f"family:{f}:{s}" for f in ("handle", "mug", "plate") for s in (0, 5, 91)],
)
def test_regions_of_built_in_objects_lie_on_them(name):
    obj = load_object(name)
    for key, region in obj.regions.items():
        placement = object_placement(obj, region)
        if region.off_surface:
            assert key.startswith("paper_") and placement.is_off
        elif not key.startswith("paper_"):
            assert placement.farthest_m < 1e-4 and placement.normal_rad < 0.2, key


def test_only_published_regions_are_meant_to_lie_off():
    for name in builtin_tasks():
        sides = [side.region for c in load_task(name).contacts for side in (c.hand, c.object)]
        assert any(region.off_surface for region in sides) == name.startswith("paper/")


def test_a_region_on_a_link_that_the_hand_lacks_is_refused(tmp_path):
    write(tmp_path, {"bezier": TOP})
    bar = load_object(tmp_path / "bar.yaml")
    region = HandRegion("nowhere", 99, load_hand("sa").regions["index/tip"].region)
    for given in ({region: "top"}, [Contact(region, ObjectRegion("top", bar.regions["top"]))]):
        with pytest.raises(InputError, match=r"contacts.0.hand: lies on link 99, which hand sa lacks"):
            Task(hand="sa", object=bar, contacts=given)
