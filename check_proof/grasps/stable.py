"""That forces balance the load wherever the solution is: the written forces, and what is next to them."""

from typing import Any

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ..intervals import down, up
from ..reading import Rejected, items, numbers
from .areas import force_points
from .form import Form, field, number
from .places import Contact, Frames
from .spans import Spans, cross, dot, matmul, matvec, stack

__all__ = ["check_stable"]

_ARM_M = 0.01
# What is written must be what follows, to so much; intervals may be a few times wider than what wrote it had.
_AGREE, _WIDER = 1e-6, 8.0
# Directions are unit vectors to this.
_UNIT = 1e-3


def check_stable(
    form: Form,
    record: dict[str, Any],
    frames: Frames,
    place: tuple[Spans, Spans],
    params: Spans,
    contacts: list[Contact],
) -> float:
    """The slack in N that was shown.

    Args:
        form: the task.
        record: the file.
        frames: the hand, wherever the solution is.
        place: rotation (3, 3) and position (3,) of the object, likewise.
        params: of patches.
        contacts: of the task.

    Raises:
        Rejected: the statement was not shown.
    """
    stable = field(field(record, "evidence", dict), "stable", dict)
    hold = field(record, "hold", dict)
    settings, squeeze = field(hold, "settings", dict), field(hold, "squeeze", dict)
    arms = numbers(squeeze.get("spin_arms"), len(form.contacts))
    mu = form.friction if settings.get("friction") is None else number(settings["friction"])
    if not ((arms > 0.0).all() and mu > 0.0):
        raise Rejected("friction or an arm is not above zero")
    points, owners = force_points(form, stable, settings, frames, *place, params, contacts)
    n = len(points)
    A, b, least = _balance(form, settings, *place, points)
    loads = items(stable.get("forces"), len(b.lo))
    forces = np.array([[numbers(force, 4) for force in items(load, n)] for load in loads]).reshape(-1, 4 * n)
    spread = _errors(A, b, forces)
    near = Spans(down(forces - spread), up(forces + spread))
    share = _effort_share(form, frames, points, owners, near)
    slack = _slack(near, points, owners, mu, arms[owners], least, form.most)
    claimed = number(stable.get("slack"))
    for name, value in (("slack", slack), ("effort_share", share)):
        said = number(stable.get(name))
        if abs(said - value) > _AGREE * (1.0 + abs(value)):
            raise Rejected(f"`{name}` is {said:.9g}, but what follows is {value:.9g}")
    if spread.max(initial=0.0) > _WIDER * number(stable.get("error")):
        raise Rejected("the forces do not balance as nearly as `error` says")
    if not (claimed > 0.0 and slack > 0.0 and share < 1.0):
        raise Rejected("forces may lie outside the cones, or ask more of a servo than it has")
    return slack


def _balance(
    form: Form, settings: dict[str, Any], R: Spans, p: Spans, contacts: list[Contact]
) -> tuple[Spans, Spans, Array]:
    """Rows A (m, 4 n) of n force points, right-hand sides b (k, m) and least normal forces (n,)."""
    n = len(contacts)
    least = np.zeros(n)
    kind = field(form.test, "kind", str)
    if kind == "press":
        least[form.test["contacts"]] = form.test["force"]
        return Spans.of(np.zeros((0, 4 * n))), Spans.of(np.zeros((1, 0))), least
    if kind == "turn":
        hinge = matvec(R, Spans.of(form.test["point"])) + p
        axis = matvec(R, Spans.of(form.test["axis"]))
        moments = _moments(contacts, hinge)
        row = stack([dot(axis, column) for column in moments])
        return row[None], (Spans.of(form.test["friction_torque"]) * (1.0 / _ARM_M))[None, None], least
    mass = form.mass if settings.get("object_mass_kg") is None else number(settings["object_mass_kg"])
    directions = [numbers(list(d), 3) for d in items(settings.get("directions"))]
    lengths = [float(np.linalg.norm(direction)) for direction in directions]
    if not (directions and all(abs(length - 1.0) < _UNIT for length in lengths) and mass > 0.0):
        raise Rejected("there is no load")
    weight = Spans.of(np.array(directions)) * (Spans.of(mass) * number(settings.get("gravity")))
    zero = np.zeros((len(directions), 3))
    b = Spans(np.hstack([-weight.hi, zero]), np.hstack([-weight.lo, zero]))
    moments = _moments(contacts, matvec(R, Spans.of(form.centre)) + p)
    columns = []
    for i in range(n):
        for c in range(4):
            force = np.zeros(3)
            force[c : c + 1] = 1.0 if c < 3 else 0.0
            moment = moments[4 * i + c]
            columns.append(Spans(np.concatenate([force, moment.lo]), np.concatenate([force, moment.hi])))
    rows = stack(columns)
    return Spans(rows.lo.T, rows.hi.T), b, least


def _moments(contacts: list[Contact], about: Spans) -> list[Spans]:
    """Torques (3,) by `_ARM_M` about a point: of each contact's forces along the axes, and its own."""
    out = []
    scale = Spans.of(1.0) * Spans.of(_ARM_M).inverse()
    for contact in contacts:
        arm = (contact.p_object - about) * scale
        out += [cross(arm, Spans.of(np.eye(3)[c])) for c in range(3)]
        out.append(contact.inward * scale)
    return out


def _errors(A: Spans, b: Spans, forces: Array) -> Array:
    """How far (k, 4 n) forces that balance exactly are from the written ones at most."""
    m = len(A.lo)
    if not m:
        return np.zeros(forces.shape)
    M = np.linalg.pinv(A.middle)
    rest = matmul(A, Spans.of(M)) - np.eye(m)
    q = float(Spans.of(rest.most).sum(1).hi.max())
    if not q < 1.0:
        raise Rejected("the grasp matrix is known too badly")
    left = stack([matvec(A, Spans.of(f)) for f in forces]) - b
    missed = left.most.max(axis=1)
    z = Spans.of(missed) * (Spans.of(1.0) - q).inverse()
    reach = Spans.of(np.abs(M)).sum(1)
    return np.asarray((z[:, None] * reach[None]).hi)


def _effort_share(form: Form, frames: Frames, points: list[Contact], owners: Indices, near: Spans) -> float:
    """The largest share of any servo's effort."""
    columns = []
    for owner, contact in zip(owners.tolist(), points, strict=True):
        moved = form.moves(form.contacts[owner].link)
        rows: list[list[Any]] = [[Spans.of(0.0)] * 4 for _ in form.names]
        slides = [slide for link in form.links for slide in link.slides]
        for k in np.flatnonzero(moved):
            axis = frames.directions[k]
            lever = axis if slides[k] else cross(axis, contact.p_hand - frames.origins[k])
            spin = Spans.of(0.0) if slides[k] else dot(axis, contact.inward)
            j, ratio, _ = form.drives[k]
            for c in range(4):
                rows[j][c] = rows[j][c] + (lever[c] if c < 3 else spin) * ratio
        columns += [stack([row[c] for row in rows]) for c in range(4)]
    T = stack(columns)  # (4 n, n_independent)
    used = stack([(T * near[k][:, None]).sum(0) for k in range(len(near.lo))])
    with np.errstate(divide="ignore"):
        return float(up(used.most / form.effort).max(initial=0.0))


def _slack(
    near: Spans,
    points: list[Contact],
    owners: Indices,
    mu: float,
    arms: Array,
    least: Array,
    most: float,
) -> float:
    """What every contact may lose at least in any load; not above zero where a force may leave its cone."""
    found, outside = np.inf, np.inf
    for k in range(len(near.lo)):
        n_contacts = int(owners.max()) + 1
        may_lose, pressed = [Spans.of(0.0)] * n_contacts, [Spans.of(0.0)] * n_contacts
        for i, (owner, point) in enumerate(zip(owners.tolist(), points, strict=True)):
            F, torque = near[k, 4 * i : 4 * i + 3], near[k, 4 * i + 3]
            normal = dot(F, point.inward)
            aside = Spans.of((F - point.inward * normal[None]).most) * Spans.of(mu).inverse()
            spin = Spans.of(torque.most) * (Spans.of(mu) * arms[i]).inverse()
            in_cone = (normal - float(least[i])) - (dot(aside, aside) + spin * spin).sqrt().hi
            outside = min(outside, float(in_cone.lo))
            may_lose[owner], pressed[owner] = may_lose[owner] + in_cone, pressed[owner] + normal
        found = min(found, *(float(one.lo) for one in may_lose))
        found = min(found, *(float(down(most - one.hi)) for one in pressed))
    return found if outside > 0.0 else outside
