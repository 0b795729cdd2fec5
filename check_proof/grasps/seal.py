"""A checksum over what the statements of a grasp file speak of, which shows any later change."""

import hashlib
import json
from typing import Any

from ..reading import Rejected

__all__ = ["check_seal"]


def check_seal(record: dict[str, Any]) -> None:
    """Raises Rejected where something was changed after the statements were written."""
    evidence = dict(record["evidence"])
    seal = evidence.pop("seal", None)
    hold, approach = record.get("hold") or {}, record.get("approach") or {}
    try:
        said = {
            "joints": record.get("joints"),
            "object": record.get("object"),
            "parameters": record.get("parameters"),
            "waypoints": approach.get("waypoints"),
            "settings": hold.get("settings"),
            "spin_arms": (hold.get("squeeze") or {}).get("spin_arms"),
            "evidence": evidence,
        }
        text = json.dumps(said, sort_keys=True, separators=(",", ":"))
    except (AttributeError, TypeError, ValueError):
        raise Rejected("the file is damaged") from None
    if seal != hashlib.sha256(text.encode()).hexdigest():
        raise Rejected("the file was changed after the statements were written")
