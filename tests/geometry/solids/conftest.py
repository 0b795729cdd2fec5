"""Meshes that tests of objects use, too."""

from ...objects.conftest import l_mesh, ring

__all__ = ["l_mesh", "ring"]
