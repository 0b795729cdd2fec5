"""The axes in which an object's contacts are written."""

import dataclasses

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Patch
from holdfast.geometry.transforms import rotation_exp
from holdfast.objects import Task
from holdfast.solver.contacts.state import State
from holdfast.solver.formulate.formulate import formulate
from holdfast.solver.formulate.object_axes import in_axes, working_axes


def turned(task: Task, Q: np.ndarray) -> Task:
    """The task with its object's patches turned by Q about the object's origin."""
    meant = [
        dataclasses.replace(
            c,
            object=dataclasses.replace(
                c.object, region=dataclasses.replace(c.object.region, off_surface=True)
            ),
        )
        for c in task.contacts
    ]
    contacts = tuple(in_axes(contact, Q) for contact in meant)
    regions = {c.object.name: c.object.region for c in contacts}
    model = dataclasses.replace(task.object, regions={**task.object.regions, **regions})
    return dataclasses.replace(task, contacts=contacts, object=model)


def state_at(task: Task, seed: int) -> State:
    rng = np.random.default_rng(seed)
    q = rng.uniform(*task.limits.T)
    n_params = 2 * sum(isinstance(c.object.region, Patch) for c in task.contacts)
    R = rotation_exp(rng.uniform(-3.0, 3.0, 3))
    return State(q, R, rng.uniform(-0.1, 0.1, 3), rng.uniform(0.0, 1.0, n_params))


@pytest.mark.parametrize("seed", range(5))
def test_axes_turn_with_the_object(upholding, seed):
    """What the contacts look like along the axes depends on the regions, not on the designer's frame."""
    Q = rotation_exp(np.random.default_rng(seed).uniform(-2.0, 2.0, 3))
    axes = working_axes(turned(upholding, Q))
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    np.testing.assert_allclose(axes, working_axes(upholding) @ Q.T, atol=1e-9)


def test_the_first_axis_is_the_normal_of_parallel_faces(upholding):
    """Between two facing squares nothing separates more surely than their normal, shifted as they may be."""
    square = np.array([[[0.0, 0, 0], [0, 0.03, 0]], [[0.02, 0, 0], [0.02, 0.03, 0]]])
    shift = np.array([0.01, 0.005, -0.05])
    faces = [Patch(BezierPatch(net), off_surface=True) for net in (square, square.transpose(1, 0, 2) + shift)]
    contacts = tuple(
        dataclasses.replace(c, object=dataclasses.replace(c.object, region=face))
        for c, face in zip(upholding.contacts, faces, strict=True)
    )
    axes = working_axes(dataclasses.replace(upholding, contacts=contacts))
    np.testing.assert_allclose(np.abs(axes[0]), [0.0, 0.0, 1.0], atol=0.0)


def test_curved_patches_keep_their_frame(upholding):
    """Turned, more of their coordinates would be Bernstein functions."""
    Q = rotation_exp(np.array([0.3, -0.5, 0.8]))
    tilted = turned(upholding, Q)
    first, *rest = tilted.contacts
    net = np.zeros((3, 2, 3))
    net[..., 0] = np.array([-0.01, 0.0, 0.01])[:, None]
    net[..., 1] = np.array([-0.01, 0.01])[None]
    net[1, :, 2] = 0.002
    bulge = dataclasses.replace(
        first, object=dataclasses.replace(first.object, region=Patch(BezierPatch(net), off_surface=True))
    )
    curved = dataclasses.replace(tilted, contacts=(bulge, *rest))
    assert not np.array_equal(working_axes(tilted), np.eye(3))
    np.testing.assert_array_equal(working_axes(curved), np.eye(3))


def test_a_fixed_object_keeps_its_frame(upholding):
    fixed = dataclasses.replace(upholding, T_palm_object=np.eye(4))
    np.testing.assert_array_equal(working_axes(fixed), np.eye(3))


@pytest.mark.parametrize("seed", range(5))
def test_states_come_back_in_the_object_s_own_frame(upholding, seed):
    """Rotation, joints and parameters survive the way to the inputs and back; the position is defined."""
    formulation = formulate(upholding)
    state = state_at(upholding, seed)
    back = formulation.state_from_inputs(formulation.inputs_from_state(state), state.q)
    np.testing.assert_allclose(back.R_palm_object, state.R_palm_object, atol=1e-9)
    np.testing.assert_allclose(back.params, state.params, atol=1e-12)
    np.testing.assert_allclose(back.q, state.q, atol=1e-9)
