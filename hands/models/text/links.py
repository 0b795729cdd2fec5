"""How the links of a URDF model hang together; MuJoCo, which compiles it, does not name those at fault."""

import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path

from ....errors import InputError, UnknownName

__all__ = ["MOVING", "add_world", "check_links", "locked_joints", "rest_palm"]

MOVING = ("revolute", "continuous", "prismatic")
_KINDS = (*MOVING, "fixed", "floating", "planar")


def add_world(root: ET.Element) -> None:
    """Gives a URDF model a link for the world where joints name one that is not there, as MuJoCo wants."""
    is_there = any(link.get("name") == "world" for link in root.findall("link"))
    if not is_there and any(_end(joint, "parent") == "world" for joint in root.findall("joint")):
        root.insert(0, ET.Element("link", {"name": "world"}))


def locked_joints(root: ET.Element, path: Path) -> dict[str, float]:
    """Positions (rad or m) of joints whose limits leave them one, which MuJoCo would read as no limits.

    Limits that are both zero are none: exporters write them where nobody said any.

    Raises:
        InputError: limits that exclude each other, naming the joint.
    """
    locked = {}
    for joint in root.findall("joint"):
        limit, name = joint.find("limit"), joint.get("name", "")
        if limit is None or joint.get("type") not in ("revolute", "prismatic"):
            continue
        try:
            lower, upper = (float(limit.get(end, "0")) for end in ("lower", "upper"))
        except ValueError:
            continue  # which MuJoCo refuses
        if lower > upper:
            raise InputError(
                path, f"joint {name}.limit", f"the lower limit {lower:g} is above the upper limit {upper:g}"
            )
        if lower == upper != 0.0:
            locked[name] = lower
    return locked


def check_links(root: ET.Element, path: Path) -> None:
    """Refuses links and joints that make no tree.

    Raises:
        InputError: naming the link or the joint.
    """
    links = [link.get("name", "") for link in root.findall("link")]
    for name, count in Counter(links).items():
        if count > 1:
            raise InputError(path, f"link {name}", f"is there {count} times; give each a name of its own")
    held: dict[str, str] = {}
    for joint in root.findall("joint"):
        name = joint.get("name", "")
        if joint.get("type") not in _KINDS:
            raise InputError(
                path,
                f"joint {name}.type",
                f"is one of {', '.join(_KINDS)}, not {str(joint.get('type'))[:80]!r}",
            )
        for end in ("parent", "child"):
            link = _end(joint, end)
            if link not in links:
                raise UnknownName(path, f"joint {name}.{end}", "link", link, links)
        child = _end(joint, "child")
        if child in held:
            raise InputError(
                path, f"link {child}", f"hangs on two joints, {held[child]} and {name}; one is allowed"
            )
        held[child] = name


def rest_palm(root: ET.Element, palm: str | None, path: Path) -> None:
    """Fixes the floating joints of a URDF model above its palm, which MuJoCo takes at the root alone.

    Unless the palm is named, they are those that carry all joints that move.

    Raises:
        InputError: a floating joint elsewhere.
    """
    joints = root.findall("joint")
    by_child = {_end(joint, "child"): joint for joint in joints}

    def above(link: str) -> list[ET.Element]:
        found = list[ET.Element]()
        while link in by_child and by_child[link] not in found:
            found.append(by_child[link])
            link = _end(by_child[link], "parent")
        return found

    if palm is not None:
        resting = above(palm)
    else:
        moving = [above(_end(joint, "parent")) for joint in joints if joint.get("type") in MOVING]
        resting = [joint for joint in joints if moving and all(joint in chain for chain in moving)]
    for joint in joints:
        if joint.get("type") != "floating":
            continue
        if joint in resting:
            joint.set("type", "fixed")
        elif _end(joint, "parent") != "world":
            raise InputError(
                path,
                f"joint {joint.get('name')}",
                "is floating; that is allowed above the palm alone: name as palm a link that it carries, or "
                f"make it fixed, or take out link {_end(joint, 'child')!r}, which nothing holds",
            )


def _end(joint: ET.Element, which: str) -> str:
    """Name of the parent or child of a joint; empty where it has none."""
    element = joint.find(which)
    return "" if element is None else element.get("link", "")
