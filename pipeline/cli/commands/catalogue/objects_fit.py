"""`holdfast objects fit MESH`."""

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .....base.files.fields import check_region_name
from .....base.text.console import Console, emit, emit_json
from .....base.text.significant import significant
from .....errors import InputError
from .....objects import MESH_FORMATS, Fit, check_size, fit_patch, load_object, metres, read_mesh

if TYPE_CHECKING:
    import trimesh


__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Fits a patch to the surface and prints it as a region of an object file."""
    import numpy as np

    _check_name(arguments.name)
    mesh = _read(arguments)
    fit = fit_patch(mesh, np.array(arguments.at), arguments.radius, arguments.degree, source=arguments.mesh)
    quality = (
        f"distance {significant(1e3 * fit.rms_m, 2)} mm rms, {significant(1e3 * fit.max_m, 2)} mm at most; "
        f"normals within {significant(math.degrees(fit.normal_rad), 2)} deg"
    )
    if arguments.json:
        emit_json(arguments.json, _as_json(arguments, fit))
    if arguments.json != "-":
        emit("\n".join([f"# {quality}", f"{arguments.name}:", *_yaml(fit)]))
    Console(quiet=arguments.quiet).say(quality)
    return 0


def _check_name(name: str) -> None:
    try:
        check_region_name(name)
    except ValueError as error:
        raise InputError("--name", "", str(error)) from None


def _read(arguments: argparse.Namespace) -> "trimesh.Trimesh":
    name, path = arguments.mesh, Path(arguments.mesh)
    if path.suffix.lower() not in MESH_FORMATS:
        return load_object(name, scale=arguments.scale, units=arguments.units).mesh
    unit_m = metres(arguments.scale, arguments.units)
    mesh, _ = read_mesh(path, name, "", unit_m=unit_m)
    check_size(mesh, name, "", unit_m=unit_m)
    return mesh


def _yaml(fit: "Fit") -> list[str]:
    import numpy as np

    # A hundredth of a micrometre is far below what a mesh says; a tiny patch takes more digits.
    across = float(np.ptp(fit.patch.control_points, axis=(0, 1)).max())
    digits = max(8, 5 - math.floor(math.log10(across)))
    rows = [
        ", ".join(
            "[" + ", ".join(f"{round(x, digits) + 0.0:.{digits}f}" for x in point) + "]" for point in row
        )
        for row in fit.patch.control_points.tolist()
    ]
    return ["  bezier:", *(f"    - [{row}]" for row in rows)]


def _as_json(arguments: argparse.Namespace, fit: "Fit") -> dict[str, Any]:
    return {
        "name": arguments.name,
        "mesh": arguments.mesh,
        "centre": fit.centre.tolist(),
        "radius": arguments.radius,
        "bezier": fit.patch.control_points.tolist(),
        "rms": fit.rms_m,
        "max": fit.max_m,
        "normal_angle": fit.normal_rad,
    }
