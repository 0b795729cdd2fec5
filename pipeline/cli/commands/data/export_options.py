"""Options of `holdfast export`."""

import argparse

from ...shared_options import add_quiet
from ...targets import file_or_folder_target, file_target

__all__ = ["EXAMPLES", "FORMATS", "add_options"]

FORMATS = {
    "isaac_grasp": "YAML of Isaac Sim",
    "graspgen": "JSON of GraspGen",
    "acronym": "HDF5 of ACRONYM",
    "dexgraspbench": ".npy of DexGraspBench",
    "mjcf": "hand and object with a keyframe a grasp",
    "urdf": "the hand",
    "usd": "hand and object as a USD scene",
}

EXAMPLES = (
    ("holdfast export runs/upholding --format isaac_grasp --out grasps.yaml", "the grasps of a run"),
    ("holdfast export g01.json g02.json --format mjcf --out both.xml", "some grasps, for plain MuJoCo"),
    ("holdfast export theirs.npy --reading length=mm --format acronym --out ours.h5", "from another program"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "sources",
        nargs="+",
        metavar="RUN|GRASP",
        help="run folders and grasp files; also grasp files of other programs",
    )
    known = "; ".join(f"{name} ({words})" for name, words in FORMATS.items())
    parser.add_argument("--format", required=True, metavar="FORMAT", help=known)
    parser.add_argument(
        "--out",
        type=file_or_folder_target,
        required=True,
        metavar="FILE",
        help="where to; a folder for urdf and for many of dexgraspbench",
    )
    parser.add_argument(
        "--held", action="store_true", help="of runs only what is held, not all that is clear"
    )
    parser.add_argument(
        "--mesh",
        type=file_target,
        metavar="FILE",
        help="write the object's mesh there as OBJ, in m, and name it",
    )
    parser.add_argument(
        "--reading",
        action="append",
        default=[],
        metavar="NAME=ANSWER",
        help="what a file of another program leaves open, such as quaternion=xyzw",
    )
    add_quiet(parser)
