"""Which offscreen renderer works on this machine, found out without importing MuJoCo.

MuJoCo reads MUJOCO_GL once, when it is imported, and the import itself fails where the library behind the
chosen backend is missing. So each backend is tried by drawing one frame in a process of its own, and the
answer is kept in the environment, where this process and its children find it again.
"""

import atexit
import functools
import logging
import os
import subprocess
import sys

from ...errors import InputError, MissingBackend

__all__ = ["BACKENDS", "RENDERER_VARIABLE", "check_renderer", "choose_backend", "configure", "expect_choice"]

RENDERER_VARIABLE = "HOLDFAST_RENDERER"
"""Environment variable that names the renderer: one of `BACKENDS`."""

BACKENDS = ("egl", "osmesa", "glfw", "rays")
"""`egl` and `osmesa` draw without a display; `glfw` needs one and is used only when asked for; `rays` is ours
and needs no OpenGL."""

_PROBED = ("egl", "osmesa")  # the faster one first
_PROBE_SECONDS = 60.0  # a driver that waits for a device that never answers counts as missing
_GL_OFF = ("disable", "disabled", "off", "false", "0")  # as MuJoCo spells it
_GL_DEFAULT = ("enable", "enabled", "on", "true", "1", "glfw", "glx")
_DRAW_ONE_FRAME = """
import mujoco
model = mujoco.MjModel.from_xml_string("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
with mujoco.Renderer(model, 16, 16) as renderer:
    renderer.update_scene(data)
    assert renderer.render().any()
"""

# Processes that try a backend already.
_begun: "dict[str, subprocess.Popen[bytes]]" = {}

_log = logging.getLogger(__name__)


def choose_backend() -> str:
    """Returns the renderer to use: one of `BACKENDS`.

    HOLDFAST_RENDERER decides, then MUJOCO_GL; where neither is set, the first of egl and osmesa that draws a
    frame, else `rays`, which shades by ray casting and works everywhere.

    Raises:
        InputError: a variable is set to a name that means nothing.
    """
    asked = os.environ.get(RENDERER_VARIABLE, "").strip().lower()
    if asked:
        if asked not in BACKENDS:
            raise InputError(RENDERER_VARIABLE, "", f"must be one of {', '.join(BACKENDS)}, not {asked!r}")
        return asked
    gl = os.environ.get("MUJOCO_GL", "").strip().lower()
    if gl in _PROBED:
        return gl
    if gl in _GL_OFF:
        return "rays"
    if gl in _GL_DEFAULT:
        return "glfw"
    if gl:
        raise InputError("MUJOCO_GL", "", f"must be one of egl, osmesa, glfw, disable, not {gl!r}")
    return _probe()


def configure() -> str:
    """Sets MUJOCO_GL and HOLDFAST_RENDERER for this process and its children, and returns the renderer.

    To be called before MuJoCo is imported. Where that has happened already with MUJOCO_GL unset, MuJoCo has
    settled on a backend that needs a display, and the answer is `rays`.
    """
    too_late = "mujoco" in sys.modules and not os.environ.get("MUJOCO_GL")
    backend = "rays" if too_late else choose_backend()
    if too_late:
        _log.warning("MuJoCo was imported before its renderer was chosen: pictures are made by ray casting")
    os.environ[RENDERER_VARIABLE] = backend
    os.environ["MUJOCO_GL"] = "disable" if backend == "rays" else backend
    return backend


def check_renderer() -> None:
    """Imports MuJoCo, which needs the library behind the backend that `configure` has set.

    Raises:
        MissingBackend: that library is missing, as may be where the backend was named by hand.
    """
    try:
        import mujoco  # noqa: F401  late: it settles on a backend when it is imported
    except (ImportError, AttributeError, OSError, RuntimeError) as error:
        backend = os.environ.get("MUJOCO_GL")
        raise MissingBackend(
            f"MuJoCo can't draw with MUJOCO_GL={backend} ({error}); HOLDFAST_RENDERER=rays needs no OpenGL"
        ) from None


@functools.cache
def _probe() -> str:
    """The first backend that draws a frame, else `rays`."""
    return next((backend for backend in _PROBED if _draws(backend)), "rays")


def expect_choice() -> None:
    """Begins to try the first backend, where one will have to be chosen: soon, and not in this very moment.

    The process that tries it needs a third of a second, in which this one can import what it needs.
    """
    is_named = any(os.environ.get(name, "").strip() for name in (RENDERER_VARIABLE, "MUJOCO_GL"))
    first = _PROBED[0]
    if not is_named and first not in _begun:
        _begun[first] = _start(first)


@atexit.register
def _end_begun() -> None:
    """Ends tries whose answer nobody has asked for: a driver may never give one."""
    for process in _begun.values():
        with process:
            process.kill()
    _begun.clear()


def _draws(backend: str) -> bool:
    """Whether a process with MUJOCO_GL set to `backend` can draw a frame."""
    with _begun.pop(backend, None) or _start(backend) as process:
        try:
            return process.wait(_PROBE_SECONDS) == 0
        except subprocess.TimeoutExpired:
            return False
        finally:
            process.kill()


def _start(backend: str) -> "subprocess.Popen[bytes]":
    """A process that tries a backend."""
    return subprocess.Popen(
        # -P keeps the folder we happen to be in off the import path.
        [sys.executable, "-P", "-c", _DRAW_ONE_FRAME],
        env={**os.environ, "MUJOCO_GL": backend},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        cwd=os.sep,  # MuJoCo writes its log into the current folder
    )


if __name__ == "__main__":
    sys.stdout.write(f"{choose_backend()}\n")
