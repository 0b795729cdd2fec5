"""`holdfast tasks`, `holdfast hands`, `holdfast objects`."""

import argparse
from collections.abc import Iterable
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING

from ....errors import InputError
from ...output import emit, format_table
from ..catalogue import entries, find_entry
from ._hand_folder import write_hand

if TYPE_CHECKING:
    from ....hands import Hand
    from ....objects import ObjectModel, Task

__all__ = ["main"]

_FAMILY_ROW = (
    "family:FAMILY:SEED",
    "any number of others, such as family:mug:17; families: bottle, box, cylinder, handle, mug, plate",
)


def main(arguments: argparse.Namespace) -> int:
    """Lists what is built in, or shows one thing in full."""
    kind, name = arguments.kind, arguments.name
    if name is None and kind == "hand" and arguments.mjcf:
        raise InputError("hands", "--mjcf", "needs the NAME of a hand")
    if name is None:
        rows = [(e.name, e.description) for e in entries(kind)]
        emit(format_table(("name", "description"), rows + ([] if kind == "hand" else [_FAMILY_ROW])))
        return 0
    if kind == "hand" and arguments.mjcf:
        write_hand(name, Path(arguments.mjcf))
        return 0
    emit("\n".join(_DETAILS[kind](name)))
    return 0


def _task_lines(name: str) -> Iterable[str]:
    from ....objects import describe_test, load_task

    task: Task = load_task(name)
    yield from _head(task.name, task.description, _where("task", name))
    yield f"hand    {task.hand.name}"
    yield f"object  {task.object.name}"
    yield f"test    {describe_test(task.test)}"
    yield ""
    yield format_table(
        ("hand", "touches"), [(contact.hand.name, contact.object.name) for contact in task.contacts]
    )
    own = task.hand.limits
    narrowed = [
        (joint, f"{lower:.4g}", f"{upper:.4g}")
        for joint, (lower, upper), limits in zip(task.hand.independent_names, task.limits, own, strict=True)
        if (lower, upper) != tuple(limits)
    ]
    if narrowed:
        yield ""
        yield format_table(("joint", "from", "to"), narrowed)


def _hand_lines(name: str) -> Iterable[str]:
    from ....hands import distance_off_surface, load_hand

    hand: Hand = load_hand(name)
    yield from _head(hand.name, hand.description, _where("hand", name))
    yield f"mass    {sum(link.inertia.mass for link in hand.links):.3g} kg"
    yield f"joints  {len(hand.independent)} independent of {len(hand.axes)}"
    yield ""
    yield format_table(
        ("link", "joint", "from", "to", "unit", "driven by"),
        [
            row
            for link in hand.links
            for row in (
                [
                    (
                        link.name if i == 0 else "",
                        axis.name,
                        *_limits(axis.kind, axis.lower, axis.upper),
                        axis.coupling.master if axis.coupling else "",
                    )
                    for i, axis in enumerate(link.axes)
                ]
                or [(link.name, "", "-", "-", "", "")]
            )
        ],
    )
    yield ""
    yield format_table(
        ("region", "link", "kind", "off its surface/mm"),
        [
            (
                key,
                hand.links[r.link].name,
                type(r.region).__name__.lower(),
                f"{1e3 * distance_off_surface(hand, r):.2f}",
            )
            for key, r in hand.regions.items()
        ],
    )
    if hand.sources:
        yield ""
        yield format_table(("figure", "source"), list(hand.sources.items()))


def _limits(kind: str, lower: float, upper: float) -> tuple[str, str, str]:
    if kind == "revolute":
        return f"{degrees(lower):.1f}", f"{degrees(upper):.1f}", "deg"
    return f"{1e3 * lower:.1f}", f"{1e3 * upper:.1f}", "mm"


def _object_lines(name: str) -> Iterable[str]:
    from ....objects import load_object

    obj: ObjectModel = load_object(name)
    yield from _head(obj.name, obj.description, _where("object", name))
    extents = " x ".join(f"{1e3 * side:.1f}" for side in obj.mesh.extents)
    yield f"size      {extents} mm"
    yield f"mass      {1e3 * obj.inertia.mass:.4g} g"
    yield f"centre    {', '.join(f'{1e3 * x:.2f}' for x in obj.inertia.centre)} mm"
    yield f"friction  {obj.friction:g}"
    yield ""
    yield format_table(
        ("part", "pieces", "inflation/%"),
        [(part.name, str(len(part.pieces)), f"{100 * part.inflation:.1f}") for part in obj.parts],
    )
    yield ""
    yield format_table(
        ("region", "kind"), [(key, type(region).__name__.lower()) for key, region in obj.regions.items()]
    )
    if obj.sources:
        yield ""
        yield format_table(("figure", "source"), list(obj.sources.items()))


def _head(name: str, description: str, path: str) -> Iterable[str]:
    yield f"{name}: {description}" if description else name
    yield f"file    {path}"


def _where(kind: str, name: str) -> str:
    if kind == "task":
        from ....objects import split_reference

        name = split_reference(name)[0]
    if name.endswith((".yaml", ".yml")):
        return name
    if name.startswith("family:"):
        return "none: made from its seed"
    if kind == "task" and name not in {entry.name for entry in entries("task")}:
        name = name.partition("/")[2]  # <object>/<task>
    return str(find_entry(kind, name).path)


_DETAILS = {"task": _task_lines, "hand": _hand_lines, "object": _object_lines}
