"""Scenes of `parts/neutral_scene.py` as Drake's plants. For `peer_drake.py`; knows nothing of our own code.

Pads are compliant by Drake's hydroelastic model: pressure grows from zero at a body's skin to the modulus at
its middle, so that a pad is as thick as its link's half. The object and its stand are rigid.
"""

from dataclasses import dataclass

import numpy as np
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddRigidHydroelasticProperties,
    Box,
    Capsule,
    CollisionFilterDeclaration,
    Convex,
    GeometrySet,
    ProximityProperties,
    Sphere,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import (
    AddMultibodyPlantSceneGraph,
    ContactModel,
    CoulombFriction,
    DiscreteContactApproximation,
)
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    PdControllerGains,
    PrismaticJoint,
    RevoluteJoint,
    RotationalInertia,
    SpatialInertia,
    UnitInertia,
)
from pydrake.systems.framework import DiagramBuilder

# Below this speed friction sticks by a viscous law, so that contacts creep by less.
STICTION_M_S = 1e-5
# Hunt and Crossley's damping of contacts in s/m.
DISSIPATION_S_M = 10.0
RESOLUTION_M = 0.004
# A hinge sticks below this speed.
HINGE_STICTION_RAD_S = 1e-3
# A body between the two axes of a universal joint, in kg and kg m^2: nothing beside a servo's armature.
BETWEEN_KG, BETWEEN_KG_M2 = 1e-5, 1e-9
COUPLED_ARMATURE, COUPLED_DAMPING = 1e-4, 0.01
HINGE_ARMATURE = 1e-4


@dataclass(eq=False)
class Plant:
    """A plant with what the trials ask of it."""

    diagram: object
    plant: object
    links: list  # bodies of the hand, in its order
    joints: list  # in the hand's order
    drives: list  # actuators of independent joints
    hand: object  # model instance
    thing: object  # body of the object
    hinge: object  # joint or None
    links_of: dict  # link number by geometry
    of_object: set  # geometries


def transform(T) -> RigidTransform:
    T = np.asarray(T, dtype=float)
    return RigidTransform(RotationMatrix.ProjectToRotationMatrix(T[:3, :3]), T[:3, 3])


def inertia_of(mass: dict) -> SpatialInertia:
    """Spatial inertia about the body's origin from mass, centre and central inertia (3, 3)."""
    m, I = mass["mass"], np.asarray(mass["inertia"])  # noqa: E741  the field's symbol
    central = RotationalInertia(I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2])
    return SpatialInertia.MakeFromCentralInertia(m, np.asarray(mass["centre"]), central)


def shape_of(shape: dict, name: str) -> tuple[object, RigidTransform]:
    if shape["kind"] == "sphere":
        return Sphere(shape["radius"]), RigidTransform(np.asarray(shape["centre"]))
    if shape["kind"] == "box":
        return Box(*(2.0 * np.asarray(shape["half_extents"]))), transform(shape["T"])
    if shape["kind"] == "capsule":
        a, b = np.asarray(shape["start"]), np.asarray(shape["end"])
        length = float(np.linalg.norm(b - a))
        R = RotationMatrix.MakeFromOneVector((b - a) / length, 2)
        return Capsule(shape["radius"], length), RigidTransform(R, 0.5 * (a + b))
    # The pressure's highest point is the hull's own middle, so hulls are centred.
    points = np.asarray(shape["vertices"])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return Convex((points - middle).T, name), RigidTransform(middle)


def pad(friction: float, modulus_Pa: float) -> ProximityProperties:
    properties = ProximityProperties()
    AddContactMaterial(
        dissipation=DISSIPATION_S_M, friction=CoulombFriction(friction, friction), properties=properties
    )
    AddCompliantHydroelasticProperties(RESOLUTION_M, modulus_Pa, properties)
    return properties


def hard(friction: float) -> ProximityProperties:
    properties = ProximityProperties()
    AddContactMaterial(
        dissipation=DISSIPATION_S_M, friction=CoulombFriction(friction, friction), properties=properties
    )
    AddRigidHydroelasticProperties(RESOLUTION_M, properties)
    return properties


def new_plant(step_s: float):
    """A diagram's builder and a plant in it with hydroelastic contacts and no gravity."""
    builder = DiagramBuilder()
    plant, graph = AddMultibodyPlantSceneGraph(builder, step_s)
    plant.set_contact_model(ContactModel.kHydroelastic)
    if step_s > 0.0:
        plant.set_discrete_contact_approximation(DiscreteContactApproximation.kLagged)
        plant.set_stiction_tolerance(STICTION_M_S)
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
    return builder, plant, graph


def build(scene: dict, *, modulus_Pa: float, step_s: float, still: bool = False) -> Plant:
    """A scene's plant.

    Args:
        scene: as `parts/neutral_scene.py` makes it.
        modulus_Pa: of the pads.
        step_s: of the simulation.
        still: without servos, couplings and time, the object floating: to look at contacts alone.
    """
    builder, plant, graph = new_plant(0.0 if still else step_s)
    hand = plant.AddModelInstance("hand")
    other = plant.AddModelInstance("object")
    pads, rigid = pad(scene["friction"], modulus_Pa), hard(scene["friction"])
    links, joints, links_of = [], [], {}
    for number, link in enumerate(scene["links"]):
        body = plant.AddRigidBody(link["name"], hand, inertia_of(link["mass"]))
        parent = plant.world_body() if link["parent"] < 0 else links[link["parent"]]
        joints += _join(plant, hand, parent, body, link)
        for i, shape in enumerate(link["shapes"]):
            name = f"{link['name']}/{i}"
            form, X = shape_of(shape, name)
            links_of[plant.RegisterCollisionGeometry(body, X, form, name, pads)] = number
        links.append(body)
    drives = [] if still else _drive(plant, scene, joints)
    thing, hinge, of_object = _place_object(plant, other, scene, rigid, still=still)
    plant.Finalize()
    _filter(scene, plant, graph, links, of_object)
    diagram = builder.Build()
    return Plant(diagram, plant, links, joints, drives, hand, thing, hinge, links_of, of_object)


def _join(plant, hand, parent, body, link: dict) -> list:
    """Joins a link to its parent: welded, or by one joint an axis with bodies between them."""
    at, joints = transform(link["T_parent"]), []
    if not link["axes"]:
        plant.WeldFrames(parent.body_frame(), body.body_frame(), at)
        return joints
    for k, axis in enumerate(link["axes"]):
        last = k == len(link["axes"]) - 1
        name = f"{link['name']}/between_{k}"
        between = SpatialInertia(
            BETWEEN_KG,
            np.zeros(3),
            UnitInertia(*(3 * [BETWEEN_KG_M2 / BETWEEN_KG])),
        )
        child = body if last else plant.AddRigidBody(name, hand, between)
        frame = plant.AddFrame(FixedOffsetFrame(f"{axis['name']}/at", parent.body_frame(), at))
        kind = RevoluteJoint if axis["kind"] == "revolute" else PrismaticJoint
        servo = axis["actuator"]
        joint = kind(
            axis["name"],
            frame,
            child.body_frame(),
            np.asarray(axis["direction"]),
            axis["lower"],
            axis["upper"],
            damping=servo["damping"] if servo else COUPLED_DAMPING,
        )
        joints.append(plant.AddJoint(joint))
        parent, at = child, RigidTransform()
    return joints


def _drive(plant, scene: dict, joints: list) -> list:
    """Servos of the independent joints, and couplings of the others; returns the servos."""
    axes = [axis for link in scene["links"] for axis in link["axes"]]
    by_name = {axis["name"]: joint for axis, joint in zip(axes, joints, strict=True)}
    servos = []
    for axis, joint in zip(axes, joints, strict=True):
        servo, coupling = axis["actuator"], axis["coupling"]
        if servo is None:
            actuator = plant.AddJointActuator(axis["name"], joint)
            actuator.set_default_rotor_inertia(COUPLED_ARMATURE)
        else:
            actuator = plant.AddJointActuator(axis["name"], joint, servo["effort"])
            actuator.set_default_rotor_inertia(servo["armature"])
            actuator.set_controller_gains(PdControllerGains(p=servo["stiffness"], d=0.0))
            servos.append(actuator)
        actuator.set_default_gear_ratio(1.0)
        if coupling is not None:
            master = by_name[coupling["master"]]
            plant.AddCouplerConstraint(joint, master, coupling["ratio"], coupling["offset"])
    return servos


def _place_object(plant, instance, scene: dict, rigid, *, still: bool):
    """The object as its test has it: afloat, on a hinge or fast; the stand is fast."""
    thing = plant.AddRigidBody("object", instance, inertia_of(scene["object"]["mass"]))
    X = transform(scene["T_palm_object"])
    hinge = None
    if still or scene["kind"] == "lift":
        pass
    elif scene["kind"] == "turn":
        point = np.asarray(scene["hinge"]["point"])
        frame = plant.AddFrame(FixedOffsetFrame("hinge/at", plant.world_frame(), X @ RigidTransform(point)))
        there = plant.AddFrame(FixedOffsetFrame("hinge/of", thing.body_frame(), RigidTransform(point)))
        hinge = plant.AddJoint(
            RevoluteJoint("hinge", frame, there, np.asarray(scene["hinge"]["axis"]), damping=0.0)
        )
        # Dry friction: a brake whose torque saturates.
        torque = scene["hinge"]["friction"]
        brake = plant.AddJointActuator("brake", hinge, torque)
        brake.set_default_rotor_inertia(HINGE_ARMATURE)
        brake.set_default_gear_ratio(1.0)
        brake.set_controller_gains(PdControllerGains(p=1e-9, d=torque / HINGE_STICTION_RAD_S))
    else:
        plant.WeldFrames(plant.world_frame(), thing.body_frame(), X)
    of_object = set()
    for i, shape in enumerate(scene["object"]["shapes"]):
        form, X_shape = shape_of(shape, f"object/{i}")
        of_object.add(plant.RegisterCollisionGeometry(thing, X_shape, form, f"object/{i}", rigid))
    if scene["kind"] != "lift" and not still:
        for i, shape in enumerate(scene["stand"]):
            form, X_shape = shape_of(shape, f"stand/{i}")
            plant.RegisterCollisionGeometry(plant.world_body(), X @ X_shape, form, f"stand/{i}", rigid)
    return thing, hinge, of_object


def _filter(scene: dict, plant, graph, links: list, of_object: set) -> None:
    """Leaves out pairs of links that never touch, and the object against its stand."""
    manager = graph.collision_filter_manager()
    for a, b in scene["not_touching"]:
        first, second = (GeometrySet(plant.GetCollisionGeometriesForBody(links[k])) for k in (a, b))
        manager.Apply(CollisionFilterDeclaration().ExcludeBetween(first, second))
    stand = plant.GetCollisionGeometriesForBody(plant.world_body())
    if stand:
        manager.Apply(
            CollisionFilterDeclaration().ExcludeBetween(GeometrySet(list(of_object)), GeometrySet(stand))
        )
