"""Options of `holdfast doctor`."""

import argparse

from ...shared_options import add_json

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast doctor", "what is found here, and what to do"),
    ("holdfast doctor --json -", "the same for a bug report"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    add_json(parser)
