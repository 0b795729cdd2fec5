"""Suggestions as task files."""

from typing import Any

import yaml

from ...base.text.significant import significant
from ...geometry import region_fields
from ...objects import Contact, ObjectRegion, Task
from .suggestion import Suggestion

__all__ = ["task_text"]


def task_text(suggestion: Suggestion, name: str, hand: str, obj: str) -> str:
    """A task file (YAML).

    Args:
        suggestion: what it says.
        name: the task's name.
        hand: name of the hand, or path of its file relative to the task file.
        obj: name of the object, or path of its file relative to the task file.
    """
    quality, task = suggestion.quality, suggestion.task
    head = {
        "name": name,
        "description": (
            f"Suggested: epsilon {significant(quality.epsilon, 3)} N, reach {suggestion.reach:.2f}"
        ),
        "hand": hand,
        "object": obj,
        "contacts": [
            {"hand": _hand_region(task, contact), "object": _region(contact.object), **_room(contact)}
            for contact in task.contacts
        ],
    }
    return yaml.safe_dump(head, sort_keys=False, allow_unicode=True, width=110, default_flow_style=None)


def _hand_region(task: Task, contact: Contact) -> str | dict[str, Any]:
    """The name of a region of the hand, or in place one that it does not have."""
    region = contact.hand
    if region.name in task.hand.regions:
        return region.name
    return {"link": task.hand.links[region.link].name, **region_fields(region.region)}


def _room(contact: Contact) -> dict[str, float]:
    return {} if contact.align_within_deg is None else {"align_within_deg": contact.align_within_deg}


def _region(region: ObjectRegion) -> str | dict[str, Any]:
    return region_fields(region.region) if region.name == "inline" else region.name
