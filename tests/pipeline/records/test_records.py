"""Grasps and runs as files: the round trip is exact, and what others have edited is refused in one line."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.objects import builtin_tasks, load_task
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import (
    GraspFile,
    RunRecord,
    Solution,
    builtin_reference,
    existing_source,
    fingerprint,
    plain_identifier,
    read_grasp,
    read_run,
    relative_source,
    resolve_source,
    to_configuration,
    to_json,
    to_solution,
    to_state,
)
from holdfast.solver import solve


def edited(path: Path, folder: Path, edit: Callable[[dict[str, Any]], object]) -> Path:
    """A copy of a JSON file, edited."""
    data = json.loads(path.read_text("utf-8"))
    edit(data)
    copy = folder / "edited.json"
    copy.write_text(json.dumps(data), "utf-8")
    return copy


def test_solutions_survive_the_round_trip() -> None:
    task = load_task("upholding")
    for configuration in solve(task, candidates=8, seed=3).configurations:
        written = to_solution(configuration, "g01")
        read = Solution.model_validate_json(json.dumps(to_json(written), allow_nan=False))
        assert read == written
        state = to_state(read, task, "test")
        assert np.array_equal(state.q, configuration.state.q)
        assert np.array_equal(state.params, configuration.state.params)
        assert np.array_equal(state.p_palm_object, configuration.state.p_palm_object)
        assert state.R_palm_object == pytest.approx(configuration.state.R_palm_object, abs=1e-14)
        again = to_configuration(read, task, "test")
        assert again.certified == configuration.certified
        assert again.residual_m < 1e-12


def test_files_of_versions_with_one_gap_are_still_read() -> None:
    (configuration,) = solve(load_task("upholding"), candidates=1).configurations
    data = to_json(to_solution(configuration, "g01"))
    for contact in data["contacts"]:
        assert abs(contact["gap"]) < 1e-6 and 0.0 <= contact.pop("region_gap") < 1e-12
    read = Solution.model_validate(data)
    assert [contact.region_gap for contact in read.contacts] == [None, None]
    assert read.gap == max(0.0, *(contact.gap for contact in read.contacts))


def test_run_and_grasp_files_survive_the_round_trip(run_record: RunRecord, grasp_path: Path) -> None:
    assert RunRecord.model_validate_json(json.dumps(to_json(run_record), allow_nan=False)) == run_record
    grasp = read_grasp(grasp_path)
    assert GraspFile.model_validate_json(json.dumps(to_json(grasp), allow_nan=False)) == grasp


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is empty"),
        ("{", "line 1"),
        ("[]", "must be a JSON object"),
        ("3", "must be a JSON object"),
        ('{"id": NaN}', "NaN is not a number"),
        ('{"id": -Infinity}', "-Infinity is not a number"),
        ('{"id": 1, "id": 2}', "'id' stands twice"),
        ('{"id": ' + "9" * 5000 + "}", "not valid JSON"),
        ("[" * 100_000, "nested too deeply"),
        ("{}", "is required"),
    ],
)
def test_what_is_no_grasp_file_is_refused(
    text: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "grasp.json"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError) as caught:
        read_grasp(path)
    assert says in str(caught.value) and str(path) in str(caught.value)
    assert main(["hold", str(path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_binary_and_folders_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "grasp.json"
    path.write_bytes(b"\xff\xfe\x00")
    for bad in (path, tmp_path, tmp_path / "missing.json"):
        with pytest.raises(InputError):
            read_grasp(bad)


EDITS: list[tuple[str, Callable[[dict[str, Any]], object]]] = [
    ("joints.index_pip", lambda d: d["joints"].update(index_pip="bent")),
    ("joints.index_pip", lambda d: d["joints"].update(index_pip=9.0)),
    ("joints.index_pip", lambda d: d["joints"].pop("index_pip")),
    ("did you mean 'index_pip'?", lambda d: d["joints"].update(index_pipp=0.1)),
    ("joints.index_dip", lambda d: d["joints"].update(index_dip=d["joints"]["index_dip"] + 0.01)),
    ("object.quaternion", lambda d: d["object"].update(quaternion=[1, 1, 0, 0])),
    ("object.quaternion", lambda d: d["object"].update(quaternion=[0, 0, 0, 0])),
    ("object.position", lambda d: d["object"].update(position=[0, 0])),
    ("mm apart", lambda d: d["object"]["position"].__setitem__(0, d["object"]["position"][0] + 0.01)),
    ("parameters", lambda d: d["parameters"].pop()),
    ("parameters.0", lambda d: d["parameters"].__setitem__(0, 1.5)),
    ("id", lambda d: d.update(id="../../escape")),
    ("did you mean 'joints'?", lambda d: d.update(jonts={})),
    ("clearance.status", lambda d: d["clearance"].update(status="fine")),
    ("unknown task 'uphold'", lambda d: d.update(task_source="uphold")),
    ("nowhere.yaml", lambda d: d.update(task_source="nowhere.yaml")),
]


@pytest.mark.parametrize(("says", "edit"), EDITS)
def test_an_edited_grasp_costs_one_line(
    says: str,
    edit: Callable[[dict[str, Any]], object],
    grasp_path: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = edited(grasp_path, tmp_path, edit)
    assert main(["clear", str(path)]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and says in err, err


def test_a_certificate_is_not_taken_on_trust(
    grasp_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = edited(grasp_path, tmp_path, lambda d: d.update(certified=False, certified_radius=None))
    assert main(["clear", str(path), "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["certified"] is True


def test_a_broken_run_file_is_refused(run_path: Path, tmp_path: Path) -> None:
    for says, edit in (
        ("verdict", lambda d: d.update(verdict="great")),
        ("grasps.0.hold.held", lambda d: d["grasps"][0]["hold"].update(held="perhaps")),
        ("solve.boxes", lambda d: d["solve"].update(boxes=None)),
    ):
        with pytest.raises(InputError, match=says.replace(".", r"\.")):
            read_run(edited(run_path / "run.json", tmp_path, edit))


def test_task_files_are_named_from_the_file_that_names_them(tmp_path: Path) -> None:
    task = tmp_path / "tasks" / "pour.yaml"
    grasp = tmp_path / "runs" / "pour" / "grasps" / "g01.json"
    named = relative_source(str(task), grasp)
    assert named == "../../../tasks/pour.yaml"
    assert Path(resolve_source(named, grasp)).resolve() == task
    assert resolve_source(relative_source("upholding", grasp), grasp) == "upholding"
    assert existing_source("upholding", grasp) == "upholding"
    with pytest.raises(InputError, match=r"g01\.json: task_source: .*pour\.yaml is not there: .*--task"):
        existing_source(named, grasp)


def test_the_fingerprint_sees_every_figure_and_no_words() -> None:
    task = load_task("upholding")
    same = replace(task, description="other words")
    assert fingerprint(same) == fingerprint(task)
    assert fingerprint(replace(task, hand=replace(task.hand, notes=("mended",)))) == fingerprint(task)
    apart = replace(task.hand, never_touching=((0, 2),))
    assert fingerprint(replace(task, hand=apart)) != fingerprint(task)
    limits = task.limits.copy()
    limits[3, 1] -= 1e-9
    assert fingerprint(replace(task, limits=limits)) != fingerprint(task)
    assert fingerprint(replace(task, contacts=task.contacts[:1])) != fingerprint(task)
    assert fingerprint(replace(task, object=replace(task.object, friction=0.61))) != fingerprint(task)


def test_built_in_tasks_are_recognised_by_what_they_say() -> None:
    for name in builtin_tasks():
        assert builtin_reference(load_task(name)) == name
    task = load_task("upholding")
    assert builtin_reference(load_task("family:mug:17")) == "family:mug:17"
    assert builtin_reference(replace(task, limits=0.9 * task.limits)) == ""
    assert builtin_reference(replace(task, name="mine")) == ""


def test_a_file_that_names_no_task_says_so(
    grasp_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = edited(grasp_path, tmp_path, lambda d: d.update(task_source=""))
    assert main(["clear", str(path)]) == 2
    assert "task_source: is empty" in capsys.readouterr().err
    assert main(["clear", str(path), "--task", "upholding"]) == 0


@pytest.mark.parametrize(
    ("name", "identifier"),
    [
        ("g01", "g01"),
        ("a-b_", "a-b_"),
        ("odd name", "odd_name"),
        ("ünï", "n_"),
        ("-x", "x"),
        ("", "grasp"),
        ("\u202e\x1b[2J", "2J"),
        ("a" * 200, "a" * 64),
        ("../x", "x"),
        ("\udcff", "grasp"),
    ],
)
def test_any_name_has_a_plain_identifier(name: str, identifier: str) -> None:
    assert plain_identifier(name) == identifier
