"""Isolates all solutions of public polynomial systems, in the notation of ibex: how many are closed in time.

    ./run bench public_systems FOLDER [--cap SECONDS] [--every N] [--json FILE]

FOLDER holds `.bch` files, also in folders inside, such as `benchs/solver/polynom` of
github.com/ibex-team/ibex-lib. Those with equations of polynomials over boxes within 1e9 are read, all others
counted as left out. No published solutions come with them, so what is reported is which are closed (complete
or infeasible), not whether that is right. Seconds and the cap are CPU time of this process.
"""

import argparse
import ast
import json
import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from holdfast.errors import InputError
from holdfast.solver import Verdict
from holdfast.solver.systems.file import system_from_data
from systems import solved

_LARGEST_POWER = 400
# A name, how many there are of it, and its value or interval; semicolons or commas part them.
_DOMAIN = re.compile(
    r"\s*(\w+)\s*(?:\[([^\]]+)\])?\s*(?:\bin\b\s*\[([^,\]]+),([^\]]+)\]|(?:\bin\b|=)\s*([^\[\],;]+))\s*(?:[,;]|$)"
)
_INDEX = re.compile(r"\b([A-Za-z_]\w*)\s*[(\[]\s*(\d+)\s*[)\]]")
_NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
_SECTIONS = re.compile(r"\b(constants|variables|constraints)\b", re.IGNORECASE)


def read(path: Path) -> dict[str, Any]:
    """A system as a system file has it.

    Raises:
        ValueError: it holds something else than equations over a box.
    """
    text = re.sub(r"//[^\n]*|/\*.*?\*/", " ", path.read_text("utf-8", errors="replace"), flags=re.DOTALL)
    before, *parts = _SECTIONS.split(text)
    titles = [part.lower() for part in parts[::2]]
    if before.strip() or titles not in (
        ["variables", "constraints"],
        ["constants", "variables", "constraints"],
    ):
        raise ValueError("more than constants, variables and constraints")
    sections = dict(zip(titles, parts[1::2], strict=True))
    constants: dict[str, Fraction] = {}
    for name, count, _, _, value in _domains(sections.get("constants", "")):
        if count or not value:
            raise ValueError(f"a constant that is no number: {name}")
        constants[name] = _number(value, constants)
    variables: dict[str, tuple[float, float]] = {}
    for name, count, lower, upper, value in _domains(sections["variables"]):
        names = [name]
        if count:
            names = [f"{name}_{k}" for k in range(1, int(_number(count, constants)) + 1)]
        bounds = (value, value) if value else (lower, upper)
        low, high = (float(_number(bound, constants)) for bound in bounds)
        variables |= dict.fromkeys(names, (low, high))
    body = re.split(r"\bend\b", sections["constraints"], flags=re.IGNORECASE)[0]
    equations = []
    for piece in filter(str.strip, body.split(";")):
        left, is_equation, right = _INDEX.sub(r"\1_\2", " ".join(piece.split())).partition("=")
        if not is_equation or any(sign in piece for sign in "<>"):
            raise ValueError(f"no equation: {piece.strip()[:40]}")
        both = left if right.strip() == "0" else f"({left}) - ({right})"
        equations.append(_with_constants(both.replace("^", "**"), constants))
    return {"variables": variables, "equations": equations}


def _domains(text: str) -> Iterator[tuple[str, str, str, str, str]]:
    """Name, count, lower and upper bound and value of each of a list; what is not given is empty."""
    at = 0
    while text[at:].strip():
        found = _DOMAIN.match(text, at)
        if found is None:
            raise ValueError(f"a domain: {' '.join(text[at:].split())[:40]}")
        name, count, lower, upper, value = (group or "" for group in found.groups())
        yield name, count, lower, upper, value
        at = found.end()


def _with_constants(expression: str, constants: Mapping[str, Fraction]) -> str:
    """An expression with numbers in place of constants."""

    def number(found: re.Match[str]) -> str:
        value = constants.get(found[0])
        return found[0] if value is None else f"({value.numerator}/{value.denominator})"

    return _NAME.sub(number, expression)


def _number(text: str, constants: Mapping[str, Fraction]) -> Fraction:
    """The value of an expression of numbers and constants."""
    try:
        return _value(ast.parse(text.strip().replace("^", "**"), mode="eval").body, text, constants)
    except SyntaxError:
        raise ValueError(f"no number: {text.strip()[:40]}") from None


def _value(node: ast.expr, text: str, constants: Mapping[str, Fraction]) -> Fraction:
    match node:
        case ast.Constant(value=int() | float()):
            # As it is written, in decimals.
            return Fraction(ast.get_source_segment(text.strip().replace("^", "**"), node) or "")
        case ast.Name(id=name) if name in constants:
            return constants[name]
        case ast.UnaryOp(op=ast.USub() | ast.UAdd() as sign, operand=operand):
            value = _value(operand, text, constants)
            return -value if isinstance(sign, ast.USub) else value
        case ast.BinOp(left=left, op=op, right=right):
            a, b = _value(left, text, constants), _value(right, text, constants)
            match op:
                case ast.Add():
                    return a + b
                case ast.Sub():
                    return a - b
                case ast.Mult():
                    return a * b
                case ast.Div() if b:
                    return a / b
                case ast.Pow() if b.denominator == 1 and 0 <= b <= _LARGEST_POWER:
                    return a ** int(b)
    raise ValueError(f"no number: {text.strip()[:40]}")


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
    for path in sorted(arguments.folder.rglob("*.bch"))[:: arguments.every]:
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
