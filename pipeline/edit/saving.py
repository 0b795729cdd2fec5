"""A draft as files: a task file, and for a mesh the object file that it needs."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from ...base.files.fields import check_name
from ...base.files.file_paths import name_from, real_path
from ...base.files.input_file import read_input
from ...base.files.output_file import write_text
from ...base.files.yaml_file import read_yaml
from ...errors import InputError
from ...geometry import region_fields
from ...hands import HAND_SUFFIXES
from ...objects import MESH_FORMATS, LiftTest, Task, TurnTest, load_task, with_hand
from ..run_object import GraspRequest, ObjectFiles
from .conditions import fields_of_test, limit_fields, support_fields
from .draft import Draft, Pair

__all__ = ["EditSource", "save_task"]

# As of meshes that are read.
_LARGEST_BYTES = 64 * 1024 * 1024


@dataclass(frozen=True)
class EditSource:
    """What is edited, as the user named it.

    Attributes:
        object: a built-in name, an object file, or a mesh; empty where a task names it.
        hand: a built-in name or a hand file; empty where the task's own is taken.
        task_file: file of the task that is edited, if there is one.
        mass_kg: of a mesh; None for the usual one.
        friction: of a mesh; None for the usual one.
        scale: factor on a mesh's coordinates, if any.
        units: unit of a mesh's coordinates; None for metres.
    """

    object: str = ""
    hand: str = ""
    task_file: Path | None = None
    mass_kg: float | None = None
    friction: float | None = None
    scale: float | None = None
    units: str | None = None

    @property
    def is_mesh(self) -> bool:
        """Whether the object comes from a mesh alone."""
        return self.object.lower().endswith(MESH_FORMATS)

    @property
    def request(self) -> GraspRequest:
        """The mesh with its figures."""
        return GraspRequest(
            self.object,
            self.hand,
            mass_kg=self.mass_kg,
            friction=self.friction,
            scale=self.scale,
            units=self.units,
        )


def save_task(draft: Draft, source: EditSource, folder: Path, name: str, *, overwrite: bool) -> str:
    """Writes the task as `<name>.yaml` into a folder, whole or not at all, and reads it again.

    For a mesh its copy and an object file are written beside it, unless they are there. What the editor does
    not change stays as the file of the task that was edited has it.

    Args:
        draft: what is saved.
        source: where it came from.
        folder: where files are written.
        name: of the task and its file.
        overwrite: whether files that are there may be replaced.

    Returns:
        The reference by which commands load it: the file, and the hand where that lies elsewhere.

    Raises:
        InputError: a name that can't be, a pair that is open, a file that is there already, or one that a
            task file in this folder can't name.
    """
    try:
        check_name(name)
    except ValueError as error:
        raise InputError("edit", "name", str(error)) from None
    task = draft.task(name)
    path = folder / f"{name}.yaml"
    mesh_file = folder / f"{draft.object.name}.yaml" if source.is_mesh else None
    for file in (path, mesh_file):
        # An object file that says the same may stay, whoever wrote it.
        if file is not None and file.exists() and not overwrite and not _is_ours(file, source, draft):
            raise InputError("edit", str(file), "exists: choose another name, or allow to overwrite")
    if mesh_file is not None and path == mesh_file:
        raise InputError("edit", "name", f"{name!r} is the name of the object's file")
    fields, hand = _fields(draft, source, folder)
    if mesh_file is not None:
        if overwrite or not mesh_file.exists():
            ObjectFiles(source.request, folder)
        fields["object"] = mesh_file.name
    fields = {**fields, "name": name, "contacts": [_contact(pair, draft) for pair in draft.pairs]}
    _set_conditions(fields, draft, task)
    if mesh_file is not None and isinstance(task.test, TurnTest):
        # The one part of a mesh is called as the object in its file.
        fields["test"]["parts"] = [read_yaml(mesh_file)["name"]]
    write_text(
        path, yaml.safe_dump(fields, sort_keys=False, allow_unicode=True, width=110, default_flow_style=None)
    )
    reference = with_hand(str(path), hand)
    load_task(reference)  # what can't be read again would be worth nothing
    return reference


def _set_conditions(fields: dict[str, Any], draft: Draft, task: Task) -> None:
    """Limits, test and support, where the draft has changed them."""
    before, hand = draft.opened, draft.hand
    if before is None or not np.array_equal(before.limits, task.limits):
        narrowed = limit_fields(hand.independent_names, task.limits, hand.limits)
        _set(fields, "joint_limits", narrowed or None)
    if task.test != (LiftTest() if before is None else before.test):
        _set(fields, "test", fields_of_test(task.test))
    if task.support is not (None if before is None else before.support):
        _set(fields, "support", None if task.support is None else support_fields(task.support))


def _set(fields: dict[str, Any], name: str, value: Any) -> None:
    if value is None:
        fields.pop(name, None)
    else:
        fields[name] = value


def _is_ours(file: Path, source: EditSource, draft: Draft) -> bool:
    """Whether it is the object file of this very mesh, as an earlier save has left it."""
    if not source.is_mesh or file.stem != draft.object.name:
        return False
    fields = read_yaml(file)
    mesh = file.parent / str(fields.get("mesh", ""))
    figures = {
        "friction": draft.object.friction,
        "mass": float(f"{draft.object.inertia.mass:.6g}"),
        "scale": source.scale,
        "units": source.units,
    }
    return (
        mesh.is_file()
        and all(fields.get(name) == figure for name, figure in figures.items())
        and read_input(mesh, _LARGEST_BYTES) == read_input(Path(source.object), _LARGEST_BYTES)
    )


def _fields(draft: Draft, source: EditSource, folder: Path) -> tuple[dict[str, Any], str | None]:
    """Fields that the pairs have no part in, and a hand to be named beside the file as it lies elsewhere."""
    old: dict[str, Any] = {"name": "", "hand": "", "object": ""}
    beside = None
    if source.task_file is not None:
        old = read_yaml(source.task_file)
        beside = real_path(source.task_file).parent
    own = (str(old["hand"]), beside)
    hand, is_elsewhere = _named(*((source.hand, None) if source.hand else own), folder)
    if not source.is_mesh:
        obj, is_outside = _named(
            *((source.object, None) if source.object else (str(old["object"]), beside)), folder
        )
        if is_outside:
            raise InputError(
                "edit",
                "--save",
                f"from {folder} a file can't name {obj!r}: choose a folder above it, or one below the "
                "current folder if it is below that too",
            )
        old["object"] = obj
    old["hand"] = Path(hand).name if is_elsewhere else hand
    return old, hand if is_elsewhere else None


def _named(name: str, beside: Path | None, folder: Path) -> tuple[str, bool]:
    """How a file in `folder` names a hand or an object, and whether it can't as that lies elsewhere."""
    if not name.lower().endswith(HAND_SUFFIXES):
        return name, False
    path = real_path(beside / name if beside else Path(name))
    named = name_from(folder, path)
    return (str(path), True) if named is None else (named, False)


def _contact(pair: Pair, draft: Draft) -> dict[str, Any]:
    assert pair.object is not None  # `Draft.task` has seen to it
    hand: Any = pair.hand.name
    if draft.hand.regions.get(pair.hand.name) is not pair.hand:  # it stands in the task itself
        hand = {"link": draft.hand.links[pair.hand.link].name, **region_fields(pair.hand.region)}
    inline = draft.object.regions.get(pair.object.name) is not pair.object.region
    obj = region_fields(pair.object.region) if inline else pair.object.name
    room = {} if pair.align_within_deg is None else {"align_within_deg": pair.align_within_deg}
    return {"hand": hand, "object": obj, **room}
