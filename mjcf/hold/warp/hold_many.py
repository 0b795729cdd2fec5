"""The lift of many grasps side by side, in MuJoCo Warp.

MuJoCo Warp moves hands and objects; the verdict is found by the code that judges every lift: how far the
object has gone, and in MuJoCo itself which contacts carry force where the motion has ended. What differs from
the lift in MuJoCo is the arithmetic, in single precision, and the order in which sums are formed.
"""

from collections.abc import Callable, Container, Sequence
from dataclasses import replace
from math import nan

import numpy as np

from ....arguments import check_instance, check_number
from ....base.machine.cancellation import give_up_if_asked
from ....base.numeric.arrays import Array, Indices
from ....errors import InputError
from ....objects import LiftTest, Task
from ...model import Grasp
from ...settings import HoldSettings
from ..checks import trial_settings
from ..lift import Lift
from ..result import HoldResult
from .worlds import NoRoom, Worlds

__all__ = ["hold_many"]

# Room for contacts in a world at first, and how often it is doubled where it is too small.
_CONTACTS, _DOUBLINGS = 48, 4
# Rest is looked for once in so many samples.
_LOOK_EVERY = 5


def hold_many(
    grasps: Sequence[Grasp],
    *,
    settings: HoldSettings | None = None,
    load: float = 1.0,
    device: str | None = None,
) -> list[HoldResult]:
    """Puts grasps to the lift of their tasks, those of a task side by side.

    Args:
        grasps: the grasps.
        settings: what to assume; None takes what each squeeze was planned for. Those of the preset
            `no_noslip` are what MuJoCo Warp was compared with MuJoCo in.
        load: how many times gravity.
        device: Warp's name of where to simulate, such as `cuda:0` or `cpu`; None takes a GPU if there is one.

    Raises:
        InputError: something else than grasps to lift, a device that isn't there, or a model that MuJoCo Warp
            can't simulate.
        MissingBackend: MuJoCo Warp is not installed.
    """
    check_number("load", load, least=0.0)
    groups: dict[tuple[int, HoldSettings], list[int]] = {}
    for i, grasp in enumerate(grasps):
        check_instance(f"grasps.{i}", grasp, Grasp, "a Grasp, made of a Configuration and its Squeeze")
        task = grasp.configuration.task
        if not isinstance(task.test, LiftTest):
            raise InputError("warp", task.name, "is no lift: MuJoCo Warp has only lifts yet")
        groups.setdefault((id(task), trial_settings(grasp, settings)), []).append(i)
    results: dict[int, HoldResult] = {}
    for (_, assumed), rows in groups.items():
        several = [grasps[i] for i in rows]
        results |= dict(zip(rows, _of_one_task(several, assumed, load, device), strict=True))
    return [results[i] for i in range(len(grasps))]


def _of_one_task(
    grasps: Sequence[Grasp], settings: HoldSettings, load: float, device: str | None
) -> list[HoldResult]:
    lifts = [Lift(grasp, settings) for grasp in grasps]
    contacts = _CONTACTS
    for _ in range(_DOUBLINGS):
        try:
            return _ManyLifts(lifts, grasps, settings, contacts, device).results(load)
        except NoRoom:
            contacts *= 2
    task: Task = grasps[0].configuration.task
    raise InputError("warp", task.name, f"has more than {contacts // 2} contacts at once")


class _ManyLifts:
    """Lifts of grasps of one task, under way."""

    def __init__(
        self,
        lifts: Sequence[Lift],
        grasps: Sequence[Grasp],
        settings: HoldSettings,
        contacts: int,
        device: str | None,
    ):
        self._lifts, self._grasps, self._settings = lifts, grasps, settings
        self._contacts, self._device = contacts, device

    def results(self, load: float) -> list[HoldResult]:
        """What becomes of every grasp in every direction."""
        qpos, qvel = self._squeezed()
        whole = [bool(np.isfinite(q).all() and np.isfinite(v).all()) for q, v in zip(qpos, qvel, strict=True)]
        held = np.flatnonzero(whole)
        for i in held.tolist():
            self._lifts[i].squeezed_elsewhere(qpos[i], qvel[i])
        directions = self._settings.directions
        which = np.repeat(held, len(directions))
        ways = np.tile(np.array(directions), (len(held), 1))
        paths, ends = self._under_gravity(which, qpos, qvel, load * self._settings.gravity * ways)
        found: list[HoldResult] = []
        for i, lift in enumerate(self._lifts):
            rows = np.flatnonzero(which == i)
            several = [
                lift.held_elsewhere(direction, paths[row], ends[row], load)
                for direction, row in zip(directions, rows, strict=whole[i])
            ]
            result = lift.result(several)
            broken = {"squeeze_slip_m": nan, "squeeze_rotation_rad": nan, "squeezed_qpos": qpos[i]}
            found.append(result if whole[i] else replace(result, **broken))
        return found

    def _squeezed(self) -> tuple[Array, Array]:
        """Positions and velocities, by grasp, once the fingers have closed, squeezed and come to rest."""
        lifts, grasps, settings = self._lifts, self._grasps, self._settings
        simulations = [lift.simulation for lift in lifts]
        every = np.arange(len(lifts))
        worlds = self._worlds(every)
        waypoints = [grasp.approach.waypoints for grasp in grasps]
        for lift, simulation, way in zip(lifts, simulations, waypoints, strict=True):
            simulation.begin(way[0], lift.squeezing.start_pose)
        self._put(worlds, every, *self._states(every))
        free = np.array([simulation.model.dof_damping for simulation in simulations])
        closing = free.copy()
        closing[:, -6:] = [lift.squeezing.viscous_damping for lift in lifts]
        worlds.set_damping(closing)
        worlds.set_gravity(np.zeros((len(lifts), 3)))
        steps = [s.closing_controls(way) for s, way in zip(simulations, waypoints, strict=True)]
        for row in np.array(steps).transpose(1, 0, 2):
            worlds.drive(row)
        worlds.set_damping(free)
        resting = np.array([lift.squeezing.resting_gravity for lift in lifts])
        start = np.array([grasp.configuration.state.q for grasp in grasps])
        targets = np.array([grasp.squeeze.targets for grasp in grasps])
        count = simulations[0].steps(settings.squeeze_s)
        for k in range(1, count + 1):
            if resting.any():
                worlds.set_gravity(k / count * resting)
            worlds.drive(start + k / count * (targets - start))
        stride = simulations[0].steps(settings.sample_s)
        left, path = simulations[0].steps(settings.settle_s), [worlds.qpos]
        while left > 0:
            give_up_if_asked()
            worlds.step(min(stride, left))
            left -= stride
            path.append(worlds.qpos)
            is_time = (len(path) - 1) % _LOOK_EVERY == 0
            if is_time and len(self._ended(path, every, Lift.has_settled)) == len(lifts):
                break
        return worlds.qpos, worlds.qvel

    def _under_gravity(
        self, which: Indices, qpos: Array, qvel: Array, gravity: Array
    ) -> tuple[list[Array], list[Array]]:
        """Paths (k, nq) and velocities (nv,) at their ends, by world, of those squeezed grasps `which`."""
        if not len(which):
            return [], []
        worlds, settings = self._worlds(which), self._settings
        self._put(worlds, which, qpos[which], qvel[which])
        worlds.set_gravity(gravity)
        simulation = self._lifts[0].simulation
        stride, samples = simulation.steps(settings.sample_s), round(settings.hold_s / settings.sample_s)
        path = [qpos[which]]
        ends: dict[int, tuple[int, Array]] = {}
        for k in range(1, samples + 1):
            give_up_if_asked()
            worlds.step(stride)
            path.append(worlds.qpos)
            if k == samples or k % _LOOK_EVERY == 0:
                # Where each has ended, as a lift of its own would: the others go on.
                for row in self._ended(path, which, Lift.has_ended, but=ends, all_of_them=k == samples):
                    ends[row] = k, worlds.qvel[row]
            if len(ends) == len(which):
                break
        by_world = np.array(path).transpose(1, 0, 2)
        rows = range(len(which))
        return [by_world[row, : ends[row][0] + 1] for row in rows], [ends[row][1] for row in rows]

    def _ended(
        self,
        path: list[Array],
        which: Indices,
        ended: Callable[[Lift, Array], bool],
        *,
        but: Container[int] = (),
        all_of_them: bool = False,
    ) -> list[int]:
        """The worlds, but for some, of which something is so by their samples so far."""
        by_world = np.array(path).transpose(1, 0, 2)
        return [
            row
            for row, i in enumerate(which.tolist())
            if row not in but and (all_of_them or ended(self._lifts[i], by_world[row]))
        ]

    def _states(self, which: Indices) -> tuple[Array, Array]:
        """Positions and velocities of the lifts' own simulations, by world."""
        datas = [self._lifts[i].simulation.data for i in which.tolist()]
        return np.array([data.qpos for data in datas]), np.array([data.qvel for data in datas])

    def _put(self, worlds: Worlds, which: Indices, qpos: Array, qvel: Array) -> None:
        """Puts worlds in states, targets and what stays behind as in the lifts' own simulations."""
        datas = [self._lifts[i].simulation.data for i in which.tolist()]
        worlds.put(
            qpos=qpos,
            qvel=qvel,
            ctrl=np.array([data.ctrl for data in datas]),
            mocap_pos=np.array([data.mocap_pos for data in datas]),
            mocap_quat=np.array([data.mocap_quat for data in datas]),
        )

    def _worlds(self, which: Indices) -> Worlds:
        models = [lift.simulation.model for lift in self._lifts]
        return Worlds(models, which, contacts=self._contacts, device=self._device)
