"""Bodies of one mesh that touch or overlap, made one solid."""

import manifold3d
import numpy as np
import trimesh

from .manifold import from_manifold, to_manifold

__all__ = ["unite"]

# Volume counted twice that is taken for rounding, as a share of the whole.
_ROUNDING = 1e-9


def unite(mesh: trimesh.Trimesh) -> tuple[trimesh.Trimesh, list[str]]:
    """The union of the bodies of a closed, outward mesh, and what was done, in words.

    A mesh whose bodies lie apart comes back as it is. A body that is inside out is a cavity of the smallest
    body around it.
    """
    whole = to_manifold(mesh)
    if whole is None:
        return mesh, []
    shells = [from_manifold(shell) for shell in whole.decompose()]
    if len(shells) < 2 and mesh.is_watertight:
        return mesh, []
    bodies = sorted((shell for shell in shells if shell.volume > 0.0), key=lambda body: float(body.volume))
    solids = [to_manifold(body) for body in bodies]
    for cavity in (shell for shell in shells if shell.volume < 0.0):
        around = [i for i, body in enumerate(bodies) if _surrounds(body, cavity)]
        cavity.invert()
        hole = to_manifold(cavity)
        if around and hole is not None and (solid := solids[around[0]]) is not None:
            solids[around[0]] = solid - hole
    sound = [solid for solid in solids if solid is not None]
    if not sound:
        return mesh, []
    union = manifold3d.Manifold.batch_boolean(sound, manifold3d.OpType.Add)
    twice = sum(solid.volume() for solid in sound) - union.volume()
    if twice <= _ROUNDING * union.volume() and mesh.is_watertight:
        return mesh, []
    if twice <= _ROUNDING * union.volume():
        return from_manifold(union), []
    said = f"united {len(sound)} bodies that overlap: {1e6 * twice:.3g} cm^3 count once"
    return from_manifold(union), [said]


def _surrounds(body: trimesh.Trimesh, cavity: trimesh.Trimesh) -> bool:
    low, high = body.bounds
    return bool(np.all(cavity.bounds[0] >= low) and np.all(cavity.bounds[1] <= high))
