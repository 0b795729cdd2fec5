"""Faults planted in sound grasps: how many are named rightly, and how often a sound one is blamed.

Usage: verify.py [--count N] [--together K] [--seed N] [--json FILE]

Grasps of a hand and of a jaw are solved for and made. Each is written as a file would have it (position,
quaternion, joint values without names, the object's scale), sound and with one fault: another joint order,
another order of quaternions, the inverse scale, millimetres, the frame between the fingertips for the palm's,
degrees, a finger 2 mm deep, or one 2 mm off. Files hold --together grasps each (1). A fault is named rightly
if the reading differs in that answer alone, or the judgement names a finger. The last line is the rate of
reading and judging without simulation.
"""

import argparse
import json
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from holdfast.console import format_table
from holdfast.errors import InputError
from holdfast.geometry import invert, quaternion_from_rotation
from holdfast.grasping import ReadyGrasp, make_grasp
from holdfast.hands import Hand, jacobian_from_axes, joint_axes
from holdfast.objects import ObjectModel, load_task
from holdfast.pipeline.formats import (
    Grasp,
    GraspFile,
    JointValues,
    Posture,
    Question,
    WrittenObject,
    WrittenPose,
)
from holdfast.pipeline.verify.judge import Judge, JudgeSettings
from holdfast.pipeline.verify.reading import Interpreter, NearObject, choose_reading
from holdfast.pipeline.verify.reading.hand_frames import hand_frames
from holdfast.pipeline.verify.reading.joint_orders import joint_orders
from holdfast.solver import solve

ROOT = Path(__file__).resolve().parent.parent
TASKS = (
    "upholding",
    "handling",
    "lid_lifting",
    "service",
    str(ROOT / "examples" / "jaw" / "grip.yaml"),
    str(ROOT / "examples" / "hands" / "pinch.yaml"),
)
SETTLED = {"angle": "rad", "joint_length": "m", "direction": "hand_in_object"}
READING = {
    "joint order": "joint_order",
    "quaternion order": "quaternion",
    "inverse scale": "scale",
    "millimetres": "length",
    "TCP for base": "frame",
    "degrees": "angle",
}
FINGER = {"2 mm deep": 2e-3, "2 mm off": -2e-3}
SCALE = 2.0


@dataclass(frozen=True, eq=False)
class Sound:
    """A grasp of ours: the hand, the object and where they are."""

    hand: Hand
    obj: ObjectModel
    joints: np.ndarray
    T_palm_object: np.ndarray
    ready: ReadyGrasp


def sound_grasps(count: int, seed: int) -> list[Sound]:
    """So many, in turns of the tasks."""
    by_task = []
    share = -(-count // len(TASKS))
    for name in TASKS:
        task = load_task(name)
        result = solve(task, candidates=2 * share, seed=seed, budget_s=60.0)
        found = []
        for configuration in result.configurations:
            made = make_grasp(configuration)
            if isinstance(made, ReadyGrasp) and made.configuration.certified:
                c = made.configuration
                found.append(Sound(task.hand, task.object, c.joint_vector, c.state.T_palm_object, made))
            if len(found) == share:
                break
        by_task.append(found)
    return [found[k] for k in range(share) for found in by_task if k < len(found)][:count]


def with_finger(sound: Sound, depth_m: float, rng: np.random.Generator) -> np.ndarray | None:
    """Joints that bring one contact so deep into the object; None where none do."""
    configuration, hand = sound.ready.configuration, sound.hand
    origins, directions = joint_axes(hand, sound.joints)[1:]
    for k in rng.permutation(len(configuration.task.contacts)):
        link, point = configuration.task.contacts[k].hand.link, configuration.contact_points[k]
        J = jacobian_from_axes(hand, origins, directions, link, point.p_hand)[0] @ hand.coupling_matrix
        along = -point.n_object @ J
        if along @ along < 1e-6:
            continue
        q = configuration.state.q + depth_m * along / (along @ along)
        if np.all(q >= hand.limits[:, 0]) and np.all(q <= hand.limits[:, 1]):
            return hand.expand(q)
    return None


def written(sounds: list[Sound], fault: str, rng: np.random.Generator) -> tuple[GraspFile, str] | None:
    """A file with one fault, and what the reading should be; None where it can't be planted."""
    hand = sounds[0].hand
    orders = [name for name in joint_orders(hand, len(hand.axes)) if name != "hand"]
    if fault == "joint order" and not orders:
        return None
    revolute = np.array([axis.kind == "revolute" for axis in hand.axes])
    if fault == "degrees" and not revolute.any():
        return None
    order = orders[int(rng.integers(len(orders)))] if fault == "joint order" else "hand"
    values, grasps = joint_orders(hand, len(hand.axes))[order], []
    for i, sound in enumerate(sounds):
        joints, T = sound.joints, invert(sound.T_palm_object)
        if fault in FINGER:
            moved = with_finger(sound, FINGER[fault], rng)
            if moved is None:
                return None
            joints = moved
        if fault == "degrees":
            joints = np.where(revolute, np.degrees(joints), joints)
        if fault == "TCP for base":
            T = T @ hand_frames(hand)["tcp"]
        quaternion = quaternion_from_rotation(T[:3, :3])
        pose = WrittenPose(
            position=T[:3, 3] * (1e3 if fault == "millimetres" else 1.0),
            quaternion=np.roll(quaternion, -1) if fault == "quaternion order" else quaternion,
        )
        scale = 1.0 / SCALE if fault == "inverse scale" else SCALE
        grasps.append(
            Grasp(str(i), Posture(pose, JointValues(joints[values])), object=WrittenObject(scale=(scale,)))
        )
    questions = (
        Question.of("quaternion", "wxyz"),
        Question.of("length", "m"),
        Question.of("scale", "times"),
        Question.of("frame", "base"),
        Question("joint_order", (), None),
    )
    file = GraspFile(Path("planted"), "dexgraspbench", "planted", tuple(grasps), questions, SETTLED)
    answer = {
        "joint order": order,
        "quaternion order": "xyzw",
        "inverse scale": "divided",
        "millimetres": "mm",
        "TCP for base": "tcp",
        "degrees": "deg",
    }.get(fault, "")
    return file, answer


def verdict(file: GraspFile, sounds: list[Sound], fault: str, answer: str) -> str:
    """`right`, `asked` where options were asked for, or what was said instead."""
    hand, obj = sounds[0].hand, sounds[0].obj
    interpreter = Interpreter(file, hand, loaded_at=np.full(3, SCALE))
    try:
        reading = choose_reading(file, interpreter, NearObject(hand, obj))
    except InputError as error:
        return f"asked: {error}"
    wanted = {READING[fault]: answer} if fault in READING else {}
    if dict(reading.found) != wanted:
        return f"read with {dict(reading.found)}, not {wanted}"
    judge = Judge(hand, JudgeSettings(presets=(), nearby=False))
    states = reading.states
    for i in range(len(sounds)):
        judged = judge.judge(obj, states.joints[i], states.T_palm_object[i], str(i))
        kinds = {f.kind for f in judged.faults}
        if fault not in FINGER:
            if kinds:
                return f"blamed: {[str(f) for f in judged.faults]}"
            continue
        kind = "penetration" if FINGER[fault] > 0.0 else "finger off"
        if kind not in kinds:
            return f"not named: {[str(f) for f in judged.faults]}"
    return "right"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--together", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    sounds = sound_grasps(arguments.count, arguments.seed)
    groups: dict[tuple[int, int], list[Sound]] = {}
    for sound in sounds:
        groups.setdefault((id(sound.hand), id(sound.obj)), []).append(sound)
    batches = [
        group[i : i + arguments.together]
        for group in groups.values()
        for i in range(0, len(group), arguments.together)
    ]
    faults = [*READING, *FINGER]
    tally: dict[str, Counter[str]] = {name: Counter() for name in ("none", *faults)}
    said, seconds, judged = [], 0.0, 0
    for k, batch in enumerate(batches):
        # Where the fault of its turn can't be planted in a grasp, as joint orders in a jaw, the next one is.
        turns = [faults[(k + j) % len(faults)] for j in range(len(faults))]
        planted = next((f, w) for f in turns if (w := written(batch, f, rng)) is not None)
        sound_file = written(batch, "none", rng)
        assert sound_file is not None
        for fault, (file, answer) in (("none", sound_file), planted):
            begun = time.process_time()
            what = verdict(file, batch, fault, answer)
            seconds += time.process_time() - begun
            judged += len(batch)
            tally[fault][what.split(":")[0].split(" with")[0]] += 1
            if what != "right":
                said.append(f"{fault} in {batch[0].hand.name} at {batch[0].obj.name}: {what}"[:300])
    rows = [
        (name, str(sum(counts.values())), str(counts["right"]), str(counts["asked"]))
        for name, counts in tally.items()
        if counts
    ]
    print(format_table(("fault", "files", "right", "asked"), rows))
    print("\n".join(said))
    of = sum(sum(tally[f].values()) for f in faults)
    right, sound = sum(tally[f]["right"] for f in faults), tally["none"]["right"]
    print(f"{right} of {of} faults named rightly; {sound} of {len(batches)} sound files not blamed")
    print(f"{judged / seconds:.1f} grasps a second of CPU time read and judged, without simulation")
    if arguments.json:
        counts = {name: dict(count) for name, count in tally.items()}
        arguments.json.write_text(
            json.dumps({"tally": counts, "rate": judged / seconds, "said": said}, indent=1)
        )


if __name__ == "__main__":
    main()
