"""MJCF and URDF models as text and meshes, read from where a hand file may look and from nowhere else.

MuJoCo would follow any path that a model names. So includes are put in place and meshes are read here, each
path checked, and the compiler gets a model in memory whose meshes have plain names. What only serves to draw
(materials, textures) is left out.
"""

import os
import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass, field, replace
from itertools import islice
from pathlib import Path
from xml.parsers.expat import ExpatError

from ....base.files.file_paths import folders_open_to, real_path, resolve_beside
from ....base.files.input_file import read_input
from ....base.files.xml_file import parse_xml
from ....errors import InputError
from .links import add_world, check_links, locked_joints, mend_limits, rest_palm
from .mesh_files import MESH_SUFFIXES, STAND_IN, MissingMesh, mesh_places, readable_mesh
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

_LARGEST_XML_BYTES = 16 * 1024 * 1024
_LARGEST_MESH_BYTES = 128 * 1024 * 1024
# Of all files together, for what is included many times grows many times.
_LARGEST_MODEL_BYTES = 256 * 1024 * 1024
_MOST_ELEMENTS = 200_000
_MOST_INCLUDES = 100
_DEEPEST = 200
# How many files below the folder of hand file or model are looked at for a mesh not where the model says.
_MOST_FILES = 20_000
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
    reader = _Reader(hand_file, path)
    root = reader.parse(path)
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
        reader.meshes,
        reader.mesh_paths,
        reader.models,
        reader.missing,
        frozenset(reader.stand_ins),
        reader.locked,
        root.tag == "robot" or any("angle" in compiler.attrib for compiler in root.iter("compiler")),
        tuple(notes),
    )


@dataclass
class _Read:
    """How much was read so far, of all files of a model and of the models that it attaches."""

    files: int = 0
    elements: int = 0
    size_bytes: int = 0

    def another_file(self, path: Path, tag: str) -> None:
        """Counts one that the file `path` includes or attaches."""
        self.files += 1
        if self.files > _MOST_INCLUDES:
            raise InputError(path, tag, f"more than {_MOST_INCLUDES} files are included or attached")


@dataclass
class _Reader:
    """Reads the files of one model; paths stay below the folders that are open to the hand file."""

    hand_file: Path
    path: Path
    meshes: dict[str, bytes] = field(default_factory=dict)
    mesh_paths: dict[str, Path] = field(default_factory=dict)
    missing: dict[str, MissingMesh] = field(default_factory=dict)
    models: dict[str, bytes] = field(default_factory=dict)
    stand_ins: set[str] = field(default_factory=set)
    locked: dict[str, float] = field(default_factory=dict)
    n_elements: int = 0
    _sizes: dict[str, int] = field(default_factory=dict)
    _names: dict[Path, str] = field(default_factory=dict)
    _read: _Read = field(default_factory=_Read)
    _all_meshes: list[Path] | None = None

    def parse(self, path: Path) -> ET.Element:
        """Root of an XML file that is not too large, too deep, or made to grow."""
        text = read_input(path, _LARGEST_XML_BYTES)
        self._read.size_bytes += len(text)
        self._read.elements += text.count(b"<")
        if self._read.size_bytes > _LARGEST_XML_BYTES or self._read.elements > _MOST_ELEMENTS:
            raise InputError(
                path,
                "",
                f"the model has more than {_LARGEST_XML_BYTES // 1024**2} MiB or {_MOST_ELEMENTS} elements, "
                "what it includes counted each time",
            )
        if re.search(rb"<!\s*(DOCTYPE|ENTITY)", text, re.IGNORECASE):
            raise InputError(path, "", "a document type or entities are not accepted")
        try:
            root = parse_xml(text.rstrip(b"\0"))  # some exporters end a file as C ends words
        except ExpatError as error:
            raise InputError(path, f"line {error.lineno}", f"not valid XML: {error}") from None
        except (LookupError, ValueError) as error:  # an encoding that does not exist
            raise InputError(path, "", f"not valid XML: {error}") from None
        layer, depth = [root], 0
        while layer:
            layer, depth = [child for element in layer for child in element], depth + 1
            if depth > _DEEPEST:
                raise InputError(path, "", f"nested deeper than {_DEEPEST} elements")
        return root

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
                named = mesh.attrib["file"]
                mesh.attrib.pop("content_type", None)
                plain = self._mesh(named, folder)
                mesh.set("file", plain)
                if plain in self.missing:
                    _keep_size(mesh)
        notes += self._read_attached(root)
        self._refuse_other_files(root)
        return notes

    def _read_attached(self, root: ET.Element) -> list[str]:
        """Reads the models that this one attaches, and names them plainly; returns what to tell."""
        notes = list[str]()
        for model in [one for asset in root.findall("asset") for one in asset.findall("model")]:
            self._read.another_file(self.path, "model")
            path = self._below(model.get("file", ""))
            reader = replace(self, path=path, stand_ins=set(), _sizes={})
            attached = reader.parse(path)
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
                plain = self._mesh(mesh.attrib["filename"], folder)
                mesh.set("filename", plain)
                if plain in self.missing:
                    _keep_size(mesh)
        ET.SubElement(
            ET.SubElement(root, "mujoco"), "compiler", {"fusestatic": "false", "strippath": "false"}
        )
        return notes

    def _put_includes(self, element: ET.Element, depth: int = 0) -> None:
        if depth > _DEEPEST:
            raise InputError(self.path, "include", f"nested deeper than {_DEEPEST} elements")
        i = 0
        while i < len(element):
            if element[i].tag == "include":
                self._read.another_file(self.path, "include")
                element[i : i + 1] = list(self.parse(self._below(element[i].get("file", ""))))
            else:
                self._put_includes(element[i], depth + 1)
                i += 1

    def _mesh(self, name: str, meshdir: str) -> str:
        """Reads a mesh file and returns the plain name under which the compiler finds it.

        Where there is none that can be read another body stands in: the link may be one that is left out.
        """
        suffix = Path(name).suffix.lower()
        path = self._find_mesh(name, meshdir) if suffix in MESH_SUFFIXES else None
        if path is None:
            plain = f"mesh_{len(self.meshes)}.stl"
            self.meshes[plain] = STAND_IN
            self.missing[plain] = MissingMesh(name, self._missing(name, meshdir))
            return plain
        if path not in self._names:
            data = read_input(path, _LARGEST_MESH_BYTES)
            self._read.size_bytes += len(data)
            if self._read.size_bytes > _LARGEST_MODEL_BYTES:
                raise InputError(
                    self.path, "mesh", f"the meshes take more than {_LARGEST_MODEL_BYTES // 1024**2} MiB"
                )
            data, suffix = readable_mesh(data, suffix, path)
            plain = f"mesh_{len(self.meshes)}{suffix}"
            self._names[path] = plain
            self.meshes[plain], self.mesh_paths[plain] = data, path
        return self._names[path]

    def _missing(self, name: str, meshdir: str) -> InputError:
        """Why a mesh can't be had."""
        if Path(name).suffix.lower() not in MESH_SUFFIXES:
            known = ", ".join(MESH_SUFFIXES)
            return InputError(
                self.path, "mesh", f"{name[:200]!r} is none of the kinds that can be read: {known}"
            )
        places = dict.fromkeys(mesh_places(name, meshdir, self._levels()))
        return InputError(
            self.path,
            f"mesh {name[:200]}",
            f"No such file: looked for from the model's folder at {', '.join(places)[:400]}; "
            "the hand file's folder must hold all of the hand's files",
        )

    def _find_mesh(self, name: str, meshdir: str) -> Path | None:
        """The first of the places of a mesh where there is a file; None where there is none."""
        refusal: InputError | None = None
        for place in mesh_places(name, meshdir, self._levels()):
            try:
                path = self._below(place)
            except InputError as error:  # outside of the folder of the hand file: perhaps it is elsewhere too
                if ":/" not in place and self._leads_out(place):
                    raise
                refusal = refusal or error
                continue
            if path.is_file():
                return path
        alike = self._meshes_ending_with(name)
        if len(alike) == 1:
            return alike[0]
        if refusal is not None:
            raise refusal
        return None

    def _leads_out(self, place: str) -> bool:
        """Whether a path stays below a folder that is open to the hand file, but for a link on its way."""
        written = Path(os.path.normpath(real_path(self.path).parent / place))
        return any(written.is_relative_to(folder) for folder in folders_open_to(self.hand_file))

    def _levels(self) -> int:
        """How many folders above that of the model may be looked into."""
        folder = self.path.parent
        within = [open_ for open_ in folders_open_to(self.hand_file) if folder.is_relative_to(open_)]
        return max(len(folder.relative_to(open_).parts) for open_ in within)

    def _meshes_ending_with(self, name: str) -> list[Path]:
        """Meshes below the folder of hand file or model whose paths end like `name`, capitals or not.

        What begins at the root of a file system, someone else's, is looked for by the longest end that fits.
        """
        parts = [
            part.lower() for part in Path(name.partition("://")[2] or name).parts if part not in ("..", ".")
        ]
        if self._all_meshes is None:
            own = real_path(self.hand_file).parent
            folder = own if self.path.is_relative_to(own) else self.path.parent
            below = islice(folder.rglob("*"), _MOST_FILES)
            self._all_meshes = [
                path for path in below if path.suffix.lower() in MESH_SUFFIXES and not path.is_symlink()
            ]
        lower = {path: [part.lower() for part in path.parts] for path in self._all_meshes}
        for k in range(len(parts) if _is_from_root(name) else min(1, len(parts))):
            end = parts[k:]
            found = [path for path, own in lower.items() if own[-len(end) :] == end and path.is_file()]
            if found:
                return found
        return []

    def _below(self, name: str) -> Path:
        """A path that the model names, which must stay below a folder that is open to the hand file."""
        if Path(name).is_absolute() or ":/" in name:
            raise InputError(self.path, "file", f"{name!r} must be a path below the folder of the hand file")
        target = resolve_beside(self.hand_file, name, f"import: {self.path.name}", beside=self.path)
        if not name:
            raise InputError(self.path, "file", "the name of a file is missing")
        return target

    def _refuse_other_files(self, root: ET.Element) -> None:
        for element in root.iter():
            is_read = element.tag in ("mesh", "model")
            other = not is_read and any(name.startswith("file") for name in element.attrib)
            if other or element.tag in ("extension", "flexcomp"):
                raise InputError(self.path, element.tag, "can't be imported: write the model out without it")


def _has_bodies(root: ET.Element) -> bool:
    return any(next(world.iter("body"), None) is not None for world in root.iter("worldbody"))


def _is_from_root(name: str) -> bool:
    return Path(name).is_absolute() or name.startswith("file:")


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


def _keep_size(mesh: ET.Element) -> None:
    """Takes a stand-in as it is, whatever scale the mesh or its class has: it must not vanish."""
    mesh.set("scale", "1 1 1")


def _drop_drawing(root: ET.Element) -> None:
    """Removes materials, textures and skins, and the attributes that name them."""
    for element in list(root.iter()):
        element.attrib.pop("material", None)
        for child in list(element):
            if child.tag in _DRAWING:
                element.remove(child)
