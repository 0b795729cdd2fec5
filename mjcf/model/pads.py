"""The pads of a squeeze in a model: how links of contacts resist spin and, where asked, how they yield.

MuJoCo takes friction and stiffness of a contact from the geom of higher priority. So the geoms of every link
that makes a contact of the task outrank the object's and bear what its pad is in this squeeze; a link that
makes several has their mean by force. What else touches the object has the smallest arm among them.
"""

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np

from ...arrays import Array
from ...objects import Task
from ..settings import HoldSettings
from .object import OBJECT_BODY, STAND_BODY
from .squeeze import Squeeze
from .sunk_contacts import pair_friction
from .xml import numbers

__all__ = ["add_pads", "set_pads"]

_PRIORITY = 2
# Impedance of soft contacts, the same at any depth, so that they are springs with one stiffness.
_IMPEDANCE = 0.95
# Least force of a planned contact, so that its stiffness is one.
_LEAST_N = 1.0


def add_pads(root: ET.Element, task: Task, settings: HoldSettings, spin_arms_m: Array) -> None:
    """Writes into a model's text at which arm (n,) friction resists spin at each contact of the task."""
    mu = settings.sliding_friction(task.object)
    arms = _by_link(task, spin_arms_m)
    for default in root.iter("default"):
        geom = default.find("geom")
        if default.get("class") == OBJECT_BODY and geom is not None:
            geom.set("friction", numbers([mu, mu * min(arms.values()), 0.0001]))
    for body in root.iter("body"):
        for link, arm_m in arms.items():
            if body.get("name") != task.hand.links[link].name:
                continue
            for geom in body.findall("geom"):
                geom.set("priority", str(_PRIORITY))
                geom.set("friction", numbers([mu, mu * arm_m, 0.0001]))
                geom.set("solref", numbers(settings.contact_solref))
                geom.set("solimp", numbers(settings.contact_solimp))
            names = {geom.get("name") for geom in body.findall("geom")}
            for pair in root.iter("pair"):  # these have values of their own, whatever the geoms'
                if pair.get("geom1") in names:
                    pair.set("friction", numbers(pair_friction(mu, mu * arm_m)))


def set_pads(model: Any, task: Task, settings: HoldSettings, squeeze: Squeeze) -> None:
    """Sets the same in a compiled model, and with `soft_pads` how far each pad yields."""
    mu = settings.sliding_friction(task.object)
    arms = _by_link(task, squeeze.spin_arms_m)
    forces_N = np.maximum(squeeze.preload[:, 0], _LEAST_N)
    # The pad's force goes with the square of its yield, so that of a weak contact is scaled up along with it.
    yields_m = squeeze.yields_m * np.sqrt(forces_N / np.maximum(squeeze.preload[:, 0], 1e-9))
    stiffness = _by_link(task, forces_N / np.maximum(yields_m, 1e-6))
    others = [i for i in range(model.nbody) if model.body(i).name in (OBJECT_BODY, STAND_BODY)]
    model.geom_friction[np.isin(model.geom_bodyid, others), 1] = mu * min(arms.values())
    solref, solimp = settings.contact_solref, settings.contact_solimp
    for link, arm_m in arms.items():
        body = model.body(task.hand.links[link].name).id
        geoms = model.geom_bodyid == body
        model.geom_priority[geoms] = _PRIORITY
        model.geom_friction[geoms] = mu, mu * arm_m, 0.0001
        if settings.soft_pads:
            solref, solimp = _spring(model, body, stiffness[link])
        model.geom_solref[geoms], model.geom_solimp[geoms] = solref, solimp
        pairs = geoms[model.pair_geom1] | geoms[model.pair_geom2]
        model.pair_friction[pairs] = pair_friction(mu, mu * arm_m)
        model.pair_solref[pairs], model.pair_solimp[pairs] = solref, solimp


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
