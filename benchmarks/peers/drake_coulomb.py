"""Whether Drake's pads slip by Coulomb's law: pinches whose critical load is known. For `peer_drake.py`.

Two soft pads on sliders press a hard body with a known force each; a force along the pads, or a torque about
their normal, acts on the body. It should slip from twice friction times force on, or, where a sphere spins,
from 16/15 friction times force times the radius of the patch on: on a pad of thickness L and modulus E a
sphere of radius R sinks in by d = sqrt(N L / (pi R E)), its patch has radius sqrt(2 R d), and the pressure
falls from its middle as 1 - r^2 / a^2.
"""

import numpy as np
from drake_scene import hard, new_plant, pad
from pydrake.common.value import Value
from pydrake.geometry import Box, Sphere
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce
from pydrake.multibody.tree import FixedOffsetFrame, PrismaticJoint, SpatialInertia
from pydrake.systems.analysis import Simulator

FORCE_N, FRICTION, MASS_KG = 20.0, 0.6, 0.1
RADIUS_M, HALF_M = 0.015, 0.012
PAD_M = 0.013
SETTLE_S, REST_S, WATCH_S = 0.5, 0.5, 0.5
# A body that still moves so far while it is watched passes the limits of a hold test within its 2 s.
SLIDES_M, SLIDES_RAD = 1e-3, 0.04
BISECTIONS = 7


def pinch(body: str, share: float, *, spin: bool, modulus_Pa: float, step_s: float) -> bool:
    """Whether a body pinched by two pads slips under so much of its critical load."""
    builder, plant, _ = new_plant(step_s)
    pads, rigid = pad(FRICTION, modulus_Pa), hard(FRICTION)
    size = RADIUS_M if body == "sphere" else HALF_M
    thing = plant.AddRigidBody("thing", SpatialInertia.SolidSphereWithMass(MASS_KG, size))
    form = Sphere(size) if body == "sphere" else Box(*(3 * [2.0 * size]))
    plant.RegisterCollisionGeometry(thing, RigidTransform(), form, "thing", rigid)
    for side in (-1.0, 1.0):
        name = f"pad {side:+.0f}"
        finger = plant.AddRigidBody(name, SpatialInertia.SolidSphereWithMass(0.05, PAD_M))
        start = RigidTransform(np.array([side * (size + PAD_M), 0.0, 0.0]))
        frame = plant.AddFrame(FixedOffsetFrame(f"{name}/at", plant.world_frame(), start))
        slider = plant.AddJoint(
            PrismaticJoint(name, frame, finger.body_frame(), np.array([-side, 0.0, 0.0]), damping=5.0)
        )
        plant.AddJointActuator(name, slider)
        wide = Box(2.0 * PAD_M, 0.08, 0.08)
        plant.RegisterCollisionGeometry(finger, RigidTransform(), wide, name, pads)
    plant.Finalize()
    simulator = Simulator(builder.Build())
    own = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.get_actuation_input_port().FixValue(own, np.full(2, FORCE_N))
    push = plant.get_applied_spatial_force_input_port()
    push.FixValue(own, Value([load(thing, 0.0, spin=spin, modulus_Pa=modulus_Pa)]))
    simulator.AdvanceTo(SETTLE_S)
    push.FixValue(own, Value([load(thing, share, spin=spin, modulus_Pa=modulus_Pa)]))
    simulator.AdvanceTo(SETTLE_S + REST_S)
    before = plant.EvalBodyPoseInWorld(own, thing)
    simulator.AdvanceTo(SETTLE_S + REST_S + WATCH_S)
    after = plant.EvalBodyPoseInWorld(own, thing)
    if spin:
        turn = (before.rotation().inverse() @ after.rotation()).ToAngleAxis().angle()
        return bool(abs(turn) > SLIDES_RAD)
    return bool(np.linalg.norm(after.translation() - before.translation()) > SLIDES_M)


def load(thing, share: float, *, spin: bool, modulus_Pa: float) -> ExternallyAppliedSpatialForce:
    """A share of the load at which the body should begin to slip."""
    force = ExternallyAppliedSpatialForce()
    force.body_index = thing.index()
    force.p_BoBq_B = np.zeros(3)
    depth = np.sqrt(FORCE_N * PAD_M / (np.pi * RADIUS_M * modulus_Pa))
    arm = 8.0 / 15.0 * np.sqrt(2.0 * RADIUS_M * depth)
    critical = 2.0 * FRICTION * FORCE_N
    torque = np.array([share * critical * arm if spin else 0.0, 0.0, 0.0])
    along = np.array([0.0, 0.0, 0.0 if spin else share * critical])
    force.F_Bq_W = SpatialForce(torque, along)
    return force


def critical_shares(modulus_Pa: float, step_s: float) -> dict[str, list[float]]:
    """By pinch, the largest share of the critical load that held and the smallest that slipped."""
    found = {}
    for body, spin in (("sphere", False), ("box", False), ("sphere", True)):
        low, high = 0.5, 1.5
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            if pinch(body, middle, spin=spin, modulus_Pa=modulus_Pa, step_s=step_s):
                high = middle
            else:
                low = middle
        found[f"{body}, {'spun' if spin else 'pulled'}"] = [low, high]
    return found
