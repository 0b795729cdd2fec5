"""Options of `holdfast objects fit`."""

import argparse

from ...converters import patch_degree, point, positive
from ...shared_options import add_json, add_quiet, add_units

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (("holdfast objects fit mug.obj --at 0,0.04,0.05 --radius 0.01", "a region for the object file"),)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("mesh", metavar="MESH", help="a mesh file, or an object")
    add_units(parser)
    parser.add_argument(
        "--at", type=point, required=True, metavar="X,Y,Z", help="a point on the surface or near it, in m"
    )
    parser.add_argument(
        "--radius",
        type=positive,
        required=True,
        metavar="R",
        help="distance of the patch's corners from its middle, in m",
    )
    parser.add_argument(
        "--degree", type=patch_degree, default=(3, 3), metavar="N or M,N", help="degree of the patch (3)"
    )
    parser.add_argument("--name", default="region", metavar="NAME", help="of the region")
    add_json(parser)
    add_quiet(parser)
