"""Judging grasps made elsewhere: files in, readings and judgements out."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ...hands import Hand
from ...mjcf import auc
from ..formats import GraspFile, QuestionName, said_to_hold
from .judge import Judge, Judged, JudgeSettings
from .nearby import NearbyVerdict
from .reading import ChosenReading, Interpreter, NearObject, Pool, choose_reading, pooled
from .sized import GivenObject, SizedObject

__all__ = ["ReadPool", "Verification", "Verified", "read_pools", "verify"]


@dataclass(frozen=True, eq=False)
class ReadPool:
    """Files of one layout with the reading of their grasps.

    Attributes:
        pool: the files.
        interpreter: of all their grasps.
        reading: how they are read.
        squeezes: (n, n_joints) where the file sends the servos to squeeze in each grasp; None where it
            doesn't say.
    """

    pool: Pool
    interpreter: Interpreter
    reading: ChosenReading
    squeezes: Array | None = None


@dataclass(frozen=True, eq=False)
class Verified:
    """A grasp of a file with its judgement.

    Attributes:
        file: where it comes from.
        index: in that file.
        name: by which the file knows it, after the file's own where there are several.
        label: whether its authors say that it holds; None where they don't.
        judged: what is known of it.
    """

    file: GraspFile
    index: int
    name: str
    label: bool | None
    judged: Judged


@dataclass(frozen=True, eq=False)
class Verification:
    """What became of all files.

    Attributes:
        hand: the hand.
        sized: the object.
        pools: files by their layout, with their readings.
        grasps: those judged, in order.
        settings: how much was done for each.
    """

    hand: Hand
    sized: SizedObject
    pools: tuple[ReadPool, ...]
    grasps: tuple[Verified, ...]
    settings: JudgeSettings

    @property
    def sound(self) -> int:
        """Grasps with nothing wrong as they are given."""
        return sum(grasp.judged.is_sound for grasp in self.grasps)

    @property
    def fixed(self) -> int:
        """Grasps with a certified one nearby."""
        return sum(
            grasp.judged.nearby is not None and grasp.judged.nearby.verdict is NearbyVerdict.FOUND
            for grasp in self.grasps
        )

    def agreement(self) -> Mapping[str, tuple[int, int]]:
        """By preset, how many labelled grasps it judges as their authors do, and how many have labels."""
        found = {}
        for preset in self.settings.presets:
            both = [
                (grasp.label, grasp.judged.trials[preset].held)
                for grasp in self.grasps
                if grasp.label is not None and preset in grasp.judged.trials
            ]
            if both:
                found[preset] = sum(label is held for label, held in both), len(both)
        return found

    def label_auc(self) -> float | None:
        """Probability that of two labelled grasps the one said to hold needs less friction, as it is given.

        None where no labels differ.
        """
        labelled = [grasp for grasp in self.grasps if grasp.label is not None]
        scores = np.array([-grasp.judged.friction_needed for grasp in labelled])
        return auc(scores, np.array([bool(grasp.label) for grasp in labelled], dtype=bool))


def read_pools(
    files: Sequence[GraspFile],
    hand: Hand,
    sized: SizedObject,
    fixed: Mapping[QuestionName, str] | None = None,
    *,
    posture: str = "grasp",
) -> tuple[ReadPool, ...]:
    """Finds out how files are to be read.

    Args:
        files: as they are written.
        hand: the hand.
        sized: the object.
        fixed: answers that someone has given.
        posture: which moment of each grasp.

    Raises:
        InputError: several readings are about equally good, or the hand can't be that of the file.
    """
    near = NearObject(hand, sized.base)
    found = []
    for pool in pooled(files):
        interpreter = Interpreter(pool.file, hand, posture, sized.loaded_at)
        reading = choose_reading(pool.file, interpreter, near, fixed)
        squeezes = _squeezes(pool.file, interpreter, reading) if posture == "grasp" else None
        found.append(ReadPool(pool, interpreter, reading, squeezes))
    return tuple(found)


def _squeezes(file: GraspFile, interpreter: Interpreter, reading: ChosenReading) -> Array | None:
    """The joints of the squeeze of each grasp, read as those of the grasp are; None where one has none."""
    given = [grasp.squeeze.joints if grasp.squeeze else None for grasp in file.grasps]
    if not interpreter.has_joints or any(joints is None or not len(joints.values) for joints in given):
        return None
    squeezed = Interpreter(file, interpreter.hand, "squeeze", interpreter.loaded_at)
    return squeezed.states(reading.answers).joints if squeezed.has_joints else None


def verify(
    files: Sequence[GraspFile],
    hand: Hand,
    given: GivenObject,
    fixed: Mapping[QuestionName, str] | None = None,
    settings: JudgeSettings | None = None,
    *,
    posture: str = "grasp",
    on_read: Callable[[ReadPool], None] = lambda _: None,
    on_judged: Callable[[Verified], None] = lambda _: None,
    should_stop: Callable[[], bool] = lambda: False,
) -> Verification:
    """Judges the grasps of files.

    Args:
        files: as they are written, of one hand and one object.
        hand: the hand.
        given: the object.
        fixed: answers to questions about the files.
        settings: how much is done for each grasp.
        posture: which moment of each grasp: `grasp`, `pregrasp` or `squeeze`.
        on_read: called with each reading that was found.
        on_judged: called with each judgement.
        should_stop: asked between steps; what was judged by then is kept.

    Raises:
        InputError: see `read_pools`; or no such object.
    """
    settings = settings or JudgeSettings()
    sized = SizedObject(given, files)
    pools = read_pools(files, hand, sized, fixed, posture=posture)
    for pool in pools:
        on_read(pool)
    grasps = []
    for verified in _judged(pools, Judge(hand, settings), sized, should_stop):
        grasps.append(verified)
        on_judged(verified)
        if should_stop():
            break
    return Verification(hand, sized, pools, tuple(grasps), settings)


def _judged(
    pools: tuple[ReadPool, ...], judge: Judge, sized: SizedObject, should_stop: Callable[[], bool]
) -> Iterator[Verified]:
    number = 0
    several = len({file.path for read in pools for file, _ in read.pool.origin}) > 1
    for read in pools:
        states = read.reading.states
        labels = {id(file): said_to_hold(file) for file, _ in read.pool.origin}
        for row, (file, index) in enumerate(read.pool.origin):
            number += 1
            judged = judge.judge(
                sized.of_size(states.factors[row]),
                states.joints[row],
                states.T_palm_object[row],
                f"grasp_{number}",
                meant=file.grasps[index].contacts,
                squeeze=None if read.squeezes is None else read.squeezes[row],
                should_stop=should_stop,
            )
            name = file.grasps[index].name
            name = f"{file.path.stem}:{name}" if several else name
            yield Verified(file, index, name, labels[id(file)][index], judged)
