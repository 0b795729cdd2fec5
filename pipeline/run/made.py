"""What a run is made with, looked up on this machine."""

import platform
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from ...workers import available_cores
from ..records import Made
from .settings import RunSettings

__all__ = ["made_here"]

# What computes; releases of these may round differently.
_PACKAGES = ("numpy", "scipy", "numba", "mujoco", "highspy", "python-fcl", "daqp", "trimesh", "coacd")
_CPU_INFO = Path("/proc/cpuinfo")


def made_here(settings: RunSettings) -> Made:
    """What a run that begins now is made with."""
    return Made(
        date=datetime.now(UTC).isoformat(timespec="seconds"),
        system=f"{platform.system()} {platform.machine()}",
        processor=_processor(),
        cores=available_cores(),
        workers=settings.workers,
        budget=settings.budget_s,
        versions={"python": platform.python_version(), **_versions()},
    )


def _versions() -> dict[str, str]:
    found = {}
    for name in _PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:  # installed by other means than a package manager
            continue
    return found


def _processor() -> str:
    try:
        lines = _CPU_INFO.read_text("utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    named = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(named, "")
