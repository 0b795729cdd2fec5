"""Options of `holdfast table`."""

import argparse

from ...shared_options import add_quiet
from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast table runs --out grasps.parquet", "every run below runs/, a row a grasp"),
    ("holdfast table runs/a runs/b --out grasps.jsonl", "JSON lines, which need no extra"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "runs",
        nargs="+",
        metavar="RUN",
        help="a run folder, or one with run folders below it, such as a batch",
    )
    parser.add_argument(
        "--out",
        type=file_target,
        required=True,
        metavar="FILE",
        help="the table: .parquet (extra `data`) or .jsonl",
    )
    parser.add_argument(
        "--croissant",
        type=file_target,
        metavar="FILE",
        help="write metadata of the Parquet table, too, such as grasps.croissant.json beside it",
    )
    parser.add_argument("--licence", metavar="NAME", help="of the data, for the metadata, such as CC-BY-4.0")
    add_quiet(parser)
