"""Hands from MJCF and URDF models.

Link frames are the frames of the model's bodies, shifted (never turned) so that the joints' axes pass through
their origins; of the palm, `palm_frame`. Bodies without joints become part of the body that carries them; a
region on such a body is given in that body's own frame all the same.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import trimesh

from ...base.files.fields import plain_name
from ...base.numeric.arrays import Array
from ...errors import InputError, UnknownName
from ...geometry import MassProperties, build_region, invert, pose
from ..finding import find_regions
from ..hand import Hand, HandRegion, Link
from ..hand_file import check_axes, check_limits
from ..joint_file import joint_frame
from ..placed import placed_region
from .file import ImportedHandFile
from .hollows import with_hollows
from .joints import ImportedJoints
from .matter import with_matter
from .model_tree import ModelTree, compile_model
from .names import new_names
from .palm import find_palm_body, warn_of_limbs
from .parallel_axes import with_parallel_axes
from .servos import with_nominal_servos
from .text import read_model_text
from .units import are_unsaid_radians, warn_of_radians, warn_of_units

__all__ = ["Imported", "import_hand", "import_model"]

# A palm does not move: where the model gives it no mass, any will do. So will it for a link without matter.
_NOMINAL_MASS = MassProperties(1e-3, np.zeros(3), 1e-7 * np.eye(3))


def import_hand(spec: ImportedHandFile, path: Path, root: Path) -> Hand:
    """Builds a hand from its validated file and the model beside it.

    Its regions are those that the file gives, or that are found where it gives none.

    Args:
        spec: the file.
        path: of the file, for error messages.
        root: folder below which the model and all of its files lie.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    return import_model(spec, path, root).hand


class Imported(NamedTuple):
    """An imported hand, and how a hand file names its parts.

    Attributes:
        hand: the hand.
        palm: the model's name of the body that is the palm.
        frames: pose T_link_body (4, 4) of the body that gave each link its name, by that name.
    """

    hand: Hand
    palm: str
    frames: dict[str, Array]


def import_model(spec: ImportedHandFile, path: Path, root: Path) -> Imported:
    """`import_hand`, with what it takes to write a hand file about it."""
    angle, notes = spec.angle, list[str]()

    def tree_of(*, as_drawn: bool) -> ModelTree:
        text = read_model_text(root / path.name, spec.model, spec.palm, angle, as_drawn=as_drawn)
        return compile_model(text, str(path))

    tree = tree_of(as_drawn=False)
    if angle is None and not spec.limits and are_unsaid_radians(tree):
        angle, notes = "radian", [warn_of_radians(tree, str(path))]
        tree = tree_of(as_drawn=False)
    importer = _Importer(spec, str(path), tree)
    if not importer.collides:
        importer = _Importer(spec, str(path), tree_of(as_drawn=True))
    importer.tell(notes)
    return Imported(importer.hand(), importer.palm_name, importer.frames)


@dataclass
class _PlacedBody:
    """Where a body of the model went: a link, and the body's pose in that link's frame."""

    link: int
    T_link_body: Array


class _Importer:
    """Turns the bodies of a model into links."""

    def __init__(self, spec: ImportedHandFile, source: str, tree: ModelTree):
        self._spec = spec
        self._source = source
        self._tree = tree
        self._palm = find_palm_body(tree, spec.palm, source)
        self._bodies = tree.carried(self._palm)
        self.collides = tree.collide_as_drawn(self._bodies)
        tree.check_meshes(self._bodies)
        self._link_names = new_names(
            "link_names", spec.link_names, tree.body_names, self._bodies, source, has_world=self._palm == 0
        )
        self.frames: dict[str, Array] = {}
        self.palm_name = tree.body_names[self._palm]
        self._joints = ImportedJoints(spec, source, tree, self._bodies)

    def tell(self, notes: list[str]) -> None:
        """Adds to what the hand has to tell of its import."""
        self._tree.notes[:0] = notes

    def hand(self) -> Hand:
        """The hand."""
        links: list[Link] = []
        placed: dict[int, _PlacedBody] = {}
        for body in self._bodies:
            joints = self._tree.joints(body) if body != self._palm else []
            if body == self._palm:
                placed[body] = _PlacedBody(0, invert(self._T_body_palm()))
                links.append(Link(self._link_names[body], -1, np.eye(4), (), (), _NOMINAL_MASS))
                continue
            parent = placed[self._tree.parents[body]]
            T = parent.T_link_body @ self._tree.T_parent_body(body)
            if joints:
                anchor = self._joints.common_anchor(body, joints)
                T0, axes = self._joints.axes(T @ pose(np.eye(3), anchor), joints)
                placed[body] = _PlacedBody(len(links), pose(np.eye(3), -anchor))
                links.append(Link(self._link_names[body], parent.link, T0, axes, (), _NOMINAL_MASS))
            else:
                placed[body] = _PlacedBody(parent.link, T)
        self.frames = {self._link_names[body]: entry.T_link_body for body, entry in placed.items()}
        links = [
            with_matter(link, _parts(placed, i), self._tree, self._source, is_palm=i == 0)
            for i, link in enumerate(links)
        ]
        if not any(link.shapes for link in links):
            raise InputError(
                self._source,
                "import",
                "the palm carries no geom, neither one that collides nor one that is drawn",
            )
        links, mended = with_parallel_axes(links)
        self._tree.notes += mended
        check_axes(links, self._source)
        given = None if self._spec.regions is None else self._regions(placed)
        hand = Hand(
            self._spec.name or plain_name(Path(self._source).stem),
            with_nominal_servos(links, self._tree),
            {},
            self._spec.description,
            dict(self._spec.sources),
            self._never_touching(placed),
            frames=self._palm_frames(placed),
            **self._spec.pressing(),
        )
        warn_of_units(hand, self._source, is_in_degrees=self._tree.is_in_degrees)
        if self._palm != 0 and self._spec.palm is None:
            warn_of_limbs(self._tree, self._palm, self._source)
        check_limits(hand, self._source)
        hand, cut = with_hollows(
            hand,
            [self._meshes(placed, i) for i in range(len(hand.links))],
            lambda whole: find_regions(whole, self._source) if given is None else given,
        )
        return replace(hand, notes=tuple(dict.fromkeys([*self._tree.notes, *cut])))

    def _meshes(self, placed: dict[int, _PlacedBody], link: int) -> list[trimesh.Trimesh | None]:
        """The meshes of a link's shapes, in its frame."""
        return [
            None if mesh is None else mesh.copy().apply_transform(T)
            for body, T in _parts(placed, link)
            for mesh in self._tree.meshes(body)
        ]

    def _T_body_palm(self) -> Array:
        frame = self._spec.palm_frame
        R = joint_frame(frame.x_axis, frame.y_axis, self._source, "palm_frame")
        return pose(R, np.array(frame.position))

    def _palm_frames(self, placed: dict[int, _PlacedBody]) -> dict[str, Array]:
        """Poses in the palm frame of the whole model, where it is fixed to the palm, and of bodies in it."""
        frames = {self._link_names[body]: at.T_link_body for body, at in placed.items() if at.link == 0}
        T_model_body, body = np.eye(4), self._palm
        while body != 0:
            T_model_body = self._tree.T_parent_body(body) @ T_model_body
            body = self._tree.parents[body]
        above = self._palm
        while above != 0 and (above == self._palm or not self._tree.kinds(above)):
            above = self._tree.parents[above]
        if above == 0:
            frames["model"] = placed[self._palm].T_link_body @ invert(T_model_body)
        return frames

    def _never_touching(self, placed: dict[int, _PlacedBody]) -> tuple[tuple[int, int], ...]:
        """Pairs of links whose bodies with shapes are kept apart by the model, all of them."""
        solid = [body for body in placed if self._tree.shapes(body)]
        apart = set(self._tree.never_touching(solid))
        every: dict[tuple[int, int], bool] = {}
        for i, a in enumerate(solid):
            for b in solid[i + 1 :]:
                first, second = sorted((placed[a].link, placed[b].link))
                if first != second:
                    key = (first, second)
                    every[key] = every.get(key, True) and (a, b) in apart
        pairs = tuple(sorted(pair for pair, kept_apart in every.items() if kept_apart))
        if pairs:
            self._tree.notes.append(
                f"{len(pairs)} of {len(every)} pairs of links never touch, by the model's excludes and bits"
            )
        return pairs

    def _regions(self, placed: dict[int, _PlacedBody]) -> dict[str, HandRegion]:
        bodies = {name: body for body, name in self._link_names.items()}
        out = {}
        for name, entry in (self._spec.regions or {}).items():
            if entry.link not in bodies:
                raise UnknownName(self._source, f"regions.{name}.link", "link", entry.link, bodies)
            at = placed[bodies[entry.link]]
            region = build_region(entry, self._source, f"regions.{name}")
            out[name] = HandRegion(name, at.link, placed_region(region, at.T_link_body))
        return out


def _parts(placed: dict[int, _PlacedBody], link: int) -> list[tuple[int, Array]]:
    """The bodies that went into a link, with their poses in it."""
    return [(body, entry.T_link_body) for body, entry in placed.items() if entry.link == link]
