"""The benchmark's teapot: Newell's surface made into four closed parts."""

import numpy as np
import trimesh

from ...base.numeric.arrays import Array
from ...geometry import MassProperties
from ...geometry.solids import Loft, shell_inertia, solid_inertia
from ..object_model import Part
from .generated import GeneratedShape
from .newell import teapot_surfaces

__all__ = ["CUTS", "teapot", "teapot_lofts"]

RGBA = tuple[float, float, float, float]

# Dense stoneware has 2200 to 2400 kg/m^3; walls of teapots are some 3 mm thick.
_DENSITY = 2300.0
_WALL_M = 0.003
# The lid would touch the pot all along its edge; it stands this much of v (0.2 mm) above its seat.
_SEAT_V = 0.003
_RIM_POINTS = 9
# Sections between which a hull is taken: found once by `Loft.find_cuts`, which takes seconds. The surface
# sinks into the hulls by less than 0.1 mm where hands touch, and by up to 1.2 mm elsewhere; the rim's are
# short so that the chords of its inner edge leave room for the lid.
CUTS: dict[str, tuple[int, ...]] = {
    "belly": (0, 35, 39),
    "rim": tuple(range(0, 49, 4)),
    "handle": (0, 12, 18, 22, 23, 25, 28, 31, 34, 36, 38, 40, 42, 44, 48),
    "spout": (0, 4, 8, 15, 18, 26, 28),
    "lid": (0, 17, 21, 24, 28, 40),
}
_GLAZE: RGBA = (0.86, 0.84, 0.78, 1.0)
_LID_GLAZE: RGBA = (0.62, 0.70, 0.72, 1.0)


def teapot() -> GeneratedShape:
    """The teapot of 292 x 136.5 x 182 mm; the pot is filled up to the seat of its lid.

    Parts: `pot` (belly and rim), `handle`, `spout`, `lid` (with its knob). The handle is massive, the rest
    weighs as walls of 3 mm.
    """
    lofts = teapot_lofts()
    belly, rim, spout, lid = (lofts[name] for name in ("belly", "rim", "spout", "lid"))
    # The seat of the lid is no wall: what is filled for collisions weighs nothing.
    walls = np.concatenate([_walls(belly.rings), _end(belly.rings[-1]), _walls(rim.rings[:, :_RIM_POINTS])])
    handle = lofts["handle"].mesh()
    pot = trimesh.util.concatenate([belly.mesh(), rim.mesh()])
    assert isinstance(pot, trimesh.Trimesh)
    pieces = {name: loft.pieces(CUTS[name]) for name, loft in lofts.items()}
    parts = (
        Part("pot", pot, pieces["belly"] + pieces["rim"], _shell(walls), _GLAZE),
        Part("handle", handle, pieces["handle"], solid_inertia(handle, _DENSITY), _GLAZE),
        Part("spout", spout.mesh(), pieces["spout"], _shell(_walls(spout.rings)), _GLAZE),
        Part("lid", lid.mesh(), pieces["lid"], _shell(_walls(lid.rings)), _LID_GLAZE),
    )
    return GeneratedShape(parts, teapot_surfaces())


def teapot_lofts() -> dict[str, Loft]:
    """The closed bodies that make it up, as sections along lines of constant v (u in the rim)."""
    rows = {
        "belly": [("belly", 0, 4, np.linspace(_SEAT_V, 1.0, 13)), ("belly", 4, 4, np.linspace(0.0, 1.0, 28))],
        "handle": [("handle", 0, 2, np.linspace(0.0, 1.0, 25)), ("handle", 2, 2, np.linspace(0.0, 1.0, 25))],
        "spout": [("spout", 0, 2, np.linspace(0.0, 1.0, 21)), ("spout", 2, 2, np.linspace(0.0, 1.0, 9))],
        "lid": [("knob", 0, 4, np.linspace(0.0, 1.0, 25)), ("lid", 0, 4, np.linspace(0.0, 1.0, 17))],
    }
    points = {"belly": 24, "handle": 16, "spout": 16, "lid": 16}
    lofts = {"rim": _rim()}
    for body, runs in rows.items():
        rings = [_ring(name, first, count, v, points[body]) for name, first, count, vs in runs for v in vs]
        # The second run begins on the section where the first one ends.
        del rings[len(runs[0][3])]
        lofts[body] = Loft(np.array(rings))
    return lofts


def _rim() -> Loft:
    """The lip as a ring, closed below by a web that reaches 1 mm into the belly."""
    surfaces = teapot_surfaces()
    v = np.linspace(0.0, 1.0, _RIM_POINTS)
    sections = []
    for k, u in [(k, u) for k in range(4) for u in np.arange(12) / 12.0]:
        curve = surfaces[f"rim_{k}"].evaluate(np.full(len(v), u), v)
        sections.append(np.vstack([curve, curve[-1] * [0.995, 1.0, 0.995], curve[0] * [1.005, 1.0, 1.005]]))
    rings = np.array(sections)
    rings[:, _RIM_POINTS:, 1] -= 0.001
    return Loft(rings, is_loop=True)


def _ring(name: str, first: int, count: int, v: float, points: int) -> Array:
    """The closed curve of constant v over patches that follow each other, (points * count, 3)."""
    surfaces = teapot_surfaces()
    u = np.arange(points) / points
    return np.concatenate(
        [surfaces[f"{name}_{i}"].evaluate(u, np.full(points, v)) for i in range(first, first + count)]
    )


def _shell(walls: Array) -> MassProperties:
    return shell_inertia(walls, _WALL_M * _DENSITY)


def _walls(rings: Array) -> Array:
    """The triangles (n, 3, 3) between sections (k, n, 3), without the ends."""
    a, b = rings[:-1], np.roll(rings, -1, axis=1)[:-1]
    c, d = rings[1:], np.roll(rings, -1, axis=1)[1:]
    return np.stack([np.stack([a, b, d], axis=2), np.stack([a, d, c], axis=2)]).reshape(-1, 3, 3)


def _end(ring: Array) -> Array:
    """The triangles (n, 3, 3) that close a section."""
    centre = np.broadcast_to(ring.mean(axis=0), ring.shape)
    return np.stack([ring, np.roll(ring, -1, axis=0), centre], axis=1)
