"""Writes the pages of the documentation that are made from the code; a test holds them up to date.

`python docs/generate.py` writes them beside this file.
"""

import argparse
import inspect
import json
import re
import runpy
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import holdfast
from holdfast.hands.hand_file import HandFile
from holdfast.objects.object_file import ObjectFile
from holdfast.objects.task_file import TaskFile
from holdfast.pipeline.cli.catalogue import entries
from holdfast.pipeline.cli.parsers import command_parser
from holdfast.pipeline.cli.registry import COMMANDS, GROUPS, Command
from holdfast.pipeline.records import GraspFile, RunRecord
from holdfast.solver.systems.file import SystemFile

HERE = Path(__file__).resolve().parent
WIDTH = 118
TITLES = {"positional arguments": "arguments"}
SECTIONS = ("Args:", "Attributes:", "Returns:", "Raises:", "Yields:")
KIND_WORDS = {"string": "text", "integer": "whole number", "boolean": "true or false", "number": "number"}
BOUND_WORDS = {
    "exclusiveMinimum": "above",
    "minimum": "at least",
    "exclusiveMaximum": "below",
    "maximum": "at most",
}
# A bound that keeps numbers finite, and says nothing to people.
FAR = 1e9
MADE = "<!-- Made from the code by docs/generate.py. -->"


MODELS = {
    "Task file": TaskFile,
    "Object file": ObjectFile,
    "Hand file": HandFile,
    "System file": SystemFile,
    "Grasp file": GraspFile,
    "Record of a run": RunRecord,
}


def commands_page() -> str:
    """Every command with its arguments, options and examples."""
    lines = ["# Commands", "", MADE, ""]
    lines += wrapped(
        "What each command takes, from the program itself: `holdfast COMMAND --help` says the same. What "
        "they have in common, exit codes and variables: [the command line](command-line.md)."
    )
    for group in GROUPS:
        if not group.commands:
            continue
        lines += ["", f"## {group.title[0].upper()}{group.title[1:]}"]
        for name in group.commands:
            lines += ["", f"### `{name}`", "", *command_lines(COMMANDS[name])]
    return "\n".join(lines) + "\n"


def command_lines(command: Command) -> Iterator[str]:
    """A command's section."""
    parser = command_parser(command)
    yield from wrapped(f"{command.summary[0].upper()}{command.summary[1:]}.")
    yield ""
    yield "```sh"
    for line, does in command.options.EXAMPLES:
        yield f"# {does}"
        yield line
    yield "```"
    for group in parser._action_groups:
        shown = [a for a in group._group_actions if a.help != argparse.SUPPRESS and a.dest != "help"]
        if not shown:
            continue
        yield ""
        title = TITLES.get(group.title or "", group.title or "")
        yield f"{title[0].upper()}{title[1:]}:"
        yield ""
        for action in shown:
            yield from wrapped(f"- {invocation(action)}: {action.help}", "  ")


def invocation(action: argparse.Action) -> str:
    """How an argument or option is written."""
    if not action.option_strings:
        return f"`[{action.metavar}]`" if action.nargs == "?" else f"`{action.metavar}`"
    names = ", ".join(action.option_strings)
    return f"`{names}`" if action.nargs == 0 else f"`{names} {action.metavar}`"


def wrapped(text: str, indent: str = "") -> list[str]:
    """Text in lines that are short enough."""
    return textwrap.wrap(
        text, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def gallery_page() -> str:
    """The nine tasks and the built-in hands, with their pictures."""
    results = {row["task"]: row for row in json.loads((HERE / "results.json").read_text("utf-8"))["tasks"]}
    about = {entry.name: entry.description for entry in entries("task")}
    lines = ["# Gallery", "", MADE, "", "## The nine tasks of the paper", ""]
    lines += wrapped(
        "Hand and object side by side; regions that must touch have the same colour and number. Counts "
        "are of 16 candidates, from [the runs behind the README](figures.md)."
    )
    for name, row in results.items():
        lines += [
            "",
            f"### {name}",
            "",
            *wrapped(f"{about[name]}. `holdfast run {name}`: {counts(row)}."),
            "",
        ]
        lines += [f"![{name}: the hand, the object and their regions](images/gallery/{name}.png)"]
    lines += ["", "## The hands of Table 1", ""]
    lines += wrapped(
        "Built from published dimensions; `holdfast hands NAME` lists where each figure comes from. A "
        "task is given another hand with `--hand NAME`."
    )
    for entry in entries("hand"):
        lines += ["", f"### {entry.name}", "", *wrapped(f"{entry.description}.")]
        if (HERE / "images" / "gallery" / f"{entry.name}.png").is_file():
            lines += ["", f"![{entry.name} with its contact regions](images/gallery/{entry.name}.png)"]
    return "\n".join(lines) + "\n"


def counts(row: dict[str, Any]) -> str:
    """What became of a task's candidates."""
    narrowly = f", {row['narrow']} of them narrowly" if row["narrow"] else ""
    return f"{row['certified']} certified, {row['clear']} clear, {row['held']} passed{narrowly}"


def figures_page() -> str:
    """Where the README's figures come from."""
    benchmarks = HERE.parent / "benchmarks"
    if str(benchmarks) not in sys.path:
        sys.path.insert(0, str(benchmarks))  # which share parts
    figures = runpy.run_path(str(benchmarks / "whole_runs" / "figures.py"))["FIGURES"]
    lines = ["# Where the figures come from", "", MADE, ""]
    lines += wrapped(
        "`./run bench figures` measures every figure of the README, prints it, and writes it: into "
        "`runs/figures`, and the table of the nine tasks into the README itself. All of them take hours; "
        "`./run bench figures NAME` measures one, and `--list` says what there is. A test compares the "
        "table with docs/results.json, and runs the examples."
    )
    lines += ["", "| name | figure | where in the README | command |", "|---|---|---|---|"]
    lines += [f"| `{f.name}` | {f.says} | {f.where} | `{f.command}` |" for f in figures]
    lines += [""]
    lines += wrapped(
        "Figures of other pages stand beside the command that measures them: of [the "
        "solver](solver.md#figures), [retraction](retraction.md#figures), [the hold "
        "test](hold-figures.md), [candidates](carrying.md#figures) and [what is "
        "proved](proved.md#figures). What earlier versions were measured at, and what was tried, are "
        "[findings](findings.md)."
    )
    return "\n".join(lines) + "\n"


def api_page() -> str:
    """What `import holdfast as hf` offers."""
    lines = ["# Python, name by name", "", MADE, ""]
    lines += wrapped("What `import holdfast as hf` offers; [Python](python.md) is how to use it.")
    for name in sorted(holdfast.__all__, key=str.casefold):
        thing = getattr(holdfast, name)
        if not callable(thing):
            continue
        lines += ["", f"## `{name}`", "", *signature_lines(name, thing), "", *docstring_lines(thing)]
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            for member, method in own_methods(thing):
                lines += ["", f"### `{name}.{member}`", ""]
                if callable(method):
                    lines += [*signature_lines(member, method), ""]
                lines += docstring_lines(method)
    return "\n".join(lines) + "\n"


def own_methods(kind: type) -> Iterator[tuple[str, Any]]:
    """Public methods and properties that a class describes."""
    for name, member in vars(kind).items():
        found = member.__func__ if isinstance(member, (classmethod, staticmethod)) else member
        if not name.startswith("_") and (inspect.isfunction(found) or isinstance(found, property)):
            yield name, found


def signature_lines(name: str, thing: Any) -> list[str]:
    """How it is called."""
    try:
        parameters = inspect.signature(thing).parameters.values()
    except (ValueError, TypeError):
        return []
    if inspect.isclass(thing) and issubclass(thing, Exception):
        return []
    words = [shown_parameter(p) for p in parameters if p.name not in ("self", "cls")]
    stars = [i for i, p in enumerate(parameters) if p.kind is p.KEYWORD_ONLY]
    if stars and not any(p.kind is p.VAR_POSITIONAL for p in parameters):
        shift = sum(p.name in ("self", "cls") for p in parameters)
        words.insert(stars[0] - shift, "*")
    one = f"{name}({', '.join(words)})"
    if len(one) <= 100:
        return ["```text", one, "```"]
    return ["```text", f"{name}(", *(f"    {word}," for word in words), ")", "```"]


def shown_parameter(parameter: inspect.Parameter) -> str:
    """A parameter with its default."""
    prefix = {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "")
    default = "" if parameter.default is parameter.empty else f"={parameter.default!r}"
    # The default of a function is that function, whose address differs from run to run.
    return f"{prefix}{parameter.name}{re.sub(' at 0x[0-9a-f]+', '', default)}"


def docstring_lines(thing: Any) -> list[str]:
    """A docstring in Google's style as Markdown."""
    lines: list[str] = []
    for block in (inspect.getdoc(thing) or "").split("\n\n"):
        head, _, rest = block.partition("\n")
        if head in SECTIONS:
            lines += [f"{head}", "", *section_lines(rest), ""]
        else:
            lines += [*wrapped(" ".join(block.split())), ""]
    return lines[:-1]


def section_lines(text: str) -> list[str]:
    """The entries of a section, one a line with what follows indented."""
    items: list[str] = []
    for line in textwrap.dedent(text).splitlines():
        if line.startswith(" ") and items:
            items[-1] += f" {line.strip()}"
        else:
            items.append(line)
    entries_ = [re.sub(r"^([\w*, ]+(?: \([^)]*\))?):", r"`\1`:", item) for item in items]
    return [line for item in entries_ for line in wrapped(f"- {item}", "  ")]


def formats_page() -> str:
    """The fields of every kind of file, from the models that read them."""
    lines = ["# Files, field by field", "", MADE, ""]
    lines += wrapped(
        "Every field of every kind of file, from the models that read them. What fields mean together, "
        "with examples: [files](files.md), [hands](hands.md), [the run folder](run-folder.md). Fields "
        "that are not listed are errors."
    )
    for title, model in MODELS.items():
        schema = model.model_json_schema(by_alias=True)
        lines += ["", f"## {title}", "", *docstring_lines(model), "", *field_table(schema, schema)]
        for name, inner in sorted(schema.get("$defs", {}).items()):
            if "properties" in inner:
                lines += ["", f"### {title}: `{name}`", "", *field_table(inner, schema)]
    return "\n".join(lines) + "\n"


def field_table(schema: dict[str, Any], whole: dict[str, Any]) -> list[str]:
    """The fields of a model."""
    required = set(schema.get("required", ()))
    rows = []
    for name, field in schema.get("properties", {}).items():
        default = "required" if name in required else f"`{json.dumps(field.get('default'))}`"
        rows.append(f"| `{name}` | {type_words(field, whole)} | {default} |")
    return ["| field | value | unless given |", "|---|---|---|", *rows]


def type_words(field: dict[str, Any], whole: dict[str, Any]) -> str:
    """What a field takes, in words."""
    if "$ref" in field:
        name = field["$ref"].rsplit("/", 1)[-1]
        inner = whole["$defs"][name]
        return f"`{name}`" if "properties" in inner else type_words(inner, whole)
    for key in ("anyOf", "oneOf"):
        if key in field:
            return " or ".join(dict.fromkeys(type_words(entry, whole) for entry in field[key]))
    if "const" in field or "enum" in field:
        return ", ".join(f"`{value}`" for value in field.get("enum", [field.get("const")]))
    match field.get("type"):
        case "array":
            inner = field.get("items") or {"anyOf": field.get("prefixItems") or [{}]}
            return f"list of {type_words(inner, whole)}"
        case "object":
            values = field.get("additionalProperties")
            return (
                f"mapping to {type_words(values, whole)}"
                if isinstance(values, dict) and values
                else "mapping"
            )
        case "null":
            return "nothing"
        case str(kind):
            return KIND_WORDS.get(kind, kind) + bounds(field)
    return "any value"


def bounds(field: dict[str, Any]) -> str:
    """What limits a number."""
    found = [f"{word} {field[key]:g}" for key, word in BOUND_WORDS.items() if abs(field.get(key, FAR)) < FAR]
    return f", {' and '.join(found)}" if found else ""


PAGES: dict[str, Callable[[], str]] = {
    "api.md": api_page,
    "commands.md": commands_page,
    "figures.md": figures_page,
    "file-formats.md": formats_page,
    "gallery.md": gallery_page,
}


def main() -> None:
    """Writes all of them."""
    for name, make in PAGES.items():
        (HERE / name).write_text(make(), "utf-8")


if __name__ == "__main__":
    main()
