import json
import os
import stat
import threading
from pathlib import Path

import pytest
from holdfast.base.files import library
from holdfast.base.files.file_model import FileModel, parse
from holdfast.base.files.file_paths import real_path, resolve_beside
from holdfast.base.files.json_file import read_json
from holdfast.base.files.output_file import write_bytes, write_json, write_text
from holdfast.base.files.yaml_file import read_yaml
from holdfast.errors import HoldfastError, InputError, UnknownName, suggest


class Inner(FileModel):
    width: float
    height: float = 1.0


class Outer(FileModel):
    name: str
    parts: list[Inner] = []
    by_name: dict[str, Inner] = {}


def read(tmp_path, text):
    path = tmp_path / "file.yaml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_yaml(path)


# --- errors


def test_messages_name_source_field_and_remedy_in_one_line():
    error = InputError("a\nb.yaml", "x.y", "must be\n  small\x1b[31m")
    assert str(error) == "a b.yaml: x.y: must be small\\x1b[31m"
    assert (error.source, error.field) == ("a\nb.yaml", "x.y")
    assert isinstance(error, HoldfastError)


def test_unknown_names_are_given_back_with_the_nearest():
    error = UnknownName("task.yaml", "hand", "hand", "sb", ["sa", "leap"])
    assert str(error) == "task.yaml: hand: unknown hand 'sb'; did you mean 'sa'?"
    assert error.known == ("sa", "leap")


def test_long_names_and_lists_are_cut():
    text = str(UnknownName("s", "f", "thing", "z" * 10**5, [f"a{i}" for i in range(1000)]))
    assert len(text) < 500
    assert "and 980 more" in text


@pytest.mark.parametrize(
    ("name", "known", "expected"),
    [
        ("handel", ["hand", "handle"], "; did you mean 'handle'?"),
        ("qqq", ["a", "b"], "; known: a, b"),
        ("x", [], "; none is known"),
    ],
)
def test_suggest(name, known, expected):
    assert suggest(name, known) == expected


# --- YAML


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-3", 1e-3),
        ("-2.5", -2.5),
        (".5", 0.5),
        ("1.", 1.0),
        ("+3", 3),
        ("1.5E+2", 150.0),
        ("010", "010"),
        ("1:30", "1:30"),
        ("1_000", "1_000"),
        ("0x10", "0x10"),
        ("2024-01-01", "2024-01-01"),
        ("no", "no"),
        ("on", "on"),
        ("true", True),
        ("null", None),
        ("", None),
        ("'1'", "1"),
        ("[1, {a: 2}]", [1, {"a": 2}]),
    ],
)
def test_scalars_are_those_of_yaml_1_2(tmp_path, text, value):
    got = read(tmp_path, f"x: {text}")["x"]
    assert got == value
    assert type(got) is type(value)


def test_utf_8_with_and_without_mark(tmp_path):
    assert read(tmp_path, "x: für".encode()) == {"x": "für"}
    assert read(tmp_path, b"\xef\xbb\xbfx: 1") == {"x": 1}


BOMB = "a: &a [x, x]\n" + "".join(
    f"{b}: &{b} [*{a}, *{a}]\n" for a, b in zip("abcdefghij", "bcdefghijk", strict=True)
)
BAD_YAML = {
    "empty": ("", "mapping"),
    "blank": ("\n\n# nothing\n", "mapping"),
    "list at top": ("- a\n- b\n", "mapping"),
    "scalar at top": ("hello", "mapping"),
    "alias": ("a: &x 1\nb: *x\n", "line 2: not valid YAML: aliases"),
    "alias bomb": (BOMB, "aliases"),
    "duplicate key": ("a: 1\nb: 2\na: 3\n", "line 3: not valid YAML: 'a' stands twice"),
    "nested duplicate": ("a: {b: 1, b: 2}", "'b' stands twice"),
    "duplicate by quotes": ("a: 1\n'a': 2\n", "stands twice"),
    "list as key": ("? [1]\n: 2\n", "must be text"),
    "inline list as key": ("{[1]: 2}", "must be text"),
    "mapping as key": ("{{a: 1}: 2}", "must be text"),
    "number as key": ("1: 2", "must be text"),
    "null as key": ("~: 2", "must be text"),
    "true as key": ("true: 2", "must be text"),
    "python tag": ("a: !!python/object/apply:os.system [ls]", "not valid YAML"),
    "python name": ("a: !!python/name:os.system", "not valid YAML"),
    "own tag": ("a: !thing 1", "not valid YAML"),
    "binary": ("a: !!binary '!'", "not valid YAML"),
    "timestamp tag": ("a: !!timestamp 2024-99-99", "not valid YAML"),
    "float tag": ("a: !!float abc", "not valid YAML"),
    "two documents": ("a: 1\n---\nb: 2\n", "not valid YAML"),
    "unclosed": ("a: [1, 2", "not valid YAML"),
    "tab": ("a:\n\t- 1", "not valid YAML"),
    "control character": ("a: \x07", "not valid YAML"),
    "null character": ("a: \x00", "not valid YAML"),
    "deep lists": ("a: " + "[" * 40 + "]" * 40, "levels deep"),
    "very deep lists": ("a: " + "[" * 100_000, "levels deep|not valid"),
    "very deep mappings": ("{a: " * 5_000, "levels deep|not valid"),
    "deep block": ("\n".join(" " * i + "a:" for i in range(500)), "levels deep"),
    "long integer": ("a: " + "9" * 5000, "thousands of digits"),
    "latin 1": ("a: für".encode("latin-1"), "UTF-8"),
    "utf 16": ("a: 1".encode("utf-16"), "UTF-8"),
    "random bytes": (bytes(range(256)), "UTF-8"),
    "too large": (b"#" * (5 * 1024**2), "larger than 4 MiB"),
}


@pytest.mark.parametrize(("text", "words"), BAD_YAML.values(), ids=BAD_YAML.keys())
def test_bad_yaml_is_refused(tmp_path, text, words):
    with pytest.raises(InputError, match=words) as caught:
        read(tmp_path, text)
    assert str(tmp_path / "file.yaml") in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("path", "words"),
    [("missing.yaml", "no such file"), ("folder", "regular file|directory"), ("pipe", "regular file"),
     ("a" * 5000, "too long"), ("nul\0l.yaml", "not the path"), ("missing/file.yaml", "no such file")],
)  # fmt: skip
def test_what_is_not_a_file_is_refused(tmp_path, path, words):
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match=words):
        read_yaml(tmp_path / path)


def test_devices_do_not_hang(tmp_path):
    (tmp_path / "zero.yaml").symlink_to("/dev/zero")
    with pytest.raises(InputError, match="regular file"):
        read_yaml(tmp_path / "zero.yaml")


# --- validation


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({}, "f: name: is required"),
        ({"nmae": "x"}, "f: nmae: unknown field; did you mean 'name'?"),
        ({"name": 3}, "f: name: input should be a valid string, not 3"),
        ({"name": "x", "parts": [{"widht": 1}]}, "f: parts.0.widht: unknown field; did you mean 'width'?"),
        (
            {"name": "x", "by_name": {"a": {"hieght": 1}}},
            "f: by_name.a.hieght: unknown field; did you mean 'height'?",
        ),
        (
            {"name": "x", "parts": [{"width": float("nan")}]},
            "f: parts.0.width: input should be a finite number, not nan",
        ),
        ({"name": "x", "parts": 5}, "f: parts: input should be a valid list, not 5"),
    ],
)
def test_messages_of_validation(data, message):
    with pytest.raises(InputError) as caught:
        parse(Outer, data, "f")
    assert str(caught.value) == message


# --- paths


def test_paths_stay_below_the_folder_of_the_file(tmp_path):
    source = tmp_path / "task.yaml"
    assert resolve_beside(source, "a/b.obj", "mesh") == tmp_path / "a" / "b.obj"
    assert resolve_beside(source, "a/../b.obj", "mesh") == tmp_path / "b.obj"
    (tmp_path / "link").symlink_to("/etc")
    (tmp_path / "loop").symlink_to("loop")
    for bad in ("../b.obj", "/etc/passwd", "a/../../b", "link/passwd", "nul\0l", str(tmp_path / "b.obj")):
        with pytest.raises(InputError, match="path") as caught:
            resolve_beside(source, bad, "mesh")
        assert caught.value.field == "mesh"


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A folder of tasks, objects and meshes side by side, which the current folder is not in."""
    folder = tmp_path / "project"
    for name in ("tasks", "objects", "meshes", "elsewhere"):
        (folder / name).mkdir(parents=True)
    (tmp_path / "secret").mkdir()
    monkeypatch.chdir(tmp_path / "secret")
    monkeypatch.delenv("HOLDFAST_ROOT", raising=False)
    return folder


def test_folders_side_by_side_see_each_other_below_the_current_folder(project, monkeypatch):
    source, mesh = project / "objects" / "mug.yaml", project / "meshes" / "mug.obj"
    with pytest.raises(InputError, match="below the current folder or HOLDFAST_ROOT"):
        resolve_beside(source, "../meshes/mug.obj", "mesh")
    monkeypatch.chdir(project)
    assert resolve_beside(source, "../meshes/mug.obj", "mesh") == mesh
    assert resolve_beside(Path("objects/mug.yaml"), "../meshes/mug.obj", "mesh") == mesh
    monkeypatch.chdir(project / "objects")
    with pytest.raises(InputError, match="must be a path below"):
        resolve_beside(source, "../meshes/mug.obj", "mesh")


def test_a_root_that_the_user_names_is_as_good(project, monkeypatch):
    source = project / "objects" / "mug.yaml"
    monkeypatch.setenv("HOLDFAST_ROOT", str(project))
    assert resolve_beside(source, "../meshes/mug.obj", "mesh") == project / "meshes" / "mug.obj"
    monkeypatch.setenv("HOLDFAST_ROOT", os.path.relpath(project))
    assert resolve_beside(source, "../meshes/mug.obj", "mesh") == project / "meshes" / "mug.obj"
    monkeypatch.setenv("HOLDFAST_ROOT", str(project / "none"))
    with pytest.raises(InputError, match="HOLDFAST_ROOT: there is no folder"):
        resolve_beside(source, "mug.obj", "mesh")


def test_there_is_no_door_to_files_elsewhere(project, monkeypatch):
    monkeypatch.chdir(project)
    monkeypatch.setenv("HOLDFAST_ROOT", str(project))
    (project / "meshes" / "out").symlink_to(project.parent / "secret")
    (project / "meshes" / "out.obj").symlink_to(project.parent / "secret" / "a.obj")
    source = project / "objects" / "mug.yaml"
    for bad in (
        "../../secret/a.obj",
        "../meshes/out/a.obj",
        "../meshes/out.obj",
        "../meshes/../../secret/a.obj",
        str(project / "meshes" / "mug.obj"),
        "../" * 30 + "etc/passwd",
        "nul\0l",
    ):
        with pytest.raises(InputError, match="path"):
            resolve_beside(source, bad, "mesh")
    # A file from elsewhere reaches nothing of the user's: neither by its own path nor through a link to it.
    stranger = project.parent / "secret" / "mug.yaml"
    (project / "objects" / "linked.yaml").symlink_to(stranger)
    for source in (stranger, project / "objects" / "linked.yaml"):
        with pytest.raises(InputError, match="must be a path below"):
            resolve_beside(source, "../project/meshes/mug.obj", "mesh")


@pytest.mark.parametrize("folder", ["/", "home", "above"])
def test_a_current_folder_that_holds_everything_opens_nothing(project, monkeypatch, folder):
    monkeypatch.setenv("HOME", str(project))
    monkeypatch.chdir({"/": "/", "home": project, "above": project.parent}[folder])
    with pytest.raises(InputError, match="must be a path below"):
        resolve_beside(project / "objects" / "mug.yaml", "../meshes/mug.obj", "mesh")


def test_a_current_folder_that_was_removed_opens_nothing(project, monkeypatch):
    monkeypatch.chdir(project / "elsewhere")
    (project / "elsewhere").rmdir()
    source = project / "objects" / "mug.yaml"
    assert resolve_beside(source, "mug.obj", "mesh") == project / "objects" / "mug.obj"
    with pytest.raises(InputError, match="must be a path below"):
        resolve_beside(source, "../meshes/mug.obj", "mesh")


def test_what_a_named_file_names_counts_from_its_own_folder(project, monkeypatch):
    source, model = project / "objects" / "hand.yaml", project / "meshes" / "hand.urdf"
    monkeypatch.chdir(project)
    assert resolve_beside(source, "a.stl", "import", beside=model) == project / "meshes" / "a.stl"
    monkeypatch.chdir(project / "elsewhere")
    with pytest.raises(InputError, match="must be a path below"):
        resolve_beside(source, "a.stl", "import", beside=model)


# --- writing


def test_files_are_written_whole_with_common_permissions(tmp_path):
    path = tmp_path / "new" / "folder" / "a.json"
    write_json(path, {"x": [1, 2.5, None]})
    assert json.loads(path.read_text()) == {"x": [1, 2.5, None]}
    (tmp_path / "plain").touch()
    assert stat.S_IMODE(path.stat().st_mode) == stat.S_IMODE((tmp_path / "plain").stat().st_mode)
    assert os.listdir(path.parent) == ["a.json"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[1]", "must be a JSON object"),
        ('{"x": NaN}', "NaN is not a number"),
        ('{"x": 1, "x": 2}', "'x' stands twice"),
        ('{"x": ', "line 1: not valid JSON"),
        ("[" * 100_000, "nested too deeply"),
        (b"\xff", "not a UTF-8 text file"),
    ],
)
def test_json_of_others_is_read_with_care(text, message, tmp_path):
    path = tmp_path / "a.json"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError, match=message):
        read_json(path)


def test_json_and_bytes_come_back_as_they_were_written(tmp_path):
    write_json(tmp_path / "a.json", {"x": [1, 2.5, None]})
    assert read_json(tmp_path / "a.json") == {"x": [1, 2.5, None]}
    write_bytes(tmp_path / "new" / "b", b"\x00\r\n\xff")
    assert (tmp_path / "new" / "b").read_bytes() == b"\x00\r\n\xff"
    assert os.listdir(tmp_path / "new") == ["b"]


@pytest.mark.parametrize("number", [float("nan"), float("inf")])
def test_json_has_no_nan(tmp_path, number):
    with pytest.raises(ValueError, match="JSON compliant"):
        write_json(tmp_path / "a.json", {"x": number})
    assert os.listdir(tmp_path) == []


def test_a_failed_write_keeps_the_old_file(tmp_path):
    write_text(tmp_path / "a", "old")
    with pytest.raises(UnicodeEncodeError):
        write_text(tmp_path / "a", "new \ud800")
    assert (tmp_path / "a").read_text() == "old"
    assert os.listdir(tmp_path) == ["a"]


def test_readers_never_see_half_a_file(tmp_path):
    path = tmp_path / "a"
    texts = {c * 200_000 for c in "ab"}
    write_text(path, "a" * 200_000)
    seen = set()
    done = threading.Event()

    def look():
        while not done.is_set():
            seen.add(path.read_text())

    reader = threading.Thread(target=look)
    reader.start()
    for text in sorted(texts) * 10:
        write_text(path, text)
    done.set()
    reader.join()
    assert seen <= texts


def test_links_in_a_circle_are_a_path_like_another(tmp_path: Path) -> None:
    (tmp_path / "a").symlink_to("b")
    (tmp_path / "b").symlink_to("a")
    assert real_path(tmp_path / "a").parent == tmp_path.resolve()
    (tmp_path / "link").symlink_to("target")
    assert real_path(tmp_path / "link") == tmp_path.resolve() / "target"


def test_only_one_function_follows_links() -> None:
    """`Path.resolve` raises what nobody expects where links go round in a circle."""
    root = Path(library.__file__).parents[2]
    outside = {"tests", "benchmarks", "docs", "examples", "build", ".venv"}
    sources = [path for path in root.rglob("*.py") if path.relative_to(root).parts[0] not in outside]
    callers = [path for path in sources if ".resolve()" in path.read_text("utf-8")]
    assert callers == [] and len(sources) > 100
