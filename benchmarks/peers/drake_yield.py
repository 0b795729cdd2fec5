"""Servo targets that press soft pads as planned and lead each tip straight. For `peer_drake.py`.

A pad yields: by how much under its planned force, the engine's own pads say, object and link moved together
along the contact's normal. Then the joints are sought at which every tip has gone that far straight inwards
and nowhere else; the servos' offsets from there are the recorded efforts.
"""

import numpy as np
from drake_scene import Plant, build, transform
from pydrake.math import RigidTransform
from pydrake.multibody.tree import JacobianWrtVariable

DEEPEST_M = 0.012
BISECTIONS = 14
ROUNDS = 3
TANGENT_WEIGHT = 0.5
# The object counts as this much dearer to move, per m and per rad, than a joint is per rad.
OBJECT_M, OBJECT_RAD = 1e-3, 1e-2


class Pads:
    """The scene at rest, its object to be put anywhere."""

    def __init__(self, scene: dict, modulus_Pa: float):
        self.scene = scene
        self.built: Plant = build(scene, modulus_Pa=modulus_Pa, step_s=0.0, still=True)
        self.plant = self.built.plant
        self.root = self.built.diagram.CreateDefaultContext()
        self.own = self.plant.GetMyMutableContextFromRoot(self.root)
        self.E, self.offset = np.asarray(scene["coupling_matrix"]), np.asarray(scene["coupling_offset"])
        # Columns of the velocities, joint by joint.
        self.columns = [joint.velocity_start() for joint in self.built.joints]
        self.X_object = transform(scene["T_palm_object"])
        self.place(np.asarray(scene["q"]), self.X_object)

    def place(self, q, X_object: RigidTransform) -> None:
        """Puts the joints (n_independent,) and the object in place."""
        positions = self.plant.GetPositions(self.own)
        for joint, value in zip(self.built.joints, self.E @ q + self.offset, strict=True):
            positions[joint.position_start()] = value
        self.plant.SetPositions(self.own, positions)
        self.plant.SetFreeBodyPose(self.own, self.built.thing, X_object)

    def press_N(self, link: int, normal) -> float:
        """Normal force of a link on the object as they are now, `normal` outwards."""
        results = self.plant.get_contact_results_output_port().Eval(self.own)
        total = 0.0
        for i in range(results.num_hydroelastic_contacts()):
            info = results.hydroelastic_contact_info(i)
            M, N = info.contact_surface().id_M(), info.contact_surface().id_N()
            force = info.F_Ac_W().translational()
            if M in self.built.of_object and self.built.links_of.get(N) == link:
                total -= float(normal @ force)
            elif N in self.built.of_object and self.built.links_of.get(M) == link:
                total += float(normal @ force)
        return total

    def yields(self, forces) -> list[float]:
        """How far in m each contact's bodies must come together for its force (n_contacts,) in N."""
        q = np.asarray(self.scene["q"])
        found = []
        for contact, wanted in zip(self.scene["contacts"], forces, strict=True):
            normal = np.asarray(contact["normal"])
            low, high = -0.001, DEEPEST_M
            for _ in range(BISECTIONS):
                depth = 0.5 * (low + high)
                self.place(q, RigidTransform(self.X_object.rotation(), self._shifted(normal, depth)))
                if self.press_N(contact["link"], normal) < wanted:
                    low = depth
                else:
                    high = depth
            found.append(0.5 * (low + high))
        self.place(q, self.X_object)
        return found

    def _shifted(self, normal, depth: float):
        """Position of the object, moved by a depth towards a link outside it."""
        return self.X_object.translation() + depth * normal

    def straight(self, yields):
        """Joints (n_independent,) at which every tip has gone straight inwards by its pad's yield."""
        q0 = np.asarray(self.scene["q"])
        q = q0.copy()
        n = len(q)
        price = np.concatenate([np.ones(n), np.full(3, OBJECT_M), np.full(3, OBJECT_RAD)])
        places = [np.asarray(contact["point"]) for contact in self.scene["contacts"]]
        links = [self.built.links[contact["link"]] for contact in self.scene["contacts"]]
        local = [
            self.plant.EvalBodyPoseInWorld(self.own, link).inverse() @ place
            for link, place in zip(links, places, strict=True)
        ]
        centre = np.asarray(self.X_object @ np.asarray(self.scene["object"]["mass"]["centre"]))
        for _ in range(ROUNDS):
            self.place(q, self.X_object)
            rows, wanted = [], []
            for k, (link, place, depth) in enumerate(zip(links, places, yields, strict=True)):
                inwards = -np.asarray(self.scene["contacts"][k]["normal"])
                p = self.plant.EvalBodyPoseInWorld(self.own, link) @ local[k]
                J = self._jacobian(link, local[k])
                r = place - centre
                cross = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
                W = TANGENT_WEIGHT * np.eye(3) + (1.0 - TANGENT_WEIGHT) * np.outer(inwards, inwards)
                rows.append(W @ np.hstack([J, -np.eye(3), cross]))
                wanted.append(W @ (place + depth * inwards - p + J @ (q - q0)))
            A, b = np.vstack(rows), np.concatenate(wanted)
            q = q0 + (price * np.linalg.lstsq(A * price, b, rcond=1e-4)[0])[:n]
        return q

    def _jacobian(self, link, point):
        """Velocity (3, n_independent) of a point of a link per velocity of the independent joints."""
        world = self.plant.world_frame()
        J = self.plant.CalcJacobianTranslationalVelocity(
            self.own, JacobianWrtVariable.kV, link.body_frame(), point, world, world
        )
        return J[:, self.columns] @ self.E


def straight_targets(scene: dict, modulus_Pa: float):
    """Targets (n_independent,) of the squeeze, their change from the recorded ones, the yields in m."""
    pads = Pads(scene, modulus_Pa)
    yields = pads.yields([contact["normal_force"] for contact in scene["contacts"]])
    stiffness = np.array(
        [
            axis["actuator"]["stiffness"]
            for link in scene["links"]
            for axis in link["axes"]
            if axis["actuator"]
        ]
    )
    targets = pads.straight(yields) + np.asarray(scene["efforts"]) / stiffness
    return targets, targets - np.asarray(scene["targets"]), yields
