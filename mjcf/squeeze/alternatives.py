"""Other squeezes of the same grasp, for where the first one moves the object.

A squeeze that looks best by statics may push the object off: a hard pinch of a thin shaft turns faster than
its force grows, a plan that leans on spin friction has none where a pad touches lightly, and on sharp
surfaces the straight way leads past the middle. Which it is, a trial says better than a rule.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...objects import LiftTest
from ...solver import Configuration
from ..model import Squeeze
from .pads import contact_pads
from .plan import plan_squeeze
from .statics import grasp_statics
from .straight import straight_targets

__all__ = ["alternative_squeezes"]

# What other plans carry at least. With 1.05 times the load another simulator refuted 10 of 54 lifts that held
# firmly here, where it was 4 of the 349 others.
_LEAST_LOAD = 1.2
# Share of the forces of a gentle squeeze.
_GENTLE = 0.8
# A sparing plan asks contacts for a share of the usual least force.
_LITTLE = 1.0 / 6.0
# Radius of the patch that a plan with little spin friction assumes, in m.
_SMALL_PATCH_M = 0.002
_ENOUGH = 1.0 - 1e-5


def alternative_squeezes(configuration: Configuration, squeeze: Squeeze) -> Iterator[Squeeze]:
    """Gentler forces, targets that efforts alone give, and plans that spare forces or spin, in this order.

    Args:
        configuration: the grasp, of a lift; there are none for other tests, where a stand holds the object.
        squeeze: the usual one, with a plan.
    """
    if not isinstance(configuration.task.test, LiftTest) or squeeze.load_factor == 0.0:
        return
    gentle = _scaled(configuration, squeeze, _GENTLE)
    is_enough = gentle.load_factor >= _LEAST_LOAD * _ENOUGH
    if is_enough:
        yield replace(gentle, rule="gentle")
    yield replace(_with_forces(configuration, squeeze, bent=True), rule="bent")
    if is_enough:
        yield replace(_with_forces(configuration, gentle, bent=True), rule="gentle, bent")
    usual = squeeze.settings
    sparing = replace(usual, planned_load=_LEAST_LOAD, planned_force_N=_LITTLE * usual.planned_force_N)
    for rule, settings in (
        ("sparing", sparing),
        ("little spin", replace(usual, patch_radius_m=_SMALL_PATCH_M)),
    ):
        planned = plan_squeeze(configuration, settings=settings)
        if (
            isinstance(planned, Squeeze)
            and planned.load_factor >= min(_LEAST_LOAD, squeeze.load_factor) * _ENOUGH
        ):
            yield replace(_with_forces(configuration, replace(planned, settings=usual)), rule=rule)


def _scaled(configuration: Configuration, squeeze: Squeeze, share: float) -> Squeeze:
    """The squeeze with a share of its forces, which carries that share of its load."""
    scaled = replace(
        squeeze,
        preload=share * squeeze.preload,
        loaded=share * squeeze.loaded,
        load_factor=share * squeeze.load_factor,
    )
    return _with_forces(configuration, scaled)


def _with_forces(configuration: Configuration, squeeze: Squeeze, *, bent: bool = False) -> Squeeze:
    """The squeeze with the targets and pads that its forces make.

    Args:
        configuration: the grasp.
        squeeze: with forces; its targets don't count.
        bent: whether joints just go on as their efforts push them, with no heed to where the tips go.
    """
    settings = squeeze.settings
    pads, normals_N = contact_pads(configuration, settings), squeeze.preload[:, 0]
    yields_m = pads.yields_m(normals_N)
    led_m = np.zeros(len(yields_m)) if bent else yields_m
    statics = grasp_statics(configuration, settings)
    efforts, targets = straight_targets(configuration, statics, squeeze.preload, led_m, squeeze.centres_m)
    return replace(
        squeeze,
        targets=targets,
        efforts=efforts,
        yields_m=yields_m,
        spin_arms_m=pads.spin_arms_m(normals_N),
    )
