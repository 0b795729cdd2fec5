"""Every figure of the README and where it comes from: lists them, or measures all and writes them.

    ./run bench figures [--list] [--into DIR] [NAME ...]

What each measurement prints goes to stdout and into DIR/NAME.txt (runs/figures); `tasks` also writes the
README's table and docs/results.json. All of them take hours; NAME measures those alone, --list lists them.
"""

import argparse
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from parts.places import ROOT

FIRST_LINE = __doc__.partition("\n")[0]


@dataclass(frozen=True)
class Figure:
    """A figure, or a table of them.

    Attributes:
        name: for this command.
        says: what the README says.
        where: the part of the README.
        command: measures it, from the root of the repository.
    """

    name: str
    says: str
    where: str
    command: str


FIGURES = (
    Figure("tasks", "the table of the nine tasks", "Run it", "./run bench tasks --readme"),
    Figure("demo", "the table of `upholding` and its seconds", "Run it", "holdfast run upholding --force"),
    Figure(
        "pinch",
        "6 of 6 grasps of the box, and their seconds",
        "Your own object",
        "./run test tests/test_readme.py -k own_object",
    ),
    Figure(
        "snippets",
        "what the examples in Python and of `holdfast system` print",
        "Your own object",
        "./run test tests/test_readme.py -k example",
    ),
    Figure(
        "refusals",
        "none of 50 grasps that were called not holdable held",
        "What is guaranteed, and what is not",
        "./run bench refusals --seed 71130",
    ),
)


def main() -> int:
    known = {figure.name: figure for figure in FIGURES}
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[*known, []])
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--into", type=Path, default=Path("runs") / "figures")
    arguments = parser.parse_args()
    chosen = [known[name] for name in arguments.names or known]
    status = 0
    for figure in chosen:
        print(f"{figure.name}: {figure.says} ({figure.where}): {figure.command}", flush=True)
        if not arguments.list:
            status = measure(figure, arguments.into) or status
    return status


def measure(figure: Figure, into: Path) -> int:
    """Runs a measurement, shows what it prints, and keeps that."""
    into.mkdir(parents=True, exist_ok=True)
    words = figure.command.split()
    if words[0] == "holdfast":
        words = [sys.executable, "-P", "-m", *words]
    with (into / f"{figure.name}.txt").open("w", encoding="utf-8") as kept:
        with subprocess.Popen(words, cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            for line in process.stdout:
                print(line, end="", flush=True)
                kept.write(line)
        return process.returncode


if __name__ == "__main__":
    raise SystemExit(main())
