"""`holdfast choose evaluate DATA [MODEL ...]`."""

import argparse
from pathlib import Path

from .....base.files.file_paths import real_path
from .....base.files.output_file import write_text
from .....base.text.console import Console, emit, emit_json
from .....errors import InputError, UnknownName
from ....choice import load_dataset
from ....choose import Situations, check_policy, load_model, to_situations
from ....choose.study import (
    Study,
    default_policies,
    headline,
    render_page,
    study_data,
    study_models,
    tables,
)

__all__ = ["main"]

_UNSEEN = ("object", "hand", "task")


def main(arguments: argparse.Namespace) -> int:
    """Compares policies on what they have not seen; prints tables, and writes a page and JSON where asked."""
    console = Console(quiet=arguments.quiet)
    folder = Path(arguments.data)
    situations = to_situations(load_dataset(folder))
    study = _of_models(arguments, situations) if arguments.models else _anew(arguments, situations, console)
    if arguments.out:
        write_text(Path(arguments.out), render_page(study, real_path(folder).name))
    if arguments.json:
        emit_json(arguments.json, study.as_json())
    if arguments.json != "-":
        emit(f"{tables(study)}\n{headline(study)}")
        if arguments.out:
            emit(arguments.out)
    return 0


def _of_models(arguments: argparse.Namespace, situations: Situations) -> Study:
    for option in ("policies", "unseen"):
        if getattr(arguments, option) is not None:
            raise InputError(
                "choose evaluate", f"--{option}", "goes without models, which are trained already"
            )
    models = {}
    for path in map(Path, arguments.models):
        name = path.stem if path.stem not in models else str(path)
        if name in models:
            raise InputError("choose evaluate", "MODEL", f"{path} stands twice")
        models[name] = load_model(path)
    return study_models(situations, models)


def _anew(arguments: argparse.Namespace, situations: Situations, console: Console) -> Study:
    policies = tuple(_split(arguments.policies)) or default_policies(situations)
    for name in policies:
        check_policy(name, situations.formulas)
    unseen = tuple(_split(arguments.unseen)) or _UNSEEN
    for name in unseen:
        if name not in _UNSEEN:
            raise UnknownName("choose evaluate", "--unseen", "question", name, _UNSEEN)
    return study_data(
        situations,
        tuple(dict.fromkeys(policies)),
        unseen=unseen,
        seeds=arguments.seeds,
        say=console.say,
    )


def _split(names: str | None) -> list[str]:
    return [name.strip() for name in (names or "").split(",") if name.strip()]
