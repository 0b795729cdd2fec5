"""What makes a run again: its command, and what it was made with."""

import shlex
from collections.abc import Sequence

from ..records import RunRecord, Setting

__all__ = ["command_of", "made_with", "proof_commands"]

# Options of `holdfast run` by the name of their setting, with their defaults.
_OPTIONS: dict[str, tuple[str, Setting]] = {
    "candidates": ("--candidates", 16),
    "sigma": ("--sigma", 0.1),
    "wanted": ("--wanted", 5),
    "margin": ("--clearance", 0.0),
}


def command_of(record: RunRecord) -> str:
    """The command that makes the run again, from the run folder where its task is a file beside it.

    Where a model has ordered the grasps, its file has to be filled in. Empty where the task was built in
    Python, which a command can't do.
    """
    if not record.task_source:
        return ""
    words = ["holdfast", "run", record.task_source, "--seed", str(record.seed)]
    for name, (option, default) in _OPTIONS.items():
        value = record.settings.get(name)
        if name == "wanted" and record.enough is not None:
            words += ["--enough", str(record.enough)]
            continue
        if isinstance(value, (int, float)) and value != default:
            words += [option, f"{value:g}"]
    if "chooser" in record.settings:
        words += ["--choose", "MODEL"]  # a record has its hash alone
    if record.made is not None and record.made.budget != 120.0:
        words += ["--budget", f"{record.made.budget:g}"]
    if record.quick:
        words.append("--quick")
    return shlex.join(words)


def made_with(record: RunRecord) -> Sequence[tuple[str, str]]:
    """Names and values of what the run was made with."""
    rows = [("Holdfast", record.holdfast), ("seed", str(record.seed)), ("task", record.task_fingerprint)]
    made = record.made
    if made is None:
        return rows
    machine = ", ".join(part for part in (made.processor, f"{made.cores} cores", made.system) if part)
    return [
        *rows,
        ("date", made.date),
        ("machine", machine),
        ("processes", str(made.workers)),
        *((name, number) for name, number in made.versions.items()),
    ]


def proof_commands(record: RunRecord) -> list[str]:
    """Commands that write the proof of an infeasible run to a file, and check that; none for other runs."""
    if record.verdict != "infeasible" or not record.task_source or record.solve is None:
        return []
    log = f"{record.task}.proof".replace("/", "_").replace(" ", "_")
    words = ["holdfast", "solve", record.task_source, "--seed", str(record.seed)]
    words += ["--sigma", f"{record.solve.sigma:g}", *(["--statics"] if record.lacks_friction else [])]
    return [
        shlex.join([*words, "--proof", log]),
        shlex.join(["holdfast", "check-proof", log, "--task", record.task_source]),
    ]
