"""Bodies of one mesh that touch or overlap, made one solid."""

import manifold3d
import numpy as np
import trimesh

from .manifold import from_manifold, to_manifold

__all__ = ["unite"]

# Volume counted twice that is taken for rounding, as a share of the whole.
_ROUNDING = 1e-9
# A surface that crosses itself is cut apart so often, at such shares of its width: what crosses is then
# bodies of their own, unless a cut runs through the very place, which not all of them do.
_CUTS, _SHARES = 6, (0.36, 0.64, 0.43)
_LEAST_TWICE = 1e-4


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
        return _cross_once(mesh, whole)
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


def _cross_once(mesh: trimesh.Trimesh, whole: manifold3d.Manifold) -> tuple[trimesh.Trimesh, list[str]]:
    """A body that does not cross itself in place of one that does, and what was done, in words."""
    best = whole
    for share in _SHARES:
        union = None if mesh.is_convex else _united_cuts(whole, share)
        if union is None or whole.volume() - union.volume() <= _LEAST_TWICE * whole.volume():
            break
        best = min(best, union, key=lambda solid: solid.volume())
    twice = whole.volume() - best.volume()
    if not twice > 0.0:
        return mesh, []
    said = f"joined the body to itself where it crosses itself: {1e6 * twice:.3g} cm^3 count once"
    return from_manifold(best), [said]


def _united_cuts(whole: manifold3d.Manifold, share: float) -> manifold3d.Manifold | None:
    """The union of a body's parts once it is cut; None where a cavity has come free by a cut."""
    parts = [whole]
    for _ in range(_CUTS):
        parts = [body for part in parts for side in _cut(part, share) for body in side.decompose()]
    if any(part.volume() < 0.0 for part in parts):
        return None
    return manifold3d.Manifold.batch_boolean(parts, manifold3d.OpType.Add)


def _cut(part: manifold3d.Manifold, share: float) -> list[manifold3d.Manifold]:
    """The two sides of a plane across the longest axis, at a share of the width."""
    box = np.array(part.bounding_box()).reshape(2, 3)
    axis = np.eye(3)[np.argmax(box[1] - box[0])]
    offset = float(axis @ (box[0] + share * (box[1] - box[0])))
    return [side for side in part.split_by_plane(axis.tolist(), offset) if not side.is_empty()]
