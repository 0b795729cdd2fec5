"""Options of `holdfast serve`."""

import argparse

from ...converters import positive, whole_number
from ...shared_options import add_quiet
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast serve grasps", "HTTP on this machine, for files in the folder grasps"),
    ("holdfast serve grasps --mcp", "MCP on stdin and stdout, as an assistant starts it"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "folder", type=folder_target, metavar="DIR", help="the folder with the files, for results too"
    )
    parser.add_argument("--mcp", action="store_true", help="an MCP server on stdin and stdout, not HTTP")
    parser.add_argument(
        "--port", type=whole_number(0), default=8090, metavar="N", help="to listen at; 0 for any (8090)"
    )
    parser.add_argument(
        "--longest",
        type=positive,
        default=600.0,
        metavar="SECONDS",
        help="time that a request may take before it is stopped (600)",
    )
    parser.add_argument(
        "--together", type=whole_number(1), default=1, metavar="N", help="requests done at the same time (1)"
    )
    add_quiet(parser)
