"""MuJoCo's models of tasks, compiled once for all grasps.

Grasps of a task differ in where hand and object stand, which is no part of the compiled model; the object's
own frame stands in the palm's until `Simulation` puts it in place. So what a test computes doesn't depend on
which grasp came first.
"""

from copy import copy
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from ...base.numeric.arrays import Mask
from ...objects import LiftTest, Task
from ..settings import HoldSettings
from .burden import Burden, set_burden
from .object import OBJECT_BODY, STAND_BODY
from .pads import set_pads
from .pressed_pads import PressedPads
from .sunk_contacts import pair_friction
from .tree import task_tree
from .xml import to_text

__all__ = ["compiled_model"]

# What a model is compiled anew for. Friction does not count: trials with noise change it each time, so it is
# written into the copy. Nor does how MuJoCo steps and solves, on which nothing that is compiled depends.
_SHAPING = ("object_mass_kg", "hand_weight", "contact_solref", "contact_solimp")
# The candidates of a small data set, which environments try in any order.
_MOST_KEPT = 64
# With less of what a force beside the axis would do, a link counts as one that only turns. Others have a
# twentieth of it and more, those that only turn have none.
_NO_GIVE = 1e-3


def compiled_model(
    task: Task,
    settings: HoldSettings,
    pads: PressedPads | None = None,
    *,
    floats: bool | None = None,
    burden: Burden | None = None,
) -> Any:
    """A model of its own for the caller, of hand and object.

    Args:
        task: the task.
        settings: friction, masses and solver settings.
        pads: at the contacts of a squeeze; None for contacts of which no force is known.
        floats: whether the object floats; None for as the task's test has it.
        burden: what the object's mass is; None for as planned.
    """
    shaping = replace(HoldSettings(), **{name: getattr(settings, name) for name in _SHAPING})
    floats = isinstance(task.test, LiftTest) if floats is None else floats
    shifts = burden is not None and bool(burden.com_offset_m.any())
    compiled = _compiled(task, shaping, floats, shifts)
    model, obj, geoms = copy(compiled.model), task.object, compiled.of_object
    _set_numerics(model, settings)
    model.geom_friction[geoms, :2] = settings.sliding_friction(obj), settings.torsional_friction(obj)
    model.pair_friction[:] = pair_friction(settings.sliding_friction(obj), settings.torsional_friction(obj))
    if burden is not None:
        set_burden(model, burden)  # before the pads: how stiff they are depends on masses
    if pads is not None:
        set_pads(model, task, settings, pads)
    return model


@dataclass(frozen=True, eq=False)
class _Compiled:
    """A model, and which of its geoms (n,) are the object's or its stand's."""

    model: Any
    of_object: Mask


def _set_numerics(model: Any, settings: HoldSettings) -> None:
    """How MuJoCo steps and solves, as the text of a model says it."""
    import mujoco  # late, as in `hold.simulation`

    option = model.opt
    option.timestep, option.impratio = settings.timestep_s, settings.impratio
    option.noslip_iterations = settings.noslip_iterations
    option.solver = int(getattr(mujoco.mjtSolver, f"mjSOL_{settings.solver.upper()}"))


@lru_cache(maxsize=_MOST_KEPT)
def _compiled(task: Task, settings: HoldSettings, floats: bool, shifts: bool) -> _Compiled:
    import mujoco  # late, as above

    root, body = task_tree(task, settings, np.eye(4), floats=floats)
    if shifts:
        # Else a body whose centre of mass is its origin is compiled so that it has to stay there.
        body.set("simple", "false")
    model = mujoco.MjModel.from_xml_string(to_text(root))
    _weigh_swivels(model)
    bodies = [i for i in range(model.nbody) if model.body(i).name in (OBJECT_BODY, STAND_BODY)]
    return _Compiled(model, np.isin(model.geom_bodyid, bodies))


def _weigh_swivels(model: Any) -> None:
    """Gives links that only turn about their centre of mass a mass to be pushed against.

    MuJoCo makes a contact as stiff as the masses of its two bodies allow, by how a force at their centres of
    mass moves them. Where such a force moves neither, as with first links of two fingers whose centres lie on
    their axes, the contact is without any give, and the simulation breaks down as they touch. What counts
    there is how a force beside the axis turns them: half way out to the farthest point of the link.
    """
    radius = np.zeros(model.nbody)
    np.maximum.at(radius, model.geom_bodyid, model.geom_rbound)
    pushed, turned = model.body_invweight0.T
    least = turned * (0.5 * radius) ** 2
    swivels = pushed < _NO_GIVE * least
    model.body_invweight0[swivels, 0] = least[swivels]
