"""`holdfast tasks`."""

import argparse

from ._listing import list_or_show

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Lists the tasks that are built in, or shows one in full."""
    return list_or_show("task", arguments)
