"""Numbers and settings as the page writes them."""

from collections.abc import Callable
from math import degrees
from typing import Any

from markupsafe import Markup

from ...base.text.plain_text import printable, shortened
from ...base.text.significant import significant
from ..records import Setting

__all__ = ["FILTERS", "fixed", "setting_name", "setting_text", "shown"]

_UNITS = {"m_s": "m/s", "rad_s": "rad/s", "m": "m", "s": "s", "rad": "rad", "kg": "kg", "N": "N"}
_LONGEST_TEXT = 3000


def shown(value: Any) -> Any:
    """What the page says, without what would turn it round or flood it; what is markup already stays."""
    if not isinstance(value, str) or isinstance(value, Markup):
        return value
    return printable(shortened(value, _LONGEST_TEXT))


def fixed(value: float, digits: int) -> str:
    """A number with so many decimals; adding zero turns the -0 that rounding may leave into 0."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def setting_name(name: str) -> str:
    """`slip_limit_m` as `slip limit, m`, and `creep_budget_m_s` as `creep budget, m/s`."""
    for suffix, unit in _UNITS.items():
        if name.endswith(f"_{suffix}"):
            return f"{name.removesuffix(f'_{suffix}').replace('_', ' ')}, {unit}"
    return name.replace("_", " ")


def setting_text(value: Setting, unset: str = "none") -> str:
    """A setting in words; `unset` for None."""
    if value is None:
        return unset
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        rows = [f"({setting_text(list(row))})" if isinstance(row, tuple) else f"{row:g}" for row in value]
        return ", ".join(rows)
    return f"{value:g}" if isinstance(value, float) else str(value)


def _mm(metres: float | None, digits: int = 2) -> str:
    return "–" if metres is None else fixed(1e3 * metres, digits)


def _tiny_mm(metres: float) -> str:
    return f"{1e3 * metres:.0e}"


def _deg(radians: float | None, digits: int = 1) -> str:
    return "–" if radians is None else fixed(degrees(radians), digits)


def _number(value: float | None, digits: int = 3) -> str:
    return "–" if value is None else significant(value, digits)


def _words(command: str) -> Markup:
    """A command line that breaks between its words: options have hyphens, at which browsers would break."""
    return Markup(" ").join(Markup("<span>{}</span>").format(word) for word in shown(command).split(" "))


def _row(values: Any, digits: int = 4) -> str:
    """Numbers of a vector side by side."""
    return ", ".join(fixed(value, digits) for value in values)


FILTERS: dict[str, Callable[..., str]] = {
    "mm": _mm,
    "tiny_mm": _tiny_mm,
    "deg": _deg,
    "number": _number,
    "vector": _row,
    "words": _words,
}
