"""Runs the benchmarks: `./run bench` lists them, `./run bench NAME [ARGUMENTS]` runs one.

Each module beside this one is a benchmark; `parts/` is what several use or one is made of, `peers/` what runs
in environments of other programs.
"""

import runpy
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main() -> int:
    names = sorted(path.stem for path in HERE.glob("*.py") if path.stem != "run")
    if len(sys.argv) < 2:
        width = max(map(len, names))
        for name in names:
            docstring = (HERE / f"{name}.py").read_text("utf-8").split('"""')[1]
            print(f"{name:{width}} {docstring.splitlines()[0]}")
        return 0
    name = sys.argv[1]
    if name not in names:
        print(f"run bench: unknown benchmark {name!r}; known: {', '.join(names)}", file=sys.stderr)
        return 2
    script = HERE / f"{name}.py"
    sys.argv = [str(script), *sys.argv[2:]]
    sys.path.insert(0, str(HERE))
    runpy.run_path(str(script), run_name="__main__")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
