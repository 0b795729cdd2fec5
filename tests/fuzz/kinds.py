"""Good inputs of every kind that a command reads, and the command that reads them without much work."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import holdfast

from ..pipeline.formats import made
from .goods import (
    HAND,
    MESH_OBJECT,
    MJCF,
    OBJECT,
    PICTURE,
    SYSTEM,
    TASK,
    URDF,
    WHOLE_RUN,
    checkpoint,
    glb,
    grasp_file,
    mesh,
    proof,
    run_record,
    whole_run,
)

__all__ = ["GRASP_FILES", "KINDS", "Kind"]

ROOT = Path(holdfast.__file__).parent
# The middle of the upper face of the box that is written as a mesh, in metres.
_TOP = "0,0,0.0678257"
GRASP_FILES: dict[str, Callable[[], bytes]] = {
    "isaac grasps": made.isaac,
    "graspgen grasps": lambda: made.as_json(made.graspgen()),
    "multigripper grasps": lambda: made.as_json(made.multigripper()),
    "acronym grasps": made.acronym,
    "dexgraspnet grasps": lambda: made.saved(made.dexgraspnet()),
    "bench grasps": lambda: made.saved(made.dexgraspbench()),
    "graspit grasps": made.graspit,
    "simox grasps": made.simox,
    "bare grasps": lambda: made.saved(made.poses()),
}
# What the editor ends with where it may not serve, once all that it is given has been read.
_NO_EDITOR = "the editor needs the package viser"


@dataclass(frozen=True)
class Kind:
    """A kind of input.

    Attributes:
        name: of the file that is damaged.
        good: what it holds.
        words: the command line that reads it; `{}` stands for its path.
        beside: other files that it needs, by name.
        makes: names of files and folders that the command may write.
        codes: exit codes that the good input may end with.
        says: what the command then says on standard error.
    """

    name: str
    good: bytes
    words: tuple[str, ...]
    beside: tuple[tuple[str, bytes], ...] = ()
    makes: tuple[str, ...] = ()
    codes: tuple[int, ...] = (0,)
    says: str = ""


def _on_mesh(words: tuple[str, ...], makes: str, codes: tuple[int, ...] = (0,), says: str = "") -> Kind:
    """A command that is given a mesh in the place of an object or a task, with its unit."""
    figures = ("--mass", "0.1", "--friction", "0.6", "--units", "m", "--scale", "1.0", "--quiet")
    return Kind("thing.stl", mesh("stl"), (*words, *figures), makes=(makes,), codes=codes, says=says)


def _fit(suffix: str) -> Kind:
    """A patch that is fitted to the middle of a flat face."""
    good, at, radius = (glb(), "0.008,0.008,0", "0.004") if suffix == "glb" else (mesh(suffix), _TOP, "0.01")
    words = ("objects", "fit", "{}", "--at", at, "--radius", radius, "--degree", "2", "--quiet")
    return Kind(f"mesh.{suffix}", good, words)


def _grasps_of_others(good: bytes) -> Kind:
    """Grasps of another program, which become those of one more."""
    words = (
        "export",
        "{}",
        "--format",
        "graspgen",
        "--out",
        "out.json",
        "--reading",
        "frame=base",
        "--quiet",
    )
    return Kind("grasps.dat", good, words, makes=("out.json",))


def _kinds() -> dict[str, Callable[[], Kind]]:
    beside_task = (("thing.yaml", OBJECT.encode()),)
    beside_hand = (("claw.xml", MJCF.encode()),)
    beside_run = (("run/media/g01_front.png", PICTURE),)
    picture = ("--out", "shown.png", "--quiet")
    little = ("--contacts", "2", "--budget", "2")
    system = ("system", "{}", "--budget", "0.3", "--workers", "1", "--quiet")
    return {
        "task": lambda: Kind("mine.yaml", TASK.encode(), ("tasks", "{}"), beside_task),
        "object": lambda: Kind("thing.yaml", OBJECT.encode(), ("objects", "{}")),
        "built hand": lambda: Kind("sa.yaml", (ROOT / "hands/data/sa.yaml").read_bytes(), ("hands", "{}")),
        "imported hand": lambda: Kind(
            "claw.yaml", HAND.encode(), ("hands", "{}"), (("claw.xml", MJCF.encode()),)
        ),
        "mjcf": lambda: Kind(
            "claw.xml", MJCF.encode(), ("hands", "claw.yaml"), (("claw.yaml", HAND.encode()),)
        ),
        "urdf": lambda: Kind(
            "claw.xml", URDF.encode(), ("hands", "claw.yaml"), (("claw.yaml", HAND.encode()),)
        ),
        **{suffix: lambda s=suffix: _fit(s) for suffix in ("obj", "stl", "ply", "off", "glb")},
        "system": lambda: Kind("system.json", json.dumps(SYSTEM).encode(), system),
        "grasp": lambda: Kind("grasp.json", grasp_file(), ("clear", "{}")),
        "run": lambda: Kind("run/run.json", run_record(), ("report", "run"), beside_run),
        "picture": lambda: Kind(
            "run/media/g01_front.png", PICTURE, ("report", "run"), (("run/run.json", run_record()),)
        ),
        "proof": lambda: Kind("proof.log", proof(), ("check-proof", "{}")),
        "checkpoint": lambda: Kind(
            "state.ckpt",
            checkpoint(),
            (*system[:1], "system.json", *system[2:], "--checkpoint", "{}", "--resume"),
            (("system.json", json.dumps(SYSTEM).encode()),),
        ),
        "mesh object": lambda: Kind(
            "cast.yaml", MESH_OBJECT.encode(), ("objects", "{}"), (("cast.stl", mesh("stl")),)
        ),
        "mesh of an object": lambda: Kind(
            "cast.stl", mesh("stl"), ("objects", "cast.yaml"), (("cast.yaml", MESH_OBJECT.encode()),)
        ),
        "shown object": lambda: Kind(
            "thing.yaml", OBJECT.encode(), ("show", "{}", *picture), makes=("shown.png",)
        ),
        "shown hand": lambda: Kind(
            "claw.yaml", HAND.encode(), ("show", "{}", *picture), beside_hand, ("shown.png",)
        ),
        "shown task": lambda: Kind(
            "mine.yaml", TASK.encode(), ("show", "{}", *picture), beside_task, ("shown.png",)
        ),
        "shown grasp": lambda: Kind(
            "grasp.json", grasp_file(), ("show", "{}", *picture), makes=("shown.png",)
        ),
        "edited task": lambda: Kind("mine.yaml", TASK.encode(), ("edit", "{}", "--port", "0"), beside_task,
            codes=(2,), says=_NO_EDITOR,
        ),
        "edited mesh": lambda: _on_mesh(("edit", "{}", "--port", "0"), "", (2,), _NO_EDITOR),
        "new hand": lambda: Kind(
            "claw.xml",
            MJCF.encode(),
            ("hands", "new", "new.yaml", "--model", "claw.xml"),
            makes=("new.yaml",),
        ),
        "suggested mesh": lambda: _on_mesh(("suggest", "{}", *little, "--out", "tasks"), "tasks", (0, 4)),
        "run mesh": lambda: _on_mesh(
            ("run", "{}", "--quick", "--candidates", "1", "--workers", "1", *little, "--out", "run"), "run",
            codes=(0, 4),
        ),
        "run task": lambda: Kind(
            "mine.yaml",
            TASK.encode(),
            ("run", "{}", "--quick", "--candidates", "1", "--workers", "1", "--budget", "2", "--quiet",
             "--out", "run"),
            beside_task,
            ("run",),
        ),
        "resumed run": lambda: Kind(
            "run/run.json", whole_run(), (*WHOLE_RUN, "--budget", "2", "--resume"), makes=("run",)
        ),
        **{name: lambda good=good: _grasps_of_others(good()) for name, good in GRASP_FILES.items()},
    }  # fmt: skip


KINDS = _kinds()
"""Makers of the kinds, by name."""
