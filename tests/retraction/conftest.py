"""Configurations to retract: contacts solved from random states, whatever else they collide with."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Hull, Patch, shape_mesh
from holdfast.geometry.transforms import rotation_exp
from holdfast.objects import Contact, ObjectModel, ObjectRegion, Part, Task, load_task
from holdfast.retraction import compute_clearance
from holdfast.solver import Configuration, ContactManifold, State, certify_state
from holdfast.solver.contacts.local_search import search_locally


def sample_configurations(task: Task, count: int, seed: int) -> list[Configuration]:
    manifold = ContactManifold(task)
    rng = np.random.default_rng(seed)
    found: list[Configuration] = []
    while len(found) < count:
        x = rng.uniform(manifold.lower, manifold.upper)
        p = rng.uniform([0.0, -0.05, 0.1], [0.15, 0.05, 0.3])
        start = State(x[: manifold.n_q], rotation_exp(2.0 * rng.normal(size=3)), p, x[manifold.n_q :])
        state = search_locally(manifold, start)
        if state is not None:
            found.append(certify_state(manifold, state))
    return found


def box_hull(low, high) -> Hull:
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    return Hull.from_points(corners)


@pytest.fixture(scope="session")
def task() -> Task:
    return load_task("upholding")


@pytest.fixture(scope="session")
def manifold(task: Task) -> ContactManifold:
    return ContactManifold(task)


@pytest.fixture(scope="session")
def configurations(task: Task) -> list[Configuration]:
    return sample_configurations(task, 25, seed=1)


@pytest.fixture(scope="session")
def colliding(configurations: list[Configuration]) -> list[Configuration]:
    return [c for c in configurations if not compute_clearance(c.task, c.state).is_clear]


@pytest.fixture(scope="session")
def clear(configurations: list[Configuration]) -> list[Configuration]:
    return [c for c in configurations if compute_clearance(c.task, c.state).is_clear]


@pytest.fixture(scope="session")
def slot_task(task: Task) -> Task:
    """The index must touch the floor of a slot that is 10 mm wide: its tip is 26 mm thick."""
    hulls = {
        "floor": box_hull((-0.02, -0.02, -0.01), (0.02, 0.02, 0.0)),
        "left": box_hull((-0.02, 0.005, 0.0), (0.02, 0.02, 0.03)),
        "right": box_hull((-0.02, -0.02, 0.0), (0.02, -0.005, 0.03)),
    }
    x, y = 0.001, 0.001
    net = [[(-x, -y, 0), (-x, y, 0)], [(x, -y, 0), (x, y, 0)]]
    region = ObjectRegion("bottom", Patch(BezierPatch(np.array(net))))
    parts = tuple(Part(name, shape_mesh(hull), (hull,), task.object.inertia) for name, hull in hulls.items())
    slot = ObjectModel("slot", parts, 0.6, {"bottom": region.region})
    contacts = (Contact(task.hand.regions["index/tip"], region),)
    return replace(task, name="slot", object=slot, contacts=contacts)
