"""Isolates all solutions of public polynomial systems, in the notation of ibex: how many are closed in time.

    ./run bench public_systems FOLDER [--cap SECONDS] [--every N] [--json FILE]

FOLDER holds `.bch` files, such as `benchs/solver/polynom` of github.com/ibex-team/ibex-lib. Those with
equations of polynomials over boxes within 1e9 are read, all others counted as left out. No published
solutions come with them, so what is reported is which are closed (complete or infeasible), not whether that
is right. Seconds and the cap are CPU time of this process.
"""

import argparse
import json
import re
from pathlib import Path
from typing import Any

from holdfast.errors import InputError
from holdfast.solver import Verdict
from holdfast.solver.systems.file import system_from_data
from systems import solved

_DOMAIN = re.compile(r"(\w+)(?:\[(\d+)\])?\s*in\s*\[([^,\]]+),([^\]]+)\]")
_INDEX = re.compile(r"\b([A-Za-z_]\w*)\s*\(\s*(\d+)\s*\)")


def read(path: Path) -> dict[str, Any]:
    """A system as a system file has it.

    Raises:
        ValueError: it holds something else than equations over a box.
    """
    text = re.sub(r"//[^\n]*|/\*.*?\*/", " ", path.read_text("utf-8", errors="replace"), flags=re.DOTALL)
    parts = re.split(r"\b(variables|constraints)\b", text, flags=re.IGNORECASE)
    if len(parts) != 5 or parts[0].strip():
        raise ValueError("more than variables and constraints")
    variables: dict[str, tuple[float, float]] = {}
    for piece in filter(str.strip, parts[2].split(";")):
        found = _DOMAIN.fullmatch(piece.strip())
        if found is None:
            raise ValueError(f"a domain: {piece.strip()[:40]}")
        name, count, lower, upper = found.groups()
        names = [name] if count is None else [f"{name}_{k}" for k in range(1, int(count) + 1)]
        variables |= dict.fromkeys(names, (float(lower), float(upper)))
    body = re.split(r"\bend\b", parts[4], flags=re.IGNORECASE)[0]
    equations = []
    for piece in filter(str.strip, body.split(";")):
        left, is_equation, right = _INDEX.sub(r"\1_\2", " ".join(piece.split())).partition("=")
        if not is_equation or any(sign in piece for sign in "<>"):
            raise ValueError(f"no equation: {piece.strip()[:40]}")
        both = left if right.strip() == "0" else f"({left}) - ({right})"
        equations.append(both.replace("^", "**"))
    return {"variables": variables, "equations": equations}


def measure(path: Path, cap_s: float) -> dict[str, Any]:
    """What becomes of a file."""
    try:
        problem = system_from_data(read(path), path.name)
    except (ValueError, InputError) as error:
        return {"name": path.stem, "left_out": str(error)}
    result, seconds = solved(problem, cap_s)
    return {
        "name": path.stem,
        "unknowns": len(problem.names),
        "verdict": result.verdict.value,
        "closed": result.verdict is not Verdict.UNDECIDED,
        "solutions": len(result.solutions),
        "remaining": len(result.remaining),
        "boxes": result.boxes,
        "seconds": seconds,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--cap", type=float, default=10.0, metavar="SECONDS")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="only every Nth file")
    parser.add_argument("--json", type=Path, metavar="FILE")
    arguments = parser.parse_args()
    rows = []
    for path in sorted(arguments.folder.glob("*.bch"))[:: arguments.every]:
        row = measure(path, arguments.cap)
        rows.append(row)
        if "left_out" in row:
            print(f"{row['name']:32} left out: {row['left_out'][:70]}", flush=True)
            continue
        print(
            f"{row['name']:32} {row['unknowns']:4} unknowns {row['verdict']:10} {row['solutions']:5} found, "
            f"{row['remaining']:5} left, {row['boxes']:7} boxes, {row['seconds']:6.2f} s",
            flush=True,
        )
    read_ = [row for row in rows if "left_out" not in row]
    print(f"{sum(row['closed'] for row in read_)} of {len(read_)} closed within {arguments.cap:g} s each")
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1), "utf-8")


if __name__ == "__main__":
    main()
