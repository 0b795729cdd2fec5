"""What hand and object of a grasp do, as states to be shown one after the other."""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ...mjcf import gravity_names
from ...mjcf.hold import outcome_word
from ...objects import Task
from ..records import Direction, GraspRecord, to_approach

__all__ = ["Motion", "motions", "recorded_trials"]

# A file may say anything; more rows than a test records are none of a test.
_MOST_ROWS = 200


@dataclass(frozen=True, eq=False)
class Motion:
    """A motion.

    Attributes:
        name: for people, unique in its grasp.
        times: (k,) when each state is reached: in s in a test, else counted.
        states: (k, n_joints + 7) joints, then position and quaternion of the object in the palm frame.
    """

    name: str
    times: Array
    states: Array

    def at(self, share: float) -> Array:
        """The state (n_joints + 7,) at a share of the motion's time, from 0 to 1."""
        time = self.times[0] + share * (self.times[-1] - self.times[0])
        state = np.array([np.interp(time, self.times, column) for column in self.states.T])
        state[-4:] /= np.linalg.norm(state[-4:])
        return state


def motions(grasp: GraspRecord, task: Task, source: str) -> list[Motion]:
    """The approach, with the squeeze where it was simulated, then the test in each recorded direction.

    Raises:
        InputError: an approach that is none of the task's hand.
    """
    hand = task.hand
    pose = np.array([*grasp.object.position, *grasp.object.quaternion])
    q = hand.expand(np.array([grasp.joints[name] for name in hand.independent_names]))
    way = [] if grasp.approach is None else list(to_approach(grasp.approach, hand, source).waypoints[:-1])
    states = [np.concatenate([hand.expand(place), pose]) for place in way] + [np.concatenate([q, pose])]
    trials = recorded_trials(grasp, task)
    if trials:
        states.append(np.array(trials[0][2].motion[0][1:]))
    name = "approach and squeeze" if trials else "approach"
    found = [Motion(name, np.arange(len(states), dtype=float), np.array(states))]
    for _, name, entry in trials:
        rows = np.array(entry.motion)
        outcome = outcome_word(entry.outcome, grasp.hold.kind) if grasp.hold and entry.outcome else ""
        where = f"gravity {name}" if name else "the test"
        found.append(Motion(f"{where}: {outcome}" if outcome else where, rows[:, 0], rows[:, 1:]))
    return found


def recorded_trials(grasp: GraspRecord, task: Task) -> list[tuple[int, str, Direction]]:
    """Number, name and record of each direction of the test of which a motion was recorded.

    Its first row is the end of the squeeze.
    """
    if grasp.hold is None:
        return []
    width = 1 + len(task.hand.joint_names) + 7
    names = gravity_names([entry.gravity for entry in grasp.hold.directions])
    return [
        (number, name, entry)
        for number, (entry, name) in enumerate(zip(grasp.hold.directions, names, strict=True))
        if 1 < len(entry.motion) <= _MOST_ROWS and all(len(row) == width for row in entry.motion)
    ]
