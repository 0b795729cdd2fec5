"""That the contacts truly hold near the written numbers: Krawczyk's test in joints, pose and parameters.

With as many of the unknowns as there are equations (those that a pivoted elimination picks; the others keep
their written values), and Y about the inverse of the slopes, K = x - Y f(x) + (I - Y F'(X)) (X - x): where K
lies inside the box X about x, it holds a true solution (Krawczyk 1969).

Alignments of flats may depend on each other, as those of two parallel jaws with two parallel faces do. Those
that follow from the other equations in floats are left out of the test, and normals are then shown to be
opposed wherever the solution is, but for what rounding leaves.
"""

from typing import Any

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ..reading import Rejected
from .form import Contact as Said
from .form import Form, Written
from .places import Contact, Frames, contacts_of, frames_of, turn_of_quaternion
from .spans import Jets, Spans, dot, matmul, matvec, stack

__all__ = ["check_existence"]

# Closed limits have room for a solution that stands at one, in rad, m, or share of a patch, and in cosines.
_ROOM = 1e-9
_MOST_WIDENINGS = 8
# Rows that are so near to depending on others, by size, follow from them.
_FOLLOWS = 1e-9


class _Unknowns:
    """Joints of fingers with a contact, half the turn and the shift of a free object, parameters of patches.

    The object is turned on from its written rotation by t: the rotation about t by twice the arc tangent of
    its length (Cayley).
    """

    def __init__(self, form: Form, written: Written):
        self.form, self.written = form, written
        moved = np.zeros(len(form.drives), dtype=bool)
        for contact in form.contacts:
            moved |= form.moves(contact.link)
        self.joints = sorted({form.drives[k][0] for k in np.flatnonzero(moved)})
        self.n_pose = 6 if form.pose is None else 0
        self.size = len(self.joints) + self.n_pose + form.n_params

    def at(self, box: Spans, jets: bool) -> tuple[list[Contact], Any, Any]:
        """Contacts, the object's rotation, and parameters, where the unknowns differ by `box` (size,)."""
        x: Any = box
        if jets:
            x = Jets(box, Spans.of(np.eye(self.size)))
        n, written = len(self.joints), self.written
        q = self.joints_at(x)
        if self.n_pose:
            R = matmul(_cayley(x[n : n + 3]), turn_of_quaternion(Spans.of(written.quaternion)))
            p = x[n + 3 : n + 6] + written.position
        else:
            assert self.form.pose is not None
            R, p = (Spans.of(part) for part in self.form.pose)
        params = x[n + self.n_pose :] + written.params
        return contacts_of(self.form, frames_of(self.form, q), R, p, params), R, params

    def joints_at(self, x: Any) -> list[Any]:
        """All independent joints where the unknowns differ by x (size,)."""
        q: list[Any] = [Spans.of(value) for value in self.written.q]
        for k, j in enumerate(self.joints):
            q[j] = x[k] + self.written.q[j]
        return q


def _cayley(t: Any) -> Any:
    """((1 - |t|^2) I + 2 t t' + 2 [t]x) / (1 + |t|^2), a rotation for every t."""
    square = dot(t, t)
    scale = (square + 1.0).inverse()
    rows = []
    for i in range(3):
        row = []
        for j in range(3):
            entry = t[i] * t[j] * 2.0
            if i == j:
                entry = entry + (1.0 - square)
            else:
                entry = entry + t[3 - i - j] * (2.0 if (i - j) % 3 == 1 else -2.0)
            row.append(entry * scale)
        rows.append(stack(row))
    return stack(rows)


def check_existence(form: Form, written: Written) -> None:
    """Shows a true solution within the written radii.

    Raises:
        Rejected: none was shown.
    """
    unknowns = _Unknowns(form, written)
    start = Spans.of(np.zeros(unknowns.size))
    at_start, aligned = _equations(form, unknowns.at(start, True)[0])
    kept = _not_following(at_start.slopes.middle.T, aligned)
    at_start = at_start[kept]
    J = at_start.slopes.middle.T
    columns = _independent(J)
    Y = np.linalg.inv(J[:, columns])
    f = matvec(Spans.of(Y), at_start.value)
    radius = 2.0 * f.most + 1e-15
    for _ in range(_MOST_WIDENINGS):
        box = np.zeros(unknowns.size)
        box[columns] = radius
        wide = Spans(-box, box)
        slopes = _equations(form, unknowns.at(wide, True)[0])[0][kept].slopes
        F = Spans(slopes.lo[columns].T, slopes.hi[columns].T)
        rest = Spans.of(np.eye(len(columns))) - matmul(Spans.of(Y), F)
        image = matvec(rest, wide[columns]) - f
        if not np.isfinite(image.most).all():
            break
        if (image.lo > -radius).all() and (image.hi < radius).all():
            low, high = np.zeros(unknowns.size), np.zeros(unknowns.size)
            low[columns], high[columns] = image.lo, image.hi
            _check_solution(unknowns, Spans(low, high))
            return
        radius = 2.0 * image.most + 1e-16
    raise Rejected("the contacts could not be shown to hold at the written numbers")


def _equations(form: Form, contacts: list[Contact]) -> tuple[Jets, list[bool]]:
    """What must be zero (m,), and which of it are alignments of normals."""
    out, aligned = [], []
    for said, contact in zip(form.contacts, contacts, strict=True):
        out += contact.misses
        aligned += [False] * len(contact.misses)
        if _is_aligned(said):
            out += [dot(contact.n_hand, tangent) for tangent in contact.tangents]
            aligned += [True] * len(contact.tangents)
    return stack(out), aligned


def _is_aligned(said: Said) -> bool:
    """Whether equations say that the normals of a contact are opposed."""
    return said.hand.kind != "cap" and said.object.kind != "cap" and not said.has_room


def _not_following(J: Array, aligned: list[bool]) -> Indices:
    """Rows of J (m, n), without alignments that depend on the rows before them and on all other equations."""
    kept: list[int] = []
    basis = np.zeros((0, J.shape[1]))
    for k in sorted(range(len(J)), key=lambda k: aligned[k]):
        rest = J[k] - basis.T @ (basis @ J[k])
        rest = rest - basis.T @ (basis @ rest)
        size = float(np.linalg.norm(rest))
        if aligned[k] and not size > _FOLLOWS * float(np.linalg.norm(J[k])):
            continue
        kept.append(k)
        if size > 0.0:
            basis = np.vstack([basis, rest / size])
    return np.array(sorted(kept), dtype=np.int64)


def _independent(J: Array) -> Indices:
    """Columns (m,) of J (m, n) that are farthest from depending on each other, one by one."""
    rest, chosen = J.copy(), []
    for _ in range(len(J)):
        sizes = np.linalg.norm(rest, axis=0)
        best = int(np.argmax(sizes)) if len(sizes) else 0
        if not len(sizes) or not sizes[best] > 1e-9 * np.abs(J).max():
            raise Rejected("the contacts' equations depend on each other, so none could be shown to hold")
        chosen.append(best)
        along = rest[:, best] / sizes[best]
        rest = rest - np.outer(along, along @ rest)
    return np.array(chosen, dtype=np.int64)


def _check_solution(unknowns: _Unknowns, found: Spans) -> None:
    """The solution keeps limits, caps and room, and lies within the written radii."""
    form, written = unknowns.form, unknowns.written
    contacts, R, params = unknowns.at(found, False)
    n = len(unknowns.joints)
    away = R - turn_of_quaternion(Spans.of(written.quaternion))
    shift = found[n + 3 : n + 6] if unknowns.n_pose else Spans.of(0.0)
    if form.pose is not None:
        shift = Spans.of(form.pose[1]) - written.position
    differences = (found[:n], away, shift, found[n + unknowns.n_pose :])
    for what, difference, radius in zip(
        ("joints", "rotation", "position", "parameters"), differences, written.radii, strict=True
    ):
        if difference.most.max(initial=0.0) > radius:
            raise Rejected(f"the true solution may be farther from the written numbers than `{what}` says")
    for j, q in enumerate(unknowns.joints_at(found)):
        if not (form.limits[j, 0] - _ROOM <= q.lo and q.hi <= form.limits[j, 1] + _ROOM):
            raise Rejected(f"joint {form.names[j]} may be beyond its limits")
    if len(params.lo) and not (params.lo.min() >= -_ROOM and params.hi.max() <= 1.0 + _ROOM):
        raise Rejected("a contact may be off its patch")
    _check_normals(form, frames_of(form, unknowns.joints_at(found)), contacts, R)


def _check_normals(form: Form, frames: Frames, contacts: list[Contact], R: Any) -> None:
    """Normals lie in their caps, and face each other."""
    for said, contact in zip(form.contacts, contacts, strict=True):
        if said.hand.kind == "cap":
            axis = matvec(frames.rotations[said.link], said.hand.normal)
            if not dot(axis, contact.inward).lo >= said.hand.least_cosine - _ROOM:
                raise Rejected("a contact may be off the hand's cap")
        if said.object.kind == "cap":
            axis = matvec(R, said.object.normal)
            if not (-dot(axis, contact.inward)).lo >= said.object.least_cosine - _ROOM:
                raise Rejected("a contact may be off the object's cap")
        if said.hand.kind != "cap" and said.object.kind != "cap":
            least = said.least_cosine - _ROOM if said.has_room else 0.0
            if not dot(contact.n_hand, contact.inward).lo >= least:
                raise Rejected("normals may fail to be opposed")
        for tangent in contact.tangents if _is_aligned(said) else []:
            length = dot(tangent, tangent).sqrt().lo
            if not dot(contact.n_hand, tangent).most <= _ROOM * length:
                raise Rejected("normals may fail to be opposed")
