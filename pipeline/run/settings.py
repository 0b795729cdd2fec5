"""What a run is asked for."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

from ...arguments import check_number, check_whole_number
from ...errors import InputError, UnknownName
from ...mjcf import HoldSettings, preset_settings
from ...objects import Task
from ...retraction import RetractionSettings
from ..records import Setting
from .chooser import Chooser

__all__ = ["RunSettings"]

# Grasps that should hold, unless fewer candidates are asked for.
_WANTED = 5
_HOLD_NAMES = tuple(entry.name for entry in fields(HoldSettings) if entry.name != "preset")


@dataclass(frozen=True)
class RunSettings:
    """What a run is asked for; the defaults are those of `holdfast run`.

    The hold test is not set as a whole, for a task has its own directions of gravity: it is a preset adapted
    to the task, with single fields overridden where `hold` names them.

    Attributes:
        candidates: configurations of which a grasp is made in a round.
        choice: among how many solved ones each of them is chosen, where some stand out by what they could
            carry as they are; 1 takes them as the solver finds them.
        seed: random seed.
        sigma: width at which the solver no longer splits boxes, in its own unit of length.
        budget_s: wall-clock time after which nothing new is begun.
        wanted: grasps that should be certified, clear and held before the solver is no longer asked, one of
            them not narrowly. None: five, or as many as there are candidates where these are fewer.
        enough: in place of `wanted`: the same, and once as many hold, what is left of the round is not
            tested. A run that is resumed with as many `wanted` tests it after all.
        margin_m: distance asked for between bodies that should not touch.
        preset: settings of the hold test by name; see `mjcf.preset_names`.
        hold: fields of `HoldSettings` in place of the preset's, by name, such as `{"hold_s": 1.0}`.
        workers: processes that retract and hold; the result does not depend on them.
        give_up_after: grasps that may fail before any is held: the rest are then left untried, for the run to
            be resumed or another task to be taken up. None: all are tried.
        chooser: says which grasps of a round are tested first; None takes them as the solver finds them.
        quick: verdicts alone, without margins and pictures. A run that is resumed without it adds these.

    Raises:
        InputError: a value that is out of range, or a field that the hold test does not have.
    """

    candidates: int = 16
    choice: int = 4
    seed: int = 0
    sigma: float = 0.1
    budget_s: float = 120.0
    wanted: int | None = None
    enough: int | None = None
    margin_m: float = 0.0
    preset: str = "holdfast"
    hold: Mapping[str, Any] = field(default_factory=dict)
    workers: int = 1
    quick: bool = False
    give_up_after: int | None = None
    chooser: Chooser | None = None

    def __post_init__(self) -> None:
        try:
            for name, least in (("candidates", 1), ("choice", 1), ("seed", 0), ("workers", 1)):
                check_whole_number(name, getattr(self, name), least=least)
            if self.wanted is not None:
                check_whole_number("wanted", self.wanted, least=0)
            if self.enough is not None:
                check_whole_number("enough", self.enough, least=1)
            if self.give_up_after is not None:
                check_whole_number("give_up_after", self.give_up_after, least=1)
            check_number("sigma", self.sigma, above=0.0)
            check_number("budget_s", self.budget_s, above=0.0)
            check_number("margin_m", self.margin_m, least=0.0)
        except InputError as error:
            raise InputError("RunSettings", error.source, error.allowed) from None
        if self.wanted is not None and self.enough is not None:
            raise InputError("RunSettings", "enough", "stands in place of wanted: name one of them")
        for name in self.hold:
            if name not in _HOLD_NAMES:
                raise UnknownName("RunSettings", "hold", "setting of the hold test", name, _HOLD_NAMES)

    @classmethod
    def from_names(cls, **settings: Any) -> "RunSettings":
        """Settings by name, such as come from a caller of `hf.run`.

        Raises:
            UnknownName: there is no such setting.
            InputError: see the class.
        """
        names = tuple(entry.name for entry in fields(cls))
        for name in settings:
            if name not in names:
                raise UnknownName("run", "", "setting", name, names)
        return cls(**settings)

    def hold_settings(self, task: Task) -> HoldSettings:
        """The settings of the hold test of a task.

        Raises:
            UnknownName: no such preset.
        """
        return replace(preset_settings(self.preset, task), **self.hold)

    @property
    def grasps_wanted(self) -> int:
        """How many grasps should hold: more rounds of the solver are for when they do not."""
        named = self.wanted if self.enough is None else self.enough
        return min(_WANTED, self.candidates) if named is None else named

    @property
    def retraction(self) -> RetractionSettings:
        """The settings of retraction."""
        return RetractionSettings(margin_m=self.margin_m)

    def as_record(self, task: Task) -> dict[str, Setting]:
        """All that the result depends on but the seed, by name."""
        hold = asdict(self.hold_settings(task))
        return self._of_all_tasks | {f"hold.{name}": value for name, value in hold.items()}

    def as_record_of_any(self) -> dict[str, Setting]:
        """The same where the task is still to be found: of the hold test what is asked for alone."""
        hold = {f"hold.{name}": value for name, value in self.hold.items()}
        return self._of_all_tasks | {"preset": self.preset, "seed": self.seed} | hold

    @property
    def _of_all_tasks(self) -> dict[str, Setting]:
        own: dict[str, Setting] = {
            "candidates": self.candidates,
            "choice": self.choice,
            "sigma": self.sigma,
            "wanted": self.grasps_wanted,
            "margin": self.margin_m,
        }
        if self.chooser is not None:
            own["chooser"] = self.chooser.digest
        return own
