"""The hold test: squeeze without gravity, then gravity in each direction, and see whether the object stays.

What is simulated: MuJoCo, with elliptic friction cones, soft-finger contacts (`condim` 4), `impratio` and the
no-slip solver. MuJoCo's contacts never stick: they creep. For a pinched 100 g box at friction 0.6 that is
4.7 mm/s with MuJoCo's defaults, 0.19 mm/s with elliptic cones and impratio 10, and below 1 um/s with no-slip
passes on top, so that a slip of 5 mm means that the grasp really gives way.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..geometry.transforms import rotation_angle, rotation_from_quaternion
from .grasp import Grasp
from .grasp_model import GRASP_KEY, OBJECT_BODY, grasp_mjcf
from .hold_result import DirectionResult, HoldResult, Outcome
from .settings import Direction, HoldSettings

__all__ = ["hold_test", "hold_tests"]

Array = NDArray[np.float64]
# Once an object has gone this many times too far, it won't come back and the rest of the time is spared.
_LOST = 4.0


def hold_test(grasp: Grasp, settings: HoldSettings | None = None) -> HoldResult:
    """Tests whether the hand holds the object; the same input gives the same bits.

    Args:
        grasp: the grasp.
        settings: what to assume; None takes what the squeeze was planned for.
    """
    settings = settings or grasp.squeeze.settings
    simulation = _Simulation(grasp, settings)
    simulation.squeeze()
    return simulation.result([simulation.hold(direction) for direction in settings.directions])


def hold_tests(
    grasps: Sequence[Grasp], settings: HoldSettings | None = None, *, workers: int = 1
) -> list[HoldResult]:
    """Tests many grasps over `workers` threads (MuJoCo lets go of Python's lock while it steps).

    The results are those of `hold_test`, bit by bit, at any number of workers.
    """
    with ThreadPoolExecutor(workers) as pool:
        return list(pool.map(lambda grasp: hold_test(grasp, settings), grasps))


@dataclass(frozen=True, eq=False)
class _Shift:
    """How far the object has moved from a reference."""

    slip_m: float
    rotation_rad: float


class _Simulation:
    """A grasp in MuJoCo, from the start of the squeeze."""

    def __init__(self, grasp: Grasp, settings: HoldSettings):
        # Imported late: MuJoCo settles on its OpenGL backend when it is imported, and the caller may choose.
        import mujoco

        self._mujoco: Any = mujoco
        self._settings = settings
        self._grasp = grasp
        configuration = grasp.configuration
        self._model = mujoco.MjModel.from_xml_string(
            grasp_mjcf(configuration, settings, grasp.squeeze.targets)
        )
        self._data = mujoco.MjData(self._model)
        self._body = self._model.body(OBJECT_BODY).id
        state = configuration.state
        R, p = state.R_palm_object, state.p_palm_object
        contact_points = [R.T @ (point.p_object - p) for point in configuration.contact_points]
        self._watched = np.array(contact_points)
        mujoco.mj_resetDataKeyframe(self._model, self._data, self._model.key(GRASP_KEY).id)
        self._start = self._pose()
        self._squeezed, self._reference = self._full_state(), self._start

    def squeeze(self) -> None:
        """Moves the servos' targets from the grasp to the squeeze, and lets the hand settle."""
        steps = self._steps(self._settings.squeeze_s)
        q, targets = self._grasp.configuration.state.q, self._grasp.squeeze.targets
        for k in range(1, steps + 1):
            self._data.ctrl[:] = q + (targets - q) * (k / steps)
            self._mujoco.mj_step(self._model, self._data)
        self._mujoco.mj_step(self._model, self._data, self._steps(self._settings.settle_s))
        self._squeezed, self._reference = self._full_state(), self._pose()

    def hold(self, direction: Direction) -> DirectionResult:
        """Lets gravity act along `direction`, starting from the squeezed state."""
        settings = self._settings
        self._restore(self._squeezed)
        warnings = self._warnings()
        self._model.opt.gravity[:] = settings.gravity * np.array(direction)
        stride = self._steps(settings.sample_s)
        shifts, qpos = [_Shift(0.0, 0.0)], [self._data.qpos.copy()]
        for _ in range(round(settings.hold_s / settings.sample_s)):
            self._mujoco.mj_step(self._model, self._data, stride)
            shifts.append(self._shift(self._reference))
            qpos.append(self._data.qpos.copy())
            if self._is_lost(shifts[-1]):
                break
        slip = np.array([shift.slip_m for shift in shifts])
        rotation = np.array([shift.rotation_rad for shift in shifts])
        touching = self._touching()
        is_stable = self._warnings() == warnings and bool(np.isfinite(slip).all())
        return DirectionResult(
            direction,
            self._outcome(is_stable, float(slip.max()), float(rotation.max()), touching),
            float(slip.max()),
            float(rotation.max()),
            touching,
            settings.timestep_s * stride * np.arange(len(slip), dtype=float),
            slip,
            rotation,
            np.array(qpos),
        )

    def result(self, directions: list[DirectionResult]) -> HoldResult:
        """The whole result, once every direction is done."""
        self._restore(self._squeezed)
        moved = self._shift(self._start)
        return HoldResult(
            self._settings, moved.slip_m, moved.rotation_rad, self._data.qpos.copy(), tuple(directions)
        )

    def _steps(self, seconds: float) -> int:
        return max(1, round(seconds / self._settings.timestep_s))

    def _full_state(self) -> Array:
        # Includes the solver's warm start, so that each direction continues just as the squeeze ended.
        kind = self._mujoco.mjtState.mjSTATE_INTEGRATION
        state = np.zeros(self._mujoco.mj_stateSize(self._model, kind))
        self._mujoco.mj_getState(self._model, self._data, state, kind)
        return state

    def _restore(self, state: Array) -> None:
        self._mujoco.mj_setState(self._model, self._data, state, self._mujoco.mjtState.mjSTATE_INTEGRATION)

    def _pose(self) -> tuple[Array, Array]:
        """Rotation (3, 3) and position (3,) of the object in the palm frame, which is the world frame."""
        joint = self._model.joint(OBJECT_BODY)
        at = int(joint.qposadr[0])
        qpos = self._data.qpos
        return rotation_from_quaternion(qpos[at + 3 : at + 7]), qpos[at : at + 3].copy()

    def _shift(self, reference: tuple[Array, Array]) -> _Shift:
        R0, p0 = reference
        R, p = self._pose()
        moved = (self._watched @ R.T + p) - (self._watched @ R0.T + p0)
        return _Shift(float(np.linalg.norm(moved, axis=1).max()), rotation_angle(R @ R0.T))

    def _is_lost(self, shift: _Shift) -> bool:
        settings = self._settings
        return (
            shift.slip_m > _LOST * settings.slip_limit_m
            or shift.rotation_rad > _LOST * settings.rotation_limit_rad
            or not np.isfinite(shift.slip_m)
        )

    def _touching(self) -> tuple[bool, ...]:
        """Whether each contact of the task carries force now."""
        forces = self._normal_forces()
        task = self._grasp.configuration.task
        names = [task.hand.links[contact.hand.link].name for contact in task.contacts]
        return tuple(forces.get(self._model.body(name).id, 0.0) > 0.0 for name in names)

    def _normal_forces(self) -> dict[int, float]:
        """Normal force in N between the object and each body that touches it."""
        self._mujoco.mj_forward(self._model, self._data)
        forces: dict[int, float] = {}
        wrench = np.zeros(6)
        for i, contact in enumerate(self._data.contact[: self._data.ncon]):
            bodies = {int(self._model.geom_bodyid[geom]) for geom in contact.geom}
            if self._body in bodies and len(bodies) == 2:
                (other,) = bodies - {self._body}
                self._mujoco.mj_contactForce(self._model, self._data, i, wrench)
                forces[other] = forces.get(other, 0.0) + float(wrench[0])
        return forces

    def _warnings(self) -> int:
        """How often MuJoCo has found the simulation to break down (or its memory too small)."""
        return int(self._data.warning.number.sum())

    def _outcome(
        self, is_stable: bool, slip_m: float, rotation_rad: float, touching: tuple[bool, ...]
    ) -> Outcome:
        settings = self._settings
        if not is_stable:
            return Outcome.UNSTABLE
        if slip_m >= settings.slip_limit_m:
            return Outcome.SLIPPED
        if rotation_rad >= settings.rotation_limit_rad:
            return Outcome.ROTATED
        return Outcome.HELD if all(touching) else Outcome.LET_GO
