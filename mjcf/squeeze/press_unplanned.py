"""A squeeze without a plan: every contact presses along its normal, whether that balances or not."""

import numpy as np

from ...base.numeric.arrays import Array
from ...solver import Configuration
from ..model import Squeeze, checked_settings
from ..settings import HoldSettings
from .pads import contact_pads
from .statics import grasp_statics
from .straight import straight_targets
from .turn_path import TURN_STATES, squeeze_trajectory

__all__ = ["press_along_normals"]


def press_along_normals(
    configuration: Configuration, force_N: float, *, settings: HoldSettings | None = None
) -> Squeeze:
    """The squeeze of a hand that presses all the same where no plan is to be had.

    In a turn the fingers go along as far as they can, and then on as they went last. Such a squeeze also says
    whether "not holdable" was right: a grasp is contradicted where this holds it.

    Args:
        configuration: the grasp.
        force_N: normal force of every contact, less where a servo would give more than its planned share.
        settings: of the test; None takes the defaults.
    """
    settings = checked_settings(settings)
    way = squeeze_trajectory(configuration)
    pressing = [_press(there, force_N, settings) for there in way]
    vector, efforts, targets = pressing[0]
    path = [targets for _, _, targets in pressing[1:]]
    if len(way) > 1:
        last = way[-1].state.q - way[-2].state.q
        path += [path[-1] + k * last for k in range(1, TURN_STATES + 1 - len(path))]
    path_array = np.array(path).reshape(len(path), len(targets))
    pads = contact_pads(configuration, settings)
    return Squeeze(
        targets=targets,
        efforts=efforts,
        preload=vector,
        loaded=vector[None],
        load_factor=0.0,
        settings=settings,
        spin_arms_m=pads.spin_arms_m(vector[:, 0]),
        yields_m=pads.yields_m(vector[:, 0]),
        path=path_array,
    )


def _press(
    configuration: Configuration, force_N: float, settings: HoldSettings
) -> tuple[Array, Array, Array]:
    """Contact vector (n, 4), efforts and servo targets, each (n_independent,)."""
    statics = grasp_statics(configuration, settings)
    most_N = configuration.task.max_normal_force_N
    vector = np.zeros((statics.n_contacts, 4))
    vector[:, 0] = force_N if most_N is None else min(force_N, most_N)
    efforts = statics.T @ vector.ravel()
    share = float((np.abs(efforts) / (settings.planned_effort * statics.effort)).max())
    vector /= max(1.0, share)
    yields_m = contact_pads(configuration, settings).yields_m(vector[:, 0])
    centres_m = np.zeros((len(vector), 2))
    return vector, *straight_targets(configuration, statics, vector, yields_m, centres_m)
