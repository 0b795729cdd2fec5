"""A model at work in a run: it sees the grasps that were made, and says which to test first."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...grasping import ReadyGrasp
from ...objects import Task
from ..choice import OBJECT_FEATURES, candidate_features, candidate_specs, object_features
from ..records import fingerprint
from .model_file import Model, load_model

__all__ = ["ModelChooser"]

_JOINT = "f_joint_"


class ModelChooser:
    """Chooses by a model; features are computed as for the data that it was trained on.

    Args:
        model: the model.
        source: the file it is from, for messages.
        load: multiple of the weight that grasps should carry.
    """

    def __init__(self, model: Model, source: str | Path, load: float = 1.0):
        self._model, self._source, self._load = model, source, load
        self._digest = model.digest

    @classmethod
    def from_file(cls, path: Path) -> "ModelChooser":
        """The chooser of a model file.

        Raises:
            InputError: it can't be used.
        """
        return cls(load_model(path), path)

    @property
    def policy(self) -> str:
        """Name of the model's policy."""
        return self._model.policy

    @property
    def digest(self) -> str:
        """Hash of all that its scores depend on."""
        return self._digest

    def check(self, task: Task) -> None:
        """Looks whether the model can judge grasps of a task.

        Raises:
            InputError: it needs features that there are not, or goes by those of hands that it knows and this
                is none of them, or no longer the same.
        """
        columns = (*candidate_specs(self._joints(task)), *OBJECT_FEATURES)
        self._model.check_fits({column.name: column.unit for column in columns}, self._source)
        hands = self._model.trained_on.hands
        if not any(column.kind == "hand" for column in self._model.columns):
            return
        if task.hand.name not in hands:
            known = f"its hands alone ({', '.join(hands)})"
            raise InputError(
                self._source,
                "trained_on.hands",
                f"goes by features of {known}, and this is {task.hand.name!r}: train it with --free",
            )
        if hands[task.hand.name] not in ("", fingerprint(task.hand)):
            raise InputError(
                self._source,
                "trained_on.hands",
                f"knows another hand by the name of {task.hand.name!r}: train it anew, or with --free",
            )

    def scores(self, made: Sequence[ReadyGrasp]) -> Array:
        """Scores (n,) of grasps of one task, the highest of those to be tested first."""
        if not made:
            return np.zeros(0)
        task = made[0].configuration.task
        joints = self._joints(task)
        of_object = object_features(task.object)
        rows = [np.concatenate([self._candidate(one, joints), of_object]) for one in made]
        names = [column.name for column in (*candidate_specs(joints), *OBJECT_FEATURES)]
        first = np.array([0, len(made)], dtype=np.int64)
        return self._model.scores(names, np.array(rows, dtype=np.float64), first, self._load)

    def _candidate(self, made: ReadyGrasp, joints: int) -> Array:
        assert made.clearing is not None  # a run clears what it tests
        return candidate_features(
            made.configuration,
            made.squeeze,
            clearance_m=made.clearing.after_m,
            opening_m=made.approach.opening_m,
            settings=made.squeeze.settings,
            most_joints=joints,
        ).astype(np.float64)

    def _joints(self, task: Task) -> int:
        """As many joints as the hand has, or as the model reads where these are more."""
        read = [column.name for column in self._model.columns if column.name.startswith(_JOINT)]
        numbers = [
            int(name.removeprefix(_JOINT)) + 1 for name in read if name.removeprefix(_JOINT).isdecimal()
        ]
        return max(len(task.hand.independent), *numbers) if numbers else len(task.hand.independent)
