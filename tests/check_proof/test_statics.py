"""Logs of statics: what is proved is accepted, and no forgery is, not even a sealed one."""

import copy
import gzip
import hashlib
import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from holdfast.check_proof import STATICS, check_proof
from holdfast.check_proof.exact_regions import read_chart
from holdfast.errors import InputError
from holdfast.geometry import BezierPatch, Cap, PointRegion
from holdfast.objects import ObjectRegion, Task, load_task
from holdfast.solver import best_friction, refute_balance, statics_form

from .logs import Records, line, read, write

FRICTION = 0.95 * 0.16058


def sealed(records: Records) -> Records:
    """With counts and checksum to match, as a forger would write them."""
    end = copy.deepcopy(next(r["end"] for r in records if "end" in r))
    body = [r for r in records if "end" not in r]
    digest = hashlib.sha256(b"".join(map(line, body))).hexdigest()
    return [*body, {"end": {**end, "boxes": sum("box" in r for r in body), "sha256": digest}}]


@pytest.fixture(scope="module")
def log(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("statics") / "handling.proof"
    refute_balance(load_task("handling"), friction=FRICTION, budget_s=60.0, proof=path)
    return path


@pytest.fixture
def records(log) -> Records:
    return read(log)


def verdict(records: Records, folder: Path, form: dict | None = None) -> str:
    return check_proof(write(folder / "forged.proof", records), form).reason


def test_what_is_proved_is_accepted(log, records):
    check = check_proof(log, statics_form(load_task("handling")))
    assert check.accepted and check.kind == STATICS and not check.with_hand
    assert check.friction == FRICTION
    assert check.boxes == sum("box" in r for r in records) > 20
    assert check.steps == sum("twist" in r for r in records) == (check.boxes + 1) // 2


def leaf(records: Records) -> dict:
    return next(r for r in records if "twist" in r)


def split(records: Records) -> dict:
    return next(r for r in records if "split" in r)


def patch(records: Records) -> list:
    return records[1]["form"]["contacts"][0][0]["patch"]


def end(records: Records) -> dict:
    return records[-1]["end"]


def _turn(records: Records) -> None:
    for r in records:
        if "twist" in r:
            r["twist"] = r["twist"][3:] + r["twist"][:3]


def _move_patch(records: Records) -> None:
    for row in patch(records):
        for point in row:
            point[1] += 0.01


def _less_leaning(records: Records) -> None:
    """The first region becomes the second one turned to face it: regions that need no friction."""
    form = records[1]["form"]
    form["contacts"][0] = copy.deepcopy(form["contacts"][1])
    for row in form["contacts"][0][0]["patch"]:
        row.reverse()
        for point in row:
            point[0] = -point[0]


def _other_twists(records: Records) -> None:
    leaves = [r for r in records if "twist" in r]
    twists = [r["twist"] for r in leaves]
    for r, twist in zip(leaves, twists[5:] + twists[:5], strict=True):
        r["twist"] = twist


def _claim_root(records: Records) -> None:
    twist = leaf(records)["twist"]
    records[2:-1] = [{"box": "0/", "twist": twist}]


def _swap(records: Records) -> None:
    records[2], records[3] = records[3], records[2]


def _drop_leaf(records: Records) -> None:
    records.remove(leaf(records))


def _drop_split(records: Records) -> None:
    records.remove(split(records))


def _double(records: Records) -> None:
    records.insert(-1, copy.deepcopy(leaf(records)))


def _both(records: Records) -> None:
    leaf(records)["split"] = [0, 0.5]


def _neither(records: Records) -> None:
    del leaf(records)["twist"]


def _second_form(records: Records) -> None:
    records.insert(2, copy.deepcopy(records[1]))


def _no_form(records: Records) -> None:
    del records[1]


def _late_form(records: Records) -> None:
    records.insert(4, records.pop(1))


def _reverse(records: Records) -> None:
    records[2:-1] = records[2:-1][::-1]


TAMPERINGS: dict[str, Callable[[Records], object]] = {
    "twist of zeros": lambda r: leaf(r).update(twist=[0] * 6),
    "twist the other way": lambda r: leaf(r).update(twist=[-x for x in leaf(r)["twist"]]),
    "twist with parts exchanged": _turn,
    "twists of other leaves": _other_twists,
    "twist too short": lambda r: leaf(r)["twist"].pop(),
    "twist too long": lambda r: leaf(r)["twist"].append(1),
    "twist of floats": lambda r: leaf(r).update(twist=[float(x) for x in leaf(r)["twist"]]),
    "twist of texts": lambda r: leaf(r).update(twist=[str(x) for x in leaf(r)["twist"]]),
    "twist of truths": lambda r: leaf(r).update(twist=[True] * 6),
    "twist beyond all size": lambda r: leaf(r).update(twist=[10**4000, 0, 0, 0, 0, 0]),
    "twist is missing": _neither,
    "leaf that is split as well": _both,
    "leaf left out": _drop_leaf,
    "leaf twice": _double,
    "split left out": _drop_split,
    "root called refuted": _claim_root,
    "children before their parent": _swap,
    "order turned round": _reverse,
    "split elsewhere": lambda r: split(r)["split"].__setitem__(1, 0.75),
    "split outside": lambda r: split(r)["split"].__setitem__(1, 1.5),
    "split at an end": lambda r: split(r)["split"].__setitem__(1, 0.0),
    "split at nothing": lambda r: split(r)["split"].__setitem__(1, None),
    "split of another parameter": lambda r: split(r)["split"].__setitem__(0, (split(r)["split"][0] + 2) % 6),
    "split of no parameter": lambda r: split(r)["split"].__setitem__(0, 6),
    "split of a parameter below all": lambda r: split(r)["split"].__setitem__(0, -1),
    "box of no tree": lambda r: leaf(r).update(box="0/2"),
    "box of another root": lambda r: leaf(r).update(box="1/"),
    "box without a name": lambda r: leaf(r).pop("box"),
    "box of a number": lambda r: leaf(r).update(box=7),
    "more friction": lambda r: end(r).update(friction=0.17),
    "friction in words": lambda r: end(r).update(friction="0.1"),
    "friction below zero": lambda r: end(r).update(friction=-0.1),
    "friction left out": lambda r: end(r).pop("friction"),
    "friction of nothing": lambda r: end(r).update(friction=None),
    "friction of a list": lambda r: end(r).update(friction=[0.1]),
    "regions left out": _no_form,
    "regions twice": _second_form,
    "regions late": _late_form,
    "patch moved": _move_patch,
    "patch turned over": lambda r: patch(r).reverse(),
    "patch without rows": lambda r: r[1]["form"]["contacts"][0][0].update(patch=[]),
    "patch with rows that differ": lambda r: patch(r)[0].pop(),
    "patch of points in a plane": lambda r: [point.pop() for row in patch(r) for point in row],
    "patch of huge numbers": lambda r: patch(r)[0][0].__setitem__(0, 1e300),
    "patch of tiny numbers": lambda r: patch(r)[0][0].__setitem__(0, 1e-300),
    "patch of whole numbers beyond floats": lambda r: patch(r)[0][0].__setitem__(0, 10**400),
    "patch with a key too many": lambda r: r[1]["form"]["contacts"][0][0].update(normal=[0, 0, 1]),
    "regions exchanged": lambda r: r[1]["form"]["contacts"].reverse(),
    "region of an unknown kind": lambda r: r[1]["form"]["contacts"][0].__setitem__(0, {"torus": 1}),
    "region that faces another": _less_leaning,
    "contact without regions": lambda r: r[1]["form"]["contacts"].__setitem__(0, []),
    "no contacts": lambda r: r[1]["form"].update(contacts=[], spin_arms_m=[]),
    "contact too many": lambda r: r[1]["form"]["contacts"].append(r[1]["form"]["contacts"][0]),
    "larger spin arm": lambda r: r[1]["form"].update(spin_arms_m=[0.05] * 3),
    "spin arm below zero": lambda r: r[1]["form"].update(spin_arms_m=[-0.01] * 3),
    "larger reach": lambda r: r[1]["form"].update(reaches_m=[0.01] * 3),
    "reach below zero": lambda r: r[1]["form"].update(reaches_m=[-0.01] * 3),
    "reach left out": lambda r: r[1]["form"].pop("reaches_m"),
    "spin arm left out": lambda r: r[1]["form"]["spin_arms_m"].pop(),
    "centre of mass elsewhere": lambda r: r[1]["form"]["centre_m"].__setitem__(0, 0.3),
    "centre of mass of two numbers": lambda r: r[1]["form"]["centre_m"].pop(),
    "no weight": lambda r: r[1]["form"].update(mass_kg=0.0),
    "weight below zero": lambda r: r[1]["form"].update(mass_kg=-1.0),
    "load along one way": lambda r: r[1]["form"].update(directions=[[0, 0, 1.0]]),
    "load along no way": lambda r: r[1]["form"].update(directions=[[0.0, 0.0, 0.0]]),
    "load along none": lambda r: r[1]["form"].update(directions=[]),
    "form is a list": lambda r: r[1].update(form=[]),
    "records of other things": lambda r: r.insert(3, {"remark": 1}),
    "something after the end": lambda r: r.append({"box": "0/"}),
}
# A force needs more of a torque about a farther centre, and less of it where spin is resisted less: these may
# leave a proof that is one, but of another task.
ANOTHER_TASK = {"centre of mass elsewhere", "regions exchanged", "patch moved"}


@pytest.mark.parametrize("name", sorted(TAMPERINGS))
def test_tampering_is_refused_though_it_is_sealed(records, tmp_path, name):
    TAMPERINGS[name](records)
    at_end = records[-1] if name == "something after the end" else None
    forged = sealed(records[:-1] if at_end else records)
    if "friction" in name:
        forged[-1]["end"] = {**forged[-1]["end"], **records[-1]["end"], "sha256": forged[-1]["end"]["sha256"]}
    reason = verdict([*forged, at_end] if at_end else forged, tmp_path)
    other = verdict([*forged, at_end] if at_end else forged, tmp_path, statics_form(load_task("handling")))
    assert other != ""
    if name not in ANOTHER_TASK:
        assert reason != "", name


def test_any_change_breaks_the_seal(records, tmp_path):
    for number, record in enumerate(records[:-1]):
        record["remark"] = 1
        assert verdict(records, tmp_path) != "", number
        del record["remark"]
    assert verdict(records, tmp_path) == ""
    end(records)["boxes"] += 1
    assert "was changed" in verdict(records, tmp_path)


def test_a_log_that_breaks_off_is_refused(log, records, tmp_path):
    assert "breaks off" in verdict(records[:-1], tmp_path)
    half = tmp_path / "half.proof"
    half.write_bytes(log.read_bytes()[: len(log.read_bytes()) // 2])
    assert not check_proof(half).accepted


@pytest.mark.parametrize("value", ["NaN", "Infinity", "-Infinity", "1e999"])
def test_numbers_that_are_none_are_refused(log, tmp_path, value):
    text = gzip.decompress(log.read_bytes()).decode()
    k = text.index('"centre_m":[') + len('"centre_m":[')
    path = tmp_path / "nan.proof"
    path.write_bytes(gzip.compress((text[:k] + value + text[text.index(",", k) :]).encode()))
    assert not check_proof(path).accepted


def test_less_friction_than_was_proved_is_proved_too(records, tmp_path):
    """Monotone: cones with less friction lie inside those with more."""
    end(records)["friction"] = 0.5 * FRICTION
    assert verdict(records, tmp_path) == ""


def test_it_is_of_this_task_and_no_other(log):
    handling = load_task("handling")
    assert "not those of the task" in check_proof(log, statics_form(load_task("upholding"))).reason
    contact = handling.contacts[0]
    moved = replace(
        contact.object.region.patch, control_points=contact.object.region.patch.control_points + 1e-12
    )
    region = replace(contact.object.region, patch=moved, off_surface=True)
    contacts = (replace(contact, object=ObjectRegion("moved", region)), *handling.contacts[1:])
    other: Task = replace(handling, contacts=contacts)
    assert "not those of the task" in check_proof(log, statics_form(other)).reason


def test_versions_and_heads(records, tmp_path):
    records[0]["holdfast_statics"] = 3
    with pytest.raises(InputError, match="newer Holdfast"):
        verdict(records, tmp_path)
    records[0]["holdfast_statics"] = True
    with pytest.raises(InputError, match="not a proof log"):
        verdict(records, tmp_path)
    records[0] = {"holdfast_statics": 1, "holdfast_proof": 4}
    with pytest.raises(InputError, match="not a proof log"):
        verdict(records, tmp_path)
    # As another kind of log it is read as that, and is none.
    records[0] = {"holdfast_proof": 4}
    assert verdict(records, tmp_path) != ""


def test_best_writes_what_it_has_proved_at_any_time(tmp_path):
    task = load_task("handling")
    for k, stop_after in enumerate((2, 40, 10**9)):
        path, steps = tmp_path / f"best{k}.proof", []

        def stop(steps: list = steps, most: int = stop_after) -> bool:
            steps.append(1)
            return len(steps) >= most

        best = best_friction(task, proof=path, should_stop=stop)
        check = check_proof(path, statics_form(task)) if best.proof_written else None
        assert check is None or (check.accepted and check.friction == best.bound)
    assert best.gap <= 0.02 and check is not None


def test_wide_contacts_are_replayed(tmp_path):
    task, path = load_task("handling"), tmp_path / "wide.proof"
    wide = refute_balance(task, friction=0.09, reach_m=0.003, budget_s=60.0, proof=path)
    assert wide.verdict.value == "infeasible"
    assert check_proof(path).accepted
    # It is no log of the task's points, though what holds for discs holds for points as well.
    assert "not those of the task" in check_proof(path, statics_form(task)).reason
    forged = read(path)
    forged[1]["form"]["reaches_m"] = [0.02] * 3
    assert "does not show" in verdict(sealed(forged), tmp_path)
    forged[1]["form"]["reaches_m"] = [0.0] * 3
    assert verdict(sealed(forged), tmp_path) == ""


def test_caps_and_points_are_replayed(tmp_path):
    task = load_task("upholding")
    centre = np.asarray(task.object.inertia.centre)
    cap = Cap(
        centre + np.array([0.02, 0.0, 0.0]), 0.01, np.array([0.36, 0.932952, 0.0]), 0.4, off_surface=True
    )
    point = PointRegion(centre - np.array([0.02, 0.0, 0.0]), np.array([-0.6, 0.8, 0.0]), off_surface=True)
    regions = [cap, point]
    contacts = tuple(
        replace(c, object=ObjectRegion(f"r{k}", region))
        for k, (c, region) in enumerate(zip(task.contacts, regions, strict=True))
    )
    task, path = replace(task, contacts=contacts), tmp_path / "caps.proof"
    best = best_friction(task, proof=path)
    check = check_proof(path, statics_form(task))
    assert check.accepted and check.friction == best.bound > 0.0
    forged = read(path)
    forged[1]["form"]["contacts"][0][0]["reach"] *= 4.0
    assert verdict(sealed(forged), tmp_path) != ""
    forged = read(path)
    forged[1]["form"]["contacts"][0][0]["axes"].pop()
    assert verdict(sealed(forged), tmp_path) != ""


def test_exact_parts_are_those_of_the_region():
    rng = np.random.default_rng(2)
    net = rng.normal(size=(3, 4, 3)).round(3)
    chart = read_chart({"patch": net.tolist()}, [Fraction(0)] * 3)
    whole = chart.over((Fraction(0), Fraction(1)), (Fraction(0), Fraction(1)))
    part = chart.over((Fraction(1, 4), Fraction(1, 2)), (Fraction(0), Fraction(1, 8)))
    for at, corner in ((whole.points[0, 0], net[0, 0]), (whole.points[-1, -1], net[-1, -1])):
        assert [Fraction(x, at[3]) / 16 for x in at[:3]] == [Fraction(float(x)) for x in corner]
    # The part's corner at (1/2, 1/8) is the patch there, which floats give but for rounding.
    at = part.points[-1, -1]
    assert np.allclose(
        [float(Fraction(x, at[3]) / 16) for x in at[:3]], BezierPatch(net).evaluate(0.5, 0.125), atol=1e-12
    )
    assert part.points.shape == (3, 4, 4) and part.normals.shape == (4, 6, 3)
    json.dumps(statics_form(load_task("handling")))
