"""Runs the benchmarks: `./run bench` lists them, `./run bench NAME [ARGUMENTS]` runs one."""

import runpy
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
# What is in this folder but measures nothing by itself.
HELPERS = {
    "run",
    "drake_coulomb",
    "drake_scene",
    "drake_trial",
    "drake_yield",
    "hold_sample",
    "jaws",
    "mesh_list",
    "neutral_scene",
    "paper_tasks",
    "peer_codac",
    "peer_drake",
    "peer_scip",
    "penalty",
    "planted_faults",
    "run_options",
    "sound_grasps",
}


def main() -> int:
    names = sorted(path.stem for path in HERE.glob("*.py") if path.stem not in HELPERS)
    if len(sys.argv) < 2:
        for name in names:
            docstring = (HERE / f"{name}.py").read_text("utf-8").split('"""')[1]
            print(f"{name:12} {docstring.splitlines()[0]}")
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
