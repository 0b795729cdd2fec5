"""Colours of a surface from people, for pictures alone: those of the corners of triangles.

Every viewer can draw that, and what can't draws patches of one colour each.
"""

from dataclasses import dataclass

import numpy as np
import trimesh
from PIL import Image
from scipy.spatial import cKDTree

from ...base.numeric.arrays import Array, Indices, Picture
from .light_mesh import light_mesh

__all__ = ["MOST_TRIANGLES", "Paint"]

MOST_TRIANGLES = 16_000
"""So many triangles a painted surface has at most."""

# A mesh in MuJoCo needs four corners, and an area that is not that of a line.
_LEAST_CORNERS, _LEAST_SHARE = 4, 1e-6


@dataclass(frozen=True, eq=False)
class Paint:
    """A surface to be looked at.

    Attributes:
        vertices: (n, 3) in the mesh's frame, in m.
        faces: (m, 3), corners of triangles, outwards as in the file.
        rgb: (n, 3) colours of the vertices as screens have them (sRGB).
    """

    vertices: Array
    faces: Indices
    rgb: Picture

    def lightened(self) -> "Paint":
        """The same, or one like it with no more triangles than are allowed."""
        if len(self.faces) <= MOST_TRIANGLES:
            return self
        light = light_mesh(trimesh.Trimesh(self.vertices, self.faces, process=False), MOST_TRIANGLES)
        vertices = np.array(light.vertices)
        _, nearest = cKDTree(self.vertices).query(vertices)
        return Paint(vertices, np.array(light.faces, dtype=np.int64), self.rgb[nearest])

    def patches(self, most: int) -> list[tuple[tuple[float, float, float], Array, Indices]]:
        """The surface in pieces of one colour each, for what can't draw more: colour, vertices, faces.

        Args:
            most: colours at most; near ones become one.
        """
        flat: Picture = self.rgb[self.faces].astype(float).mean(axis=1).round().astype(np.uint8)
        palette, index = _palette(flat, most)
        index = self._without_scraps(palette, index)
        found = []
        for k in np.unique(index):
            used, own = np.unique(self.faces[index == k], return_inverse=True)
            red, green, blue = (float(share) for share in palette[k] / 255.0)
            found.append(((red, green, blue), self.vertices[used], own.reshape(-1, 3)))
        return found

    def _without_scraps(self, palette: Picture, index: Indices) -> Indices:
        """What is so little of the surface that it is no mesh of its own takes the nearest other colour."""
        a, b, c = (self.vertices[corner] for corner in self.faces.T)
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        total = np.bincount(index, area, len(palette))
        corners = np.array([len(np.unique(self.faces[index == k])) for k in range(len(palette))])
        is_whole = (corners >= _LEAST_CORNERS) & (total > _LEAST_SHARE * total.sum())
        if not is_whole.any():
            return np.zeros_like(index)
        kept = np.flatnonzero(is_whole)
        away = np.linalg.norm(palette[:, None].astype(float) - palette[kept].astype(float), axis=2)
        nearest: Indices = kept[np.argmin(away, axis=1)]
        return nearest[index]


def _palette(rgb: Picture, most: int) -> tuple[Picture, Indices]:
    """At most so many colours (k, 3), and which of them each colour of `rgb` (n, 3) becomes."""
    colours, index = np.unique(rgb, axis=0, return_inverse=True)
    if len(colours) <= most:
        return colours, index.reshape(-1)
    picture = Image.fromarray(rgb[None]).quantize(most, dither=Image.Dither.NONE)
    table = np.array(picture.getpalette(), dtype=np.uint8).reshape(-1, 3)
    return table, np.asarray(picture, dtype=np.int64)[0]
