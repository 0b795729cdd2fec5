"""How a compiled model couples joints: by equalities, by limits of tendons, and loosely by other tendons."""

import mujoco
import numpy as np
from mujoco import mjtEq, mjtJoint, mjtObj, mjtTrn

from ...errors import InputError
from ..hand import Coupling
from .lines import line_of_curve, line_of_spring, misses_limits
from .linkages import Linkages, closes_loop, leads_elsewhere
from .tendons import gear_on_joint, pulled_joints

__all__ = ["ModelCouplings"]

# A tendon leads a joint that nothing drives where it leaves it less play than this, either way.
_MOST_PLAY_RAD = 0.2


class ModelCouplings:
    """The couplings of a compiled model.

    Attributes:
        linkages: what closed loops do, once `of_joints` was asked.
    """

    def __init__(self, model: mujoco.MjModel, source: str, joint_names: list[str]):
        self._model = model
        self._source = source
        self._joint_names = joint_names
        # What to tell of joints that follow by the limits of a tendon.
        self._led: dict[str, str] = {}
        # The same of joints that follow on another line than the model's own.
        self._replaced: dict[str, str] = {}
        self.linkages = Linkages()

    def of_joints(self, kept: set[int], given: set[str]) -> dict[str, Coupling]:
        """Couplings by the name of the joint that follows, among the bodies `kept`.

        Args:
            kept: the bodies.
            given: joints whose couplings the hand file gives: the model's are passed over.

        Raises:
            InputError: a constraint that closes a loop, or a coupling that is no straight line.
        """
        out: dict[str, Coupling] = {}
        m = self._model
        loops: list[int] = []
        for e in range(m.neq):
            if not m.eq_active0[e] or not self._touches(e, kept):
                continue
            name = mujoco.mj_id2name(m, mjtObj.mjOBJ_EQUALITY, e)
            if closes_loop(m, e):
                if leads_elsewhere(m, e, kept):
                    self.linkages.notes.append(f"equality {name or e}: ties the hand to what is left out")
                else:
                    loops.append(e)
                continue
            field = f"import: equality {name or e}"
            match m.eq_type[e]:
                case mjtEq.mjEQ_JOINT:
                    follower, master, ratio, offset = self._joint_equality(e)
                    if ratio is None and self._joint_names[follower] not in given:
                        ratio, offset = self._line_of_curve(e)
                case mjtEq.mjEQ_TENDON if self._runs_through_space(e):
                    self.linkages.notes.append(
                        f"equality {name or e}: ties tendons that run through space, and was left out; each "
                        "joint that they pull is one of its own unless coupled says how it follows another"
                    )
                    continue
                case mjtEq.mjEQ_TENDON:
                    follower, master, ratio, offset = self._tendon_equality(e, field)
                case _:
                    raise InputError(
                        self._source,
                        field,
                        "ties a flex; only couplings of joints and loops of bodies are known",
                    )
            if self._joint_names[follower] in given:
                continue
            if ratio == 0.0:
                self.linkages.still[follower] = offset
                self.linkages.notes.append(
                    f"{self._joint_names[follower]} stands still, for the model lets it follow nothing"
                )
                continue
            if master < 0 or ratio is None:
                raise InputError(
                    self._source,
                    field,
                    "couples joints by something else than offset + ratio * position; "
                    f"say in coupled how {self._joint_names[follower]!r} follows",
                )
            if self._joint_names[follower] in out:
                raise InputError(
                    self._source, field, f"couples {self._joint_names[follower]!r}, which is coupled already"
                )
            out[self._joint_names[follower]] = Coupling(self._joint_names[master], ratio, offset)
        self._add_led(out, kept, given)
        leading = {coupling.master for coupling in out.values()}
        self.linkages.add(m, self._source, self._joint_names, loops, given | set(out), leading)
        return out | self.linkages.couplings

    def _add_led(self, out: dict[str, Coupling], kept: set[int], given: set[str]) -> None:
        """Adds joints that nothing drives and that the limits of a tendon keep near a straight line.

        Such a tendon stands for the linkage or the cable inside a finger that bends its last joint along.
        """
        m = self._model
        for t in range(m.ntendon):
            pulls = pulled_joints(m, t)
            if pulls is None or len(pulls) != 2 or not m.tendon_limited[t]:
                continue
            follower, master = sorted(pulls, key=self._is_driven)
            names = {self._joint_names[j] for j in pulls}
            if (
                self._is_driven(follower)
                or not self._is_driven(master)
                or not all(m.jnt_type[j] == mjtJoint.mjJNT_HINGE and m.jnt_bodyid[j] in kept for j in pulls)
                or names & (out.keys() | given)
                or not all(pulls.values())
            ):
                continue
            lower, upper = (float(end) / pulls[follower] for end in m.tendon_range[t])
            play, name = 0.5 * abs(upper - lower), self._joint_names[follower]
            if play > _MOST_PLAY_RAD:
                continue
            # Unlike those of equalities, limits are of positions as they are.
            ratio = -pulls[master] / pulls[follower]
            out[name] = Coupling(self._joint_names[master], ratio, 0.5 * (lower + upper))
            tendon = mujoco.mj_id2name(m, mjtObj.mjOBJ_TENDON, t) or f"{t}"
            self._led[name] = (
                f"tendon {tendon}: lets {name} follow {self._joint_names[master]} by the ratio {ratio:.4g}; "
                f"its {play:.2g} rad of play were left out"
            )

    def _joint_equality(self, e: int) -> tuple[int, int, float | None, float]:
        """Follower, master, ratio and offset; no ratio where it is no straight line.

        One without a master stands where it is held, which is a ratio of zero.
        """
        m = self._model
        follower, master = int(m.eq_obj1id[e]), int(m.eq_obj2id[e])
        coefficients = m.eq_data[e, :5]
        if master < 0:
            return follower, master, 0.0, float(coefficients[0]) + self._zero(follower)
        if np.any(coefficients[2:] != 0.0):
            return follower, master, None, 0.0
        ratio = float(coefficients[1])
        return (
            follower,
            master,
            ratio,
            float(coefficients[0]) + self._zero(follower) - ratio * self._zero(master),
        )

    def _line_of_curve(self, e: int) -> tuple[float | None, float]:
        """Ratio and offset of the line that stands for the curve of an equality; no ratio where none does."""
        line = line_of_curve(self._model, e)
        if line is None:
            return None, 0.0
        follower, master = int(self._model.eq_obj1id[e]), int(self._model.eq_obj2id[e])
        # Its own limits are those of the curve.
        self.linkages.limits[follower] = line.range
        is_hinge = self._model.jnt_type[follower] == mjtJoint.mjJNT_HINGE
        off = f"{np.degrees(line.off):.2g} degrees" if is_hinge else f"{1e3 * line.off:.2g} mm"
        name = self._joint_names[follower]
        self._replaced[name] = (
            f"{name} follows {self._joint_names[master]} on a curve, for which a straight line of the ratio "
            f"{line.ratio:.4g} stands: it is off by {off} at most"
        )
        return line.ratio, line.offset

    def _tendon_equality(self, e: int, field: str) -> tuple[int, int, float | None, float]:
        """As `_joint_equality`, of tendons whose lengths are tied and which have two joints between them."""
        m = self._model
        coefficients = m.eq_data[e, :5]
        pulls: dict[int, float] = {}
        for tendon, factor in ((int(m.eq_obj1id[e]), 1.0), (int(m.eq_obj2id[e]), -float(coefficients[1]))):
            if tendon < 0:
                continue
            for j, pull in (pulled_joints(m, tendon) or {}).items():
                pulls[j] = pulls.get(j, 0.0) + factor * pull
        joints = sorted(j for j, pull in pulls.items() if pull)
        if len(joints) != 2 or np.any(coefficients[2:] != 0.0):
            if not joints:
                raise InputError(self._source, field, "ties tendons that pull no joint")
            return joints[-1], -1, None, 0.0
        # Driven joints lead; else the one nearer to the palm.
        master, follower = joints
        if self._is_driven(follower) and not self._is_driven(master):
            master, follower = follower, master
        ratio = -pulls[master] / pulls[follower]
        offset = float(coefficients[0]) / pulls[follower] + self._zero(follower) - ratio * self._zero(master)
        if misses_limits(m, follower, master, ratio, offset) and int(m.eq_obj2id[e]) < 0:
            line = line_of_spring(m, int(m.eq_obj1id[e]), follower, master)
            if line is not None:
                name = self._joint_names[follower]
                self._replaced[name] = (
                    f"{name} can't follow {self._joint_names[master]} as an equality says, for its limits "
                    "exclude that; it follows by the spring of their tendon, "
                    f"by the ratio {line.ratio:.4g} and {line.offset:.3g}"
                )
                return follower, master, line.ratio, line.offset
        return follower, master, ratio, offset

    def _runs_through_space(self, e: int) -> bool:
        """Whether a tendon that an equality of tendons ties is more than a sum of joints."""
        m = self._model
        return any(t >= 0 and pulled_joints(m, int(t)) is None for t in (m.eq_obj1id[e], m.eq_obj2id[e]))

    def _zero(self, j: int) -> float:
        """The position of a joint at which the model's bodies stand as written."""
        return float(self._model.qpos0[self._model.jnt_qposadr[j]])

    def _is_driven(self, j: int) -> bool:
        """Whether an actuator acts on joint j alone."""
        return any(gear_on_joint(self._model, a, j) for a in range(self._model.nu))

    def tendon_notes(self, kept: set[int], coupled: set[str]) -> list[str]:
        """What to tell of tendons that pull several joints of the bodies `kept` and are no couplings.

        Args:
            kept: the bodies.
            coupled: names of the joints that follow another.
        """
        m = self._model
        notes = [note for name, note in (self._led | self._replaced).items() if name in coupled]
        in_space = list[str]()
        told: dict[tuple[str, tuple[str, ...]], list[str]] = {}
        for t in range(m.ntendon):
            pulls = pulled_joints(m, t)
            name = mujoco.mj_id2name(m, mjtObj.mjOBJ_TENDON, t) or f"{t}"
            if pulls is None:
                in_space.append(name)
                continue
            joints = [j for j in pulls if int(m.jnt_bodyid[j]) in kept]
            names = {self._joint_names[j] for j in joints}
            if len(joints) < 2 or coupled & names:
                continue
            acts = bool(m.tendon_limited[t]) or bool(np.any(m.tendon_stiffness[t] > 0.0))
            driven = any(
                m.actuator_trntype[a] == mjtTrn.mjTRN_TENDON and int(m.actuator_trnid[a, 0]) == t
                for a in range(m.nu)
            )
            if driven or acts:
                how = "drives together" if driven else "ties loosely"
                told.setdefault((how, tuple(sorted(names))), []).append(name)
        if in_space:
            notes.append(f"tendon {', '.join(in_space)}: runs through space, and was left out")
        for (how, pulled), tendons in told.items():
            notes.append(
                f"tendon {', '.join(tendons)}: {how} {', '.join(pulled)}, and was left out; each is a joint "
                "of its own unless coupled says how one follows the other"
            )
        return notes

    def _touches(self, e: int, kept: set[int]) -> bool:
        """Whether equality e concerns a body that is kept; what can't be told does."""
        m = self._model
        ids = [int(m.eq_obj1id[e]), int(m.eq_obj2id[e])]
        match m.eq_type[e]:
            case mjtEq.mjEQ_JOINT:
                bodies = [int(m.jnt_bodyid[j]) for j in ids if j >= 0]
            case mjtEq.mjEQ_CONNECT | mjtEq.mjEQ_WELD:
                sites = m.eq_objtype[e] == mjtObj.mjOBJ_SITE
                bodies = [int(m.site_bodyid[i]) if sites else i for i in ids]
            case mjtEq.mjEQ_TENDON:
                pulls = [pulled_joints(m, i) for i in ids if i >= 0]
                if any(own is None for own in pulls):
                    return True
                bodies = [int(m.jnt_bodyid[j]) for own in pulls for j in own or {}]
            case _:
                return True
        return any(body in kept for body in bodies)
