import numpy as np
import pytest
from holdfast.base.files.file_model import parse
from holdfast.errors import InputError
from holdfast.geometry import Cap, Patch, PointRegion, RegionSpec, build_region

FLAT = [[[0, 0, 0], [0, 0.02, 0]], [[0.01, 0, 0], [0.01, 0.02, 0]]]


def build(data):
    return build_region(parse(RegionSpec, data, "file"), "file", "regions.r")


def test_cap():
    cap = build({"cap": {"centre": [0, 0, 1], "radius": 0.1, "axis": [0, 3, 4], "half_angle_deg": 60}})
    assert isinstance(cap, Cap)
    assert cap.axis == pytest.approx([0, 0.6, 0.8])
    points, normals = cap.sample(500, np.random.default_rng(0))
    assert points == pytest.approx(cap.centre + cap.radius * normals)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(500))
    cosines = normals @ cap.axis
    assert cosines.min() >= 0.5 - 1e-12
    # Uniform by area means uniform in the height above the base (Archimedes).
    assert cosines.mean() == pytest.approx(0.75, abs=0.02)


def test_patch():
    patch = build({"bezier": FLAT})
    assert isinstance(patch, Patch)
    points, normals = patch.sample(50, np.random.default_rng(0))
    assert points[:, 2] == pytest.approx(np.zeros(50))
    assert normals == pytest.approx(np.tile([0, 0, 1], (50, 1)))


def test_point():
    region = build({"point": [1, 2, 3], "normal": [0, 0, -5]})
    assert isinstance(region, PointRegion)
    points, normals = region.sample(3, np.random.default_rng(0))
    assert points == pytest.approx(np.tile([1, 2, 3], (3, 1)))
    assert normals == pytest.approx(np.tile([0, 0, -1], (3, 1)))


def with_cap(**changes):
    return {"cap": {"centre": [0, 0, 0], "radius": 0.01, "axis": [0, 0, 1], "half_angle_deg": 60, **changes}}


BAD = {
    "nothing": ({}, "regions", "exactly one of"),
    "two kinds": ({"bezier": FLAT, "point": [0, 0, 0], "normal": [0, 0, 1]}, "", "exactly one of"),
    "point alone": ({"point": [0, 0, 0]}, "", "needs a normal"),
    "normal beside a patch": ({"bezier": FLAT, "normal": [0, 0, 1]}, "", "needs a normal"),
    "zero normal": ({"point": [0, 0, 0], "normal": [0, 0, 0]}, "normal", "zero vector"),
    "zero axis": (with_cap(axis=[0, 0, 0]), "cap.axis", "zero vector"),
    "half angle 0": (with_cap(half_angle_deg=0), "half_angle_deg", "greater than 0"),
    "half angle 200": (with_cap(half_angle_deg=200), "half_angle_deg", "180"),
    "half angle as text": (with_cap(half_angle_deg="60"), "half_angle_deg", "number"),
    "half angle true": (with_cap(half_angle_deg=True), "half_angle_deg", "number"),
    "radius negative": (with_cap(radius=-0.01), "radius", "metres"),
    "radius tiny": (with_cap(radius=1e-12), "radius", "metres"),
    "radius in mm": (with_cap(radius=1300.0), "radius", "metres"),
    "centre NaN": (with_cap(centre=[0, float("nan"), 0]), "cap.centre.1", "finite"),
    "centre infinite": (with_cap(centre=[float("inf"), 0, 0]), "cap.centre.0", "finite"),
    "centre far": (with_cap(centre=[1e12, 0, 0]), "cap.centre.0", "100 m"),
    "centre of two numbers": (with_cap(centre=[0, 0]), "cap.centre.2", "required"),
    "ragged net": ({"bezier": [FLAT[0], [*FLAT[1], [0, 0, 1]]]}, "bezier", "same number"),
    "1 x 2 net": ({"bezier": FLAT[:1]}, "bezier", "2 x 2"),
    "2 x 1 net": ({"bezier": [FLAT[0][:1], FLAT[1][:1]]}, "bezier", "2 x 2"),
    "empty net": ({"bezier": []}, "bezier", "2 x 2"),
    "empty rows": ({"bezier": [[], []]}, "bezier", "2 x 2"),
    "degree 10": (
        {"bezier": [[[i, j, 0] for j in range(2)] for i in range(11)]},
        "bezier",
        "degrees up to 9",
    ),
    "collapsed": ({"bezier": [[FLAT[0][0]] * 2, FLAT[1]]}, "bezier", "degenerate"),
    "a point four times": ({"bezier": [[[1, 1, 1]] * 2] * 2}, "bezier", "metres"),
    "a line": ({"bezier": [[[0, 0, 0], [0.01, 0, 0]], [[0.02, 0, 0], [0.03, 0, 0]]]}, "bezier", "degenerate"),
    "numbers for points": ({"bezier": [[1, 2], [3, 4]]}, "bezier.0.0", "tuple"),
}


@pytest.mark.parametrize(("data", "field", "words"), BAD.values(), ids=BAD.keys())
def test_bad_regions_are_refused(data, field, words):
    with pytest.raises(InputError) as caught:
        build(data)
    assert words in str(caught.value)
    assert field in str(caught.value) or caught.value.field == ""
    assert "\n" not in str(caught.value)
