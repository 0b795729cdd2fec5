"""A hand as a folder of its own for plain MuJoCo, in the manner of mujoco_menagerie.

`<hand>_hand.xml` with the hand, `scene.xml` with floor and light around it, `assets/` with the meshes of its
shapes, `README.md` with its derivation and sources, and `CHANGELOG.md`. Everything is written from the same
`Hand` that the solver uses: equal hands make equal files.
"""

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import trimesh

from ... import __version__
from ...base.files.output_file import write_text
from ...base.numeric.arrays import Array
from ...geometry import Shape, shape_mesh
from ...hands import Actuator, Hand, forward_kinematics
from ..model import add_hand, element, new_model, numbers, section, to_text
from .postures import leaf_links, open_posture, pinch, power_posture
from .readme import changelog, readme

__all__ = ["export_hand", "hand_files"]


def export_hand(hand: Hand, folder: Path, *, sources: str = "") -> list[Path]:
    """Writes the folder; gives the paths of its files.

    Args:
        hand: the hand.
        folder: where to; made where it is missing.
        sources: where the hand's numbers come from, as plain text for the README.

    Raises:
        InputError: a name that a model can't carry.
    """
    paths = []
    for name, text in hand_files(hand, sources=sources).items():
        paths.append(folder / name)
        write_text(paths[-1], text)
    return paths


def hand_files(hand: Hand, *, sources: str = "") -> dict[str, str]:
    """The text of each file by its path in the folder."""
    model = f"{hand.name}_hand.xml"
    assets: dict[str, str] = {}
    return {
        model: _hand_xml(hand, assets),
        "scene.xml": _scene_xml(hand, model),
        "README.md": readme(hand, model, sources),
        "CHANGELOG.md": changelog(hand),
        **assets,
    }


def _hand_xml(hand: Hand, assets: dict[str, str]) -> str:
    root = new_model(f"{hand.name} hand")
    compiler = root.find("compiler")
    assert compiler is not None
    compiler.set("meshdir", "assets")
    _choose_solver(root)
    add_hand(root, hand, compensate_weight=False)
    _write_classes(root, hand)
    for i, link in enumerate(hand.links):
        _part_geoms(root, hand, i, link.shapes, assets)
    _add_sensors(root, hand)
    _add_keyframes(root, hand)
    for empty in [entry for entry in root if entry.tag != "compiler" and not len(entry) and not entry.attrib]:
        root.remove(empty)
    root.insert(0, ET.Comment(f" {hand.name} hand, written by Holdfast {__version__}; see README.md "))
    return to_text(root)


def _choose_solver(root: ET.Element) -> None:
    """Asks for CG: with elliptic cones, Newton broke down under random controls of the Allegro hand."""
    option = section(root, "option")
    option.set("solver", "CG")
    del option.attrib["jacobian"]  # it is Newton that needs a dense one


def _body(root: ET.Element, name: str) -> ET.Element:
    found = root.find(f".//body[@name='{name}']")
    assert found is not None
    return found


def _write_classes(root: ET.Element, hand: Hand) -> None:
    """Splits geoms into classes for looks and for collisions, and names the servos' classes."""
    default = section(root, "default")
    top = default.find("default")
    assert top is not None
    geom = top.find("geom")
    assert geom is not None
    top.remove(geom)
    visual = element(top, "default", class_=f"{hand.name}/visual")
    element(visual, "geom", group="2", contype="0", conaffinity="0", mass="0")
    collision = element(top, "default", class_=f"{hand.name}/collision")
    element(collision, "geom", group="3", condim="4")
    renamed = {"hand": hand.name, "hand/coupled": f"{hand.name}/coupled", **_servo_classes(hand)}
    for child in list(top.findall("default")):
        name = child.get("class", "")
        if name in ("hand/palm", "hand/link_even", "hand/link_odd", "hand/tip"):
            # Colours are looks: they go below the class of what is drawn.
            top.remove(child)
            visual.append(child)
            renamed[name] = f"{hand.name}/{name.removeprefix('hand/')}"
    for entry in root.iter():
        for key in ("class", "childclass"):
            if entry.get(key) in renamed:
                entry.set(key, renamed[entry.get(key, "")])


def _servo_classes(hand: Hand) -> dict[str, str]:
    """Readable names of the classes `hand/servo_<i>`: the last words of their joints' names."""
    joints: dict[Actuator, list[str]] = {}
    for axis in hand.axes:
        if axis.actuator is not None:
            words = joints.setdefault(axis.actuator, [])
            word = axis.name.rpartition("_")[2]
            if word not in words:
                words.append(word)
    names, taken = {}, set[str]()
    for i, words in enumerate(joints.values()):
        name = "_".join(words) if len(words) <= 3 else f"servo_{i}"
        name = f"servo_{i}" if name in taken else name
        taken.add(name)
        names[f"hand/servo_{i}"] = f"{hand.name}/{name}"
    return names


def _part_geoms(
    root: ET.Element, hand: Hand, link: int, shapes: tuple[Shape, ...], assets: dict[str, str]
) -> None:
    """Draws each geom of a link by a mesh of its own, and leaves the exact shape for collisions."""
    name = hand.links[link].name
    body, asset = _body(root, name), section(root, "asset")
    for i, shape in enumerate(shapes):
        geom = body.find(f"geom[@name='{name}/{i}']")
        assert geom is not None
        mesh = f"{name}_{i}"
        assets[f"assets/{mesh}.obj"] = _obj(shape_mesh(shape), mesh)
        known = asset.find(f"mesh[@name='{name}/{i}']")
        if known is None:
            known = element(asset, "mesh")
        known.attrib.clear()
        known.attrib.update(name=mesh, file=f"{mesh}.obj", inertia="convex")
        looks = geom.get("class", "")
        geom.set("class", f"{hand.name}/collision")
        if geom.get("type") == "mesh":
            geom.set("mesh", mesh)
        drawn = ET.Element("geom", {"class": looks, "type": "mesh", "mesh": mesh})
        body.insert(list(body).index(geom), drawn)


def _obj(mesh: trimesh.Trimesh, name: str) -> str:
    """The mesh as Wavefront OBJ, nine digits a number."""
    lines = [f"o {name}"]
    lines += [f"v {numbers(vertex, digits=9)}" for vertex in mesh.vertices]
    lines += ["f " + " ".join(str(int(i) + 1) for i in face) for face in mesh.faces]
    return "\n".join(lines) + "\n"


def _add_sensors(root: ET.Element, hand: Hand) -> None:
    """A touch sensor around the last link of each finger, and the site of the grasp on the palm."""
    root.insert(list(root).index(section(root, "keyframe")), sensors := ET.Element("sensor"))
    for i in leaf_links(hand):
        link = hand.links[i]
        if not link.shapes:
            continue
        points = np.concatenate([shape_mesh(shape).vertices for shape in link.shapes])
        centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
        radius = 1.05 * float(np.linalg.norm(points - centre, axis=1).max())
        site = f"{link.name}_touch"
        element(
            _body(root, link.name),
            "site",
            name=site,
            pos=numbers(centre),
            size=numbers([radius], digits=4),
            group="4",
            rgba="0.85 0.2 0.15 0.3",
        )
        element(sensors, "touch", name=site, site=site)
    element(
        _body(root, hand.links[0].name),
        "site",
        name="grasp_site",
        pos=numbers(_grasp_point(hand)),
        size="0.005",
        group="4",
        rgba="0.2 0.4 0.85 1",
    )


def _grasp_point(hand: Hand) -> Array:
    """Where the hand grasps: between the pads of a pinch, or in the middle of the last links half bent."""
    found = pinch(hand)
    if found is not None:
        return found.centre
    Ts = forward_kinematics(hand, hand.expand(power_posture(hand)))
    tips = leaf_links(hand) or (0,)
    return np.asarray(np.mean([Ts[i][:3, 3] for i in tips], axis=0))


def _add_keyframes(root: ET.Element, hand: Hand) -> None:
    postures = {"open": open_posture(hand), "power": power_posture(hand)}
    found = pinch(hand)
    if found is not None:
        postures["pinch"] = found.q
    for name, q in postures.items():
        key = element(section(root, "keyframe"), "key", name=name)
        key.set("qpos", numbers(hand.expand(q), digits=7))
        key.set("ctrl", numbers(q, digits=7))


def _scene_xml(hand: Hand, model: str) -> str:
    root = ET.Element("mujoco", {"model": f"{hand.name} hand scene"})
    element(root, "include", file=model)
    element(root, "statistic", center="0 0 0.1", extent="0.4")
    visual = element(root, "visual")
    element(visual, "headlight", diffuse="0.6 0.6 0.6", ambient="0.3 0.3 0.3", specular="0 0 0")
    element(visual, "global", azimuth="140", elevation="-20")
    asset = element(root, "asset")
    sky = {"type": "skybox", "builtin": "gradient", "rgb1": "0.93 0.945 0.96", "rgb2": "1 1 1"}
    element(asset, "texture", width="64", height="384", **sky)
    floor = {"type": "2d", "builtin": "checker", "rgb1": "0.86 0.87 0.88", "rgb2": "0.8 0.81 0.82"}
    element(asset, "texture", name="floor", width="300", height="300", **floor)
    element(asset, "material", name="floor", texture="floor", texuniform="true", texrepeat="8 8")
    world = element(root, "worldbody")
    element(world, "light", pos="0 0 1.5", dir="0 0 -1", directional="true")
    element(world, "geom", name="floor", type="plane", pos="0 0 -0.2", size="0 0 0.05", material="floor")
    return to_text(root)
