"""Instances of the linear program solver HiGHS that print nothing and keep to one thread."""

from functools import cache

import highspy

from ...errors import HoldfastError
from ..machine.native_output import native_stdout_dropped

__all__ = ["accept", "new_highs"]


def new_highs() -> highspy.Highs:
    """An instance that keeps the basis it is given: presolve would discard it."""
    _drop_banner()
    highs = highspy.Highs()
    accept(highs.setOptionValue("output_flag", False))
    accept(highs.setOptionValue("threads", 1))
    accept(highs.setOptionValue("presolve", "off"))
    return highs


@cache
def _drop_banner() -> None:
    """Lets HiGHS 1.16 print its banner, which a process's first instance does whatever it is told later."""
    with native_stdout_dropped():
        highspy.Highs()


def accept(status: highspy.HighsStatus) -> None:
    """Raises where HiGHS refuses a call: it answers a status and would otherwise go on without."""
    if status == highspy.HighsStatus.kError:
        raise HoldfastError("HiGHS refused a call; the linear program is not usable")
