"""Logs of the load: what is proved is accepted, and no forgery is, not even a sealed one."""

import copy
import hashlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from holdfast.check_proof import LOAD, check_proof
from holdfast.geometry import Cap, PointRegion
from holdfast.objects import ObjectRegion, load_task
from holdfast.solver import best_load, load_form, statics_form

from .logs import Records, line, read, write


def sealed(records: Records) -> Records:
    """With counts and checksum to match, as a forger would write them."""
    body = [r for r in records if "end" not in r]
    digest = hashlib.sha256(b"".join(map(line, body))).hexdigest()
    end = {**records[-1]["end"], "sha256": digest}
    if end.get("boxes") is not None:
        end["boxes"] = sum("box" in r for r in body)
    return [*body, {"end": end}]


@pytest.fixture(scope="module")
def log(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("load") / "handling.proof"
    steps: list[int] = []
    best_load(
        load_task("handling"),
        proof=path,
        gap=0.001,
        on_progress=lambda *_: steps.append(1),
        should_stop=lambda: len(steps) > 10,
    )
    return path


@pytest.fixture
def records(log) -> Records:
    return read(log)


def verdict(records: Records, folder: Path, form: dict | None = None) -> str:
    return check_proof(write(folder / "forged.proof", records), form).reason


def test_what_is_proved_is_accepted(log, records):
    check = check_proof(log, load_form(load_task("handling")))
    assert check.accepted and check.kind == LOAD
    assert check.multiple == records[-1]["end"]["multiple"] > 20.0 and check.force_N == 30.0
    assert check.boxes == sum("box" in r for r in records) > 10 and check.friction is None
    assert check.steps == sum("twist" in r for r in records) == (check.boxes + 1) // 2


def leaf(records: Records) -> dict:
    return next(r for r in records if "twist" in r)


def split(records: Records) -> dict:
    return next(r for r in records if "split" in r)


def form(records: Records) -> dict:
    return records[1]["form"]


def end(records: Records) -> dict:
    return records[-1]["end"]


def _other_twists(records: Records) -> None:
    leaves = [r for r in records if "twist" in r]
    twists = [r["twist"] for r in leaves]
    for r, twist in zip(leaves, twists[3:] + twists[:3], strict=True):
        r["twist"] = twist


def _all(records: Records, change: Callable[[dict], object]) -> None:
    for r in records:
        if "twist" in r:
            change(r)


def _claim_root(records: Records) -> None:
    known = leaf(records)
    records[2:-1] = [{**known, "box": "0/"}]


def _turn_form(records: Records) -> None:
    records[0] = {"holdfast_statics": 1}


TAMPERINGS: dict[str, Callable[[Records], object]] = {
    "a smaller multiple": lambda r: end(r).update(multiple=0.99 * end(r)["multiple"]),
    "no multiple at all": lambda r: end(r).update(multiple=0.0),
    "a multiple below zero": lambda r: end(r).update(multiple=-1.0),
    "a multiple in words": lambda r: end(r).update(multiple="3"),
    "multiple left out": lambda r: end(r).pop("multiple"),
    "friction claimed instead": lambda r: end(r).update(friction=end(r).pop("multiple")),
    "twist of zeros": lambda r: leaf(r).update(twist=[0] * 6),
    "twist that only turns": lambda r: leaf(r).update(twist=[0, 0, 0, *leaf(r)["twist"][3:]]),
    "twists the other way": lambda r: _all(r, lambda x: x.update(twist=[-t for t in x["twist"]])),
    "twists with parts exchanged": lambda r: _all(
        r, lambda x: x.update(twist=x["twist"][3:] + x["twist"][:3])
    ),
    "twist too short": lambda r: leaf(r)["twist"].pop(),
    "twist of floats": lambda r: leaf(r).update(twist=[float(x) for x in leaf(r)["twist"]]),
    "twist beyond all size": lambda r: leaf(r).update(twist=[10**4000, 0, 0, 0, 0, 0]),
    "twist left out": lambda r: leaf(r).pop("twist"),
    "normals turned round": lambda r: leaf(r).update(along=[[-x for x in e] for e in leaf(r)["along"]]),
    "normals of zeros": lambda r: leaf(r).update(along=[[0, 0, 0]] * 3),
    "normals of too few contacts": lambda r: leaf(r)["along"].pop(),
    "normals of floats": lambda r: leaf(r)["along"][0].__setitem__(0, 0.5),
    "normals of a list": lambda r: leaf(r)["along"].__setitem__(0, 7),
    "normals left out": lambda r: leaf(r).pop("along"),
    "normals across": lambda r: _all(r, lambda x: x.update(along=[[e[1], -e[0], 0] for e in x["along"]])),
    "leaf left out": lambda r: r.remove(leaf(r)),
    "leaf twice": lambda r: r.insert(-1, copy.deepcopy(leaf(r))),
    "leaf that is split as well": lambda r: leaf(r).update(split=[0, 0.5]),
    "split left out": lambda r: r.remove(split(r)),
    "split outside": lambda r: split(r)["split"].__setitem__(1, 1.5),
    "root called bounded": _claim_root,
    "friction left out": lambda r: form(r).pop("friction"),
    "more friction": lambda r: form(r).update(friction=0.9),
    "friction below zero": lambda r: form(r).update(friction=-0.1),
    "stronger contacts": lambda r: form(r).update(forces_N=[31.0] * 3),
    "a force of nothing": lambda r: form(r).update(forces_N=[0.0] * 3),
    "a force too few": lambda r: form(r)["forces_N"].pop(),
    "a lighter load": lambda r: form(r).update(mass_kg=0.5 * form(r)["mass_kg"]),
    "no weight": lambda r: form(r).update(mass_kg=0.0),
    "less gravity": lambda r: form(r).update(gravity=1.62),
    "no gravity": lambda r: form(r).update(gravity=0.0),
    "larger spin arm": lambda r: form(r).update(spin_arms_m=[0.05] * 3),
    "reaches beside": lambda r: form(r).update(reaches_m=[0.01] * 3),
    "regions left out": lambda r: r.pop(1),
    "regions twice": lambda r: r.insert(2, copy.deepcopy(r[1])),
    "a contact too many": lambda r: form(r)["contacts"].append(form(r)["contacts"][0]),
    "the head of another kind": _turn_form,
    "something after the end": lambda r: r.append({"box": "0/"}),
}


@pytest.mark.parametrize("name", sorted(TAMPERINGS))
def test_tampering_is_refused_though_it_is_sealed(records, tmp_path, name):
    TAMPERINGS[name](records)
    beyond = [records.pop()] if name == "something after the end" else []
    forged = [*sealed(records), *beyond]
    assert verdict(forged, tmp_path) != "", name
    assert verdict(forged, tmp_path, load_form(load_task("handling"))) != ""


def test_twists_of_other_leaves_show_something_too(records, tmp_path):
    """Any twist that moves shows something, if not as much."""
    _other_twists(records)
    end(records)["multiple"] *= 1e4
    assert verdict(sealed(records), tmp_path) == ""


def test_a_larger_multiple_is_proved_too(records, tmp_path):
    end(records)["multiple"] *= 1.5
    assert verdict(records, tmp_path) == ""


def test_any_change_breaks_the_seal(records, tmp_path):
    for number, record in enumerate(records[:-1]):
        record["remark"] = 1
        assert verdict(records, tmp_path) != "", number
        del record["remark"]
    assert verdict(records, tmp_path) == ""


def test_it_is_of_this_task_with_any_forces(tmp_path):
    task, path = load_task("upholding"), tmp_path / "load.proof"
    best = best_load(task, max_force_N=7.5, proof=path)
    check = check_proof(path, load_form(task))
    assert check.accepted and check.multiple == best.bound and check.force_N == 7.5
    for other in (load_form(load_task("handling")), statics_form(task), load_form(task) | {"friction": 0.5}):
        assert "not those of the task" in check_proof(path, other).reason


def test_caps_and_points_are_replayed(tmp_path):
    task, path = load_task("upholding"), tmp_path / "caps.proof"
    centre = np.asarray(task.object.inertia.centre)
    axis = np.array([0.98, 0.0, np.sqrt(1.0 - 0.98**2)])
    regions = [
        Cap(centre + np.array([0.02, 0.0, 0.0]), 0.01, axis, 0.3, off_surface=True),
        PointRegion(centre - np.array([0.02, 0.0, 0.0]), np.array([-1.0, 0.0, 0.0]), off_surface=True),
    ]
    contacts = tuple(
        replace(c, object=ObjectRegion(f"r{k}", region))
        for k, (c, region) in enumerate(zip(task.contacts, regions, strict=True))
    )
    best = best_load(replace(task, contacts=contacts), proof=path)
    check = check_proof(path, load_form(replace(task, contacts=contacts)))
    assert check.accepted and check.multiple == best.bound > best.value > 0.0


def test_nothing_is_written_where_nothing_is_proved(tmp_path):
    path = tmp_path / "none.proof"
    best = best_load(load_task("handling"), proof=path, budget_s=1e-9, should_stop=lambda: True)
    assert best.proof_written == path.exists()
