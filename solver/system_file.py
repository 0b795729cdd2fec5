"""System files (JSON): polynomial equations in named variables over a box."""

import keyword
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ..errors import InputError
from ..files import FileModel, parse
from .expression import ExactPolynomial, parse_polynomial

__all__ = ["SystemProblem", "system_from_data"]

_LARGEST = 1e9
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
        lower: (n,)
        upper: (n,)
        equations: polynomials that must be zero, with the file's decimals taken exactly.
    """

    names: tuple[str, ...]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    equations: tuple[ExactPolynomial, ...]


def system_from_data(data: dict[str, Any], source: str) -> SystemProblem:
    """Builds a system from the content of a system file.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    spec = parse(SystemFile, data, source)
    for name, (lower, upper) in spec.variables.items():
        if not name.isidentifier() or not name.isascii() or keyword.iskeyword(name):
            raise InputError(
                source, f"variables.{name}", "a variable is a letter, then letters, digits and _"
            )
        if lower > upper:
            raise InputError(
                source, f"variables.{name}", f"the lower end {lower:g} is above the upper {upper:g}"
            )
    names = tuple(spec.variables)
    equations = tuple(
        parse_polynomial(text, names, source, f"equations.{i}") for i, text in enumerate(spec.equations)
    )
    for i, equation in enumerate(equations):
        if not equation:
            raise InputError(source, f"equations.{i}", "is zero for all values, so it says nothing")
    bounds = np.array(list(spec.variables.values()), dtype=float)
    return SystemProblem(names, bounds[:, 0].copy(), bounds[:, 1].copy(), equations)
