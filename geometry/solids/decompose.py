"""Convex pieces of a closed mesh, by CoACD, cached by content."""

import contextlib
import hashlib
import io
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import trimesh

from ...base.files.array_file import load_arrays
from ...base.files.file_paths import cache_folder
from ...base.files.input_file import read_input
from ...base.files.output_file import write_bytes
from ...errors import InputError
from ..shapes import Hull
from .closeness import Closeness, measure_closeness
from .coacd_process import PATIENCE, run_coacd
from .hollows import cut_at_hollows
from .manifold import from_hull, from_manifold, to_manifold

__all__ = ["Decomposition", "convex_pieces", "simplified"]

# Part of the cache key: raise it when anything below changes the pieces.
_VERSION = 6
# CoACD hangs on some meshes: so long for one try, and for all of a mesh.
_LONGEST_TRY_S, _LONGEST_S = 25.0, 60.0
# Share of the time that is given by the clock which CoACD may take.
_FOR_COACD = 0.7
# Pieces that stand out further than this bridge hollows, such as the inside of a ring or of a handle.
_FAR_M = 5e-4
# Cuts take time by the triangle, so that a surface of more is made simpler for them, by no more than this
# share of its size.
_MANY_TRIANGLES, _SIMPLER = 4000, (2e-4, 5e-4, 1e-3)
_LARGEST_BYTES = 64 * 1024 * 1024
# Thorough tries of more triangles ran out of their time, or were no better than quick ones cut further.
_THOROUGH_TRIANGLES = 1500
# What is tried in turn: preprocessing, and whether with little effort, coarsely. A surface with faults is
# only for the last two.
_TRIES: tuple[tuple[Literal["off", "on"], bool], ...] = (
    ("off", False),
    ("off", True),
    ("on", False),
    ("on", True),
)
_COARSE = 3.0


@dataclass(frozen=True, eq=False)
class Decomposition:
    """Convex pieces that stand for a solid, and how well.

    Attributes:
        pieces: convex hulls that together cover it.
        closeness: how far pieces and surface lie apart; None where the surface bounds no solid.
        note: where pieces are coarser than asked for, why, in words; empty otherwise.
        within_s: where time that was given for it ended the cutting, how much that was; None elsewhere.
    """

    pieces: tuple[Hull, ...]
    closeness: Closeness | None
    note: str = ""
    within_s: float | None = None

    def is_enough(self, within_s: float | None) -> bool:
        """Whether so much time is no reason to cut anew: all else takes the pieces that there are."""
        return self.within_s is None or within_s is None or within_s <= self.within_s


@dataclass
class _TimeLeft:
    """Time that may still be spent on cuts.

    Attributes:
        seconds: of a machine that is not busy, in s.
        until_s: by the clock that never goes back, where that much is given; None elsewhere.
        is_cut_short: whether the latter has ended a cut.
    """

    seconds: float = _LONGEST_S
    until_s: float | None = None
    is_cut_short: bool = False

    def for_try(self, is_quick: bool) -> tuple[float, float]:
        """What the next try may take, in s: where a processor is free, and at most by the clock.

        Of what is given by the clock, thorough tries leave half to quick ones.
        """
        limit_s = min(_LONGEST_TRY_S, self.seconds)
        longest_s = PATIENCE * limit_s
        if self.until_s is not None:
            given_s = self.until_s - time.monotonic()
            self.is_cut_short |= given_s <= 0.0
            longest_s = min(longest_s, given_s if is_quick else 0.5 * given_s)
        return min(limit_s, longest_s), longest_s

    def note_try(self, took_s: float, limit_s: float, longest_s: float, *, has_ended: bool) -> None:
        """Counts a try; what a busy machine took beyond the limit is not charged."""
        self.seconds -= min(limit_s, took_s)
        if not has_ended and self.until_s is not None and took_s >= min(limit_s, longest_s):
            self.is_cut_short = True


def convex_pieces(
    mesh: trimesh.Trimesh, *, threshold: float = 0.05, seed: int = 0, within_s: float | None = None
) -> Decomposition:
    """Convex hulls that together cover a closed mesh; the mesh's own hull where it is convex already.

    Args:
        mesh: closed surface, outward normals, in m.
        threshold: CoACD's concavity threshold (its own unit: share of the mesh's size).
        seed: seed of CoACD's sampling; the same seed gives the same pieces.
        within_s: time by the clock after which no cut goes on, in s. What is coarser for that is kept until
            more time is given. None gives it a minute of an idle machine.
    """
    if mesh.is_convex:
        hull = (Hull.from_points(mesh.vertices),)
        return Decomposition(hull, measure_closeness(mesh, hull))
    digest = hashlib.sha256(f"{_VERSION} {threshold} {seed}".encode())
    for array in (np.asarray(mesh.vertices, dtype="<f8"), np.asarray(mesh.faces, dtype="<i8")):
        digest.update(array.tobytes())
    cached = cache_folder() / "pieces" / f"{digest.hexdigest()}.npz"
    made = _read(cached)
    if made is None or not made.is_enough(within_s):
        made = _decompose(mesh, threshold, seed, within_s)
        _write(cached, made)
    return made


def _decompose(mesh: trimesh.Trimesh, threshold: float, seed: int, within_s: float | None) -> Decomposition:
    """The pieces; cut further where those of the threshold bridge hollows."""
    now_s = time.monotonic()
    time_left = _TimeLeft(until_s=None if within_s is None else now_s + _FOR_COACD * within_s)
    bodies, is_solid = _bodies(mesh)
    pieces, uncut = _pieces(bodies, is_solid, threshold, seed, time_left)
    closeness = measure_closeness(mesh, pieces)
    are_cut_further = closeness is not None and closeness.outside_m > _FAR_M
    if are_cut_further:
        simpler = simplified(mesh)
        until_s = None if within_s is None else now_s + within_s
        pieces = cut_at_hollows(pieces, simpler, until_s=until_s)
        if simpler is not mesh:
            pieces = _fit(pieces, mesh)
        closeness = measure_closeness(mesh, pieces)
    is_short = time_left.is_cut_short
    note = _note(uncut, len(bodies), within_s if is_short else None, are_cut_further=are_cut_further)
    return Decomposition(tuple(pieces), closeness, note, within_s if is_short else None)


def _note(uncut: int, bodies: int, within_s: float | None, *, are_cut_further: bool) -> str:
    """What of a mesh is coarser than asked for, and why.

    Args:
        uncut: bodies that CoACD did not cut.
        bodies: all of them.
        within_s: the time, where that was the reason; None elsewhere.
        are_cut_further: whether what stood far out was cut in another way.
    """
    in_time = "" if within_s is None else f" in the {max(0.0, within_s):.0f} s that there were for it"
    if not uncut:
        return f"cut coarsely, as there was no cutting it finely{in_time}" if in_time else ""
    of_what = "the mesh" if bodies == 1 else f"{uncut} of its {bodies} bodies"
    then = "halved again and again instead" if are_cut_further else "the convex hull stands for it"
    return f"{of_what} could not be cut into convex pieces by CoACD{in_time}: {then}"


def _pieces(
    bodies: list[trimesh.Trimesh], is_solid: bool, threshold: float, seed: int, time_left: _TimeLeft
) -> tuple[list[Hull], int]:
    """The pieces of all bodies, the hull of each that can't be cut in time; and how many these are."""
    pieces: list[Hull] = []
    uncut = 0
    for body in bodies:
        if body.is_convex:
            pieces.append(Hull.from_points(body.vertices))
            continue
        made = _cut(body, is_solid, threshold, seed, time_left)
        uncut += made is None
        pieces += [Hull.from_points(body.vertices)] if made is None else made
    return pieces, uncut


def _bodies(mesh: trimesh.Trimesh) -> tuple[list[trimesh.Trimesh], bool]:
    """The bodies of a mesh, each apart, and whether they bound solids; one with cavities stays whole."""
    solid = to_manifold(mesh)
    if solid is None:
        return [mesh], False
    bodies = [from_manifold(body) for body in solid.decompose()]
    if len(bodies) < 2 or any(body.volume <= 0.0 for body in bodies):
        return [mesh], True
    return bodies, True


def _cut(
    body: trimesh.Trimesh, is_solid: bool, threshold: float, seed: int, time_left: _TimeLeft
) -> list[Hull] | None:
    """Convex pieces of one body, on its surface; None where CoACD finds none in time.

    Its preprocessing moves the surface outwards, so it is only for what can't be cut without.
    """
    simpler = simplified(body)
    is_dense = len(simpler.faces) > _THOROUGH_TRIANGLES
    for preprocess, is_quick in _TRIES if is_solid else _TRIES[2:]:
        if is_dense and preprocess == "off" and not is_quick:
            continue
        limit_s, longest_s = time_left.for_try(is_quick)
        if limit_s <= 0.0:
            return None
        started = time.monotonic()
        clouds = run_coacd(
            simpler,
            preprocess=preprocess,
            threshold=_COARSE * threshold if is_quick else threshold,
            seed=seed,
            limit_s=limit_s,
            longest_s=longest_s,
            is_quick=is_quick,
        )
        took_s = time.monotonic() - started
        time_left.note_try(took_s, limit_s, longest_s, has_ended=clouds is not None)
        # A flat sliver has no inside, so nothing is lost without it.
        smallest = 1e-6 * body.scale
        hulls = [
            Hull.from_points(c)
            for c in clouds or ()
            if len(c) > 3 and np.linalg.matrix_rank(c - c.mean(axis=0), tol=smallest) == 3
        ]
        if hulls:
            return _fit(hulls, body)
    return None


def simplified(body: trimesh.Trimesh) -> trimesh.Trimesh:
    """A body of not too many triangles, near the one given; that one itself where it bounds no solid."""
    solid = to_manifold(body) if len(body.faces) > _MANY_TRIANGLES else None
    if solid is None:
        return body
    for share in _SIMPLER:
        solid = solid.simplify(share * float(body.scale))
        if solid.num_tri() <= _MANY_TRIANGLES:
            break
    return body if solid.is_empty() else from_manifold(solid)


def _fit(hulls: list[Hull], body: trimesh.Trimesh) -> list[Hull]:
    """Each piece becomes the hull of what of the body lies in it: no corner stays outside of the surface."""
    solid = to_manifold(body)
    if solid is None:
        return hulls
    fitted = []
    for hull in hulls:
        inside = from_hull(hull) ^ solid
        if inside.volume() > 1e-9 * body.scale**3:
            fitted.append(Hull.from_points(from_manifold(inside).vertices))
    return fitted or hulls


def _read(path: Path) -> Decomposition | None:
    """What a cache file holds, None where it is not there or not whole."""
    try:
        data: dict[str, Any] = dict(load_arrays(read_input(path, _LARGEST_BYTES), largest=_LARGEST_BYTES))
        pieces = tuple(Hull(data[f"v{i}"], data[f"f{i}"]) for i in range(int(data["count"])))
        widths = [float(width) for width in data["closeness"]]
        note = str(data["note"])
        # Files of earlier versions have none.
        short = [float(seconds) for seconds in data.get("within_s", ())]
    except (InputError, ValueError, KeyError, TypeError):
        return None
    if not pieces or not all(_is_sound(piece) for piece in pieces) or len(widths) not in (0, 2):
        return None
    return Decomposition(pieces, Closeness(*widths) if widths else None, note, short[0] if short else None)


def _is_sound(piece: Hull) -> bool:
    v, f = piece.vertices, piece.faces
    if v.ndim != 2 or v.shape[1] != 3 or f.ndim != 2 or f.shape[1] != 3 or len(v) < 4 or len(f) < 4:
        return False
    if v.dtype != np.float64 or f.dtype != np.int64:
        return False
    return bool(np.isfinite(v).all() and f.min() >= 0 and f.max() < len(v))


def _write(path: Path, made: Decomposition) -> None:
    arrays: dict[str, Any] = {
        f"{k}{i}": a for i, p in enumerate(made.pieces) for k, a in (("v", p.vertices), ("f", p.faces))
    }
    arrays["count"] = np.array(len(made.pieces))
    arrays["closeness"] = np.array(made.closeness or (), dtype=float)
    arrays["note"] = np.array(made.note)
    arrays["within_s"] = np.array([] if made.within_s is None else [made.within_s])
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)
    # A cache that can't be written only costs time.
    with contextlib.suppress(InputError):
        write_bytes(path, buffer.getvalue())
