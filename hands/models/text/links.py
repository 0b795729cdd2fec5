"""How the links of a URDF model hang together; MuJoCo, which compiles it, does not name those at fault."""

import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path

from ....errors import InputError, UnknownName

__all__ = ["MOVING", "add_world", "check_links", "locked_joints", "mend_limits", "rest_palm"]

MOVING = ("revolute", "continuous", "prismatic")
_KINDS = (*MOVING, "fixed", "floating", "planar")


def add_world(root: ET.Element) -> list[str]:
    """Gives a URDF model a link for the world where joints name one that is not there, as MuJoCo wants.

    So it stands for the wrist of a hand that was cut off its robot: a link that only joints name, all as
    their parent, and from which everything else hangs. Where a link that is there hangs on nothing too, the
    name is a slip of the pen.

    Returns:
        What was done.
    """
    links = {link.get("name", "") for link in root.findall("link")}
    joints = root.findall("joint")
    parents, children = ({_end(joint, end) for joint in joints} for end in ("parent", "child"))
    missing = {name for name in parents - links - children if name}
    notes = list[str]()
    if len(missing) == 1 and not links - children and "world" not in missing | links:
        notes = [f"link {missing.pop()}, on which all others hang, is not in the model: it became the world"]
        for joint in joints:
            if _end(joint, "parent") not in links:
                joint.find("parent").set("link", "world")  # type: ignore[union-attr]
        missing = {"world"}
    if "world" in missing:
        root.insert(0, ET.Element("link", {"name": "world"}))
    return notes


def mend_limits(root: ET.Element) -> list[str]:
    """Turns limits round whose lower end is written where the upper one belongs; returns what was done."""
    turned = list[str]()
    for joint in root.findall("joint"):
        limit = joint.find("limit")
        if limit is None or "lower" not in limit.attrib or "upper" not in limit.attrib:
            continue
        lower, upper = limit.attrib["lower"], limit.attrib["upper"]
        try:
            is_turned = float(lower) > float(upper)
        except ValueError:
            continue  # which MuJoCo refuses
        if is_turned:
            limit.attrib.update(lower=upper, upper=lower)
            turned.append(f"{joint.get('name', '')} ({lower} to {upper})")
    return [f"limits the wrong way round, turned: {', '.join(turned)}"] if turned else []


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
            one, other = ("lower", "upper") if "upper" not in limit.attrib else ("upper", "lower")
            raise InputError(
                path,
                f"joint {name}.limit",
                f"the lower limit {lower:g} is above the upper limit {upper:g}, for {other} is not there and "
                f"counts as 0; give it beside {one}",
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
