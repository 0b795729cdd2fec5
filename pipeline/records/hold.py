"""The part of a grasp file that the physical test fills in."""

from typing import Literal

from ...fields import Finite
from ...files import FileModel

__all__ = ["Direction", "Hold", "Setting", "Squeeze"]

Setting = bool | int | float | str | None | list[float] | list[tuple[Finite, Finite, Finite]]
"""A setting by its value, as files have it."""


class Direction(FileModel):
    """The hold test in one direction of gravity.

    Attributes:
        gravity: acceleration in the palm frame, in m/s^2.
        held: whether the object stayed within the limits and every finger kept touching.
        outcome: the same in words, with the reason.
        slip: largest displacement of the object; None where the simulation broke down.
        rotation: largest rotation of the object; None where the simulation broke down.
        creep: how fast the slip still changed in the last half second, in m/s; None as for the others.
        curve: pairs (time, displacement), for drawing.
    """

    gravity: tuple[Finite, Finite, Finite]
    held: bool
    outcome: str = ""
    slip: float | None
    rotation: float | None
    creep: float | None = None
    curve: list[tuple[float, float]] = []


class Squeeze(FileModel):
    """The joint targets that press the fingers on the object.

    Attributes:
        targets: position targets by independent joint.
        efforts: torques (forces of prismatic joints) of the squeeze by independent joint.
        normal_forces: normal force of the squeeze at each contact, in N.
        path: position targets that follow in a turn, one after the other in equal times.
        load_factor: how many times the object's weight the plan balances.
        slip: how far the squeeze itself moved the object; None where it was not simulated.
        rotation: how far the squeeze itself turned it; None where it was not simulated.
    """

    targets: dict[str, float]
    efforts: dict[str, float] = {}
    normal_forces: list[float] = []
    path: list[dict[str, float]] = []
    load_factor: float
    slip: float | None = None
    rotation: float | None = None


class Hold(FileModel):
    """The physical test.

    Attributes:
        preset: name of the settings.
        settings: the settings by name.
        kind: what was tested: `lift` against gravity, `turn`, or `press`.
        held: whether the test was passed, in every direction; False where the grasp could not be tried.
        margin: largest load up to which it passed, in multiples of the test's: gravity, the friction of the
            hinge, or the force of a press; None where not measured.
        settings_agree: whether other settings say the same; None where they were not tried.
        agreement: the verdict by each other setting.
        creep: fastest creep over the directions in m/s; None where the simulation broke down.
        creep_rotation: the same of the rotation in rad/s.
        at_rest: whether both stay within the budget that the settings state.
        probability: share of trials with noise that passed; None where there were none.
        trials: number of those trials.
        directions: results by direction of gravity.
        squeeze: how the hand pressed; None where no squeeze was found.
        reason: why the grasp could not be tried.
    """

    preset: str
    settings: dict[str, Setting] = {}
    kind: Literal["lift", "turn", "press"] = "lift"
    held: bool
    margin: float | None = None
    settings_agree: bool | None = None
    agreement: dict[str, bool] = {}
    creep: float | None = None
    creep_rotation: float | None = None
    at_rest: bool | None = None
    probability: float | None = None
    trials: int = 0
    directions: list[Direction] = []
    squeeze: Squeeze | None = None
    reason: str = ""

    @property
    def held_count(self) -> int:
        """Number of directions that held."""
        return sum(direction.held for direction in self.directions)

    @property
    def slip(self) -> float | None:
        """Largest slip over the directions, None where there is no figure."""
        return max((d.slip for d in self.directions if d.slip is not None), default=None)

    @property
    def rotation(self) -> float | None:
        """Largest rotation over the directions, None where there is no figure."""
        return max((d.rotation for d in self.directions if d.rotation is not None), default=None)
