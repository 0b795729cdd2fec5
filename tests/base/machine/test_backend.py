"""The choice of the offscreen renderer, with MuJoCo out of the process."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator

import pytest
from holdfast.base.machine import backend
from holdfast.errors import InputError


@pytest.fixture(autouse=True)
def clean(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Neither a variable nor an earlier answer decides."""
    for name in ("MUJOCO_GL", backend.RENDERER_VARIABLE):
        monkeypatch.setenv(name, "")  # so that whatever a test sets is undone
        monkeypatch.delenv(name)
    backend._probe.cache_clear()
    yield
    backend._probe.cache_clear()


@pytest.fixture
def working(monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[str]]:
    """Makes only the backends named draw, and returns the list of those tried."""

    def declare(*names: str) -> list[str]:
        tried: list[str] = []

        def draws(name: str) -> bool:
            tried.append(name)
            return name in names

        monkeypatch.setattr(backend, "_draws", draws)
        return tried

    return declare


def without_mujoco(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "mujoco", raising=False)


@pytest.mark.parametrize(
    ("works", "chosen", "tried"),
    [
        (("egl", "osmesa"), "egl", ["egl"]),
        (("osmesa",), "osmesa", ["egl", "osmesa"]),
        ((), "rays", ["egl", "osmesa"]),
    ],
)
def test_first_backend_that_draws_is_chosen_and_remembered(
    working: Callable[..., list[str]], works: tuple[str, ...], chosen: str, tried: list[str]
) -> None:
    seen = working(*works)
    assert backend.choose_backend() == chosen
    assert backend.choose_backend() == chosen
    assert seen == tried


@pytest.mark.parametrize(
    ("gl", "chosen"),
    [
        ("egl", "egl"),
        (" OSMesa ", "osmesa"),
        ("disable", "rays"),
        ("off", "rays"),
        ("glfw", "glfw"),
        ("1", "glfw"),
    ],
)
def test_mujoco_gl_is_honoured_without_a_probe(
    working: Callable[..., list[str]], monkeypatch: pytest.MonkeyPatch, gl: str, chosen: str
) -> None:
    seen = working()
    monkeypatch.setenv("MUJOCO_GL", gl)
    assert backend.choose_backend() == chosen
    assert seen == []


def test_our_own_variable_decides_over_mujocos(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "egl")
    monkeypatch.setenv(backend.RENDERER_VARIABLE, "rays")
    assert backend.choose_backend() == "rays"


@pytest.mark.parametrize("variable", ["MUJOCO_GL", backend.RENDERER_VARIABLE])
def test_unknown_name_is_refused_with_the_choices(monkeypatch: pytest.MonkeyPatch, variable: str) -> None:
    monkeypatch.setenv(variable, "vulkan")
    with pytest.raises(InputError, match=rf"{variable}: must be one of egl, osmesa, .*, not 'vulkan'"):
        backend.choose_backend()


@pytest.mark.parametrize(
    ("works", "renderer", "gl"),
    [(("egl",), "egl", "egl"), (("osmesa",), "osmesa", "osmesa"), ((), "rays", "disable")],
)
def test_configure_tells_mujoco_and_the_children(
    working: Callable[..., list[str]],
    monkeypatch: pytest.MonkeyPatch,
    works: tuple[str, ...],
    renderer: str,
    gl: str,
) -> None:
    without_mujoco(monkeypatch)
    seen = working(*works)
    assert backend.configure() == renderer
    assert os.environ["MUJOCO_GL"] == gl
    assert os.environ[backend.RENDERER_VARIABLE] == renderer
    backend._probe.cache_clear()  # as in a child
    tried = list(seen)
    assert backend.configure() == renderer
    assert seen == tried


def test_configure_after_an_import_of_mujoco_does_without_opengl(
    working: Callable[..., list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    working("egl")
    monkeypatch.setitem(sys.modules, "mujoco", sys)
    assert backend.configure() == "rays"


def test_a_choice_that_is_expected_is_begun_once(monkeypatch: pytest.MonkeyPatch) -> None:
    begun = []

    def start(name: str) -> subprocess.Popen[bytes]:
        begun.append(name)
        return subprocess.Popen([sys.executable, "-c", ""])

    monkeypatch.setattr(backend, "_start", start)
    backend.expect_choice()
    backend.expect_choice()
    assert backend.choose_backend() == "egl" and begun == ["egl"]
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    backend.expect_choice()
    assert begun == ["egl"], "where one is named there is nothing to find out"


def test_a_try_that_nobody_asks_for_ends_with_the_command() -> None:
    code = (
        "import subprocess, sys; from holdfast.base.machine import backend;"
        "backend._start = lambda _: subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)']);"
        "backend.expect_choice(); print(backend._begun['egl'].pid)"
    )
    words = [sys.executable, "-P", "-W", "error", "-c", code]
    finished = subprocess.run(words, capture_output=True, text=True, check=True, timeout=60)
    assert finished.stderr == ""
    with pytest.raises(ProcessLookupError):
        os.kill(int(finished.stdout), 0)


def test_import_is_light() -> None:
    """The probe must be able to fail without taking this process along."""
    code = (
        "import sys, holdfast.base.machine.backend;"
        "heavy = {'mujoco', 'numpy', 'holdfast.solver', 'holdfast.mjcf'} & set(sys.modules);"
        "sys.exit(f'imported {heavy}' if heavy else 0)"
    )
    finished = subprocess.run([sys.executable, "-P", "-c", code], capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stderr


def test_module_prints_a_renderer_that_works_here() -> None:
    """The real probe, as the run script asks for it."""
    command = [sys.executable, "-P", "-m", "holdfast.base.machine.backend"]
    name = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    assert name in {"egl", "osmesa", "rays"}
