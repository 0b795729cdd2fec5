"""README and changelog of a hand's folder."""

from ... import __version__
from ...hands import Hand

__all__ = ["changelog", "readme"]


def changelog(hand: Hand) -> str:
    """The text of `CHANGELOG.md`."""
    return _CHANGELOG.format(name=hand.name, version=__version__)


def readme(hand: Hand, model: str, sources: str) -> str:
    """The text of `README.md`.

    Args:
        hand: the hand.
        model: name of the file with its model.
        sources: where the hand's numbers come from, as plain text.
    """
    servos = "\n".join(
        f"| `{axis.name}` | {axis.actuator.effort:g} | {axis.actuator.stiffness:g} | "
        f"{axis.actuator.damping:g} | {axis.actuator.armature:g} |"
        for axis in hand.axes
        if axis.actuator is not None
    )
    couplings = "\n".join(
        f"- `{axis.name}` = {axis.coupling.ratio:g} x `{axis.coupling.master}`"
        + (f" + {axis.coupling.offset:g} rad" if axis.coupling.offset else "")
        for axis in hand.axes
        if axis.coupling is not None
    )
    return _README.format(
        name=hand.name,
        model=model,
        description=hand.description or "A hand.",
        servos=servos or "| none | | | | |",
        couplings=couplings or "There are none.",
        coupling_step=_COUPLING_STEP if couplings else "There are no coupled joints.",
        sources=_sources(hand, sources),
        version=__version__,
    )


def _sources(hand: Hand, head: str) -> str:
    """What the hand file says of its numbers, at its head and in its field `sources`."""
    entries = "\n".join(f"- {figure}: {source}" for figure, source in hand.sources.items())
    return (
        "\n\n".join(text for text in (head.strip(), entries) if text)
        or "The hand file says nothing about them."
    )


_CHANGELOG = """# Changelog of the {name} hand

## {version}

- Written by Holdfast {version} from its hand `{name}`.
"""

_COUPLING_STEP = """Coupled joints are equality constraints with `solref` 0.005 s and `solimp` 0.9995. In the
   SA hand they stay within 0.01 deg of where their drivers ask them to be, under 30 N at the tip."""


_README = """# {name} hand (MJCF)

{description}

`{model}` is the hand alone, its palm fixed in the world; `scene.xml` puts it above a floor. Both load with
plain MuJoCo, 3.0 or later. The model asks for the solver CG, as Newton may break down with elliptic cones.

## How it was made

Holdfast {version} wrote this folder from its hand `{name}`, by `holdfast hands {name} --mjcf DIR` (or
with the path of a hand file in place of the name). Nothing in it was edited by hand.

1. Bodies, joints, limits and couplings are those of the hand file. Bodies are called after the links, joints
   and actuators after the axes.
2. The shapes are the convex ones of the hand file. What is drawn (class `{name}/visual`, group 2) are meshes
   in `assets/`; what collides (class `{name}/collision`, group 3) are spheres, capsules, boxes and hulls.
3. Links next to each other, and links that overlap whatever the joints do, are excluded from contact.
4. {coupling_step}
5. Each last link has a touch sensor; `grasp_site` is where the pads meet in a pinch. Keyframes: `open`,
   `pinch` (where two pads can face each other) and `power`.

## Servos

| joint | largest effort, N m or N | gain kp | damping | armature |
|---|---|---|---|---|
{servos}

## Couplings

{couplings}

## Sources

{sources}

## Licence

That of Holdfast (Apache-2.0). What the hand file takes from another model, such as meshes or figures, stays
under that model's licence.
"""
