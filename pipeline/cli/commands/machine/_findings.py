"""What of this machine and this installation counts for Holdfast, found out piece by piece."""

import os
import platform
import shutil
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from ..... import __version__
from .....base.files.file_paths import ROOT_VARIABLE, cache_folder, real_path
from .....base.machine.backend import RENDERER_VARIABLE, choose_backend
from .....errors import HoldfastError
from .....workers import available_cores
from ._needs import needs, numbers, version_of

__all__ = ["Finding", "State", "findings"]

_NEWEST_PYTHON = (3, 13)
# Versions of MuJoCo that are known to be wrong, and what is.
_BAD_MUJOCO: dict[tuple[int, ...], str] = {
    (4, 0, 0): "factorises the Newton Hessian wrongly where cones are elliptic"
}
_LEAST_FREE_BYTES = 1 << 30
_VARIABLES = (
    RENDERER_VARIABLE,
    "HOLDFAST_CACHE",
    ROOT_VARIABLE,
    "MUJOCO_GL",
    "OPENBLAS_NUM_THREADS",
    "NO_COLOR",
)
_KEPT_CODE = ("*.nbi", "*.nbc")


class State(Enum):
    """How a finding stands."""

    GOOD = "good"
    NOTE = "note"
    WRONG = "wrong"


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at.

    Attributes:
        name: of the thing.
        found: how it is.
        state: how that stands.
        advice: what to do; empty where there is nothing to do.
    """

    name: str
    found: str
    state: State = State.GOOD
    advice: str = ""


def findings() -> Iterator[Finding]:
    """All of them, one after the other; the renderer takes some seconds to be tried."""
    yield _python()
    yield _cores()
    yield _renderer()
    yield _mujoco()
    yield from _packages()
    yield from _extras()
    yield _cache()
    yield _kept_code()
    yield from (Finding(name, os.environ[name]) for name in _VARIABLES if name in os.environ)


def _python() -> Finding:
    where = f"{platform.system()} {platform.machine()}"
    found = f"holdfast {__version__}, Python {platform.python_version()} on {where}"
    if sys.version_info[:2] > _NEWEST_PYTHON:
        newest = ".".join(map(str, _NEWEST_PYTHON))
        return Finding("version", found, State.NOTE, f"nothing has been run on more than Python {newest} yet")
    return Finding("version", found)


def _cores() -> Finding:
    usable, there = available_cores(), os.cpu_count() or 1
    found = f"{usable}" if usable == there else f"{usable} of {there}"
    memory = f", {_size(_memory_bytes())} of memory" if _memory_bytes() else ""
    return Finding("cores", f"{found}{memory}")


def _memory_bytes() -> int:
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError):
        return 0


def _renderer() -> Finding:
    try:
        backend = choose_backend()
    except HoldfastError as error:
        return Finding("renderer", str(error), State.WRONG, "unset it, or take one of these")
    if backend == "rays":
        asked = os.environ.get(RENDERER_VARIABLE) or os.environ.get("MUJOCO_GL")
        why = "as asked" if asked else "no OpenGL without a display works here"
        advice = "" if asked else "pictures are slower; Debian: apt-get install libegl1 libgl1, or libosmesa6"
        return Finding("renderer", f"rays ({why})", State.GOOD if asked else State.NOTE, advice)
    return Finding("renderer", backend)


def _mujoco() -> Finding:
    version = version_of("mujoco")
    if version is None:
        return Finding("mujoco", "not installed", State.WRONG, "pip install mujoco")
    wrong = _BAD_MUJOCO.get(numbers(version))
    if wrong:
        return Finding("mujoco", version, State.WRONG, f"this version {wrong}: pip install 'mujoco<4'")
    return Finding("mujoco", version)


def _packages() -> Iterator[Finding]:
    """Libraries that are missing or out of bounds, or a line that none is."""
    wrong = [
        Finding(
            need.name,
            need.installed or "not installed",
            State.WRONG,
            f"pip install '{need.name}{need.bounds}'",
        )
        for need in needs()
        if need.extra is None and not need.is_met
    ]
    yield from wrong
    if not wrong:
        yield Finding("libraries", "all there, in versions that were tried")


def _extras() -> Iterator[Finding]:
    optional = [need for need in needs() if need.extra is not None]
    for extra in sorted({need.extra or "" for need in optional}):
        missing = [need.name for need in optional if need.extra == extra and not need.is_met]
        found = f"without {', '.join(missing)}" if missing else "installed"
        advice = f"if you want it: pip install 'holdfast[{extra}]'" if missing else ""
        yield Finding(f"extra {extra}", found, State.NOTE if missing else State.GOOD, advice)


def _cache() -> Finding:
    folder = cache_folder()
    found = f"{folder}, {_size(_bytes_in(folder))}"
    if not _is_writable(folder):
        advice = "shapes are worked out anew each time: set HOLDFAST_CACHE to a folder of yours"
        return Finding("cache", f"{found}, not writable", State.NOTE, advice)
    if shutil.disk_usage(_existing(folder)).free < _LEAST_FREE_BYTES:
        return Finding(
            "cache", f"{found}, its disk is nearly full", State.NOTE, "it can be removed at any time"
        )
    return Finding("cache", found)


def _kept_code() -> Finding:
    """Machine code of the inner loops, beside the sources."""
    package = real_path(Path(__file__)).parents[4]
    kept = sum(_bytes_in(folder, _KEPT_CODE) for folder in package.rglob("__pycache__"))
    if kept:
        return Finding("compiled code", f"{_size(kept)} beside the sources")
    if os.access(package, os.W_OK):
        return Finding(
            "compiled code", "none yet", State.NOTE, "the first run compiles for about a minute, once"
        )
    return Finding("compiled code", "in numba's cache folder: the sources can't be written to")


def _bytes_in(folder: Path, patterns: tuple[str, ...] = ("*",)) -> int:
    total = 0
    for path in (path for pattern in patterns for path in folder.rglob(pattern)):
        try:
            total += path.lstat().st_size if path.is_file() and not path.is_symlink() else 0
        except OSError:  # it went away while we looked
            continue
    return total


def _existing(folder: Path) -> Path:
    """The folder, or the nearest one around it that is there."""
    return next((place for place in (folder, *folder.parents) if place.is_dir()), Path(os.sep))


def _is_writable(folder: Path) -> bool:
    return os.access(_existing(folder), os.W_OK | os.X_OK)


def _size(count: int) -> str:
    for unit in ("bytes", "KiB", "MiB"):
        if count < 1024:
            return f"{count:.0f} {unit}"
        count //= 1024
    return f"{count:.0f} GiB"
