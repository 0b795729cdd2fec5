"""System files (JSON): polynomial equations in named variables over a box."""

import re
from dataclasses import dataclass
from fractions import Fraction
from typing import Annotated, Any

from pydantic import Field

from ...base.files.file_model import FileModel, parse
from ...errors import InputError
from ..polynomial import FactoredPolynomial, parse_factors

__all__ = ["SystemProblem", "system_from_data"]

_LARGEST = 1e9
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,99}", re.ASCII)
Bound = Annotated[float, Field(ge=-_LARGEST, le=_LARGEST)]


class SystemFile(FileModel):
    """A system file."""

    name: str = ""
    description: str = ""
    variables: dict[str, tuple[Bound, Bound]] = Field(min_length=1, max_length=500)
    equations: list[str] = Field(min_length=1, max_length=2000)


@dataclass(frozen=True, eq=False)
class SystemProblem:
    """A polynomial system over a box.

    Attributes:
        names: (n,) variables, in the order of the file.
        lower: (n,) with the file's decimals taken exactly, so that 0.3 and 3/10 are the same.
        upper: (n,)
        equations: products that must be zero, factor by factor, with the file's decimals taken exactly.
    """

    names: tuple[str, ...]
    lower: tuple[Fraction, ...]
    upper: tuple[Fraction, ...]
    equations: tuple[FactoredPolynomial, ...]


def system_from_data(data: dict[str, Any], source: str) -> SystemProblem:
    """Builds a system from the content of a system file.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    spec = parse(SystemFile, data, source)
    for name, (lower, upper) in spec.variables.items():
        if not _NAME.fullmatch(name):
            shown = name if len(name) <= 40 else name[:40] + "..."
            raise InputError(
                source,
                f"variables.{shown}",
                "a variable is a letter or _, then up to 99 letters, digits and _",
            )
        if lower > upper:
            raise InputError(source, f"variables.{name}", f"the lower end {lower} is above the upper {upper}")
    names = tuple(spec.variables)
    equations = tuple(
        parse_factors(text, names, source, f"equations.{i}") for i, text in enumerate(spec.equations)
    )
    for i, equation in enumerate(equations):
        if equation.is_zero:
            raise InputError(source, f"equations.{i}", "is zero for all values, so it says nothing")
    # The shortest decimal that reads as a float is the one that the file has, or its like.
    ends = [(Fraction(repr(low)), Fraction(repr(high))) for low, high in spec.variables.values()]
    return SystemProblem(names, tuple(low for low, _ in ends), tuple(high for _, high in ends), equations)
