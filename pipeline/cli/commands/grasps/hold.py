"""`holdfast hold GRASP`."""

import argparse
from math import degrees, sqrt

from .....base.machine.backend import configure
from .....base.text.console import emit, emit_json, format_table
from .....errors import InputError
from .....grasping import Refusal, Trial, squeeze_grasp, try_hold
from .....mjcf import HoldSettings, Noise, hold_many, kind_of_test, preset_names, preset_settings
from .....mjcf.hold import load_word, outcome_word, passed_word, verdict_word
from ....records import GraspFile, Hold, to_json, to_solution, updated
from ....report import leaning, near_miss
from ....run import proved, with_quality, with_trial, without_squeeze
from .._grasp import Loaded, finish, load

__all__ = ["main", "summary"]

_ALL = "all"
# What a test in MuJoCo has beside its verdict, and its record, which is to be found again by `check`.
_OF_MUJOCO = ("out", "margin", "agree", "robust")


def main(arguments: argparse.Namespace) -> int:
    """Squeezes a grasp as it is, puts it to the test, and says what happened."""
    configure()
    if arguments.preset == _ALL:
        return _compare(arguments)
    in_warp = arguments.engine == "warp"
    for option in _OF_MUJOCO if in_warp else ():
        if getattr(arguments, option):
            raise InputError(f"--{option}", "", "needs --engine mujoco")
    loaded = load(arguments)
    task = loaded.configuration.task
    preset = arguments.preset or ("no_noslip" if in_warp else "holdfast")
    settings = preset_settings(preset, task, directions_name=arguments.directions)
    noise = Noise(trials=arguments.robust, seed=arguments.seed) if arguments.robust else None
    record = _tried(
        loaded, settings, in_warp=in_warp, margin=arguments.margin, agreement=arguments.agree, noise=noise
    )
    if arguments.out or arguments.json:
        record = proved(record, task, settings, loaded.path)
    finish(arguments, record, summary(record))
    return 0 if record.is_held else 4


def _tried(
    loaded: Loaded,
    settings: HoldSettings,
    *,
    in_warp: bool = False,
    margin: bool = False,
    agreement: bool = False,
    noise: Noise | None = None,
) -> GraspFile:
    """The record of the grasp after its test, or without one where no squeeze is found."""
    # What is tested is the configuration as it was proved anew, some 1e-16 from what the file says.
    found = to_solution(loaded.configuration, loaded.record.id)
    record = updated(loaded.record, **dict(found), evidence=None)
    grasp = squeeze_grasp(loaded.configuration, settings=settings)
    if isinstance(grasp, Refusal):
        return with_quality(without_squeeze(record, grasp, settings), grasp.quality)
    if in_warp:
        (result,) = hold_many([grasp.grasp], settings=settings)
        return with_quality(with_trial(record, Trial(grasp, result)), grasp.quality)
    trial = try_hold(
        grasp,
        settings=settings,
        fingers=True,
        margin=margin,
        agreement=agreement,
        noise=noise,
        of_failed=True,
    )
    return with_quality(with_trial(record, trial), grasp.quality)


def _compare(arguments: argparse.Namespace) -> int:
    """The verdicts of all presets, one by one; 0 where they agree that it passes."""
    for option in _OF_MUJOCO:
        if getattr(arguments, option):
            raise InputError(f"--{option}", "", "needs one preset, not all")
    if arguments.engine != "mujoco":
        raise InputError("--engine", "", "is mujoco where all presets are compared")
    loaded = load(arguments)
    rows, records = [], []
    for name in preset_names():
        settings = preset_settings(name, loaded.configuration.task, directions_name=arguments.directions)
        record = _tried(loaded, settings)
        assert record.hold is not None
        records.append(record)
        rows.append((name, *_row(record.hold)))
    header = ("preset", "verdict", "directions", "load/(m/s2)", "friction", "slip/mm", "turn/deg", "why not")
    passed = passed_word(kind_of_test(loaded.configuration.task))
    held = [record.is_held for record in records]
    if arguments.json:
        emit_json(arguments.json, {"presets": [to_json(record) for record in records]})
    if arguments.json != "-":
        head = f"{loaded.record.id}: {passed} by {sum(held)} of {len(held)} presets"
        emit(f"{head}\n\n{format_table(header, rows)}")
    return 0 if all(held) else 4


def _row(hold: Hold) -> tuple[str, ...]:
    gravity, friction = hold.settings["gravity"], hold.settings["friction"]
    why = hold.reason or next((entry.outcome for entry in hold.directions if not entry.held), "")
    if not why and not hold.held:
        why = "the squeeze moved it, or it sinks in"
    return (
        verdict_word("held" if hold.held else "not held", hold.kind),
        f"{hold.held_count}/{len(hold.directions)}" if hold.directions else "-",
        f"{gravity:g}",
        "object's" if friction is None else f"{friction:g}",
        _mm(hold.slip),
        _deg(hold.rotation),
        why,
    )


def summary(record: GraspFile) -> str:
    """What became of the grasp in its test: the verdict, a row for each direction, and other measures."""
    hold = record.hold
    assert hold is not None
    verdict = verdict_word("held" if hold.held else "not held", hold.kind)
    if not hold.directions:
        return f"{record.id}: {verdict}: {hold.reason}"
    if hold.kind == "lift":
        head = f"{record.id}: {verdict} in {hold.held_count} of {len(hold.directions)} directions"
    else:
        head = f"{record.id}: {verdict}"
    head += ", narrowly" if record.is_narrow or record.is_near_miss else ""
    rows = [
        (
            " ".join(f"{x:+.1f}" for x in direction.gravity),
            outcome_word(direction.outcome, hold.kind),
            _mm(direction.slip),
            _deg(direction.rotation),
            "-" if direction.creep is None else f"{1e6 * direction.creep:.1f}",
        )
        for direction in hold.directions
    ]
    table = format_table(("gravity/(m/s2)", "outcome", "slip/mm", "turn/deg", "creep/(um/s)"), rows)
    return "\n".join([head, "", table, *_extra_lines(hold)])


def _extra_lines(hold: Hold) -> list[str]:
    passed, lines = passed_word(hold.kind), [*leaning(hold), *near_miss(hold)]
    if (
        hold.squeeze is not None
        and hold.directions
        and not hold.held
        and all(d.held for d in hold.directions)
    ):
        lines.append(f"the squeeze itself moved the object by {_mm(hold.squeeze.slip)} mm")
    if hold.at_rest is False:
        lines.append("what moved in the end was faster than the budget of creep")
    if hold.strain is not None:
        lines.append(f"strain: {hold.strain:.2f} of what is thought safe")
    if hold.margin is not None:
        lines.append(f"margin: {passed} up to {hold.margin:.2f} times {load_word(hold.kind)}")
    if hold.squeeze is not None and hold.squeeze.least is not None:
        lines.append(f"least squeeze: {passed} with {100 * hold.squeeze.least:.0f} % of the squeeze")
    if hold.settings_agree is not None:
        other = [name for name, held in hold.agreement.items() if held != hold.held]
        lines.append("other numerical settings: " + (f"not with {', '.join(other)}" if other else "agree"))
    if hold.probability is not None:
        p, n = hold.probability, hold.trials
        shrunk = (p * n + 1.0) / (n + 2.0)
        error = sqrt(shrunk * (1.0 - shrunk) / n)
        lines.append(f"with noise: {passed} in {round(p * n)} of {n} trials, {p:.2f} +- {error:.2f}")
    return ["", *lines] if lines else []


def _mm(metres: float | None) -> str:
    return "-" if metres is None else f"{1e3 * metres:.3f}"


def _deg(radians: float | None) -> str:
    return "-" if radians is None else f"{degrees(radians):.3f}"
