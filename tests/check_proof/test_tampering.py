"""A log that was changed proves nothing that is not so."""

import copy
from typing import Any

import numpy as np
import pytest
from holdfast.check_proof import check_proof
from holdfast.solver import task_form

from .logs import boxes_of, check, forged, sealed, steps_of, write


def test_any_change_breaks_the_seal(records, tmp_path):
    """Even one that leaves a valid proof, such as a multiplier written differently."""
    assert check(records, tmp_path) == ""
    for number, record in enumerate(records):
        record["remark"] = 1
        # What stands beside the checksum itself means nothing.
        assert (check(records, tmp_path) == "") == ("end" in record), number
        del record["remark"]
    changed = copy.deepcopy(records)
    changed[-1]["end"]["boxes"] += 1
    assert check(changed, tmp_path) != ""
    assert check([*records, {"end": {}}], tmp_path) == "something follows the last record"


def test_rays_are_needed_and_flipped_they_are_none(records, tmp_path):
    refuted = [r for r in boxes_of(records) if r["steps"] and r["steps"][-1][0] == "ray"]
    assert refuted
    needed = flipped = 0
    for record in refuted:
        ray = record["steps"].pop()
        is_needed = "is not shown to be empty" in check(sealed(records), tmp_path)
        needed += is_needed
        record["steps"].append(["ray", ray[1], [-y for y in ray[2]]])
        if is_needed:
            assert "a ray does not show what it should" in check(sealed(records), tmp_path)
        largest = int(np.argmax(np.abs(ray[2])))
        record["steps"][-1] = ["ray", ray[1], [-y if k == largest else y for k, y in enumerate(ray[2])]]
        flipped += "a ray does not show what it should" in check(sealed(records), tmp_path)
        record["steps"][-1] = ray
    # The checker propagates further than the solver, and a ray may have strength to spare.
    assert 2 * needed >= len(refuted) and 2 * flipped >= len(refuted)


def test_bounds_that_are_missing_leave_boxes_open(records, tmp_path):
    for record in boxes_of(records):
        record["steps"] = [s for s in record["steps"] if s[0] != "bound"]
    assert check(sealed(records), tmp_path) != ""


def test_multipliers_may_not_be_those_of_another_bound(records, tmp_path):
    """Each bound's multipliers go to the next one: as bounds they are valid, but worthless."""
    bounds = steps_of(records, "bound")
    duals = [b[3:] for b in bounds]
    for step, other in zip(bounds, duals[1:] + duals[:1], strict=True):
        step[3:] = other
    assert check(sealed(records), tmp_path) != ""


@pytest.mark.parametrize("move", [-0.3, 0.3, 50.0])
def test_a_split_somewhere_else_is_not_what_was_refuted(records, tmp_path, move):
    (first,) = [r for r in boxes_of(records) if r["box"] == ""]
    first["split"][1] += move
    assert check(sealed(records), tmp_path) != ""


def test_a_split_of_another_column_is_not_what_was_refuted(records, tmp_path):
    (first,) = [r for r in boxes_of(records) if r["box"] == ""]
    first["split"][0] += 1
    assert check(sealed(records), tmp_path) != ""


def test_every_child_is_needed_and_only_once(records, tmp_path):
    for k, record in enumerate(records):
        if "box" not in record:
            continue
        without = sealed(records[:k] + records[k + 1 :])
        assert check(without, tmp_path) != "", k
        twice = sealed(records[: k + 1] + records[k:])
        assert "not open" in check(twice, tmp_path), k


def test_a_leaf_is_not_made_by_saying_so(records, tmp_path):
    for record in [r for r in boxes_of(records) if "split" in r and len(r["box"]) <= 1]:
        others = [r for r in boxes_of(records) if not r["box"].startswith(record["box"])]
        leaf = {"box": record["box"], "steps": record["steps"]}
        claimed = sealed([*records[:2], *sorted([*others, leaf], key=lambda r: len(r["box"]))])
        assert "is not shown to be empty" in check(claimed, tmp_path)


def test_a_child_does_not_come_before_its_parent(records, tmp_path):
    order = [*records[:2], *reversed(boxes_of(records))]
    assert "not open" in check(sealed(order), tmp_path)
    order = [records[0], *records[2:-1], records[1]]
    assert check(sealed(order), tmp_path) != ""


def test_a_box_smaller_than_propagation_gives_is_refused(records, tmp_path):
    for _, lower, upper, _ in steps_of(records, "over")[:3]:
        kept = list(lower)
        k = int(np.argmax(np.subtract(upper, lower)))
        lower[k] = 0.5 * (lower[k] + upper[k])
        assert "propagation does not give the box" in check(sealed(records), tmp_path)
        lower[:] = kept


def test_a_box_larger_than_it_need_be_proves_less(records, tmp_path):
    for _, lower, upper, _ in steps_of(records, "over"):
        lower[:], upper[:] = [x - 1.0 for x in lower], [x + 1.0 for x in upper]
    assert check(sealed(records), tmp_path) != ""


def test_the_system_is_that_of_the_task_to_the_last_bit(proved, records, tmp_path):
    task, path = proved
    form, form_of_task = records[1]["form"], task_form(task)
    for change in ("coefficient", "side", "bound", "product"):
        kept = copy.deepcopy(form)
        if change == "coefficient":
            form["rows"][20][1][0] = float(np.nextafter(form["rows"][20][1][0], 9.0))
        elif change == "side":
            form["rows"][0][2] -= 1e-9
        elif change == "bound":
            form["upper"][3] += 1e-9
        else:
            form["products"][5][1] = form["products"][5][0]
        forgery = write(tmp_path / "form.proof", sealed(records))
        assert check_proof(forgery, form_of_task).reason == "the log's system is not that of the task"
        form.clear()
        form.update(kept)
    # Written back as it was, the form is the task's again.
    assert check_proof(write(tmp_path / "same.proof", sealed(records)), form_of_task).accepted
    assert check_proof(path, form_of_task).accepted


def test_a_system_made_easier_to_solve_is_no_longer_refuted(records, tmp_path):
    """The rows with a constant, such as lengths and unit norms, get room on both sides."""
    for row in records[1]["form"]["rows"]:
        row[2], row[3] = (
            None if end is None else end + room for end, room in ((row[2], -5.0), (row[3], 5.0))
        )
    assert check(sealed(records), tmp_path) != ""


def test_slopes_are_those_that_the_multipliers_were_made_for(curved, tmp_path):
    """Any slopes give valid planes; with others than the log's the multipliers prove nothing."""
    assert sum(len(planes) for *_, planes in steps_of(curved, "over")) >= 4
    assert check(forged(curved, lambda plane: None), tmp_path) == ""

    def swap(plane: list[Any]) -> None:
        plane[1:] = plane[:0:-1]

    def flip(plane: list[Any]) -> None:
        plane[1] = -plane[1]

    def flatten(plane: list[Any]) -> None:
        plane[1:] = [0.0, 0.0]

    def steepen(plane: list[Any]) -> None:
        plane[2] += 1e200

    for change in (swap, flip, flatten, steepen):
        assert check(forged(curved, change), tmp_path) != "", change.__name__


def test_a_slope_that_is_off_by_a_little_proves_a_little_less(curved, tmp_path):
    def nudge(plane: list[Any]) -> None:
        plane[1] *= 1.0 + 1e-9

    assert check(forged(curved, nudge), tmp_path) == ""


def test_planes_can_not_be_left_out(curved, tmp_path):
    without = copy.deepcopy(curved)
    for over in steps_of(without, "over"):
        over[3].clear()
    assert "an index is out of range" in check(sealed(without), tmp_path)


@pytest.mark.parametrize(
    "plane",
    [None, [], [0, 1.0], [0, 1.0, 1.0, 1.0], [1, 1.0, 1.0], [-1, 1.0, 1.0], [0, "1", 1.0], [0.0, 1.0, 1.0]],
)
def test_a_plane_that_makes_no_sense_is_rejected(curved, plane, tmp_path):
    records = copy.deepcopy(curved)
    steps_of(records, "over")[0][3].append(plane)
    assert check(sealed(records), tmp_path) != ""
