"""A squeeze without a plan: every contact presses along its normal, whether that balances or not."""

import numpy as np

from ..solver import Configuration
from .settings import HoldSettings
from .squeeze import Squeeze
from .statics import grasp_statics

__all__ = ["insist"]


def insist(configuration: Configuration, force_N: float, settings: HoldSettings | None = None) -> Squeeze:
    """The squeeze of a hand that presses all the same where no plan is to be had.

    It says whether "not holdable" was right: a grasp is contradicted where this holds it.

    Args:
        configuration: a grasp for a lift or a press.
        force_N: normal force of every contact, less where a servo would give more than its planned share.
        settings: of the test; None takes the defaults.
    """
    settings = settings or HoldSettings()
    statics = grasp_statics(configuration, settings)
    vector = np.zeros((statics.n_contacts, 4))
    vector[:, 0] = force_N
    efforts = statics.T @ vector.ravel()
    share = float((np.abs(efforts) / (settings.planned_effort * statics.effort)).max())
    scale = 1.0 / max(1.0, share)
    targets = configuration.state.q + scale * efforts / statics.stiffness
    return Squeeze(targets, scale * efforts, scale * vector, scale * vector[None], 0.0, settings)
