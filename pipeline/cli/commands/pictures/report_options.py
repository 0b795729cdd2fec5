"""Options of `holdfast report`."""

import argparse

from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (("holdfast report runs/upholding", "writes runs/upholding/report.html"),)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("run", metavar="RUN", help="a run folder, such as runs/upholding")
    parser.add_argument("--out", type=file_target, metavar="FILE", help="where to write (RUN/report.html)")
