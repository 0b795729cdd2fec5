"""Runs the benchmarks: `./run bench` lists them, `./run bench NAME [ARGUMENTS]` runs one.

Each module in the folders `solving` to `whole_runs` is a benchmark; `parts/` is what several use or one is
made of, `peers/` what runs in environments of other programs.
"""

import ast
import runpy
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
GROUPS = ("solving", "statics", "holding", "bringing", "whole_runs")


def benchmarks() -> dict[str, Path]:
    """All of them, by name."""
    return {path.stem: path for group in GROUPS for path in sorted((HERE / group).glob("*.py"))}


def first_line(script: Path) -> str:
    """Of what a module says of itself."""
    return (ast.get_docstring(ast.parse(script.read_text("utf-8"))) or "").partition("\n")[0]


def list_all(scripts: dict[str, Path]) -> None:
    """Prints what each measures, group by group."""
    width = max(map(len, scripts))
    for group in GROUPS:
        print(f"{group.replace('_', ' ')}:")
        for name, path in scripts.items():
            if path.parent.name == group:
                print(f"  {name:{width}} {first_line(path)}")


def main() -> int:
    scripts = benchmarks()
    if len(sys.argv) < 2:
        list_all(scripts)
        return 0
    script = scripts.get(sys.argv[1])
    if script is None:
        known = ", ".join(sorted(scripts))
        print(f"run bench: unknown benchmark {sys.argv[1]!r}; known: {known}", file=sys.stderr)
        return 2
    sys.argv = [str(script), *sys.argv[2:]]
    sys.path[:0] = [str(script.parent), str(HERE)]
    runpy.run_path(str(script), run_name="__main__")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
