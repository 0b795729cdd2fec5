"""Options of `holdfast query`."""

import argparse

from ...converters import whole_number
from ...shared_options import add_json

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast query grasps.parquet 'SELECT hand, count(*) FROM grasps WHERE good GROUP BY hand'", "by hand"),
    ("holdfast query grasps.parquet 'SELECT row, margin FROM grasps ORDER BY margin DESC'",
     "`holdfast check` takes a row's number"),
    ("holdfast query grasps.parquet 'DESCRIBE grasps'", "its columns"),
)  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "file", metavar="FILE", help="a Parquet table of `holdfast table` or `holdfast batch`"
    )
    parser.add_argument("sql", metavar="SQL", help="one statement, in which the table is called grasps")
    parser.add_argument(
        "--most", type=whole_number(1), default=100, metavar="N", help="rows to print (100); --json has all"
    )
    add_json(parser)
