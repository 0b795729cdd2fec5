"""Servos of joints for which neither the model nor the hand file has one, and inertia of those without."""

from dataclasses import replace

import numpy as np

from ..finding import surface_points
from ..hand import Actuator, Axis, Link
from .model_tree import ModelTree

__all__ = ["with_nominal_servos"]

# What a finger's end presses with, and how far a joint yields at full effort.
_FORCE_N = 30.0
_YIELD_RAD = 0.1
_EFFORTS = (0.2, 5.0)
# The model's own limit counts where it lets a finger press with this much at least.
_LEAST_FORCE_N = 5.0
# Of a critically damped bare finger, as of the built-in hands: per effort.
_DAMPING_S = 0.4 / 3.0
_ARMATURE = 0.002 / 3.0
_JAW = Actuator(effort=40.0, stiffness=2000.0, damping=20.0, armature=0.01)


def with_nominal_servos(links: list[Link], tree: ModelTree) -> tuple[Link, ...]:
    """The links with a servo on every joint that follows no other, and none without armature; notes say so.

    Without armature the thin links of a finger are all that moves with it: a contact of an object with so
    little mass rings, or throws the object away.
    """
    levers = _levers(links)
    taken, heavier, out = list[str](), list[str](), list[Link]()
    for link, lever in zip(links, levers, strict=True):
        axes = []
        for axis in link.axes:
            usual = _nominal(axis, lever, tree.efforts.get(axis.name))
            if axis.coupling is None and axis.actuator is None:
                axis = replace(axis, actuator=usual)
                taken.append(axis.name)
            elif axis.actuator is not None and axis.actuator.armature == 0.0:
                axis = replace(axis, actuator=replace(axis.actuator, armature=usual.armature))
                heavier.append(axis.name)
            axes.append(axis)
        out.append(replace(link, axes=tuple(axes)))
    if taken:
        tree.notes.append(
            f"usual servos ({_FORCE_N:g} N at the finger's end, or less if the model says so) were taken for "
            f"{', '.join(taken)}: the model has no damped position actuator with an effort limit for them"
        )
    if heavier:
        tree.notes.append(f"the usual armature was taken for {', '.join(heavier)}: none is given for them")
    return tuple(out)


def _nominal(axis: Axis, lever_m: float, model_effort: float | None) -> Actuator:
    if axis.kind == "prismatic":
        return _JAW
    effort = float(np.clip(_FORCE_N * lever_m, *_EFFORTS))
    if model_effort is not None and _LEAST_FORCE_N * lever_m <= model_effort < effort:
        effort = model_effort
    return Actuator(effort, effort / _YIELD_RAD, _DAMPING_S * effort, _ARMATURE * effort)


def _levers(links: list[Link]) -> list[float]:
    """How far the farthest point that a link carries is from the link's joint, at most, in m."""
    levers = [0.0] * len(links)
    for i in reversed(range(len(links))):
        points = surface_points(links[i].shapes)
        own = float(np.linalg.norm(points, axis=1).max()) if len(points) else 0.0
        levers[i] = max(levers[i], own)
        if i > 0:
            parent = links[i].parent
            step = float(np.linalg.norm(links[i].T_parent_link0[:3, 3]))
            levers[parent] = max(levers[parent], step + levers[i])
    return levers
