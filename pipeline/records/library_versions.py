"""Versions of the libraries on which a run's figures depend."""

from functools import cache
from importlib.metadata import PackageNotFoundError, version

__all__ = ["library_versions"]

_DECISIVE = ("coacd", "daqp", "highspy", "mujoco", "numba", "numpy", "python-fcl", "scipy", "trimesh")


@cache
def library_versions() -> dict[str, str]:
    """Version by name of each library that is installed with its metadata."""
    found = {}
    for name in _DECISIVE:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
