"""Faults planted in sound grasps: how many are named rightly, and how often a sound one is blamed.

Usage: ./run bench verify [--count N] [--together K] [--seed N] [--models DIR] [--kept FILE]
                          [--json FILE] [--words]

Grasps of hands and of a jaw, built-in and imported ones, are solved for and freed of penetration. Each is
written as a file would have it (position, quaternion, joint values without names, the object's scale), sound
and with one fault: another joint order, another order of quaternions, the inverse scale, millimetres, the
frame between the fingertips for the palm's, degrees, a finger 2 mm deep, or one 2 mm off. Files hold
--together grasps each (1).

*Named* are faults where the reading differs in that answer alone, or the judgement names the finger, and
nothing else; *open* those where the same touches in the right reading as in the one that was taken, and both
are said; *asked* those where options are asked for among whose answers the right one is, and all is named
once it is given; the rest is *wrong*. Of those asked for it is counted which are *decidable*: in no other
reading that is offered is the grasp judged as it is in the one that is meant (the same faults, as many bodies
that touch). --kept FILE keeps the sound grasps for another time. The last line is the rate of reading and
judging without simulation.
"""

import argparse
import json
import time
from collections import Counter
from collections.abc import Sequence
from itertools import product
from pathlib import Path

import numpy as np
from holdfast.base.text.console import format_table
from holdfast.pipeline.verify.judge import Judge, JudgeSettings
from holdfast.pipeline.verify.reading import (
    AmbiguousReading,
    ChosenReading,
    Interpreter,
    NearObject,
    choose_reading,
)
from parts.places import SHARED
from parts.planted_faults import FAULTS, FINGER, SCALE, Planted, planted
from parts.sound_grasps import Sound, sound_grasps

MODELS = SHARED / "models"


class Reader:
    """Reads and judges files of one hand at one object."""

    def __init__(self, sound: Sound):
        self.hand, self.obj = sound.task.hand, sound.task.object
        self.near = NearObject(self.hand, self.obj)
        self.judge = Judge(self.hand, JudgeSettings(presets=(), nearby=False))

    def verdict(self, file: Planted, sounds: Sequence[Sound]) -> tuple[str, str]:
        """`named`, `open`, `asked` or `wrong`, and what was said."""
        interpreter = Interpreter(file.file, self.hand, loaded_at=np.full(3, SCALE))
        said, how = "", "named"
        try:
            reading = choose_reading(file.file, interpreter, self.near)
            if not _is_meant(reading, file, sounds) and reading.left_open:
                said, how, answers = f"{dict(reading.left_open)}", "open", reading.left_open
        except AmbiguousReading as asked:
            said, how, answers = asked.allowed, "asked", asked.answers
        if how != "named":
            right = {name: file.wanted.get(name, self._usual(file, name)) for name in answers}
            if any(right[name] not in several for name, several in answers.items()):
                return "wrong", f"asked for what is not there: {said}"
            meant = choose_reading(file.file, interpreter, self.near, right)
            # What is left open is judged as it was taken.
            reading = reading if how == "open" else meant
            if not _is_meant(meant, file, sounds):
                return "wrong", f"read with {dict(meant.found)}, not {file.wanted}; {said}"
        elif not _is_meant(reading, file, sounds):
            return "wrong", f"read with {dict(reading.found)}, not {file.wanted}"
        for i in range(len(sounds)):
            states = reading.states
            judged = self.judge.judge(self.obj, states.joints[i], states.T_palm_object[i], str(i))
            what = _blame(file, i, [fault.kind for fault in judged.faults])
            if what:
                return "wrong", f"{what}: {[str(fault) for fault in judged.faults]}; {said}"
        return how, said

    def is_decidable(self, file: Planted, sounds: Sequence[Sound]) -> bool:
        """Whether, of the readings that are asked for, the one that is meant alone is as sound as it is."""
        interpreter = Interpreter(file.file, self.hand, loaded_at=np.full(3, SCALE))
        try:
            choose_reading(file.file, interpreter, self.near)
        except AmbiguousReading as asked:
            answers = asked.answers
        else:
            return False
        names = list(answers)
        meant: tuple[object, ...] = ()
        others = []
        for several in product(*answers.values()):
            fixed = dict(zip(names, several, strict=True))
            try:
                reading = choose_reading(file.file, interpreter, self.near, fixed)
            except AmbiguousReading:
                return False
            states = reading.states
            judged = [
                self.judge.judge(self.obj, states.joints[i], states.T_palm_object[i], str(i))
                for i in range(len(sounds))
            ]
            said = tuple(sorted(fault.kind for one in judged for fault in one.faults))
            touching = tuple(sum(abs(t.distance_m) < 2e-4 for t in one.measured.touches) for one in judged)
            if _is_meant(reading, file, sounds):
                meant = said, touching
            else:
                others.append((said, touching))
        return meant not in others

    def _usual(self, file: Planted, name: str) -> str:
        return {"quaternion": "wxyz", "length": "m", "scale": "times", "angle": "rad"}.get(
            name, "hand" if name == "joint_order" else "base"
        )


def _is_meant(reading: ChosenReading, file: Planted, sounds: Sequence[Sound]) -> bool:
    """Whether a reading puts hand and object where the file means them."""
    T = np.array([sound.configuration.state.T_palm_object for sound in sounds])
    moved = np.abs(reading.states.T_palm_object - T).max()
    return bool(moved <= 2e-4 and np.abs(reading.states.joints - file.joints).max() <= 2e-3)


def _blame(file: Planted, i: int, kinds: Sequence[str]) -> str:
    """What is not as it should be about the faults of a grasp; empty for nothing."""
    if file.fault not in FINGER:
        return "blamed" if kinds else ""
    kind = "penetration" if FINGER[file.fault] > 0.0 else "finger off"
    return "" if kind in kinds else "not named"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--together", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--models", type=Path, default=MODELS)
    parser.add_argument("--kept", type=Path)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--words", action="store_true", help="what was asked, too, not only what went wrong")
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    sounds = sound_grasps(arguments.count, arguments.seed, arguments.models, arguments.kept)
    groups: dict[int, list[Sound]] = {}
    for sound in sounds:
        groups.setdefault(id(sound.task), []).append(sound)
    files = [
        group[i : i + arguments.together]
        for group in groups.values()
        for i in range(0, len(group), arguments.together)
    ]
    readers = {key: Reader(group[0]) for key, group in groups.items()}
    tally: dict[str, Counter[str]] = {name: Counter() for name in ("none", *FAULTS)}
    hands: dict[str, Counter[str]] = {}
    said, seconds, judged, decidable = [], 0.0, 0, 0
    for k, batch in enumerate(files):
        # Where the fault of its turn can't be planted in a grasp, as joint orders in a jaw, the next one is.
        reader = readers[id(batch[0].task)]
        turns = (FAULTS[(k + j) % len(FAULTS)] for j in range(len(FAULTS)))
        faulty = next(
            file for fault in turns if (file := planted(batch, fault, reader.near, rng)) is not None
        )
        sound_file = planted(batch, "none", reader.near, rng)
        assert sound_file is not None
        for file in (sound_file, faulty):
            begun = time.process_time()
            how, words = reader.verdict(file, batch)
            seconds += time.process_time() - begun
            judged += len(batch)
            tally[file.fault][how] += 1
            decides = how == "asked" and reader.is_decidable(file, batch)
            decidable += decides
            hands.setdefault(batch[0].task.hand.name, Counter())[how] += 1
            if how == "wrong" or (how != "named" and arguments.words):
                task, mark = batch[0].task, " (decidable)" if decides else ""
                said.append(
                    f"{how}{mark}: {file.fault} in {task.hand.name} at {task.object.name}: {words}"[:300]
                )
    columns = ("named", "open", "asked", "wrong")
    for title, counts in (("fault", tally), ("hand", hands)):
        rows = [
            (name, str(sum(count.values())), *(str(count[how]) for how in columns))
            for name, count in counts.items()
            if count
        ]
        print(format_table((title, "files", *columns), rows))
    print("\n".join(said))
    of, faults = len(files), sum((tally[fault] for fault in FAULTS), Counter())
    print(f"faults: {', '.join(f'{faults[how]} {how}' for how in columns)} of {of}")
    sound = tally["none"]
    print(
        f"sound: {sound['named']} not blamed, {sound['open']} open, {sound['asked']} asked, "
        f"{sound['wrong']} blamed of {of}"
    )
    print(f"{decidable} of those that were asked for are decidable by what is judged of a grasp")
    print(f"{judged / seconds:.1f} grasps a second of CPU time read and judged, without simulation")
    if arguments.json:
        record = {name: dict(count) for name, count in tally.items()}
        arguments.json.write_text(
            json.dumps({"tally": record, "rate": judged / seconds, "said": said}, indent=1)
        )


if __name__ == "__main__":
    main()
