"""What the text of a model says beyond what a hand needs, taken out before MuJoCo compiles it.

Other readers of such files pass over it, or take the first of what stands twice; MuJoCo refuses the model, or
warns. Simulators' settings, sensors and key frames say nothing of a hand either, and may name what an older
or newer MuJoCo knows.
"""

import re
import xml.etree.ElementTree as ET

__all__ = ["drop_repeated_meshes", "drop_repeats", "drop_simulation", "without_unknown"]

# Elements of URDF that others have once.
_ONCE = {
    "link": ("inertial",),
    "joint": ("parent", "child", "origin", "axis", "limit", "mimic", "dynamics"),
    "inertial": ("origin", "mass", "inertia"),
    "collision": ("origin", "geometry"),
    "visual": ("origin", "geometry"),
}
_SIMULATION = ("option", "size", "visual", "statistic", "custom", "sensor", "keyframe")
_UNKNOWN = re.compile(r"unrecognized attribute: '([\w.:-]+)'\s+Element '([\w.:-]+)', line (\d+)")


def drop_repeats(root: ET.Element) -> list[str]:
    """Keeps the first of elements that a URDF link or joint has once; returns what was done.

    Names of shapes, which MuJoCo wants to be different, serve nothing and are taken away too.
    """
    dropped = list[str]()
    for link in root.iter("link"):
        for solid in (*link.findall("collision"), *link.findall("visual")):
            solid.attrib.pop("name", None)
    for part in (*root.findall("link"), *root.findall("joint")):
        for element in part.iter():
            for tag in _ONCE.get(element.tag, ()):
                for again in element.findall(tag)[1:]:
                    element.remove(again)
                    dropped.append(f"{tag} of {part.get('name', '')}")
    notes = _number_joints(root)
    if dropped:
        notes.append(f"stands more than once, and the first was taken: {', '.join(dict.fromkeys(dropped))}")
    return notes


def _number_joints(root: ET.Element) -> list[str]:
    """Gives joints of the same name different ones, where MuJoCo would take them away; what was done."""
    names, renamed = {joint.get("name") for joint in root.findall("joint")}, list[str]()
    seen = set[str]()
    for joint in root.findall("joint"):
        name = joint.get("name", "")
        if name and name in seen:
            new = next(other for k in range(2, len(names) + 3) if (other := f"{name}_{k}") not in names)
            joint.set("name", new)
            names.add(new)
            renamed.append(new)
        seen.add(name)
    return [f"joints of the same name, renamed: {', '.join(renamed)}"] if renamed else []


def drop_repeated_meshes(root: ET.Element) -> list[str]:
    """Keeps the first of the meshes of an MJCF model that have one name; returns what was done."""
    seen, dropped = set[str](), list[str]()
    for asset in root.findall("asset"):
        for mesh in asset.findall("mesh"):
            name = mesh.get("name", "")
            if name in seen:
                asset.remove(mesh)
                dropped.append(name)
            seen.add(name)
    named = ", ".join(dict.fromkeys(dropped))
    return [f"meshes of the same name, of which the first was taken: {named}"] if dropped else []


def drop_simulation(root: ET.Element) -> None:
    """Removes settings, sensors and key frames from an MJCF model, but none of its parts."""
    for child in list(root):
        if child.tag in _SIMULATION:
            root.remove(child)


def without_unknown(xml: str, words: str) -> tuple[str, str] | None:
    """A model without the attribute that MuJoCo, by its own words, does not know.

    Args:
        xml: text of the model.
        words: what MuJoCo says.

    Returns:
        The text without it, and what was left out; None where the words are of something else.
    """
    found = _UNKNOWN.search(words)
    if found is None:
        return None
    attribute, tag, line = found[1], found[2], int(found[3]) - 1
    lines = xml.split("\n")
    if not 0 <= line < len(lines):
        return None
    start = re.compile(rf"(<{re.escape(tag)}\b[^<>]*?)\s{re.escape(attribute)}=\"[^\"]*\"")
    lines[line], count = start.subn(r"\1", lines[line], count=1)
    return ("\n".join(lines), f"{attribute} of {tag}") if count else None
