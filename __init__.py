"""Holdfast: certified grasp synthesis with specified contact regions, retraction and a hold test."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("holdfast")
except PackageNotFoundError:  # the tree was imported without being installed
    __version__ = "0+unknown"

__all__ = ["__version__"]
