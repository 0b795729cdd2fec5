"""`holdfast clear GRASP`."""

import argparse

from ..backend import configure

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Frees a grasp of penetration and says how deep it was and is."""
    configure()
    from ..stages import clear_grasp
    from ..text import describe
    from ._grasp import finish, load

    loaded = load(arguments)
    record, clear = clear_grasp(loaded.record, loaded.configuration)
    finish(arguments, record, describe(record))
    return 4 if clear is None else 0
