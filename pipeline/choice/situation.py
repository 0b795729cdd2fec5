"""A situation of choice: a hand, an object and the regions that touch, and how to come by its task again."""

from pathlib import Path
from typing import Any

from ...base.files.file_model import FileModel
from ...base.files.yaml_file import read_yaml
from ...errors import InputError, UnknownName
from ...geometry import RegionSpec, build_region, region_fields
from ...hands import Hand, load_hand
from ...objects import (
    Contact,
    ObjectRegion,
    Task,
    builtin_tasks,
    load_object,
    load_task,
    split_reference,
    with_hand,
)
from ...objects.families import FAMILIES, FAMILY_PREFIX, check_family, family_grasps, is_family
from ..records import fingerprint
from ..suggest import searches

__all__ = [
    "Situation",
    "SituationContact",
    "category",
    "check_reference",
    "find_situation",
    "own_hand",
    "task_of",
]

# Contacts of a family are made for this hand; for others they are looked for.
_FAMILY_HAND = "sa"
# Tries of a search for contacts; in place of a time, so that the same seed finds the same.
_MOST_TRIES = 40
_LONGEST_S = 600.0
_TASK_SUFFIXES = (".yaml", ".yml")


class SituationContact(FileModel):
    """A contact that was looked for: a region of the hand by name, and one of the object by its numbers."""

    hand: str
    object: RegionSpec


class Situation(FileModel):
    """How to come by a task again.

    Attributes:
        object: of what object: `family:mug:17`, a built-in one, a mesh or an object file; or the task itself,
            a built-in one or a task file, if there are no contacts.
        hand: its name, or the path of its file; empty for a task's own.
        contacts: those that were looked for; empty where the object's family or a task names them.
        fingerprint: of the task, by which it is known again.
    """

    object: str
    hand: str
    contacts: list[SituationContact] = []
    fingerprint: str


def find_situation(reference: str, hand: str, *, seed: int = 0) -> tuple[Situation, Task] | None:
    """The situation of an object or a task with a hand, contacts looked for where nobody names them.

    Args:
        reference: as `Situation.object`.
        hand: as `Situation.hand`.
        seed: of the search for contacts.

    Returns:
        It, and its task; None where the hand finds no way to hold the object.

    Raises:
        InputError: an object, a task or a hand that can't be used, or a task without this hand's regions.
    """
    if _names_task(reference) or _has_family_contacts(reference, hand):
        task = load_task(with_hand(reference, hand or None))
        return Situation(object=reference, hand=hand, fingerprint=fingerprint(task)), task
    hand = hand or _FAMILY_HAND
    loaded, obj = load_hand(hand), load_object(reference)
    for search in searches(loaded, obj, None, seed):
        tried = search.tried
        found = search.more(1, budget_s=_LONGEST_S, should_stop=lambda: tried.tasks >= _MOST_TRIES)  # noqa: B023
        if found:
            contacts = [
                SituationContact(
                    hand=contact.hand.name,
                    object=RegionSpec.model_validate(region_fields(contact.object.region)),
                )
                for contact in found[0].task.contacts
            ]
            draft = Situation(object=reference, hand=hand, contacts=contacts, fingerprint="")
            task = _from_contacts(draft, loaded, "situation")
            return draft.model_copy(update={"fingerprint": fingerprint(task)}), task
    return None


def task_of(situation: Situation, source: str | Path) -> Task:
    """The task of a situation.

    Raises:
        InputError: what it names is not there, or is no longer the same.
    """
    if situation.contacts:
        task = _from_contacts(
            situation, load_hand(situation.hand, source=str(source), field="hand"), str(source)
        )
    else:
        task = load_task(with_hand(situation.object, situation.hand or None))
    if fingerprint(task) != situation.fingerprint:
        raise InputError(
            source, "object", f"{situation.object} or hand {situation.hand} is no longer the same"
        )
    return task


def check_reference(reference: str) -> None:
    """Looks whether there is an object, a family or a task of that name.

    Raises:
        InputError: there is none.
    """
    if is_family(reference):  # that a member can be made is known
        family, _, seed = reference.removeprefix(FAMILY_PREFIX).partition(":")
        if seed or family not in FAMILIES:
            check_family(reference, source="objects")
    elif not _names_task(reference):
        load_object(reference, source="objects")


def own_hand(reference: str) -> Hand:
    """The hand of a task, and `sa` for what is no task.

    Raises:
        InputError: a task or an object that can't be used.
    """
    if _names_task(reference):
        return load_task(reference).hand
    return load_hand(_FAMILY_HAND)


def category(reference: str) -> str:
    """What kind of thing it is that a reference names: the family, or the name of the object or the task."""
    if is_family(reference):
        return reference.removeprefix(FAMILY_PREFIX).partition(":")[0]
    return Path(split_reference(reference)[0]).stem


def _names_task(reference: str) -> bool:
    text, _ = split_reference(reference)
    if is_family(text):
        return False
    if text.endswith(_TASK_SUFFIXES):
        content: Any = read_yaml(Path(text))
        return isinstance(content, dict) and "contacts" in content
    return any(text in (name, name.rpartition("/")[2]) for name in builtin_tasks())


def _has_family_contacts(reference: str, hand: str) -> bool:
    return is_family(reference) and hand in ("", _FAMILY_HAND) and bool(family_grasps(reference))


def _from_contacts(situation: Situation, hand: Hand, source: str) -> Task:
    obj = load_object(situation.object, source=source, field="object")
    pairs = []
    for k, contact in enumerate(situation.contacts):
        if contact.hand not in hand.regions:
            raise UnknownName(
                source, f"contacts.{k}.hand", f"region of hand {hand.name}", contact.hand, hand.regions
            )
        region = build_region(contact.object, source, f"contacts.{k}.object")
        pairs.append(Contact(hand.regions[contact.hand], ObjectRegion("inline", region)))
    return Task(name=f"{obj.name}_{hand.name}", hand=hand, object=obj, contacts=tuple(pairs), source=source)
