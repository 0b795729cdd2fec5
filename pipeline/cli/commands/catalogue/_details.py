"""The details of a task, a hand or an object, line by line."""

from argparse import Namespace
from collections.abc import Iterable
from math import degrees
from typing import Any

from .....base.text.console import format_table
from .....base.text.significant import significant
from .....geometry import MOST_OFF_M, ConvexSurface, Placement, Region, place_region
from .....hands import HAND_SUFFIXES, Hand, hand_placement, load_hand, mirrored
from .....objects import (
    MESH_FORMATS,
    ObjectModel,
    Part,
    describe_test,
    load_object,
    load_task,
    object_placement,
    split_reference,
)
from ...catalogue import entries, find_entry
from ._as_data import hand_data, object_data, task_data

__all__ = ["details", "details_data"]

_PLACEMENT = ("off surface/mm", "at most/mm", "normals/deg", "in a task")


def details(kind: str, name: str, figures: Namespace) -> Iterable[str]:
    """What there is to say about a `task`, `hand` or `object` by its name or path, or a hand's mirror image.

    Args:
        kind: which of these it is.
        name: name or path.
        figures: of an object that is a mesh, `mass`, `friction`, `scale` and `units`; of a hand, `mirror`.

    Raises:
        InputError: there is none, or its file can't be used.
    """
    if kind == "object":
        return _object_lines(name, figures)
    return _hand_lines(name, figures) if kind == "hand" else _task_lines(name)


def details_data(kind: str, name: str, figures: Namespace) -> dict[str, Any]:
    """The same as plain data."""
    if kind == "object":
        data = object_data(_object(name, figures))
    else:
        data = hand_data(_hand(name, figures)) if kind == "hand" else task_data(load_task(name))
    return {**data, "file": _where(kind, name)}


def _object(name: str, figures: Namespace) -> ObjectModel:
    return load_object(
        name,
        mass_kg=figures.mass,
        friction=figures.friction,
        scale=figures.scale,
        units=figures.units,
    )


def _hand(name: str, figures: Namespace) -> Hand:
    return mirrored(load_hand(name)) if figures.mirror else load_hand(name)


def _task_lines(name: str) -> Iterable[str]:
    task = load_task(name)
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


def _hand_lines(name: str, figures: Namespace) -> Iterable[str]:
    hand = _hand(name, figures)
    yield from _head(hand.name, hand.description, _where("hand", name))
    yield f"mass    {significant(sum(link.inertia.mass for link in hand.links), 3)} kg"
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
        ("region", "link", "kind", *_PLACEMENT),
        [
            (key, hand.links[r.link].name, _kind(r.region), *_placed(r.region, hand_placement(hand, r)))
            for key, r in hand.regions.items()
        ],
    )
    if hand.notes:
        yield ""
        yield "On import:"
        yield from (f"- {note}" for note in hand.notes)
    if hand.sources:
        yield ""
        yield format_table(("figure", "source"), list(hand.sources.items()))


def _limits(kind: str, lower: float, upper: float) -> tuple[str, str, str]:
    if kind == "revolute":
        return f"{degrees(lower):.1f}", f"{degrees(upper):.1f}", "deg"
    return f"{1e3 * lower:.1f}", f"{1e3 * upper:.1f}", "mm"


def _object_lines(name: str, figures: Namespace) -> Iterable[str]:
    obj = _object(name, figures)
    yield from _head(obj.name, obj.description, _where("object", name))
    extents = " x ".join(f"{1e3 * side:.1f}" for side in obj.mesh.extents)
    yield f"size      {extents} mm"
    yield f"mass      {1e3 * obj.inertia.mass:.4g} g"
    yield f"centre    {', '.join(f'{1e3 * x:.2f}' for x in obj.inertia.centre)} mm"
    yield f"friction  {obj.friction:g}"
    yield ""
    yield format_table(
        ("part", "pieces", "inflation/%", "outside/mm", "missing/mm"),
        [
            (part.name, str(len(part.pieces)), f"{100 * part.inflation:.1f}", *_closeness(part))
            for part in obj.parts
        ],
    )
    yield ""
    pieces = ConvexSurface(obj.pieces)
    yield format_table(
        ("region", "kind", "off pieces/mm", *_PLACEMENT),
        [
            (
                key,
                _kind(region),
                f"{1e3 * place_region(region, pieces).off_m:.2f}",
                *_placed(region, object_placement(obj, region)),
            )
            for key, region in obj.regions.items()
        ],
    )
    if obj.sources:
        yield ""
        yield format_table(("figure", "source"), list(obj.sources.items()))


def _kind(region: Region) -> str:
    return type(region).__name__.lower()


def _placed(region: Region, placement: Placement) -> tuple[str, str, str, str]:
    """How far a region lies off its body's surface, how it faces there, and what a task says of that."""
    word = "partly off" if placement.farthest_m > MOST_OFF_M else ""
    if placement.is_off or placement.is_turned:
        word = "off, as meant" if region.off_surface else "refused"
    return (
        f"{1e3 * placement.off_m:.2f}",
        f"{1e3 * placement.farthest_m:.2f}",
        f"{degrees(placement.normal_rad):.0f}",
        word,
    )


def _closeness(part: Part) -> tuple[str, str]:
    """How far pieces stick out of the surface, and the surface out of them, in mm."""
    if part.closeness is None:
        return "-", "-"
    return f"{1e3 * part.closeness.outside_m:.2f}", f"{1e3 * part.closeness.missing_m:.2f}"


def _head(name: str, description: str, path: str) -> Iterable[str]:
    yield f"{name}: {description}" if description else name
    yield f"file    {path}"


def _where(kind: str, name: str) -> str:
    if kind == "task":
        name = split_reference(name)[0]
    if name.lower().endswith((*HAND_SUFFIXES, *MESH_FORMATS)):
        return name
    if name.startswith("family:"):
        return "none: made from its seed"
    if kind == "task" and name not in {entry.name for entry in entries("task")}:
        name = name.partition("/")[2]  # <object>/<task>
    return str(find_entry(kind, name).path)
