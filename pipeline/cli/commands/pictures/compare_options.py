"""Options of `holdfast compare`."""

import argparse

from ...shared_options import add_json

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (("holdfast compare runs/upholding runs/upholding_2", "settings, counts, verdicts and times"),)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("first", metavar="RUN", help="a run folder")
    parser.add_argument("second", metavar="RUN", help="another one")
    add_json(parser)
