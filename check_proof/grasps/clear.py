"""That nothing sinks in deeper than it may, wherever the solution is: planes between pieces and vertices.

On a stretch of the way a plane stands still while the pieces move. The gap along its normal is the least of
functions, one for each two vertices, whose second derivative is bounded: so it lies above the line between
its values at the ends, less that bound times s (1 - s) / 2.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ..intervals import down, up
from ..reading import Rejected, indices, items, numbers
from .form import Form, Written, field, number
from .places import Frames, frames_of
from .spans import Spans, matvec

__all__ = ["check_clear"]

# Halvings beyond those that the file has planes for.
_MORE_HALVINGS = 2
_MOST_HALVINGS = 24
# No honest way needs more, and a forged one must come to an end.
_MOST_STRETCHES, _MOST_WAYPOINTS = 2000, 100
_DIRECTIONS = np.array(
    [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) != (0, 0, 0)],
    dtype=float,
)
_Planes = dict[tuple[int, int], dict[int, Array]]


def check_clear(form: Form, written: Written, record: dict[str, Any], R: Spans, p: Spans) -> bool:
    """Whether the way was shown to be clear, too, beside the grasp.

    Raises:
        Rejected: the statement was not shown.
    """
    clear = field(field(record, "evidence", dict), "clear", dict)
    depth, contact_depth, margin = (number(clear.get(n)) for n in ("depth", "contact_depth", "margin"))
    if min(depth, contact_depth, margin) < 0.0:
        raise Rejected("a depth is below zero")
    planes = _planes(form, clear)
    scene = _Scene(form, R, p)
    everything = np.arange(len(form.pairs))
    apart = margin if margin > 0.0 else -depth
    required = np.where(form.intended, -contact_depth, apart) - form.stands_out
    q = Spans.around(written.q, written.radii[0])
    here = scene.at(frames_of(form, [q[k] for k in range(len(written.q))]))
    open_ = here.room(everything, required, planes.get((-1, 1), {})) < 0.0
    if open_.any():
        raise Rejected(f"pair {int(np.argmax(open_))} of pieces may sink in too deep in the grasp")
    if field(clear, "approach", bool) is False:
        return False
    way = _way(form, record)
    if not 2 <= len(way) <= _MOST_WAYPOINTS or not np.array_equal(way[-1], written.q):
        raise Rejected("the approach does not end in the grasp")
    required = np.where(form.intended, -contact_depth, -depth) - form.stands_out
    for step, (start, end) in enumerate(pairwise(way)):
        _Step(scene, written, (start, end), required).check(
            {cell: found for (which, cell), found in planes.items() if which == step}
        )
    return True


def _planes(form: Form, clear: dict[str, Any]) -> _Planes:
    """Normals by step and stretch, then by pair."""
    out: _Planes = {}
    for plane in items(clear.get("planes")):
        step, cell, *rest = items(plane, 6)
        if type(step) is not int or type(cell) is not int or not 1 <= cell < 1 << _MOST_HALVINGS:
            raise Rejected("a plane belongs nowhere")
        (pair,) = indices(rest[:1], len(form.pairs), 1).tolist()
        normal = numbers(rest[1:], 3)
        if not 0.1 < np.linalg.norm(normal) < 10.0:
            raise Rejected("a plane has no normal")
        out.setdefault((step, cell), {})[pair] = normal
    return out


def _way(form: Form, record: dict[str, Any]) -> list[Array]:
    """The waypoints, each (n_independent,)."""
    places = items(field(record, "approach", dict).get("waypoints"))
    return [
        numbers([place.get(name) if isinstance(place, dict) else None for name in form.names])
        for place in places
    ]


class _Scene:
    """The object in its place, with the hand to be put there."""

    def __init__(self, form: Form, R: Spans, p: Spans):
        self.form = form
        self._still = [
            None if piece.link >= 0 else matvec(R, Spans.of(piece.core)) + p for piece in form.pieces
        ]
        self._still_ends = [None if x is None else _ends(x, _DIRECTIONS) for x in self._still]
        radii = np.array([piece.radius for piece in form.pieces])
        self.radii = up(radii[form.pairs[:, 0]] + radii[form.pairs[:, 1]])

    def at(self, frames: Frames) -> "_Bodies":
        """All pieces, the hand where its links may be."""
        vertices, ends = [], []
        for piece, still, still_ends in zip(self.form.pieces, self._still, self._still_ends, strict=True):
            placed = still
            if placed is None:
                R, p = frames.rotations[piece.link], frames.positions[piece.link]
                placed = matvec(R, Spans.of(piece.core)) + p
            vertices.append(placed)
            ends.append(_ends(placed, _DIRECTIONS) if still_ends is None else still_ends)
        return _Bodies(self, vertices, np.array([e[0] for e in ends]), np.array([e[1] for e in ends]))


class _Bodies:
    """Pieces in their places, with the least and the most of each along `_DIRECTIONS`."""

    def __init__(self, scene: _Scene, vertices: list[Spans], least: Array, most: Array):
        self._scene, self._vertices, self._least, self._most = scene, vertices, least, most

    def room(self, pairs: Indices, required: Array, normals: dict[int, Array]) -> Array:
        """Below what pairs (k,) have beyond what they need, by the best direction or their own normal."""
        best = self.common(pairs, required).max(axis=1)
        for i, pair in enumerate(pairs.tolist()):
            if best[i] < 0.0 and pair in normals:
                best[i] = max(best[i], self.along(pair, required[pair], normals[pair]))
        return best

    def common(self, pairs: Indices, required: Array) -> Array:
        """The same (k, 26) along `_DIRECTIONS`."""
        a, b = self._scene.form.pairs[pairs].T
        needs = _needs(up(required[pairs] + self._scene.radii[pairs])[:, None], _DIRECTIONS)
        return np.asarray(down(down(self._least[b] - self._most[a]) - needs))

    def along(self, pair: int, required: float, normal: Array) -> float:
        """The same of one pair along a normal."""
        a, b = self._scene.form.pairs[pair]
        n = normal[None]
        gap = down(_ends(self._vertices[b], n)[0] - _ends(self._vertices[a], n)[1])
        need = _needs(np.array([[up(required + self._scene.radii[pair])]]), n)
        return float(down(gap - need[0])[0])


class _Step:
    """A straight line in joint space from one waypoint to the next."""

    def __init__(self, scene: _Scene, written: Written, ends: tuple[Array, Array], required: Array):
        self._scene, self._written, self._required = scene, written, required
        self._start, self._end = ends
        form = scene.form
        step = Spans.of(self._end) - self._start
        bends = _bends(form, step.most)
        self._bend = up(bends[form.pairs[:, 0]] + bends[form.pairs[:, 1]])
        self._known: dict[float, _Bodies] = {}

    def check(self, planes: dict[int, dict[int, Array]]) -> None:
        """Raises Rejected where some pair is not shown to keep its distance all along."""
        deepest = max((cell.bit_length() for cell in planes), default=1) + _MORE_HALVINGS
        stretches = 0
        pending: list[tuple[int, Indices, dict[int, Array]]] = [(1, np.arange(len(self._required)), {})]
        while pending:
            cell, pairs, normals = pending.pop()
            normals = {**normals, **planes.get(cell, {})}
            open_ = self._lowest(cell, pairs).max(axis=1) < 0.0
            left = [k for k in pairs[open_].tolist() if not self._is_apart(cell, k, normals)]
            if not left:
                continue
            stretches += 1
            if cell.bit_length() > deepest or stretches > _MOST_STRETCHES:
                raise Rejected(f"pair {left[0]} of pieces may sink in too deep on the way")
            pending += [(2 * cell + half, np.array(left), normals) for half in (0, 1)]

    def _lowest(self, cell: int, pairs: Indices) -> Array:
        start, end = (self._at(share).common(pairs, self._required) for share in _shares(cell))
        lengths = up(np.sqrt((_DIRECTIONS**2).sum(axis=1)))
        return _lowest(start, end, up(self._bend_on(cell)[pairs][:, None] * lengths))

    def _is_apart(self, cell: int, pair: int, normals: dict[int, Array]) -> bool:
        if pair not in normals:
            return False
        normal = normals[pair]
        start, end = (self._at(s).along(pair, self._required[pair], normal) for s in _shares(cell))
        length = Spans.of(normal)
        bend = up(self._bend_on(cell)[pair] * (length * length).sum(0).sqrt().hi)
        return bool(_lowest(np.array(start), np.array(end), np.array(bend)) >= 0.0)

    def _bend_on(self, cell: int) -> Array:
        first, last = _shares(cell)
        return np.asarray(self._bend * (last - first) ** 2)  # a power of two, so exact

    def _at(self, share: float) -> _Bodies:
        if share not in self._known:
            q = Spans.of(self._start) * (1.0 - share) + Spans.of(self._end) * share
            radius = self._written.radii[0]
            q = q + Spans(np.full(len(self._start), -radius), np.full(len(self._start), radius))
            frames = frames_of(self._scene.form, [q[k] for k in range(len(self._start))])
            self._known[share] = self._scene.at(frames)
        return self._known[share]


def _shares(cell: int) -> tuple[float, float]:
    depth = cell.bit_length() - 1
    first = cell - (1 << depth)
    return first / (1 << depth), (first + 1) / (1 << depth)


def _ends(vertices: Spans, directions: Array) -> tuple[Array, Array]:
    """Below and above n . x (k,) over vertices (n, 3), for directions n (k, 3)."""
    along = (vertices[:, None, :] * directions[None]).sum(-1)
    return along.lo.min(axis=0), along.hi.max(axis=0)


def _needs(lengths: Array, directions: Array) -> Array:
    """Above lengths (m, 1) times |n| (k,), of any sign; (m, k)."""
    n = Spans.of(directions)
    norms = (n * n).sum(-1).sqrt()
    return (Spans.of(lengths) * norms[None]).hi


def _lowest(start: Array, end: Array, bend: Array) -> Array:
    """Below the parabolas start + (end - start) s - bend s (1 - s) / 2 over s in [0, 1].

    With s on a grid of dyadic points, and between these by the parabola's own bend: a sixteenth of the
    interval loses bend / 2048, so that nothing need be divided.
    """
    lowest = np.full(np.broadcast_shapes(start.shape, bend.shape), np.inf)
    first, rise, curve = Spans.of(start), Spans.of(end) - start, Spans.of(bend)
    for k in range(17):
        s = k / 16.0
        at = first + rise * s - curve * (0.5 * s * (1.0 - s))
        lowest = np.minimum(lowest, at.lo)
    return np.asarray(down(lowest - up(bend * 2.0**-11)))


def _bends(form: Form, moves: Array) -> Array:
    """What the second derivative (n_pieces,) of a point of each piece is at most along a step, in m.

    Of a point x by joints i and j, j further out or the same, it is a_i x (a_j x (x - o_j)), or a_i x a_j
    where j slides, and zero where i does: at most r_j, the farthest of joint j's axis from the piece, or 1.
    """
    by_joint = np.array([float(up(abs(ratio) * moves[j])) for j, ratio, _ in form.drives])
    slides = np.array([slide for link in form.links for slide in link.slides], dtype=bool)
    out = np.zeros(len(form.pieces))
    for i, piece in enumerate(form.pieces):
        total, turned = 0.0, 0.0
        for k, reach in _chain(form, piece.link, _farthest(piece.core) + piece.radius):
            # Twice each pair of joints, and each joint once with itself, if it turns.
            own = 0.0 if slides[k] else by_joint[k]
            total = float(up(total + up(reach * up(by_joint[k] * up(own + 2.0 * turned)))))
            turned = float(up(turned + own))
        out[i] = total
    return out


def _farthest(core: Array) -> float:
    x = Spans.of(core)
    return float(up((x * x).sum(-1).sqrt().hi.max()))


def _chain(form: Form, link: int, far: float) -> Iterator[tuple[int, float]]:
    """Joints that move a link, from the palm on, each with the farthest that its axis has to the piece."""
    firsts = np.cumsum([0, *(len(other.slides) for other in form.links)])
    found: list[tuple[int, float]] = []
    while link >= 0:
        here = form.links[link]
        for k in range(firsts[link + 1] - 1, firsts[link] - 1, -1):
            slides = here.slides[k - firsts[link]]
            found.append((k, 1.0 if slides else float(up(far * (1.0 + 1e-12)))))
            if slides:
                far = float(up(far + form.joint_reach[k]))
        far = float(up(far + _farthest(here.position.lo[None])))
        link = here.parent
    return iter(found[::-1])
