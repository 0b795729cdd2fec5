"""Closed linkages of a compiled model: how their joints follow the one that is driven.

A hand is a tree, so what closes a loop (`connect`, `weld`) is left out, and the joints of the loop follow its
driven joint in straight lines instead. The lines are fitted to how the model itself moves: with the driven
joint at one position after another, the loop closed, and the springs of what is then still free at rest.
"""

from copy import copy
from dataclasses import dataclass, field

import mujoco
import numpy as np
from mujoco import mjtConstraint, mjtEq, mjtJoint, mjtObj, mjtTrn
from scipy.optimize import least_squares

from ...base.numeric.arrays import Array
from ...errors import InputError
from ..hand import Coupling
from .tendons import pulled_joints

__all__ = ["Linkages", "closes_loop", "leads_elsewhere"]

# Positions of the driven joint that are looked at, and the fewest that say how others follow.
_STEPS, _FEWEST = 33, 8
# A loop that is closed within this is closed; straight lines may leave it open by so much.
_CLOSED_M, _MOST_OPEN_M = 1e-4, 2e-3
# A line through the model's zero that is a parallelogram, or stands still, is one within this.
_SNAP_RAD = np.radians(0.1)
# A joint that moves less than this share of the driven one stands still.
_LEAST_RATIO = 0.01
# What an open loop (m) weighs beside the springs' pull, the root of N m/rad times rad.
_CLOSING = 1e3
# What keeps a joint without a spring where it was, where the loop leaves it free.
_KEEPING = 1e-3


@dataclass
class Linkages:
    """How the joints of closed loops move.

    Attributes:
        couplings: of joints that follow, by name.
        still: positions of joints that stand still whatever the driven joint does, by number.
        limits: by number, of driven joints whose loops do not close in all of their range, and of joints that
            follow on a line in place of the model's curve.
        notes: what was done, for people.
    """

    couplings: dict[str, Coupling] = field(default_factory=dict)
    still: dict[int, float] = field(default_factory=dict)
    limits: dict[int, tuple[float, float]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def add(
        self,
        model: mujoco.MjModel,
        source: str,
        names: list[str],
        equalities: list[int],
        known: set[str],
        leading: set[str],
    ) -> None:
        """Adds what the loops do that equalities of a model close.

        Args:
            model: the model.
            source: its file, for error messages.
            names: of its joints.
            equalities: the equalities that close loops.
            known: names of joints whose couplings are known otherwise.
            leading: names of joints that others follow.

        Raises:
            InputError: a loop that not one joint alone drives, or whose joints follow no straight line.
        """
        for own, joints in _connected(model, equalities):
            free = [j for j in joints if names[j] not in known]
            masters = [j for j in joints if _is_moved(model, j)]
            followers = [j for j in free if j not in masters]
            if not followers or (not masters and len(free) == 1):
                continue  # the file says how all of the others follow
            label = mujoco.mj_id2name(model, mjtObj.mjOBJ_EQUALITY, own[0]) or own[0]
            where = f"import: equality {label}"
            masters = masters or [j for j in joints if names[j] in known | leading]
            if len(masters) != 1:
                listed = ", ".join(names[j] for j in (masters or joints))
                how = "more than one of its joints is driven" if masters else "none of its joints is driven"
                raise InputError(
                    source,
                    where,
                    f"closes a loop, and {how} ({listed}): say in coupled how all but one follow another",
                )
            followers = [j for j in free if j != masters[0]]
            self._follow(_Loop(model, own, masters[0], followers), source, where, names)

    def _follow(self, loop: "_Loop", source: str, where: str, names: list[str]) -> None:
        master = names[loop.master]
        at, positions = loop.sweep()
        lines, gap = _lines(loop, at, positions)
        while gap > _MOST_OPEN_M and not loop.is_limited and len(at) > _FEWEST:
            # A joint that may turn all the way round does so in no linkage.
            kept = slice(len(at) // 4, len(at) - len(at) // 4)
            at, positions = at[kept], positions[kept]
            lines, gap = _lines(loop, at, positions)
        if len(at) < 2:
            raise InputError(
                source, where, f"closes a loop that does not close when {master!r} moves; check the model"
            )
        if gap > _MOST_OPEN_M:
            off = np.abs(lines[:, 0] * at[:, None] + lines[:, 1] - positions).max(axis=0)
            worst = names[loop.followers[int(np.argmax(off))]]
            raise InputError(
                source,
                where,
                f"closes a loop whose joints do not follow {master!r} in straight lines (it would open by "
                f"{1e3 * gap:.1f} mm, most by {worst!r}): say in coupled how they follow it",
            )
        lower, upper = loop.range
        step = (upper - lower) / (_STEPS - 1)
        narrowed = ""
        if at[0] > lower + 0.5 * step or at[-1] < upper - 0.5 * step:
            self.limits[loop.master] = (float(at[0]), float(at[-1]))
            narrowed = f"; {master} keeps to {at[0]:.4g} .. {at[-1]:.4g}, where it closes"
        told = []
        for j, (ratio, offset) in zip(loop.followers, lines, strict=True):
            if ratio == 0.0:
                self.still[j] = float(offset)
                told.append(f"{names[j]} stands still")
            else:
                self.couplings[names[j]] = Coupling(master, float(ratio), float(offset))
                told.append(f"{names[j]} follows by {ratio:.5g}")
        self.notes.append(
            f"the loop of {master} is closed by straight lines: {', '.join(told)}; they leave it open by "
            f"{1e3 * gap:.2g} mm at most{narrowed}"
        )


class _Loop:
    """A loop of a model with its driven joint at a position.

    Args:
        model: the model.
        equalities: those that close it.
        master: its driven joint.
        followers: its other joints.

    Attributes:
        range: lower and upper position of the driven joint.
        is_limited: whether the model limits it.
        zeros: positions of the followers where the model stands as written.
    """

    def __init__(self, model: mujoco.MjModel, equalities: list[int], master: int, followers: list[int]):
        self.master, self.followers = master, followers
        self._model, self._data = copy(model), mujoco.MjData(model)
        self._model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        self._equalities = equalities
        address = model.jnt_qposadr
        self._of_master, self._of_followers = int(address[master]), address[followers]
        self.zeros = np.array(model.qpos0[self._of_followers])
        self._stiffness = np.asarray(model.jnt_stiffness).reshape(model.njnt, -1)[followers, 0]
        self._at_rest = np.array(model.qpos_spring[self._of_followers])
        is_limited = np.array(model.jnt_limited[followers], dtype=bool)
        far = np.where(model.jnt_type[followers] == mjtJoint.mjJNT_HINGE, 2.0 * np.pi, 1.0)
        self._lower = np.where(is_limited, model.jnt_range[followers, 0], -far)
        self._upper = np.where(is_limited, model.jnt_range[followers, 1], far)
        self.is_limited = bool(model.jnt_limited[master])
        lower, upper = model.jnt_range[master] if self.is_limited else (-np.pi, np.pi)
        self.range = (float(lower), float(upper))

    def sweep(self) -> tuple[Array, Array]:
        """Positions (n,) of the driven joint at which the loop closes, in a row, and of the others (n, k)."""
        at = np.linspace(*self.range, _STEPS)
        # From where the model stands, both ways: there it closes.
        first = int(np.argmin(np.abs(at - self._model.qpos0[self._of_master])))
        found: dict[int, Array] = {}
        for way in (range(first, _STEPS), range(first - 1, -1, -1)):
            positions = found.get(first, self.zeros)
            for i in way:
                positions = self._settle(float(at[i]), positions)
                if self.open_m(float(at[i]), positions) > _CLOSED_M:
                    break
                found[i] = positions
        rows = sorted(found)
        return at[rows], np.array([found[i] for i in rows]).reshape(-1, len(self.followers))

    def open_m(self, master: float, followers: Array) -> float:
        """How far the loop is open, in m (for what a weld turns, in rad times its length)."""
        return float(np.abs(self._residual(master, followers)).max())

    def _settle(self, master: float, before: Array) -> Array:
        """Where the followers come to rest, from where they were before."""
        spring = np.sqrt(self._stiffness)

        def pulls(followers: Array) -> Array:
            return np.concatenate(
                [
                    _CLOSING * self._residual(master, followers),
                    spring * (followers - self._at_rest),
                    _KEEPING * (followers - before),
                ]
            )

        room = 1e-9 * (self._upper - self._lower)
        start = np.clip(before, self._lower + room, self._upper - room)
        found = least_squares(pulls, start, bounds=(self._lower, self._upper), xtol=1e-12, ftol=1e-14)
        return np.asarray(found.x)

    def _residual(self, master: float, followers: Array) -> Array:
        data = self._data
        data.qpos[:] = self._model.qpos0
        data.qpos[self._of_master] = master
        data.qpos[self._of_followers] = followers
        mujoco.mj_fwdPosition(self._model, data)
        own = (data.efc_type == mjtConstraint.mjCNSTR_EQUALITY) & np.isin(data.efc_id, self._equalities)
        return np.array(data.efc_pos[own])


def closes_loop(model: mujoco.MjModel, e: int) -> bool:
    """Whether equality e ties bodies together."""
    return int(model.eq_type[e]) in (int(mjtEq.mjEQ_CONNECT), int(mjtEq.mjEQ_WELD))


def leads_elsewhere(model: mujoco.MjModel, e: int, kept: set[int]) -> bool:
    """Whether equality e ties the bodies `kept` to what they do not move, as a mocap body or an arm."""
    if any(model.body_mocapid[body] >= 0 for body in _tied_bodies(model, e)):
        return True
    return any(int(model.jnt_bodyid[j]) not in kept for j in _joints_of_loop(model, e))


def _tied_bodies(model: mujoco.MjModel, e: int) -> tuple[int, int]:
    a, b = int(model.eq_obj1id[e]), int(model.eq_obj2id[e])
    if model.eq_objtype[e] == mjtObj.mjOBJ_SITE:
        return int(model.site_bodyid[a]), int(model.site_bodyid[b])
    return a, b


def _lines(loop: _Loop, at: Array, positions: Array) -> tuple[Array, float]:
    """Ratios and offsets (k, 2) of straight lines through positions, and how far they open the loop, in m."""
    if len(at) < 2:
        return np.zeros((len(loop.followers), 2)), 0.0
    lines = np.array([_line(at, q, zero) for q, zero in zip(positions.T, loop.zeros, strict=True)])
    return lines, max(loop.open_m(q, lines[:, 0] * q + lines[:, 1]) for q in at)


def _line(x: Array, y: Array, zero: float) -> tuple[float, float]:
    """Ratio and offset of the straight line through points: one to one or still where that fits as well."""
    ratio, offset = np.polyfit(x, y, 1)
    if abs(ratio) < _LEAST_RATIO:
        return 0.0, zero if np.abs(y - zero).max() <= _SNAP_RAD else float(np.mean(y))
    whole = float(np.round(ratio))
    if abs(whole) <= 1.0:
        for shift in (zero, float(np.mean(y - whole * x))):
            if np.abs(whole * x + shift - y).max() <= _SNAP_RAD:
                return whole, shift
    return float(ratio), float(offset)


def _connected(model: mujoco.MjModel, equalities: list[int]) -> list[tuple[list[int], list[int]]]:
    """Loops that share no joint: the equalities that close them, and their joints."""
    groups: list[tuple[list[int], set[int]]] = []
    for e in equalities:
        own, joints = [e], _joints_of_loop(model, e)
        apart = []
        for others, theirs in groups:
            if theirs & joints:
                own, joints = others + own, theirs | joints
            else:
                apart.append((others, theirs))
        groups = [*apart, (own, joints)]
    return [(own, sorted(joints)) for own, joints in groups]


def _joints_of_loop(model: mujoco.MjModel, e: int) -> set[int]:
    """Joints between the two bodies that equality e ties."""
    above = [_and_above(model, body) for body in _tied_bodies(model, e)]
    joints: set[int] = set()
    for body in above[0] ^ above[1]:
        first = int(model.body_jntadr[body])
        joints |= set(range(first, first + int(model.body_jntnum[body])))
    return joints


def _and_above(model: mujoco.MjModel, body: int) -> set[int]:
    found = {body}
    while body:
        body = int(model.body_parentid[body])
        found.add(body)
    return found


def _is_moved(model: mujoco.MjModel, j: int) -> bool:
    """Whether an actuator acts on joint j, alone or with others by a tendon."""
    for a in range(model.nu):
        target = int(model.actuator_trnid[a, 0])
        match model.actuator_trntype[a]:
            case mjtTrn.mjTRN_JOINT | mjtTrn.mjTRN_JOINTINPARENT if target == j:
                return True
            case mjtTrn.mjTRN_TENDON if j in (pulled_joints(model, target) or {}):
                return True
    return False
