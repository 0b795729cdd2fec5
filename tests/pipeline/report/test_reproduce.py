"""The command by which a report says that its run is made again."""

import shlex

from holdfast.pipeline.cli.parsers import command_parser
from holdfast.pipeline.cli.registry import COMMANDS
from holdfast.pipeline.records import RunRecord
from holdfast.pipeline.report.reproduce import command_of


def test_it_names_options_as_help_does_and_what_differs_from_the_usual(run_record: RunRecord) -> None:
    settings = {**run_record.settings, "candidates": 7, "margin": 0.001, "sigma": 0.2}
    words = shlex.split(command_of(run_record.model_copy(update={"settings": settings})))
    parser = command_parser(COMMANDS["run"])
    options = {word for word in words if word.startswith("--")}
    assert options <= set(parser.format_help().split())
    asked = parser.parse_args(words[2:])
    assert (asked.candidates, asked.clearance, asked.sigma) == (7, 0.001, 0.2)
    assert asked.seed == run_record.seed


def test_a_model_that_has_chosen_is_asked_for(run_record: RunRecord) -> None:
    settings = {**run_record.settings, "chooser": "0" * 64}
    words = shlex.split(command_of(run_record.model_copy(update={"settings": settings})))
    asked = command_parser(COMMANDS["run"]).parse_args(words[2:])
    assert asked.choose == "MODEL"
    assert "--choose" not in shlex.split(command_of(run_record))
