"""All real roots of a polynomial system, from its equations as text."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import overload

from ..base.text.notebook import html_table
from ..errors import InputError
from ..solver import SystemResult, Verdict, solve_system
from ..solver.systems import system_from_data

__all__ = ["Root", "Roots", "roots"]

_MOST_SHOWN = 10


@dataclass(frozen=True)
class Root:
    """A box around one root, or a box of a cover where there are fewer equations than unknowns.

    Attributes:
        values: the middle of the box, by unknown.
        radius: every point of the box lies within it of the middle, in each unknown.
        certified: whether a root is proved to lie in the box, and no other in that of a square system.
    """

    values: dict[str, float]
    radius: float
    certified: bool

    def __getitem__(self, name: str) -> float:
        return self.values[name]

    def __str__(self) -> str:
        values = ", ".join(f"{name} = {value:.9g}" for name, value in self.values.items())
        proved = "" if self.certified else ", not certified"
        return f"{values} (within {self.radius:.2g}{proved})"


@dataclass(frozen=True, eq=False, repr=False)
class Roots(Sequence[Root]):
    """The roots that were found, as a sequence.

    Attributes:
        names: the unknowns.
        result: of the solver, with its verdict and the boxes that remain.
    """

    names: tuple[str, ...]
    result: SystemResult

    @property
    def verdict(self) -> Verdict:
        """COMPLETE where these are all; INFEASIBLE where it is proved that there are none; else UNDECIDED."""
        return self.result.verdict

    def __len__(self) -> int:
        return len(self.result)

    @overload
    def __getitem__(self, index: int) -> Root: ...
    @overload
    def __getitem__(self, index: slice) -> list[Root]: ...
    def __getitem__(self, index: int | slice) -> Root | list[Root]:
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        box = self.result[index]
        values = dict(zip(self.names, box.middle.tolist(), strict=True))
        return Root(values=values, radius=box.radius, certified=box.certified)

    def __iter__(self) -> Iterator[Root]:
        return (self[k] for k in range(len(self)))

    def __str__(self) -> str:
        lines = [str(self.result), *(f"  {root}" for root in self[:_MOST_SHOWN])]
        if len(self) > _MOST_SHOWN:
            lines.append(f"  and {len(self) - _MOST_SHOWN} more")
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"<Roots: {self.result}>"

    def _repr_html_(self) -> str:
        rows = [(*root.values.values(), root.radius, "yes" if root.certified else "no") for root in self]
        return html_table(str(self.result), [*self.names, "radius", "certified"], rows)


def roots(
    equations: Sequence[str] | str,
    *,
    sigma: float | None = None,
    budget_s: float = 60.0,
    workers: int = 1,
    **unknowns: tuple[float, float],
) -> Roots:
    """All real roots of polynomials in a closed box, each proved, or a proof that there are none.

    `hf.roots(["x**2 + y**2 - 1", "x - y**3"], x=(-2, 2), y=(-2, 2))`

    Args:
        equations: polynomials that must be zero, as text; see `solver.polynomial.parse_polynomial`.
        sigma: boxes narrower than this are not split; 1e-7, or 0.05 where there are fewer equations than
            unknowns, unless given.
        budget_s: time after which the search stops.
        workers: processes to use; their number has no influence on the result.
        **unknowns: the interval of each unknown, a point where its value is known. Unknowns named as an
            argument above go through `holdfast.solver.solve_system`.

    Raises:
        InputError: an equation, interval or argument that can't be used.
    """
    texts = [equations] if isinstance(equations, str) else list(equations)
    box = {}
    for name, ends in unknowns.items():
        try:
            lower, upper = ends
            box[name] = [float(lower), float(upper)]
        except (TypeError, ValueError):
            raise InputError("roots", name, f"must be an interval (lower, upper), not {ends!r}") from None
    problem = system_from_data({"variables": box, "equations": texts}, "roots")
    result = solve_system(
        problem.equations, problem.lower, problem.upper, sigma=sigma, budget_s=budget_s, workers=workers
    )
    return Roots(problem.names, result)
