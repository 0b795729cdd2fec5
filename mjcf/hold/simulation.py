"""A model of a grasp in MuJoCo, under way: what every physical test does with it."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ...base.machine.cancellation import give_up_if_asked
from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices
from ...solver import Configuration
from ..model import OBJECT_BODY, grasp_qpos
from ..settings import HoldSettings

__all__ = ["Simulation"]

# Whether a drive can end is asked once in so many samples.
_LOOK_EVERY = 3


class Simulation:
    """MuJoCo's model and data of a grasp, at first in the grasp.

    Args:
        model: MuJoCo's model of the task, this simulation's own, as `compiled_model` makes it.
        configuration: the grasp.
        settings: of the test.
    """

    def __init__(self, model: Any, configuration: Configuration, settings: HoldSettings):
        # Imported late: MuJoCo settles on its OpenGL backend when it is imported, and the caller may choose.
        import mujoco

        self._mujoco: Any = mujoco
        self.settings = settings
        self.configuration = configuration
        self.model = model
        self.data = mujoco.MjData(model)
        self._body = model.body(OBJECT_BODY).id
        self._body_of = np.array(model.geom_bodyid, dtype=np.int64)
        hand = configuration.task.hand
        contacts = configuration.task.contacts
        self._links = np.array([model.body(hand.links[contact.hand.link].name).id for contact in contacts])
        self._floats = model.nq > len(hand.axes) and model.jnt_type[-1] == mujoco.mjtJoint.mjJNT_FREE
        self._object_pose = grasp_qpos(configuration)[-7:]
        self.begin(configuration.state.q)

    def begin(self, q: Array, pose: Array | None = None) -> None:
        """Puts everything in place, at rest.

        Args:
            q: independent joints (n_independent,), also the servos' targets.
            pose: of the object (7,) in the palm frame; None for where the grasp has it.
        """
        pose = self._object_pose if pose is None else pose
        model, data = self.model, self.data
        if not self._floats:
            model.body_pos[self._body], model.body_quat[self._body] = pose[:3], pose[3:]
        self._mujoco.mj_resetData(model, data)
        joints = self.configuration.task.hand.expand(q)
        data.qpos[: len(joints)], data.ctrl[:] = joints, q
        if self._floats:
            data.qpos[-7:] = pose
        # The parts that stay behind are where the object is.
        data.mocap_pos[:], data.mocap_quat[:] = pose[:3], pose[3:]

    def close(self, waypoints: Array, pose: Array | None = None) -> bool:
        """Closes the fingers along straight lines between `waypoints` (k, n_independent), in `close_s`.

        The pace is even in the largest joint motion of each line, so that no servo has to hurry.

        Args:
            waypoints: from the pregrasp to the grasp.
            pose: of the object, as in `begin`.

        Returns:
            Whether nothing has touched anything, so that no property of contacts counted.
        """
        self.begin(waypoints[0], pose)
        data, is_free = self.data, True
        for row in self.closing_controls(waypoints):
            data.ctrl[:] = row
            self._mujoco.mj_step(self.model, data)
            is_free = is_free and data.ncon == 0
        return is_free

    def closing_controls(self, waypoints: Array) -> Array:
        """The servos' targets (steps, n_independent) in each step of `close`."""
        way = np.concatenate([[0.0], np.abs(np.diff(waypoints, axis=0)).max(axis=1).cumsum()])
        steps = self.steps(self.settings.close_s)
        places = way[-1] * np.arange(1, steps + 1) / steps
        return np.column_stack([np.interp(places, way, joint) for joint in waypoints.T])

    def steps(self, seconds: float) -> int:
        """Number of steps in a time, at least one."""
        return max(1, round(seconds / self.settings.timestep_s))

    def step(self, count: int) -> None:
        """So many steps with everything left as it is."""
        give_up_if_asked()
        self._mujoco.mj_step(self.model, self.data, count)

    def drive(
        self,
        start: Array,
        end: Array,
        seconds: float,
        *,
        gravity: Array | None = None,
        keep_every: int = 0,
        until: Callable[[], bool] | None = None,
    ) -> list[Array]:
        """Moves the servos' targets (n_independent,) evenly from `start` to `end`.

        Meanwhile gravity goes from what it is to `gravity` (3,) in m/s^2, unless that is None.

        Args:
            start: targets at first.
            end: targets at last.
            seconds: the time for it.
            gravity: see above.
            keep_every: of so many steps one is kept; 0 keeps none.
            until: asked every few samples; where it says so, the rest is left out.

        Returns:
            The full states before the first and after each `keep_every`-th step.
        """
        steps, look = self.steps(seconds), _LOOK_EVERY * self.steps(self.settings.sample_s)
        ctrl, mj_step, model, data = self.data.ctrl, self._mujoco.mj_step, self.model, self.data
        shares = np.arange(1, steps + 1)[:, None] / steps
        rows = start + shares * (end - start)
        before = model.opt.gravity.copy()
        pulls = before + shares * (np.zeros(3) if gravity is None else gravity - before)
        give_up_if_asked()
        kept: list[Array] = []
        for k, (row, pull) in enumerate(zip(rows, pulls, strict=True)):
            if keep_every and k % keep_every == 0:
                kept.append(self.full_state())
            if until is not None and k and k % look == 0 and until():
                break
            ctrl[:] = row
            if gravity is not None:
                model.opt.gravity[:] = pull
            mj_step(model, data)
        return kept

    def full_state(self) -> Array:
        """All that the future depends on, the solver's warm start included."""
        kind = self._mujoco.mjtState.mjSTATE_INTEGRATION
        state = np.zeros(self._mujoco.mj_stateSize(self.model, kind))
        self._mujoco.mj_getState(self.model, self.data, state, kind)
        return state

    def take(self, qpos: Array, qvel: Array, ctrl: Array) -> None:
        """Takes positions (nq,), velocities (nv,) and servo targets (n_independent,) from elsewhere."""
        self.data.qpos[:], self.data.qvel[:], self.data.ctrl[:] = qpos, qvel, ctrl

    def restore(self, state: Array) -> None:
        """Goes back to what `full_state` has given."""
        self._mujoco.mj_setState(self.model, self.data, state, self._mujoco.mjtState.mjSTATE_INTEGRATION)

    def forward(self) -> None:
        """Computes contacts and forces of the present positions; what comes after is as without it."""
        # Finding forces moves the solver's warm start, and with it the last bits of all later steps.
        warm_start = self.data.qacc_warmstart
        before = warm_start.copy()
        self._mujoco.mj_forward(self.model, self.data)
        warm_start[:] = before

    def warnings(self) -> int:
        """How often MuJoCo has found the simulation to break down (or its memory too small)."""
        return int(self.data.warning.number.sum())

    def penetration_m(self) -> float:
        """How deep the hand sinks into the object now, at least 0.

        What its convex pieces stand out at a contact doesn't count.
        """
        self.forward()
        which, contact = self._others() >= 0, self.data.contact
        return float((contact.includemargin[which] - contact.dist[which]).max(initial=0.0))

    def normal_forces(self) -> Array:
        """Normal force (n_contacts,) in N between the object and the link of each contact of the task.

        A link that makes several contacts of the task counts with its whole force for each.
        """
        self.forward()
        return self._touching()[0]

    def normal_forces_of_last_step(self) -> Array:
        """As `normal_forces`, as they were a step ago: what a look every few steps needs costs nothing then.

        After `begin`, `take` or `restore` they are of what was there before, until the next step.
        """
        return self._touching()[0]

    def contact_speeds(self) -> tuple[Array, Array]:
        """Normal forces (n_contacts,) in N, and how fast each contact of the task slides, in m/s.

        A contact slides as fast as the two bodies' points at its place move apart in the tangent plane; of
        several places where a link touches, the one with the largest force counts. Contacts and forces are
        those of the last step.
        """
        normals, strongest = self._touching()
        speeds = np.zeros(len(self._links))
        for i, (link, there) in enumerate(zip(self._links.tolist(), strongest.tolist(), strict=True)):
            if there >= 0:
                contact = self.data.contact[there]
                apart = self._velocity(link, contact.pos) - self._velocity(self._body, contact.pos)
                speeds[i] = np.linalg.norm(contact.frame.reshape(3, 3)[1:] @ apart)
        return normals, speeds

    def object_pose(self) -> Array:
        """Pose (7,) of the object in the palm frame, which is the world frame."""
        return np.concatenate([self.data.xpos[self._body], self.data.xquat[self._body]])

    def floating_pose(self) -> Array:
        """The same of an object that floats, as its positions have it: no step behind, and before any."""
        return self.data.qpos[-7:].copy()

    def all_touch(self) -> bool:
        """Whether every contact of the task carried force a step ago."""
        return bool((self.normal_forces_of_last_step() > 0.0).all())

    def hinge_friction(self) -> float:
        """The largest torque in Nm with which dry friction has held the last joint in the last step."""
        data, mujoco = self.data, self._mujoco
        rows = (data.efc_type == mujoco.mjtConstraint.mjCNSTR_FRICTION_DOF) & (
            data.efc_id == self.model.nv - 1
        )
        return float(np.abs(data.efc_force[rows]).max(initial=0.0))

    def _velocity(self, body: int, point: Array) -> Array:
        """Velocity (3,) of the point of a body that is at `point` now."""
        J = np.zeros((3, self.model.nv))
        self._mujoco.mj_jac(self.model, self.data, J, None, point, body)
        return J @ self.data.qvel

    def _others(self) -> Indices:
        """The other body (n,) of each contact with the object, and -1 for contacts of others."""
        geoms = self.data.contact.geom
        others = np.empty(len(geoms), dtype=np.int64)
        _other_bodies(geoms, self._body_of, self._body, others)
        return others

    def _touching(self) -> tuple[Array, Indices]:
        """Normal forces (n_contacts,) in N at the contacts of the task, and where each link presses most.

        Contacts are those that MuJoCo has found last.
        """
        others = self._others()
        normals, strongest = np.empty(len(self._links)), np.empty(len(self._links), dtype=np.int64)
        # A contact without rows has no force; of an elliptic cone's rows the first is normal.
        rows = self.data.contact.efc_address
        _link_forces(others, rows, self.data.efc_force, self._links, normals, strongest)
        return normals, strongest


# Asked for every few steps; numpy takes as long over so few contacts as MuJoCo over a step.
@compiled
def _other_bodies(geoms: Indices, body_of: Indices, body: int, out: Indices) -> None:
    """Writes the other body (n,) of each contact of a body, and -1 for contacts that are not its.

    Args:
        geoms: (n, 2) geoms of the contacts.
        body_of: (n_geoms,) the body of each geom.
        body: which one.
        out: (n,) takes the bodies.
    """
    for k in range(len(geoms)):
        a, b = body_of[geoms[k, 0]], body_of[geoms[k, 1]]
        if (a == body) == (b == body):
            out[k] = -1
        else:
            out[k] = b if a == body else a


@compiled
def _link_forces(
    others: Indices, rows: Indices, forces: Array, links: Indices, normals: Array, strongest: Indices
) -> None:
    """Adds up normal forces of contacts by link.

    Args:
        others: (n,) see `_other_bodies`.
        rows: (n,) the row in `forces` of each contact's normal force; -1 where it has none.
        forces: of all constraints, in N.
        links: (k,) bodies.
        normals: (k,) takes the sum for each link.
        strongest: (k,) takes the contact with the largest force of each link, the last of equals; -1 where
            the link touches nowhere.
    """
    for i in range(len(links)):
        normals[i], strongest[i] = 0.0, -1
        largest = 0.0
        for k in range(len(others)):
            if others[k] != links[i]:
                continue
            force = forces[rows[k]] if rows[k] >= 0 else 0.0
            normals[i] += force
            if strongest[i] < 0 or force >= largest:
                strongest[i], largest = k, force
