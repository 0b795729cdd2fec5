"""The run script, with stand-ins for Python, pip and apt-get that write down what they are asked to do."""

import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

RUN = Path(__file__).resolve().parents[1] / "run"

PYTHON = """#!/bin/sh
echo "python $*" >>"$LOG"
case "$*" in
-V) echo "Python 3.11.9" ;;
"-c import ensurepip"*) [ ! -e "$STUBS/no-venv" ] ;;
"-m venv "*)
    mkdir -p "$3/bin"
    cp "$STUBS/venv-python" "$3/bin/python"
    cp "$STUBS/venv-python" "$3/bin/holdfast"
    ;;
esac
"""
VENV_PYTHON = """#!/bin/sh
echo "venv $(basename "$0")" "$@" >>"$LOG"
case "$*" in
"-m pip"*)
    touch "$STUBS/pip-started"
    [ ! -e "$STUBS/pip-waits" ] || sleep 20
    [ ! -e "$STUBS/pip-fails" ]
    ;;
"-m venv "*)
    mkdir -p "$3/bin"
    cp "$0" "$3/bin/python"
    ;;
*holdfast.base.machine.backend*) cat "$STUBS/works" ;;
*"-m pytest"*)
    env >"$STUBS/environment"
    pwd >"$STUBS/folder"
    printf '[%s]' "$@" >"$STUBS/arguments"
    exit 7
    ;;
esac
"""
APT = """#!/bin/sh
echo "apt-get $*" >>"$LOG"
case "$*" in
*python3-venv*) rm -f "$STUBS/no-venv" ;;
*libegl1*) echo egl >"$STUBS/works" ;;
esac
"""


class Checkout:
    """A checkout with only what the script reads, in a folder with a space."""

    def __init__(self, folder: Path):
        self.root = folder / "a checkout"
        self.stubs = folder / "stubs"
        self.home = folder / "home"
        self.log = folder / "log"
        for new in (self.root, self.stubs, self.home):
            new.mkdir()
        shutil.copy(RUN, self.root / "run")
        for name in ("requirements-dev.txt", "requirements-bench.txt", "pyproject.toml"):
            (self.root / name).write_text("first\n")
        for name, text in {"python3": PYTHON, "venv-python": VENV_PYTHON, "apt-get": APT}.items():
            self.stub(name, text)
        self.become(1000)
        self.renders_with("egl")
        self.environment = {
            "PATH": f"{self.stubs}:/usr/bin:/bin",
            "HOME": str(self.home),
            "STUBS": str(self.stubs),
            "LOG": str(self.log),
        }

    def stub(self, name: str, text: str) -> None:
        (self.stubs / name).write_text(text)
        (self.stubs / name).chmod(0o755)

    def become(self, uid: int) -> None:
        self.stub("id", f"#!/bin/sh\necho {uid}\n")

    def renders_with(self, backend: str) -> None:
        (self.stubs / "works").write_text(f"{backend}\n")

    def start(self, *arguments: str, **variables: str) -> subprocess.Popen[str]:
        """Starts the script in another folder, with a fresh log and in a process group of its own."""
        self.log.write_text("")
        return subprocess.Popen(
            [self.root / "run", *arguments],
            cwd=self.home,
            env=self.environment | variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def run(self, *arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
        process = self.start(*arguments, **variables)
        out, err = process.communicate(timeout=30)
        return subprocess.CompletedProcess(arguments, process.returncode, out, err)

    def calls(self, *words: str) -> list[str]:
        """Logged calls that contain all the words."""
        return [line for line in self.log.read_text().splitlines() if all(word in line for word in words)]

    def seen_by_pytest(self, variable: str) -> str | None:
        lines = (self.stubs / "environment").read_text().splitlines()
        return dict(line.split("=", 1) for line in lines if "=" in line).get(variable)


@pytest.fixture
def checkout(tmp_path: Path) -> Checkout:
    return Checkout(tmp_path)


def test_help_names_every_command(checkout: Checkout) -> None:
    for arguments in ([], ["help"], ["--help"]):
        result = checkout.run(*arguments)
        assert result.returncode == 0
        assert all(
            f"\n  {name} " in result.stdout for name in ("demo", "test", "check", "docs", "bench", "setup")
        )
    assert checkout.calls() == []


def test_unknown_command_is_a_usage_error(checkout: Checkout) -> None:
    result = checkout.run("tset")
    assert result.returncode == 2
    assert "unknown command 'tset'" in result.stderr


def test_first_call_installs_and_the_second_does_not(checkout: Checkout) -> None:
    assert checkout.run("setup").returncode == 0
    assert len(checkout.calls("pip install", "--require-hashes", "requirements-dev.txt")) == 1
    assert len(checkout.calls("pip install", "--no-deps", "--no-build-isolation", "--editable")) == 1
    assert checkout.run("setup").returncode == 0
    assert checkout.calls("pip") == []
    assert checkout.calls("backend") == []


def test_changed_project_is_installed_anew_in_the_same_environment(checkout: Checkout) -> None:
    checkout.run("setup")
    (checkout.root / "pyproject.toml").write_text("second\n")
    checkout.run("setup")
    assert len(checkout.calls("pip install")) == 1
    assert len(checkout.calls("--editable")) == 1


def test_changed_requirements_make_a_new_environment(checkout: Checkout) -> None:
    checkout.run("setup")
    left_over = checkout.root / ".venv/left-over"
    left_over.touch()
    (checkout.root / "requirements-dev.txt").write_text("second\n")
    checkout.run("setup")
    assert len(checkout.calls("pip install")) == 2
    assert not left_over.exists()


@pytest.mark.parametrize("benchmark", ["solver", "second_engine"])
def test_peers_are_installed_once_and_only_for_benchmarks_that_want_them(
    checkout: Checkout, benchmark: str
) -> None:
    checkout.run("bench", "systems")
    assert checkout.calls("requirements-bench.txt") == []
    assert checkout.run("bench", benchmark).returncode == 0
    assert len(checkout.calls("pip install", "--require-hashes", "requirements-bench.txt")) == 1
    assert checkout.calls(f"benchmarks/run.py {benchmark}")
    checkout.run("bench", benchmark)
    assert checkout.calls("pip") == []


def test_a_benchmark_goes_without_peers_that_cannot_be_had(checkout: Checkout) -> None:
    checkout.run("setup")
    (checkout.stubs / "pip-fails").touch()
    result = checkout.run("bench", "solver")
    assert result.returncode == 0
    assert "goes without them" in result.stderr
    assert checkout.calls("benchmarks/run.py solver")
    assert not (checkout.root / ".venv/peers").exists()


def test_moved_checkout_makes_a_new_environment(checkout: Checkout) -> None:
    checkout.run("setup")
    checkout.root = checkout.root.rename(checkout.root.with_name("moved"))
    checkout.run("setup")
    assert len(checkout.calls("pip install")) == 2


def test_failed_installation_is_loud_and_starts_over(checkout: Checkout) -> None:
    (checkout.stubs / "pip-fails").touch()
    assert checkout.run("test").returncode == 1
    assert checkout.calls("-m pytest") == []
    (checkout.stubs / "pip-fails").unlink()
    assert checkout.run("setup").returncode == 0
    assert len(checkout.calls("-m venv")) == 1
    assert len(checkout.calls("pip install")) == 2


def test_killed_installation_starts_over(checkout: Checkout) -> None:
    waits = checkout.stubs / "pip-waits"
    waits.touch()
    process = checkout.start("setup")
    with process:
        while not (checkout.stubs / "pip-started").exists():
            assert process.poll() is None
            time.sleep(0.01)
        os.killpg(process.pid, signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    waits.unlink()
    assert checkout.run("setup").returncode == 0
    assert len(checkout.calls("-m venv")) == 1


def test_tests_run_in_the_root_without_the_slow_ones(checkout: Checkout) -> None:
    result = checkout.run("test", "-k", "two words")
    assert result.returncode == 7, "the exit code is pytest's"
    assert (checkout.stubs / "folder").read_text().strip() == str(checkout.root)
    arguments = (checkout.stubs / "arguments").read_text()
    assert "[-m][not slow]" in arguments
    assert arguments.endswith("[-k][two words]")


def test_all_tests_include_the_slow_ones(checkout: Checkout) -> None:
    checkout.run("test", "--all", "-x")
    arguments = (checkout.stubs / "arguments").read_text()
    assert "slow" not in arguments
    assert arguments.endswith("[-m][][-x]")


def test_demo_passes_its_arguments_on(checkout: Checkout) -> None:
    assert checkout.run("demo", "--out", "two words").returncode == 0
    assert checkout.calls("venv holdfast run upholding --out two words")


def test_link_to_the_script_works(checkout: Checkout) -> None:
    (checkout.home / "run").symlink_to(checkout.root / "run")
    result = subprocess.run(
        [checkout.home / "run", "setup"], env=checkout.environment, capture_output=True, check=False
    )
    assert result.returncode == 0
    assert (checkout.root / ".venv").is_dir()


def test_what_works_is_exported(checkout: Checkout) -> None:
    checkout.run("test")
    assert checkout.seen_by_pytest("HOLDFAST_RENDERER") == "egl"
    assert checkout.seen_by_pytest("MUJOCO_GL") == "egl"
    assert checkout.calls("apt-get") == []


def test_ordinary_user_without_opengl_gets_ray_casting(checkout: Checkout) -> None:
    checkout.renders_with("rays")
    result = checkout.run("test")
    assert "ray casting" in result.stderr
    assert checkout.seen_by_pytest("HOLDFAST_RENDERER") == "rays"
    assert checkout.seen_by_pytest("MUJOCO_GL") == "disable"
    assert checkout.calls("apt-get") == []


def test_root_without_opengl_installs_it(checkout: Checkout) -> None:
    checkout.become(0)
    checkout.renders_with("rays")
    checkout.run("test")
    assert checkout.calls("apt-get", "install", "libegl1 libgl1 libosmesa6")
    assert checkout.seen_by_pytest("MUJOCO_GL") == "egl"


@pytest.mark.parametrize(
    ("given", "mujoco_gl"),
    [({"MUJOCO_GL": "osmesa"}, "osmesa"), ({"HOLDFAST_RENDERER": "rays"}, "disable")],
)
def test_callers_choice_of_renderer_stands(checkout: Checkout, given: dict[str, str], mujoco_gl: str) -> None:
    checkout.run("test", **given)
    assert checkout.calls("backend") == []
    assert checkout.seen_by_pytest("MUJOCO_GL") == mujoco_gl


def test_caches_stay_inside_where_there_is_no_home(checkout: Checkout) -> None:
    checkout.run("test", HOME="")
    assert checkout.seen_by_pytest("XDG_CACHE_HOME") == str(checkout.root / ".venv/cache")


def test_foreign_python_path_is_dropped(checkout: Checkout) -> None:
    checkout.run("test", PYTHONPATH="somewhere")
    assert checkout.seen_by_pytest("PYTHONPATH") is None


def test_bytecode_is_kept(checkout: Checkout) -> None:
    checkout.run("test", PYTHONDONTWRITEBYTECODE="1")
    assert checkout.seen_by_pytest("PYTHONDONTWRITEBYTECODE") is None
    assert len(checkout.calls("compileall")) == 1


def test_python_without_venv_is_named_in_one_line(checkout: Checkout) -> None:
    (checkout.stubs / "no-venv").touch()
    result = checkout.run("test")
    assert result.returncode == 1
    assert result.stderr == "run: python3 has no venv: install it (Debian: apt-get install python3-venv)\n"


def test_root_gets_the_missing_venv_installed(checkout: Checkout) -> None:
    (checkout.stubs / "no-venv").touch()
    checkout.become(0)
    assert checkout.run("setup").returncode == 0
    assert checkout.calls("apt-get", "install", "python3-venv")
