"""`holdfast export RUN|GRASP...`."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from .....base.files.output_file import write_bytes
from .....base.machine.backend import configure
from .....base.text.console import emit
from .....errors import InputError, UnknownName
from ....exports import PlacedGrasp, grasp_files, hand_urdf, keyframes_mjcf, obj_text, usd_text
from ._export_sources import OwnGrasps, foreign_grasps, own_grasps
from .export_options import FORMATS

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Writes grasps in another format, and prints the paths of the files."""
    configure()
    if arguments.format not in FORMATS:
        raise UnknownName("--format", "", "format", arguments.format, FORMATS)
    out = Path(arguments.out)
    paths = [Path(source) for source in arguments.sources]
    found = [own_grasps(path, held=arguments.held) for path in paths]
    own = [grasps for grasps in found if grasps is not None]
    if arguments.reading and len(own) == len(paths):
        raise InputError(
            "--reading", "", "is for files of other programs; grasps of Holdfast leave nothing open"
        )
    if arguments.format in ("mjcf", "urdf", "usd") or arguments.mesh:
        _check_own(own, paths, "--mesh" if arguments.mesh else f"--format {arguments.format}")
    files = _model_files(own, arguments.format, out)
    if files is None:
        placed: list[PlacedGrasp] = []
        for path, grasps in zip(paths, found, strict=True):
            placed += (
                foreign_grasps(path, arguments) if grasps is None else grasps.placed(arguments.mesh or "")
            )
        files = grasp_files(_with_own_names(placed), arguments.format, out)
    if arguments.mesh:
        files[Path(arguments.mesh)] = obj_text(own[0].task.object.mesh).encode("utf-8")
    for path, data in files.items():
        write_bytes(path, data)
        emit(str(path))
    return 0


def _check_own(own: Sequence[OwnGrasps], paths: Sequence[Path], option: str) -> None:
    """Models and meshes are of one task of ours."""
    if len(own) < len(paths):
        raise InputError(option, "", "needs grasps of Holdfast, for a file of another program has no models")
    names = {(grasps.task.hand.name, grasps.task.object.name) for grasps in own}
    if len(names) > 1:
        raise InputError(option, "", f"needs grasps of one hand and one object, not of {len(names)}")


def _model_files(own: Sequence[OwnGrasps], format_: str, out: Path) -> dict[Path, bytes] | None:
    """The files of a model; None for other formats."""
    if format_ == "urdf":
        return {out / name: text.encode("utf-8") for name, text in hand_urdf(own[0].task.hand).items()}
    if format_ not in ("mjcf", "usd"):
        return None
    grasps = [(record, each.task) for each in own for record in each.records]
    if len({record.id for record, _ in grasps}) < len(grasps):
        raise InputError(f"--format {format_}", "", "two grasps have the same id, by which they are named")
    write = keyframes_mjcf if format_ == "mjcf" else usd_text
    return {out: write(grasps, str(own[0].path)).encode("utf-8")}


def _with_own_names(placed: Sequence[PlacedGrasp]) -> list[PlacedGrasp]:
    """The grasps, named apart where several files have a grasp of the same name."""
    if len({grasp.name for grasp in placed}) == len(placed):
        return list(placed)
    return [replace(grasp, name=f"grasp_{i}") for i, grasp in enumerate(placed)]
