"""What words of the command line stand for: a number, a point, a length; or what is allowed instead."""

import argparse
from collections.abc import Callable

__all__ = ["clearance", "names", "numbers", "patch_degree", "point", "positive", "share", "whole_number"]

# More than this no hand keeps from what it holds.
_MOST_CLEARANCE_M = 0.1


def whole_number(least: int) -> Callable[[str], int]:
    """A converter to whole numbers of at least `least`."""

    def convert(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least or value > 2**31:
            raise argparse.ArgumentTypeError(f"must be a whole number, at least {least}, not {text!r}")
        return value

    return convert


def positive(text: str) -> float:
    """A number above 0."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    # Compared this way round, NaN fails too.
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"must be a number above 0, not {text!r}")
    return value


def share(text: str) -> float:
    """A number above 0 and below 1."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1.0:
        raise argparse.ArgumentTypeError(f"must be a share above 0 and below 1, not {text!r}")
    return value


def clearance(text: str) -> float:
    """A length from 0 up, in m."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= _MOST_CLEARANCE_M:
        raise argparse.ArgumentTypeError(f"must be a length from 0 to {_MOST_CLEARANCE_M:g} m, not {text!r}")
    return value


def point(text: str) -> tuple[float, ...]:
    """Three coordinates, in m."""
    try:
        point = tuple(float(part) for part in text.split(","))
    except ValueError:
        point = ()
    if len(point) != 3 or not all(abs(x) < 1e6 for x in point):
        raise argparse.ArgumentTypeError(f"must be three numbers such as 0.01,0,-0.02, not {text!r}")
    return point


def patch_degree(text: str) -> tuple[int, int]:
    """The degree of a patch: a number, or one for each parameter."""
    parts = text.split(",")
    if len(parts) > 2 or not all(part in "123456789" and len(part) == 1 for part in parts):
        raise argparse.ArgumentTypeError(f"must be a whole number from 1 to 9, or two, not {text!r}")
    return int(parts[0]), int(parts[-1])


def names(text: str) -> tuple[str, ...]:
    """Names with commas between."""
    found = tuple(part.strip() for part in text.split(","))
    if not all(found):
        raise argparse.ArgumentTypeError(f"must be names with commas between, not {text!r}")
    return found


def numbers(text: str) -> tuple[float, ...]:
    """Numbers above 0 with commas between."""
    return tuple(positive(part) for part in text.split(","))
