"""The command line: exit codes, errors of one line, clean stdout, and a quick start."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from holdfast.pipeline.cli import registry
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.run import folder_name

COMMANDS = (
    "export",
    "run",
    "solve",
    "system",
    "clear",
    "hold",
    "render",
    "show",
    "edit",
    "view",
    "compare",
    "report",
    "suggest",
    "dataset",
    "choose train",
    "choose evaluate",
    "verify",
    "batch",
    "table",
    "query",
    "check",
    "best",
    "check-proof",
    "tasks",
    "hands",
    "hands new",
    "objects",
    "objects fit",
    "completion",
    "doctor",
    "serve",
)
TASK = {
    "name": "mine",
    "hand": "sa",
    "object": "scalpel",
    "contacts": [
        {"hand": "index/tip", "object": "index_grip"},
        {"hand": "thumb/tip", "object": "thumb_grip"},
    ],
}


def error_of(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """The one line on stderr of a command that must fail with 2."""
    assert main(words) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("holdfast: ") and err.endswith("\n") and err.count("\n") == 1, err
    return err


def task_file(folder: Path, **changes: object) -> str:
    path = folder / "mine.yaml"
    path.write_text(yaml.safe_dump({**TASK, **changes}), "utf-8")
    return str(path)


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    listed = re.findall(r"^  ([a-z][\w-]*(?: \w+)?)(?:  |$)", capsys.readouterr().out, re.M)
    assert sorted(listed) == sorted(COMMANDS)


def test_a_renderer_is_looked_for_early_where_one_is_asked_for() -> None:
    """While what a command imports is loaded: see `expect_choice`."""
    for command in registry.COMMANDS.values():
        source = Path(registry.__file__).with_name("commands") / command.group / f"{command.module_name}.py"
        assert command.draws == ("    configure()\n" in source.read_text()), command.name


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*command.split(), "--help"]) == 0
    assert capsys.readouterr().out.startswith(f"usage: holdfast {command}")


def test_no_words_show_the_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    assert "  run  " in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["rnu"], "did you mean 'run'?"),
        (["frobnicate", "x"], "unknown command 'frobnicate'; known: run, "),
        (["help"], "did you mean '--help'?"),
        (["version"], "did you mean '--version'?"),
        (["run", "upholding", "--frobnicate"], "`holdfast run --help` lists the options"),
        (["clear", "x.json", "--margni"], "`holdfast clear --help` lists the options"),
        (["run", "upholding", "--candidate", "3"], "did you mean '--candidates'?"),
        (["run", "upholding", "--cand", "3"], "'--cand'"),
        (["run", "upholding", "--timeout", "3"], "did you mean '--budget'?"),
        (["hold", "g.json", "--timeout", "3"], "`holdfast hold --help` lists the options"),
        (["run", "upholding", "extra"], "unknown argument 'extra'"),
        (["objects", "fti", "box.obj"], "unknown command 'objects fti'; did you mean 'objects fit'?"),
        (["hands", "nwe", "x.yaml"], "did you mean 'hands new'?"),
        (["choose", "trian", "set"], "did you mean 'choose train'?"),
        (["objects", "teapot", "extra"], "unknown argument 'extra'"),
        (["run"], "TASK"),
        (["run", "upholding", "--candidates", "0"], "at least 1"),
        (["run", "upholding", "--candidates", "many"], "at least 1, not 'many'"),
        (["run", "upholding", "--candidates", "1" + "0" * 5000], "at least 1"),
        (["run", "upholding", "--seed", "-1"], "at least 0"),
        (["run", "upholding", "--sigma", "nan"], "above 0, not 'nan'"),
        (["run", "upholding", "--budget", "inf"], "above 0, not 'inf'"),
        (["run", "upholding", "--budget", "0"], "above 0"),
        (["--no-such-option"], "--no-such-option"),
    ],
)
def test_bad_usage(words: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert says in error_of(capsys, *words)


@pytest.mark.parametrize("command", ["run", "solve"])
def test_an_unknown_task_is_named_with_the_known_ones(
    command: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert "did you mean 'upholding'?" in error_of(capsys, command, "upholdin")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["run", "solve", "tasks"])
@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"contcats": []}, "did you mean 'contacts'?"),
        ({"hand": "sb"}, "unknown hand 'sb'"),
        ({"object": "scapel"}, "did you mean 'scalpel'?"),
        ({"contacts": [{"hand": "index/top", "object": "index_grip"}]}, "did you mean 'index/tip'?"),
        ({"contacts": []}, "contacts"),
        (
            {
                "contacts": [
                    {"hand": "index/tip", "object": {"point": [0, 0, float("nan")], "normal": [0, 0, 1]}}
                ]
            },
            "contacts.0.object.point.2",
        ),
        (
            {
                "contacts": [
                    {
                        "hand": "index/tip",
                        "object": {"bezier": [[[0, 0, 0], [0, float("nan"), 0]], [[1, 0, 0], [1, 1, 0]]]},
                    }
                ]
            },
            "contacts.0.object.bezier",
        ),
        ({"joint_limits": {"index_abduction": [0.2, -0.2]}}, "joint_limits.index_abduction"),
    ],
)
def test_a_bad_task_file_costs_one_line(
    command: str,
    changes: dict[str, object],
    says: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    path = task_file(tmp_path, **changes)
    error = error_of(capsys, command, path)
    assert says in error and path in error


@pytest.mark.parametrize("command", ["clear", "hold", "render", "report"])
def test_a_missing_file_costs_one_line(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert "nowhere.json" in error_of(capsys, command, "nowhere.json")


def test_a_missing_task_file_costs_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert "nowhere.yaml" in error_of(capsys, "run", "nowhere.yaml")


def listed_names(capsys: pytest.CaptureFixture[str]) -> list[str]:
    """The names of a listing, without the row that stands for all families of objects."""
    names = [line.split()[0] for line in capsys.readouterr().out.splitlines()[2:]]
    return [name for name in names if not name.startswith("family:")]


@pytest.mark.parametrize("kind", ["task", "hand", "object"])
def test_listings(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([f"{kind}s"]) == 0
    names = listed_names(capsys)
    assert names == sorted(names) and names
    for name in names:
        assert main([f"{kind}s", name]) == 0
        # A name with a folder, such as paper/handling, stands in files with an underscore.
        assert capsys.readouterr().out.startswith(f"{name.replace('/', '_')}:")
    assert main([f"{kind}s", "nothing-of-the-kind"]) == 2


def test_listings_agree_with_the_libraries(capsys: pytest.CaptureFixture[str]) -> None:
    from holdfast.hands import builtin_hands
    from holdfast.objects import builtin_objects, builtin_tasks

    for kind, known in (("task", builtin_tasks()), ("hand", builtin_hands()), ("object", builtin_objects())):
        main([f"{kind}s"])
        assert tuple(listed_names(capsys)) == known


def test_a_task_of_ones_own_is_shown(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = task_file(tmp_path, joint_limits={"index_abduction": [-0.2, 0.2]})
    assert main(["tasks", path]) == 0
    out = capsys.readouterr().out
    assert path in out and "index_abduction  -0.2  0.2" in out


def test_listing_loads_nothing_heavy() -> None:
    """Which is what makes it quick."""
    program = (
        "import sys; from holdfast.pipeline.cli import main; main(['tasks']); "
        "heavy = {'mujoco', 'scipy', 'trimesh', 'numba', 'gymnasium'}; print(*(heavy & set(sys.modules)))"
    )
    finished = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert finished.stdout.splitlines()[-1] == ""


def test_a_proof_goes_from_solve_to_check_proof(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Faces 260 mm apart are too far for index finger and thumb."""
    faces = [[[[x, s * y, s * 0.13] for y in (-0.02, 0.02)] for x in (-0.02, 0.02)] for s in (-1, 1)]
    pairs = zip(("index/tip", "thumb/tip"), faces, strict=True)
    contacts = [{"hand": hand, "object": {"bezier": net, "off_surface": True}} for hand, net in pairs]
    task = task_file(tmp_path, contacts=contacts)
    proof = tmp_path / "no.proof"
    assert main(["solve", task, "--quiet", "--first", "--proof", str(proof)]) == 3
    assert main(["check-proof", str(proof), "--task", task]) == 0
    assert "accepted: mine is infeasible" in capsys.readouterr().out
    assert main(["check-proof", str(proof), "--task", "upholding"]) == 4
    assert capsys.readouterr().out.startswith("rejected: the log's system is not that of the task")
    proof.write_bytes(proof.read_bytes()[:-20])
    assert main(["check-proof", str(proof), "--json", "-"]) == 4
    report = json.loads(capsys.readouterr().out)
    assert report["accepted"] is False and report["task"] is None and report["reason"]
    assert "not a proof log" in error_of(capsys, "check-proof", task)
    assert "nowhere" in error_of(capsys, "check-proof", str(tmp_path / "nowhere"))


def test_a_reader_that_leaves_is_no_error() -> None:
    program = "import sys; from holdfast.pipeline.cli import main; sys.exit(main(['hands', 'sa']))"
    process = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stdout is not None and process.stderr is not None
    process.stdout.close()
    error = process.stderr.read()
    process.stderr.close()
    assert (process.wait(), error) == (0, b"")


@pytest.mark.parametrize(
    ("name", "folder"), [("pour", "pour"), ("../../etc", "______etc"), ("", "_"), ("a b/c", "a_b_c")]
)
def test_a_task_name_cannot_lead_elsewhere(name: str, folder: str) -> None:
    assert folder_name(name) == folder
