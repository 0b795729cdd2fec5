"""`holdfast verify FILE... --hand HAND --object OBJECT`."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from .....base.files.output_file import make_folder
from .....base.text.console import Console, emit, emit_json, format_table
from .....errors import InputError, UnknownName
from .....hands import load_hand
from .....mjcf import preset_names
from .....objects import looks_like_mesh
from ....formats import GraspFile, QuestionName, read_grasps
from ....verify import (
    GivenObject,
    JudgeSettings,
    NearbyVerdict,
    ReadPool,
    Verification,
    Verified,
    as_record,
    reading_lines,
    verify,
    write_fixed,
    write_page,
)
from ...interrupt import stop_on_interrupt

__all__ = ["main"]

_ANSWERS: dict[QuestionName, str] = {
    "quaternion": "quaternion",
    "length": "length",
    "angle": "angle",
    "joint_length": "joint_length",
    "scale": "scale_is",
    "frame": "frame",
    "direction": "direction",
    "joint_order": "joint_order",
}


def main(arguments: argparse.Namespace) -> int:
    """Judges grasps; exit code 0 where nothing is wrong with any of them, else 4."""
    settings, fixed = _settings(arguments), _answers(arguments)
    console, given = Console(quiet=arguments.quiet), _object(arguments)
    files = _first([read_grasps(Path(name)) for name in arguments.files], arguments.count)
    hand = load_hand(arguments.hand, source="verify", field="--hand")
    count = console.count("judging", sum(len(file.grasps) for file in files))
    with stop_on_interrupt(console.say) as should_stop:
        found = verify(
            files,
            hand,
            given,
            fixed,
            settings,
            posture=arguments.posture,
            on_read=lambda read: _say_reading(read, console),
            on_judged=lambda _: count.step(),
            should_stop=should_stop,
        )
        if arguments.out:
            _write(found, Path(arguments.out), console)
        interrupted = should_stop()
    if arguments.json:
        emit_json(arguments.json, as_record(found))
    if arguments.json != "-":
        _print(found)
    return 130 if interrupted else 0 if found.sound == len(found.grasps) else 4


def _say_reading(read: ReadPool, console: Console) -> None:
    for line in reading_lines(read):
        console.say(line)


def _settings(arguments: argparse.Namespace) -> JudgeSettings:
    for name in arguments.preset or ():
        if name not in preset_names():
            raise UnknownName("verify", "--preset", "preset", name, preset_names())
    if arguments.no_hold and arguments.preset:
        raise InputError("verify", "--no-hold", "excludes --preset")
    if arguments.no_nearby and arguments.prove:
        raise InputError("verify", "--no-nearby", "excludes --prove")
    presets = () if arguments.no_hold else tuple(arguments.preset or preset_names())
    return JudgeSettings(presets, not arguments.no_nearby, arguments.prove or 0.0)


def _answers(arguments: argparse.Namespace) -> dict[QuestionName, str]:
    given = {question: getattr(arguments, name) for question, name in _ANSWERS.items()}
    return {question: answer for question, answer in given.items() if answer is not None}


def _object(arguments: argparse.Namespace) -> GivenObject:
    if not looks_like_mesh(arguments.object):
        for name in ("mass", "friction", "scale", "units"):
            if getattr(arguments, name) is not None:
                raise InputError("verify", f"--{name}", "goes with a mesh; an object file has its own")
    return GivenObject(
        arguments.object, arguments.units, arguments.mass, arguments.friction, arguments.scale or 1.0
    )


def _first(files: list[GraspFile], count: int | None) -> list[GraspFile]:
    """The files with so many grasps in all."""
    if count is None:
        return files
    kept = []
    for file in files:
        if count > 0:
            kept.append(file.only(range(min(count, len(file.grasps)))))
            count -= len(file.grasps)
    return kept


def _write(found: Verification, folder: Path, console: Console) -> None:
    make_folder(folder)
    write_page(found, folder / "verify.html")
    for path in [folder / "verify.html", *write_fixed(found, folder)]:
        console.say(f"wrote {path}")


def _print(found: Verification) -> None:
    presets = found.settings.presets
    header = ["grasp", "fingers", "deepest/mm", "off/mm", "carries", "held", "nearby", "held there", "wrong"]
    emit(format_table(header, [_row(grasp, presets) for grasp in found.grasps]))
    parts = [f"{found.sound} of {len(found.grasps)} grasps are sound as given"]
    if found.settings.nearby:
        parts.append(f"{found.fixed} have a certified grasp nearby")
        if presets:
            parts.append(f"{sum(grasp.judged.fixed_holds for grasp in found.grasps)} of these hold")
    for preset, (agree, of) in found.agreement().items():
        parts.append(f"{preset} agrees with {agree} of {of} labels")
    score = found.label_auc()
    if score is not None:
        parts.append(f"AUC of the friction they need against the labels {score:.2f}")
    emit("\n" + "; ".join(parts))


def _row(grasp: Verified, presets: Sequence[str]) -> list[str]:
    judged = grasp.judged
    off = max(judged.off_m.values(), default=0.0)
    return [
        grasp.name,
        str(len({touch.finger for touch in judged.measured.touches})),
        f"{1e3 * judged.measured.depth_m:.2f}",
        f"{1e3 * off:.2f}",
        f"{judged.carried:.1f}",
        f"{sum(trial.held for trial in judged.trials.values())}/{len(judged.trials)}" if presets else "-",
        "-" if judged.nearby is None else judged.nearby.verdict.value,
        _held_there(grasp) if presets else "-",
        _wrong(grasp),
    ]


def _held_there(grasp: Verified) -> str:
    nearby, trials = grasp.judged.nearby, grasp.judged.nearby_trials
    if nearby is None or nearby.verdict is not NearbyVerdict.FOUND:
        return "-"
    return f"{sum(trial.held for trial in trials.values())}/{len(trials)}"


def _wrong(grasp: Verified) -> str:
    """The gravest fault, and how many more there are."""
    faults = grasp.judged.faults
    if not faults:
        return "nothing"
    more = f" and {len(faults) - 1} more" if len(faults) > 1 else ""
    return f"{faults[0]}{more}"
