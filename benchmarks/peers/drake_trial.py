"""A grasp in Drake: closed, squeezed, then lifted, turned or pressed. For `peer_drake.py`.

Timing, servos and limits are those of the scene, which come from its run folder. What keeps the object in
place while the fingers close is a lock. Gravity acts as a force on the object (and on the links, where the
hand is to carry its own weight).
"""

import numpy as np
from drake_scene import Plant, transform
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce
from pydrake.multibody.tree import PrismaticJoint
from pydrake.systems.analysis import Simulator

# Once an object has gone this many times too far, the rest of the time is spared.
LOST = 4.0
AT_LIMIT = 0.999
# A contact without force may come back within this time.
BACK_S = 0.5
# A direction ends early once so many times the pace of the last `PACE_S` would not lead to a limit in the
# time that is left, every contact touching; but no sooner than `SWING_S` after gravity has set in, for at a
# turning point of its swing an object stands still as well.
PACES, PACE_S, SWING_S = 3.0, 0.1, 0.3


class Trial:
    """A plant under way.

    Args:
        built: the plant.
        scene: what it was built from.
        step_s: of the simulation.
        whole: whether gravity acts for its whole time in every direction, however still the object is.
    """

    def __init__(self, built: Plant, scene: dict, step_s: float, *, whole: bool = False):
        self.built, self.scene, self.step_s, self.whole = built, scene, step_s, whole
        self.plant = built.plant
        self.simulator = Simulator(built.diagram)
        self.context = self.simulator.get_mutable_context()
        self.own = self.plant.GetMyMutableContextFromRoot(self.context)
        self.expand = np.asarray(scene["coupling_matrix"]), np.asarray(scene["coupling_offset"])
        self.ctrl = np.zeros(0)
        self.servo_port = self.plant.get_desired_state_input_port(built.hand)
        # The port counts all of the hand's actuators, those of coupled joints too.
        order = self.plant.GetJointActuatorIndices(built.hand)
        self.n_servos = len(order)
        self.where = [order.index(actuator.index()) for actuator in built.drives]
        self.slid = np.zeros(len(scene["contacts"]))
        X = transform(scene["T_palm_object"])
        self.normals_object = [X.rotation().inverse() @ np.array(c["normal"]) for c in scene["contacts"]]
        self.pull(np.zeros(3))

    def begin(self, q) -> None:
        """Puts everything in place, at rest; the object is locked where it floats."""
        plant, own = self.plant, self.own
        joints = self.expand[0] @ q + self.expand[1]
        for joint, value in zip(self.built.joints, joints, strict=True):
            if isinstance(joint, PrismaticJoint):
                joint.set_translation(own, value)
            else:
                joint.set_angle(own, value)
        plant.SetVelocities(own, np.zeros(plant.num_velocities()))
        if self.scene["kind"] == "lift":
            plant.SetFreeBodyPose(own, self.built.thing, transform(self.scene["T_palm_object"]))
        if self.built.hinge is not None:
            port = plant.get_desired_state_input_port(self.built.thing.model_instance())
            port.FixValue(own, np.zeros(2))
        self.aim(q)
        self.simulator.Initialize()

    def aim(self, q) -> None:
        """The servos' targets (n_independent,)."""
        self.ctrl = np.asarray(q, dtype=float)
        wanted = np.zeros(2 * self.n_servos)
        wanted[self.where] = self.ctrl
        self.servo_port.FixValue(self.own, wanted)

    def pull(self, gravity) -> None:
        """Lets a gravity (3,) in m/s^2 act from now on."""
        loads = [(self.built.thing, self.scene["object"]["mass"])]
        if self.scene["hand_weight"]:
            loads += [
                (b, link["mass"]) for b, link in zip(self.built.links, self.scene["links"], strict=True)
            ]
        forces = []
        for body, mass in loads:
            force = ExternallyAppliedSpatialForce()
            force.body_index = body.index()
            force.p_BoBq_B = np.asarray(mass["centre"])
            force.F_Bq_W = SpatialForce(np.zeros(3), mass["mass"] * np.asarray(gravity))
            forces.append(force)
        self.plant.get_applied_spatial_force_input_port().FixValue(self.own, Value(forces))

    def run(self, seconds: float) -> None:
        self.simulator.AdvanceTo(self.context.get_time() + seconds)

    def restore(self, earlier, targets) -> None:
        """Goes back to an earlier context, with the servos at their targets."""
        self.context.SetTimeStateAndParametersFrom(earlier)
        self.aim(targets)
        self.simulator.Initialize()

    def drive(self, start, end, seconds: float, gravity=None) -> None:
        """Moves the targets evenly while gravity grows, step by step."""
        count = max(1, round(seconds / self.step_s))
        for k in range(1, count + 1):
            self.aim(start + (end - start) * k / count)
            if gravity is not None and np.any(gravity):
                self.pull(np.asarray(gravity) * k / count)
            self.run(self.step_s)

    def close(self) -> None:
        """From the pregrasp to the grasp."""
        waypoints = np.asarray(self.scene["waypoints"])
        self.begin(waypoints[0])
        free = self.scene["kind"] == "lift"
        if free:
            joint = self.plant.get_joint(self.plant.GetJointIndices(self.built.thing.model_instance())[0])
            joint.Lock(self.own)
        way = np.concatenate([[0.0], np.abs(np.diff(waypoints, axis=0)).max(axis=1).cumsum()])
        count = max(1, round(self.scene["times"]["close"] / self.step_s))
        for place in way[-1] * np.arange(1, count + 1) / count:
            self.aim([np.interp(place, way, column) for column in waypoints.T])
            self.run(self.step_s)
        if free:
            joint.Unlock(self.own)

    def pose(self) -> RigidTransform:
        return self.plant.EvalBodyPoseInWorld(self.own, self.built.thing)

    def touches(self):
        """Of each contact between hand and object: its link, the force (3,) on the object, and its middle."""
        results = self.plant.get_contact_results_output_port().Eval(self.own)
        for i in range(results.num_hydroelastic_contacts()):
            info = results.hydroelastic_contact_info(i)
            surface = info.contact_surface()
            M, N = surface.id_M(), surface.id_N()
            force = info.F_Ac_W().translational()  # on the body of M
            if M in self.built.of_object and N in self.built.links_of:
                yield self.built.links_of[N], np.array(force), np.array(surface.centroid())
            elif N in self.built.of_object and M in self.built.links_of:
                yield self.built.links_of[M], -np.array(force), np.array(surface.centroid())

    def contacts(self) -> tuple[np.ndarray, np.ndarray]:
        """Normal forces (n,) in N of the task's contacts, and how fast each slides, in m/s."""
        forces: dict = {}
        speeds: dict = {}
        strongest: dict = {}
        X = self.pose()
        V_object = self.plant.EvalBodySpatialVelocityInWorld(self.own, self.built.thing)
        planned = {c["link"]: n for c, n in zip(self.scene["contacts"], self.normals_object, strict=True)}
        for link, force, place in self.touches():
            if link not in planned:
                continue
            normal = X.rotation() @ planned[link]
            press = float(-normal @ force)
            forces[link] = forces.get(link, 0.0) + press
            if press < strongest.get(link, 0.0):
                continue
            strongest[link] = press
            V = self.plant.EvalBodySpatialVelocityInWorld(self.own, self.built.links[link])
            p = self.plant.EvalBodyPoseInWorld(self.own, self.built.links[link]).translation()
            v = V.translational() + np.cross(V.rotational(), place - p)
            w = V_object.translational() + np.cross(V_object.rotational(), place - X.translation())
            apart = v - w
            speeds[link] = float(np.linalg.norm(apart - normal * (normal @ apart)))
        links = [c["link"] for c in self.scene["contacts"]]
        return (
            np.array([forces.get(link, 0.0) for link in links]),
            np.array([speeds.get(link, 0.0) for link in links]),
        )

    def kept(self) -> list[bool]:
        """Whether each contact touches or does so again soon."""
        touching = self.contacts()[0] > 0.0
        sample = self.scene["times"]["sample"]
        for _ in range(round(BACK_S / sample)):
            if touching.all():
                break
            self.run(sample)
            touching |= self.contacts()[0] > 0.0
        return touching.tolist()

    def moved(self, reference: RigidTransform) -> tuple[float, float]:
        """Largest displacement in m of what is watched, and rotation in rad."""
        X = self.pose()
        watched = np.asarray(self.scene["watched"]).T
        slip = float(np.linalg.norm(X @ watched - reference @ watched, axis=0).max())
        R = (X.rotation() @ reference.rotation().inverse()).matrix()
        return slip, float(np.arccos(np.clip(0.5 * (np.trace(R) - 1.0), -1.0, 1.0)))

    def efforts(self) -> float:
        """Largest share of a servo's limit."""
        efforts = self.plant.get_net_actuation_output_port(self.built.hand).Eval(self.own)
        shares = [
            abs(efforts[k]) / actuator.effort_limit()
            for k, actuator in zip(self.where, self.built.drives, strict=True)
        ]
        return max(shares)


def lift(trial: Trial, targets) -> dict:
    """Squeeze, and gravity in each direction, until the first that fails.

    Returns:
        `held`, `reason`, motion in the squeeze, normal forces after it, and directions one by one.
    """
    scene, times = trial.scene, trial.scene["times"]
    trial.close()
    start = transform(scene["T_palm_object"])
    q = np.asarray(scene["q"])
    trial.drive(q, targets, times["squeeze"], scene["gravity"] * np.asarray(scene["resting"]))
    trial.run(times["settle"])
    slip, turn = trial.moved(start)
    found = {"squeeze_slip": slip, "squeeze_turn": turn, "normals": trial.contacts()[0].tolist()}
    found["directions"] = []
    limit = scene["rotation_limit"]
    if slip >= scene["slip_limit"] or (limit is not None and turn >= limit):
        what = "moved" if slip >= scene["slip_limit"] else "turned"
        return {**found, "held": False, "reason": f"{what} in the squeeze"}
    squeezed = trial.context.Clone()
    reference = trial.pose()
    reason = ""
    for number, direction in enumerate(scene["directions"]):
        trial.restore(squeezed, targets)
        entry = hold(trial, direction, reference)
        found["directions"].append(entry)
        if entry["outcome"] != "held":
            reason = f"{entry['outcome']} under gravity {number + 1}"
            break
    return {**found, "held": not reason, "reason": reason or "held"}


def hold(trial: Trial, direction, reference: RigidTransform) -> dict:
    """Gravity in one direction, for its whole time if the request asks for that."""
    scene, times = trial.scene, trial.scene["times"]
    trial.pull(scene["gravity"] * np.asarray(direction))
    worst = [0.0, 0.0]
    limit = scene["rotation_limit"]
    poses = [trial.pose()]
    count = round(times["hold"] / times["sample"])
    for k in range(1, count + 1):
        trial.run(times["sample"])
        slip, turn = trial.moved(reference)
        poses.append(trial.pose())
        worst = [max(worst[0], slip), max(worst[1], turn)]
        if slip > LOST * scene["slip_limit"] or (limit is not None and turn > LOST * limit):
            break
        if not trial.whole and is_safe(trial, poses, worst, (count - k) * times["sample"]):
            break
    outcome = "held"
    if worst[0] >= scene["slip_limit"]:
        outcome = "slipped"
    elif limit is not None and worst[1] >= limit:
        outcome = "turned"
    elif scene["must_touch"] != "none":
        touching = trial.kept()
        if not (all(touching) if scene["must_touch"] == "all" else any(touching)):
            outcome = "let go"
    return {"gravity": list(direction), "outcome": outcome, "slip": worst[0], "turn": worst[1]}


def is_safe(trial: Trial, poses: list, worst: list[float], left_s: float) -> bool:
    """Whether the object is so far from the limits, and so slow, that the rest of the time can be spared."""
    scene, sample_s = trial.scene, trial.scene["times"]["sample"]
    back = round(PACE_S / sample_s)
    if (len(poses) - 1) * sample_s < SWING_S or scene["must_touch"] != "all":
        return False
    moved = trial.moved(poses[-1 - back])
    limits = scene["slip_limit"], np.inf if scene["rotation_limit"] is None else scene["rotation_limit"]
    ahead = PACES * left_s / PACE_S
    near = [w + ahead * m < limit for w, m, limit in zip(worst, moved, limits, strict=True)]
    return all(near) and bool((trial.contacts()[0] > 0.0).all())


def stand_trial(trial: Trial, targets, path) -> dict:
    """A turn or a press: squeeze, then along the path or at rest."""
    scene, times = trial.scene, trial.scene["times"]
    q = np.asarray(scene["q"])
    trial.close()
    track = {"slid": [np.zeros(len(scene["contacts"]))], "normals": [], "efforts": [], "angle": 0.0}
    _go(trial, track, q, targets, times["squeeze"])
    _go(trial, track, targets, targets, times["settle"])
    squeezed, normals = track["slid"][-1].copy(), trial.contacts()[0]
    track["normals"] = [normals]
    at = np.asarray(targets)
    for there in path:
        _go(trial, track, at, np.asarray(there), times["turn"] / len(path))
        at = np.asarray(there)
    _go(trial, track, at, at, times["settle"] if len(path) else times["hold"])
    since = float((track["slid"][-1] - squeezed).max())
    found = {
        "squeeze_slip": float(squeezed.max()),
        "squeeze_turn": 0.0,
        "normals": normals.tolist(),
        "slip": since,
        "turn": track["angle"],
        "directions": [],
    }
    reason = _stand_reason(trial, track, squeezed, since)
    return {**found, "held": not reason, "reason": reason or "held"}


def _stand_reason(trial: Trial, track: dict, squeezed, since: float) -> str:
    scene = trial.scene
    if float(squeezed.max()) >= scene["slip_limit"]:
        return "moved in the squeeze"
    if since >= scene["slip_limit"]:
        return "slipped"
    if not all(trial.kept()):
        return "let go"
    if max(track["efforts"]) >= AT_LIMIT:
        return "servo at its limit"
    if scene["kind"] == "turn":
        return "" if track["angle"] >= scene["hinge"]["angle"] else "did not get as far as asked"
    pressed = np.array(track["normals"])[:, scene["press"]["contacts"]].min()
    return "" if pressed >= scene["press"]["force"] else "did not press as hard as asked"


def _go(trial: Trial, track: dict, start, end, seconds: float) -> None:
    count = max(1, round(seconds / trial.scene["times"]["sample"]))
    for k in range(count):
        here, there = (start + (end - start) * share for share in (k / count, (k + 1) / count))
        trial.drive(here, there, seconds / count)
        normals, speeds = trial.contacts()
        track["slid"].append(track["slid"][-1] + speeds * seconds / count)
        track["normals"].append(normals)
        track["efforts"].append(trial.efforts())
        if trial.built.hinge is not None:
            track["angle"] = float(trial.built.hinge.get_angle(trial.own))
