"""How far the true solution of a certificate is from a state at most, in the terms of states."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...objects import Task
from ..contacts import Certificate, Configuration, State
from ..formulate import UNIT_M, Formulation, formulate
from ..interval import Balls

__all__ = ["SolutionRadii", "solution_radii"]

# A solution farther from a state than this, in its own measure, is not the one that it stands for.
_FARTHEST = 1e-3
# Boxes of the same solution in other variables were up to ten times as wide. A rotation is written as a
# quaternion, which stands for it to within 1e-15.
_WIDER, _ROOM = 32.0, 1e-12
# More than what three roundings take away.
_UP = 1.0 + 2.0**-50


@dataclass(frozen=True)
class SolutionRadii:
    """A true solution of a task's equations lies this close to a state, with room to spare.

    The room is for whoever proves it again in other variables, which gives another box.

    Attributes:
        joints: difference of every independent joint at most, in rad or m; joints of fingers without a
            contact are where the state has them.
        rotation: of every entry of the object's rotation.
        position: of every coordinate of the object's position, in m.
        parameters: of every patch parameter.
    """

    joints: float
    rotation: float
    position: float
    parameters: float


def solution_radii(configuration: Configuration, state: State | None = None) -> SolutionRadii | None:
    """The radii about a state, of the configuration's certificate; None where it has none, or one far away.

    Args:
        configuration: a certified one.
        state: near the configuration's, such as the same as it is written; None for its own.
    """
    if configuration.certificate is None:
        return None
    state = state or configuration.state
    f = _formulation(configuration.task)
    box = _box(configuration.certificate)
    found = SolutionRadii(
        joints=_roomy(_joints(f, box, state)),
        rotation=_roomy(_rotation(f, box, state)),
        position=_roomy(_position(f, box, state)),
        parameters=_roomy(_most(box[f.param_inputs] - state.params) if len(f.param_inputs) else 0.0),
    )
    widest = max(found.joints, found.rotation, found.position, found.parameters)
    return found if widest < _FARTHEST else None


@lru_cache(maxsize=8)
def _formulation(task: Task) -> Formulation:
    return formulate(task)


def _box(certificate: Certificate) -> Balls:
    return Balls.between(certificate.lower, certificate.upper)


def _roomy(radius: float) -> float:
    return _WIDER * radius + _ROOM


def _most(difference: Balls) -> float:
    return float(difference.most.max(initial=0.0))


def _joints(f: Formulation, box: Balls, state: State) -> float:
    found = [0.0]
    for j, (c, s) in f.angle_inputs.items():
        at = Balls.exact(state.q[j]) / float(f.divisors[j])
        cosine, sine = at.cosine(), at.sine()
        ahead = box[c] * cosine + box[s] * sine
        aside = (box[s] * cosine - box[c] * sine).most
        # (c, s) lies on the unit circle, so `aside` is the sine of the difference; arcsin x <= x (1 + x^2)
        # below a half.
        if not (ahead.lower > 0.0 and aside < 0.5):
            return np.inf
        found.append(float(aside * (1.0 + 2.0 * aside * aside) * f.divisors[j] * _UP))
    for j, k in f.slide_inputs.items():
        found.append(_most(box[k] * UNIT_M - state.q[j]))
    for j, k in f.turn_inputs.items():
        found.append(_most(box[k] - state.q[j]))
    return max(found)


def _rotation(f: Formulation, box: Balls, state: State) -> float:
    if f.task.T_palm_object is not None:
        return _most(Balls.exact(f.task.T_palm_object[:3, :3]) - state.R_palm_object)
    c, d = box[f.rotation_inputs[:3]], box[f.rotation_inputs[3:]]
    return _most(Balls.stack([c, d, c.cross(d)], axis=1) @ f.axes - state.R_palm_object)


def _position(f: Formulation, box: Balls, state: State) -> float:
    if f.task.T_palm_object is not None:
        return _most(Balls.exact(f.task.T_palm_object[:3, 3]) - state.p_palm_object)
    return _most(box[f.position] * UNIT_M - state.p_palm_object)
