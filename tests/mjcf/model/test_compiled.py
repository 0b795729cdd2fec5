"""What is set in a model after MuJoCo has compiled it."""

import mujoco
import numpy as np
from holdfast.mjcf.model.compiled import _weigh_swivels, compiled_model
from holdfast.mjcf.settings import HoldSettings
from holdfast.objects import load_task

# Two paddles that turn about their centres of mass, driven against each other, and a body that floats.
PADDLES = """
<mujoco>
  <option timestep="0.0025" cone="elliptic" gravity="0 0 0"/>
  <default>
    <geom type="capsule" size="0.005" mass="0.02" condim="4"/>
    <joint armature="0.002" damping="0.4"/>
  </default>
  <worldbody>
    <body name="left"><joint name="a" axis="0 0 1"/><geom fromto="-0.03 0 0 0.03 0 0"/></body>
    <body name="right" pos="0.05 0.012 0">
      <joint name="b" axis="0 0 1"/>
      <geom fromto="-0.03 0 0 0.03 0 0"/>
    </body>
    <body name="ball" pos="0 0 1"><freejoint/><geom type="sphere" size="0.02"/></body>
  </worldbody>
  <actuator><position joint="a" kp="4" ctrlrange="-1 1"/></actuator>
</mujoco>
"""


def stiffest(model: mujoco.MjModel) -> float:
    """The largest stiffness of a contact while the left paddle is pressed on the right one."""
    data, stiffness = mujoco.MjData(model), 0.0
    data.ctrl[:] = 0.5
    for _ in range(200):
        mujoco.mj_step(model, data)
        stiffness = max([stiffness, *data.efc_D[: data.nefc]])
    assert stiffness > 0.0
    return stiffness


def test_links_that_turn_about_their_centres_of_mass_give_where_they_touch() -> None:
    model = mujoco.MjModel.from_xml_string(PADDLES)
    ball, before = model.body("ball").id, model.body_invweight0.copy()
    assert stiffest(model) > 1e12
    _weigh_swivels(model)
    assert np.array_equal(model.body_invweight0[[0, ball]], before[[0, ball]])
    assert np.array_equal(model.body_invweight0[:, 1], before[:, 1])
    assert stiffest(model) < 1e6


def test_other_links_keep_the_masses_that_mujoco_gives_them() -> None:
    for name in ("upholding", "family:box:1@shadow"):
        model = compiled_model(load_task(name), HoldSettings())
        weights = model.body_invweight0.copy()
        _weigh_swivels(model)
        assert np.array_equal(model.body_invweight0, weights)
