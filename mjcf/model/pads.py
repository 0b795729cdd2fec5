"""The pads of a squeeze in a model: how links of contacts resist spin and, where asked, how they yield.

MuJoCo takes friction and stiffness of a contact from the geom of higher priority. So the geoms of every link
that makes a contact of the task outrank the object's and bear what its pad is in this squeeze; a link that
makes several has their mean by force. What else touches the object has the smallest arm among them.
"""

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...hands import Hand
from ...objects import Task
from ..settings import HoldSettings
from .object import OBJECT_BODY, STAND_BODY
from .pressed_pads import PressedPads
from .sunk_contacts import pair_friction
from .xml import numbers

__all__ = ["add_pads", "set_pads"]

_PRIORITY = 2
# Impedance of soft contacts, the same at any depth, so that they are springs with one stiffness.
_IMPEDANCE = 0.95
# Least force of a planned contact, so that its stiffness is one.
_LEAST_N = 1.0


def add_pads(root: ET.Element, model: Any, hand: Hand) -> None:
    """Writes into a model's text what `set_pads` has set in the compiled model."""
    names = {link.name for link in hand.links}
    for body in root.iter("body"):
        if body.get("name") not in names:
            continue
        for geom in body.findall("geom"):
            compiled = model.geom(geom.get("name"))
            if compiled.priority[0] == _PRIORITY:
                geom.set("priority", str(_PRIORITY))
                for name in ("friction", "solref", "solimp"):
                    geom.set(name, numbers(getattr(compiled, name)))
    # These have values of their own, whatever the geoms'.
    for i, pair in enumerate(root.iter("pair")):
        for name in ("friction", "solref", "solimp"):
            pair.set(name, numbers(getattr(model, f"pair_{name}")[i]))
    for default in root.iter("default"):
        of_class = default.find("geom")
        if default.get("class") == OBJECT_BODY and of_class is not None:
            (first, *_) = np.flatnonzero(model.geom_bodyid == model.body(OBJECT_BODY).id)
            of_class.set("friction", numbers(model.geom_friction[first]))


def set_pads(model: Any, task: Task, settings: HoldSettings, pads: PressedPads) -> None:
    """Sets the friction of a squeeze's contacts in a compiled model, and with `soft_pads` their springs."""
    mu = settings.sliding_friction(task.object)
    arms = _by_link(task, pads.spin_arms_m)
    springs = _by_link(task, _stiffness(pads))
    others = [i for i in range(model.nbody) if model.body(i).name in (OBJECT_BODY, STAND_BODY)]
    model.geom_friction[np.isin(model.geom_bodyid, others), 1] = mu * min(arms.values())
    for link, arm_m in arms.items():
        body = model.body(task.hand.links[link].name).id
        geoms = model.geom_bodyid == body
        solref, solimp = settings.contact_solref, settings.contact_solimp
        if settings.soft_pads and springs[link] < np.inf:
            solref, solimp = _spring(model, body, springs[link])
        model.geom_priority[geoms] = _PRIORITY
        model.geom_friction[geoms] = mu, mu * arm_m, 0.0001
        model.geom_solref[geoms], model.geom_solimp[geoms] = solref, solimp
        pairs = geoms[model.pair_geom1] | geoms[model.pair_geom2]
        model.pair_friction[pairs] = pair_friction(mu, mu * arm_m)
        model.pair_solref[pairs], model.pair_solimp[pairs] = solref, solimp


def _stiffness(pads: PressedPads) -> Array:
    """Force over yield (n,) in N/m at the planned force; infinite where nothing yields."""
    # The force goes with the square of the yield, so a contact that is to press with next to nothing has the
    # stiffness that it has at 1 N.
    scale = np.sqrt(np.maximum(pads.normals_N, _LEAST_N) / np.maximum(pads.normals_N, 1e-9))
    soft = pads.yields_m > 0.0
    forces_N = scale * np.maximum(pads.normals_N, 1e-9)
    return np.divide(forces_N, pads.yields_m, out=np.full(len(soft), np.inf), where=soft)


def _spring(
    model: Any, body: int, stiffness_N_m: float
) -> tuple[tuple[float, float], tuple[float, float, float, float, float]]:
    """`solref` and `solimp` of a contact that is a spring, critically damped, between a body and the object.

    MuJoCo sees a contact as a spring per inverse mass: its stiffness is that of `solref` over (1 - d) A, with
    the impedance d and the inverse mass A of both bodies at the reference position.
    """
    obj = model.body(OBJECT_BODY).id
    A = float(model.body_invweight0[body, 0] + model.body_invweight0[obj, 0])
    k = stiffness_N_m * (1.0 - _IMPEDANCE) * A
    solref = -k, -2.0 * float(np.sqrt(k))
    return solref, (_IMPEDANCE, _IMPEDANCE, 0.001, 0.5, 2.0)


def _by_link(task: Task, values: Array) -> dict[int, float]:
    """The mean of what contacts (n,) have, by the index of their link."""
    links = np.array([contact.hand.link for contact in task.contacts])
    return {int(link): float(values[links == link].mean()) for link in dict.fromkeys(links.tolist())}
