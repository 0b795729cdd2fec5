"""MJCF and URDF models as text and meshes, read from where a hand file may look and from nowhere else.

Includes are put in place and meshes are read, and the compiler gets a model in memory whose meshes have plain
names. What only serves to draw (materials, textures) is left out.
"""

import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass, field, replace
from pathlib import Path

from ....base.files.file_paths import resolve_beside
from ....errors import InputError
from .links import add_world, check_links, locked_joints, mend_limits, rest_palm
from .mesh_files import MissingMesh
from .mesh_shelf import MeshShelf
from .model_files import DEEPEST, ModelFiles
from .repair import (
    check_mimics,
    check_numbers,
    mend_inertials,
    mend_urdf_numbers,
    visuals_as_collisions,
)
from .size import check_size
from .surplus import drop_repeated_meshes, drop_repeats, drop_simulation

__all__ = ["ModelText", "read_model_text"]

# Elements of xacro, from which a processor of its own puts models together.
_XACRO, _EXPRESSION = "xacro:", re.compile(r"\$[({]")
_DRAWING = ("texture", "material", "skin")


@dataclass(frozen=True)
class ModelText:
    """A model that names no file outside itself.

    Attributes:
        xml: MJCF or URDF text.
        meshes: contents of the mesh files, by the names that the text gives them.
        mesh_paths: where these files lie, by the same names.
        models: texts of models that this one attaches, by the names that it gives them.
        missing: meshes that can't be had, by the same names; what the text gets in their place is a stand-in.
        stand_ins: bodies with a mass whose inertia is a stand-in, for the model's is that of no body.
        locked: positions (rad or m) of joints that can't move, by name.
        says_angle: whether it says in what unit its angles are.
        notes: what was mended, for people to read.
    """

    xml: str
    meshes: dict[str, bytes]
    mesh_paths: dict[str, Path]
    models: dict[str, bytes]
    missing: dict[str, MissingMesh]
    stand_ins: frozenset[str]
    locked: dict[str, float]
    says_angle: bool
    notes: tuple[str, ...]


def read_model_text(
    hand_file: Path, name: str, palm: str | None, angle: str | None = None, *, as_drawn: bool = False
) -> ModelText:
    """Reads the model that `import: name` of a hand file names.

    Args:
        hand_file: the hand file, or the model itself.
        name: path of the model from there.
        palm: body that is the palm; None where it is to be found.
        angle: unit of the angles of an MJCF model, `radian` or `degree`; None leaves it to the model.
        as_drawn: whether links of a URDF model that don't collide do so as they are drawn, even if others do.

    Raises:
        InputError: a path out of the folders open to the hand file, an unreadable file, no MJCF or URDF.
    """
    path = resolve_beside(hand_file, name, "import")
    files = ModelFiles(hand_file)
    reader = _Reader(path, files, MeshShelf(files, path))
    root = files.parse(path)
    if root.tag == "robot" and _is_template(root):
        raise InputError(path, "", "is a template in xacro; `xacro FILE > hand.urdf` makes a URDF of it")
    notes = list[str]()
    if root.tag == "mujoco":
        notes += reader.prepare_mjcf(root)
        if not reader.models and not _has_bodies(root):
            raise InputError(
                path, "", "has no bodies: is it a part that another model includes? Name that one"
            )
        if angle is not None:
            _set_angle(root, angle)
    elif root.tag == "mujocoinclude":
        raise InputError(path, "", "is a part that another model includes; name that one")
    elif root.tag == "robot":
        notes += reader.prepare_urdf(root, palm, as_drawn=as_drawn)
    else:
        raise InputError(
            path, "", f"neither MJCF nor URDF: its root is <{root.tag[:40]}>, not <mujoco> or <robot>"
        )
    notes += reader.finish(root)
    return ModelText(
        ET.tostring(root, encoding="unicode"),
        reader.shelf.contents,
        reader.shelf.paths,
        reader.models,
        reader.shelf.missing,
        frozenset(reader.stand_ins),
        reader.locked,
        root.tag == "robot" or any("angle" in compiler.attrib for compiler in root.iter("compiler")),
        tuple(notes),
    )


@dataclass
class _Reader:
    """Reads one model, or one that it attaches; files, meshes and attached models belong to all of them."""

    path: Path
    files: ModelFiles
    shelf: MeshShelf
    models: dict[str, bytes] = field(default_factory=dict)
    stand_ins: set[str] = field(default_factory=set)
    locked: dict[str, float] = field(default_factory=dict)
    n_elements: int = 0
    _sizes: dict[str, int] = field(default_factory=dict)

    def finish(self, root: ET.Element) -> list[str]:
        """Refuses or mends the numbers of a model that was prepared; returns what to tell."""
        check_numbers(root, self.path)
        self.n_elements = check_size(root, self.path, self._sizes)
        stand_ins, notes = mend_inertials(root, self.path)
        self.stand_ins |= stand_ins
        return notes

    def prepare_mjcf(self, root: ET.Element) -> list[str]:
        """Puts includes in place, names meshes plainly and drops what no hand needs; returns what to tell."""
        self._put_includes(root)
        _drop_drawing(root)
        drop_simulation(root)
        folder = ""
        for compiler in root.iter("compiler"):
            folder = compiler.attrib.pop("assetdir", folder)
            folder = compiler.attrib.pop("meshdir", folder)
            for unused in ("texturedir", "strippath"):
                compiler.attrib.pop(unused, None)
        for mesh in root.iter("mesh"):
            if "file" in mesh.attrib:
                mesh.attrib.setdefault("name", Path(mesh.attrib["file"]).stem)
        notes = drop_repeated_meshes(root)
        for mesh in root.iter("mesh"):
            if "file" in mesh.attrib:
                mesh.attrib.pop("content_type", None)
                self._name_plainly(mesh, "file", folder)
        notes += self._read_attached(root)
        self._refuse_other_files(root)
        return notes

    def _read_attached(self, root: ET.Element) -> list[str]:
        """Reads the models that this one attaches, and names them plainly; returns what to tell."""
        notes = list[str]()
        for model in [one for asset in root.findall("asset") for one in asset.findall("model")]:
            path = self.files.other(self.path, model.get("file", ""), "model")
            reader = replace(self, path=path, stand_ins=set(), _sizes={})
            attached = self.files.parse(path)
            if attached.tag != "mujoco":
                raise InputError(
                    path, "", f"is attached, and has to be MJCF: its root is <{attached.tag[:40]}>"
                )
            notes += [*reader.prepare_mjcf(attached), *reader.finish(attached)]
            plain = f"model_{len(self.models)}.xml"
            self.models[plain] = ET.tostring(attached)
            name = model.attrib.setdefault("name", attached.get("model", ""))
            model.attrib.pop("content_type", None)
            model.set("file", plain)
            self._sizes[name] = reader.n_elements
            for place in root.iter("attach"):
                if place.get("model") == name:
                    self.stand_ins |= {place.get("prefix", "") + body for body in reader.stand_ins}
        return notes

    def prepare_urdf(self, root: ET.Element, palm: str | None, *, as_drawn: bool) -> list[str]:
        """Names meshes plainly and asks the compiler to keep fixed links apart; returns what to tell."""
        notes = drop_repeats(root) + mend_urdf_numbers(root) + add_world(root) + mend_limits(root)
        check_links(root, self.path)
        self.locked = locked_joints(root, self.path)
        check_mimics(root, self.path)
        rest_palm(root, palm, self.path)
        _drop_drawing(root)
        folder = ""
        for extension in root.findall("mujoco"):
            for compiler in extension.iter("compiler"):
                folder = compiler.get("meshdir", folder)
            root.remove(extension)
        if visuals_as_collisions(root, is_forced=as_drawn):
            what = "the hand's links have" if as_drawn else "the model has"
            notes.append(f"{what} no collision elements: what it draws collides, as convex hulls")
        for link in root.iter("link"):
            for visual in link.findall("visual"):  # never compiled, and often in formats that MuJoCo lacks
                link.remove(visual)
        for mesh in root.iter("mesh"):
            if "filename" in mesh.attrib:
                self._name_plainly(mesh, "filename", folder)
        ET.SubElement(
            ET.SubElement(root, "mujoco"), "compiler", {"fusestatic": "false", "strippath": "false"}
        )
        return notes

    def _put_includes(self, element: ET.Element, depth: int = 0) -> None:
        if depth > DEEPEST:
            raise InputError(self.path, "include", f"nested deeper than {DEEPEST} elements")
        i = 0
        while i < len(element):
            if element[i].tag == "include":
                path = self.files.other(self.path, element[i].get("file", ""), "include")
                element[i : i + 1] = list(self.files.parse(path))
            else:
                self._put_includes(element[i], depth + 1)
                i += 1

    def _name_plainly(self, mesh: ET.Element, attribute: str, meshdir: str) -> None:
        """Takes a mesh to the shelf, and names it in the text as it is called there."""
        plain = self.shelf.take(mesh.attrib[attribute], meshdir, self.path)
        mesh.set(attribute, plain)
        if plain in self.shelf.missing:
            # The stand-in as it is, whatever scale the mesh or its class has: it must not vanish.
            mesh.set("scale", "1 1 1")

    def _refuse_other_files(self, root: ET.Element) -> None:
        for element in root.iter():
            is_read = element.tag in ("mesh", "model")
            other = not is_read and any(name.startswith("file") for name in element.attrib)
            if other or element.tag in ("extension", "flexcomp"):
                raise InputError(self.path, element.tag, "can't be imported: write the model out without it")


def _has_bodies(root: ET.Element) -> bool:
    return any(next(world.iter("body"), None) is not None for world in root.iter("worldbody"))


def _is_template(root: ET.Element) -> bool:
    """Whether something is left for xacro to do."""
    if any(element.tag.startswith(_XACRO) for element in root.iter()):
        return True
    parts = [part for part in root if part.tag in ("link", "joint")]
    values = [value for part in parts for element in part.iter() for value in element.attrib.values()]
    return any(_EXPRESSION.search(value) for value in values)


def _set_angle(root: ET.Element, angle: str) -> None:
    """Says in what unit the angles of an MJCF model are."""
    for compiler in root.iter("compiler"):
        compiler.attrib.pop("angle", None)
    root.insert(0, ET.Element("compiler", {"angle": angle}))


def _drop_drawing(root: ET.Element) -> None:
    """Removes materials, textures and skins, and the attributes that name them."""
    for element in list(root.iter()):
        element.attrib.pop("material", None)
        for child in list(element):
            if child.tag in _DRAWING:
                element.remove(child)
