"""Many simulations of one task side by side in MuJoCo Warp, in single precision."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ....base.machine.extras import from_extra
from ....base.numeric.arrays import Array, Indices
from ....errors import InputError

__all__ = ["NoRoom", "Worlds"]

# Fields of MuJoCo's model in which grasps of one task differ, by their pads.
_OF_PADS = ("geom_friction", "geom_solref", "geom_solimp", "pair_friction", "pair_solref", "pair_solimp")
_WHAT = "the hold test in MuJoCo Warp"


class NoRoom(Exception):
    """More contacts than there was room for: what was simulated since is worth nothing."""


class Worlds:
    """So many worlds, each a copy of one of several models that differ in their pads alone.

    Args:
        models: MuJoCo's models.
        which: (n,) index of each world's model.
        contacts: room for contacts in a world, on average.
        device: Warp's name of where to simulate, such as `cuda:0` or `cpu`; None takes a GPU if there is one.

    Raises:
        InputError: a device that isn't there, or a model that MuJoCo Warp can't simulate.
        MissingBackend: its packages are not installed.
    """

    def __init__(self, models: Sequence[Any], which: Indices, *, contacts: int, device: str | None = None):
        import mujoco  # late, as in `hold.simulation`

        self._wp: Any = from_extra("warp", "gpu", _WHAT, package="warp-lang")
        self._wp.config.log_level = self._wp.LOG_ERROR  # before it begins, as the next line has it do
        self._mjw: Any = from_extra("mujoco_warp", "gpu", _WHAT, package="mujoco-warp")
        self._device = self._checked(device)
        self._n, self._which = len(which), which
        first = models[0]
        # The first rows of an elliptic contact with spin, and of limits and friction of joints.
        rows = 4 * contacts + 2 * first.nv
        sizes = {name: self._n for name in (*_OF_PADS, "dof_damping") if getattr(first, name).size}
        with self._wp.ScopedDevice(self._device):
            try:
                self._model = self._mjw.put_model(first, batch_sizes=sizes)
                self._data = self._mjw.put_data(
                    first, mujoco.MjData(first), nworld=self._n, nconmax=contacts, njmax=rows
                )
            except NotImplementedError as refused:
                raise InputError("warp", "", f"MuJoCo Warp can't simulate this model: {refused}") from None
            for name in sizes:
                # Friction of pairs and impedances have a layout of their own, which the array's type knows.
                values = np.array([getattr(model, name) for model in models])[which]
                getattr(self._model, name).assign(values.astype(np.float32))
            # What does not fit is looked for here, and costs no line each.
            self._model.opt.warn_overflow = 0

    def _checked(self, device: str | None) -> Any:
        try:
            return self._wp.get_preferred_device() if device is None else self._wp.get_device(device)
        except (ValueError, RuntimeError):
            known = ", ".join(str(known) for known in self._wp.get_devices())
            raise InputError("warp", "device", f"is {device!r}, and there is {known}") from None

    def put(self, *, qpos: Array, qvel: Array, ctrl: Array, mocap_pos: Array, mocap_quat: Array) -> None:
        """Puts every world in a state: what is given has a row for each, in MuJoCo's order."""
        given = {"qpos": qpos, "qvel": qvel, "ctrl": ctrl, "mocap_pos": mocap_pos, "mocap_quat": mocap_quat}
        for name, values in given.items():
            if values.size:
                getattr(self._data, name).assign(values.astype(np.float32))
        self._data.qacc_warmstart.zero_()

    def set_gravity(self, gravity: Array) -> None:
        """Gravity (n, 3) in m/s^2 from now on."""
        opt = self._model.opt
        if len(opt.gravity) != self._n:
            opt.gravity = self._wp.zeros(self._n, dtype=self._wp.vec3, device=self._device)
            opt.gravity._is_batched = True
        opt.gravity.assign(gravity.astype(np.float32))

    def set_damping(self, dof_damping: Array) -> None:
        """Damping (n, nv) of what moves from now on."""
        self._model.dof_damping.assign(dof_damping.astype(np.float32))

    def drive(self, ctrl: Array) -> None:
        """A step with the servos' targets (n, n_independent), which stay."""
        self._data.ctrl.assign(ctrl.astype(np.float32))
        self.step(1)

    def step(self, count: int) -> None:
        """So many steps with everything left as it is.

        Raises:
            NoRoom: some world has had more contacts than there was room for.
        """
        with self._wp.ScopedDevice(self._device):
            for _ in range(count):
                self._mjw.step(self._model, self._data)
        # Grasps end in NaN where a simulation breaks down, which is a result; what found no room is none.
        if self._data.overflow.numpy().any():
            raise NoRoom

    @property
    def qpos(self) -> Array:
        """Positions (n, nq)."""
        return np.asarray(self._data.qpos.numpy(), dtype=float)

    @property
    def qvel(self) -> Array:
        """Velocities (n, nv)."""
        return np.asarray(self._data.qvel.numpy(), dtype=float)
