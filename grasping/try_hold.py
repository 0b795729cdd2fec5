"""The trial of a grasp: its hold test, and what else is worth knowing about the verdict."""

from dataclasses import dataclass, field, replace
from functools import cached_property

from ..mjcf import (
    Agreement,
    FingerFirst,
    HoldResult,
    HoldSettings,
    LessSpin,
    LoadLimit,
    Noise,
    Robustness,
    hold_test,
    load_limit,
    strain,
    whole_strain,
)
from .extras import Extras, find_extras
from .firm_squeeze import Leaning, tried_squeeze
from .ready_grasp import ReadyGrasp

__all__ = ["Trial", "try_hold"]


@dataclass(frozen=True, eq=False, repr=False)
class Trial:
    """A grasp with its hold test.

    Attributes:
        grasp: what was tried.
        result: of the test, with the recorded motion.
        leaning: what it may lean on: what becomes of the object where one finger arrives first, or with less
            spin friction; nothing where that was not asked for, the test failed, or it has no such trial.
        margin: multiple of the load at which it first fails; None where it was not asked for.
        least_squeeze: share of the squeeze that still holds; None where the margin was not asked for, or the
            test has no such share.
        agreement: verdicts with other numerical settings; None where they were not asked for.
        robustness: verdicts with noise; None where they were not asked for.
    """

    grasp: ReadyGrasp
    result: HoldResult
    leaning: Leaning = field(default_factory=Leaning)
    margin: float | None = None
    least_squeeze: float | None = None
    agreement: Agreement | None = None
    robustness: Robustness | None = None

    @property
    def held(self) -> bool:
        """Whether the test was passed."""
        return self.result.held

    @property
    def is_narrow(self) -> bool:
        """Whether the test was passed, but not firmly: see `Leaning.is_firm`."""
        return self.held and self.is_firmness_known and not self.leaning.is_firm(self.result)

    @property
    def is_firmness_known(self) -> bool:
        """Whether it was tried what it leans on; of a press its test says it."""
        is_asked = self.result.kind == "press" and self.result.settings.fingers_first
        return self.leaning.is_known or is_asked

    @property
    def is_near_miss(self) -> bool:
        """Whether the test was not passed, but nearly: see `HoldResult.is_near_miss`."""
        return self.result.is_near_miss

    @property
    def strain(self) -> float | None:
        """How much of what is thought safe it takes if held (`mjcf.whole_strain`); None if not known."""
        result, leaning, settings = self.result, self.leaning, self.result.settings
        is_known = leaning.is_known if result.kind == "lift" else settings.fingers_first
        if not self.held or not is_known:
            return None
        tried: list[tuple[FingerFirst | LessSpin, bool]] = [
            (finger, finger.kept) for finger in leaning.fingers
        ]
        tried += [] if leaning.spin is None else [(leaning.spin, leaning.spin.held)]
        # One that it does not stand may have cost it a contact, near no limit.
        trials = [
            max(strain(entry.slip_m, entry.rotation_rad, settings), 0.0 if stands else 1.0)
            for entry, stands in tried
        ]
        if result.kind != "turn":
            trials.append(result.load_strain / settings.firm_share)
        return whole_strain(result.squeeze_slip_m, result.squeezed_normals_N, trials, settings)

    @property
    def fingers(self) -> tuple[FingerFirst, ...]:
        """What becomes of the object where one finger arrives first, as far as that was tried."""
        return self.leaning.fingers

    @property
    def less_spin(self) -> LessSpin | None:
        """What becomes of the object with less spin friction; None where that was not tried."""
        return self.leaning.spin

    @cached_property
    def limit(self) -> LoadLimit | None:
        """What keeps the squeeze from carrying the planned load, found when first asked for."""
        grasp = self.grasp.grasp
        return load_limit(grasp.configuration, settings=self.result.settings, squeeze=grasp.squeeze)

    @property
    def extras(self) -> Extras:
        """What else was found about the verdict."""
        return Extras(self.margin, self.least_squeeze, self.agreement, self.robustness)

    def __str__(self) -> str:
        return str(self.result) if self.margin is None else f"{self.result}, margin {self.margin:.2f}"

    def __repr__(self) -> str:
        return f"<Trial: {self}>"

    def _repr_html_(self) -> str:
        return self.result._repr_html_()


def _strains(result: HoldResult) -> list[float] | None:
    """How much of its limits each direction of a lift takes that is held; None of another."""
    if result.kind != "lift" or not result.held:
        return None
    return [strain(entry.slip_m, entry.rotation_rad, result.settings) for entry in result.directions]


def try_hold(
    grasp: ReadyGrasp,
    *,
    settings: HoldSettings | None = None,
    fingers: bool = False,
    margin: bool = False,
    agreement: bool = False,
    noise: Noise | None = None,
    of_failed: bool = False,
) -> Trial:
    """Puts a grasp to the test of its task; each thing that is asked for beside costs more simulations.

    Args:
        grasp: the grasp.
        settings: of the test; None takes those that the squeeze was planned for.
        fingers: whether to let each finger arrive first, to try less spin friction, and to look for another
            squeeze where the object does not stand this one; the trial's grasp then has the squeeze that was
            chosen.
        margin: whether to look for the load at which it first fails, and for the least squeeze that holds.
        agreement: whether to repeat the test with other numerical settings.
        noise: what to repeat it with, for the probability of passing; None for nothing.
        of_failed: whether margin, agreement and noise are for grasps that fail the test, too.
    """
    simulated, leaning = grasp.grasp, Leaning()
    if fingers:
        simulated, result, leaning = tried_squeeze(simulated, settings=settings)
        grasp = grasp if simulated is grasp.grasp else replace(grasp, grasp=simulated)
    else:
        result = hold_test(simulated, settings=settings)
    extras = Extras()
    if result.held or of_failed:
        extras = find_extras(
            simulated,
            held=result.held,
            settings=result.settings,
            strains=_strains(result),
            margin=margin,
            agreement=agreement,
            noise=noise,
            usual=result.usual,
            pressed_N=result.pressed_N,
        )
    return Trial(
        grasp,
        result,
        leaning=leaning,
        margin=extras.margin,
        least_squeeze=extras.least_squeeze,
        agreement=extras.agreement,
        robustness=extras.robustness,
    )
