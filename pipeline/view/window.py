"""A grasp in MuJoCo's own window, where there is a screen."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...mjcf import trial_mjcf
from ..records import to_configuration
from .viewable import Viewable

__all__ = ["has_screen", "open_window"]

_SCREENS = ("DISPLAY", "WAYLAND_DISPLAY")


def has_screen() -> bool:
    """Whether this process has a screen to open a window on."""
    return any(os.environ.get(name) for name in _SCREENS)


def open_window(grasp: Viewable) -> None:
    """Shows a grasp in MuJoCo's viewer, squeezed where a squeeze is known; returns when it is closed.

    Raises:
        InputError: the model beside the grasp's file can't be read by MuJoCo.
    """
    import mujoco.viewer  # late, as in `mjcf.hold.simulation`

    model, data = _begun(grasp)
    mujoco.viewer.launch(model, data)


def _begun(grasp: Viewable) -> tuple[Any, Any]:
    """MuJoCo's model and data at the squeeze, or at the grasp without one."""
    import mujoco

    path = grasp.path.with_suffix(".xml")
    try:
        if path.is_file():
            model = mujoco.MjModel.from_xml_path(str(path))
        else:
            model = mujoco.MjModel.from_xml_string(_text(grasp))
    except ValueError as error:
        raise InputError(path, "", f"can't be read by MuJoCo: {error}") from None
    data = mujoco.MjData(model)
    keys = [model.key(i).name for i in range(model.nkey)]
    for name in ("squeeze", "grasp"):
        if name in keys:
            mujoco.mj_resetDataKeyframe(model, data, keys.index(name))
            break
    mujoco.mj_forward(model, data)
    return model, data


def _text(grasp: Viewable) -> str:
    """The model of a grasp file that has none beside it."""
    task, record = grasp.task, grasp.record
    squeeze = None if record.hold is None else record.hold.squeeze
    names = task.hand.independent_names
    known = squeeze is not None and squeeze.targets.keys() == set(names)
    targets = np.array([squeeze.targets[name] for name in names]) if squeeze and known else None
    return trial_mjcf(to_configuration(record, task, Path(grasp.path)), targets=targets)
