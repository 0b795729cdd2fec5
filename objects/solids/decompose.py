"""Convex pieces of a closed mesh, by CoACD, cached by content."""

import contextlib
import hashlib
import io
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from ...files import cache_folder, write_bytes
from ...geometry import Hull

__all__ = ["convex_pieces"]

# Part of the cache key: raise it when anything below changes the pieces.
_VERSION = 1


def convex_pieces(mesh: trimesh.Trimesh, *, threshold: float = 0.05, seed: int = 0) -> tuple[Hull, ...]:
    """Convex hulls that together cover a closed mesh; the mesh's own hull where it is convex already.

    Args:
        mesh: closed surface, outward normals, in m.
        threshold: CoACD's concavity threshold (its own unit: share of the mesh's size).
        seed: seed of CoACD's sampling; the same seed gives the same pieces.
    """
    if mesh.is_convex:
        return (Hull.from_points(mesh.vertices),)
    digest = hashlib.sha256(f"{_VERSION} {threshold} {seed}".encode())
    for array in (np.asarray(mesh.vertices, dtype="<f8"), np.asarray(mesh.faces, dtype="<i8")):
        digest.update(array.tobytes())
    cached = cache_folder() / "pieces" / f"{digest.hexdigest()}.npz"
    pieces = _read(cached)
    if pieces is None:
        pieces = _decompose(mesh, threshold, seed)
        _write(cached, pieces)
    return pieces


def _decompose(mesh: trimesh.Trimesh, threshold: float, seed: int) -> tuple[Hull, ...]:
    import coacd  # takes 0.2 s and most runs find their pieces in the cache

    coacd.set_log_level("error")
    parts = coacd.run_coacd(coacd.Mesh(mesh.vertices, mesh.faces), threshold=threshold, seed=seed)
    clouds = [np.asarray(vertices, dtype=float) for vertices, _ in parts]
    # A flat sliver has no inside, so nothing is lost without it.
    smallest = 1e-6 * mesh.scale
    solid = [c for c in clouds if np.linalg.matrix_rank(c - c.mean(axis=0), tol=smallest) == 3]
    return tuple(Hull.from_points(cloud) for cloud in solid)


def _read(path: Path) -> tuple[Hull, ...] | None:
    """The pieces in a cache file, None where it is not there or not whole."""
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as data:
            pieces = tuple(Hull(data[f"v{i}"], data[f"f{i}"]) for i in range(int(data["count"])))
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, zlib.error):
        return None
    return pieces if pieces and all(_is_sound(piece) for piece in pieces) else None


def _is_sound(piece: Hull) -> bool:
    v, f = piece.vertices, piece.faces
    if v.ndim != 2 or v.shape[1] != 3 or f.ndim != 2 or f.shape[1] != 3 or len(v) < 4 or len(f) < 4:
        return False
    if v.dtype != np.float64 or f.dtype != np.int64:
        return False
    return bool(np.isfinite(v).all() and f.min() >= 0 and f.max() < len(v))


def _write(path: Path, pieces: tuple[Hull, ...]) -> None:
    arrays: dict[str, Any] = {
        f"{k}{i}": a for i, p in enumerate(pieces) for k, a in (("v", p.vertices), ("f", p.faces))
    }
    arrays["count"] = np.array(len(pieces))
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)
    # A cache that can't be written only costs time.
    with contextlib.suppress(OSError):
        write_bytes(path, buffer.getvalue())
