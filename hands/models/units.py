"""Units that a model's numbers probably have, where no hand has such joints or lengths."""

import warnings

import numpy as np

from ...errors import InputWarning
from ...geometry import shape_mesh
from ..hand import Hand
from ..kinematics import forward_kinematics
from .model_tree import ModelTree

__all__ = ["are_unsaid_radians", "warn_of_radians", "warn_of_units"]

# Hinges that turn by less than this, all of them, have limits in radians that were read as degrees: by 2 pi
# rad a joint turns once around.
_STIFF_RAD = np.radians(2.0 * np.pi) * 1.01
_FEWEST_HINGES = 2
# What hands measure; those in other units are most often refused, as beyond all measure.
_USUAL_M = (0.02, 2.0)


def are_unsaid_radians(tree: ModelTree) -> bool:
    """Whether a model does not say the unit of its angles, and no hinge of it turns if they are degrees."""
    return tree.is_in_degrees and not tree.says_angle and _are_stiff(tree.turns_rad)


def warn_of_radians(tree: ModelTree, source: str) -> str:
    """Warns that angles are read as radians though the model does not say so; returns the words."""
    said = (
        "the model does not say the unit of its angles, and in degrees no joint would turn by more than "
        f"{np.degrees(max(tree.turns_rad)):.1f}: they were read as radians; `angle: degree` in a hand file "
        "that imports it reads them as degrees"
    )
    warnings.warn(InputWarning(source, "import", said), stacklevel=2)
    return said


def _are_stiff(turns_rad: list[float]) -> bool:
    return len(turns_rad) >= _FEWEST_HINGES and 0.0 < max(turns_rad) <= _STIFF_RAD


def warn_of_units(hand: Hand, source: str, *, is_in_degrees: bool) -> None:
    """Warns of joints that hardly turn and of sizes that no hand has, with the likely cause and its remedy.

    Args:
        hand: as it was imported.
        source: the file, for the message.
        is_in_degrees: whether angles of the model were read as degrees, as those of MJCF are unless it says
            otherwise.
    """
    turns = [axis.upper - axis.lower for axis in hand.axes if axis.kind == "revolute"]
    if is_in_degrees and _are_stiff(turns):
        said = (
            f"no joint turns by more than {np.degrees(max(turns)):.1f} degrees: the model's angles are "
            'probably radians; give it <compiler angle="radian"/>, or say `angle: radian` in a hand file '
            "that imports it"
        )
        warnings.warn(InputWarning(source, "import", said), stacklevel=2)
    sizes = [float(np.ptp(shape_mesh(s).bounds, axis=0).max()) for link in hand.links for s in link.shapes]
    origins = forward_kinematics(hand, hand.expand(hand.limits.mean(axis=1)))[:, :3, 3]
    reach = float(np.ptp(origins, axis=0).max())
    size = max(reach, *sizes)
    if not _USUAL_M[0] <= size <= _USUAL_M[1]:
        said = (
            f"the hand is {size:.3g} m large, and hands are {_USUAL_M[0]:g} to {_USUAL_M[1]:g} m: "
            "are the model's lengths in metres, and the scales of its meshes right?"
        )
        warnings.warn(InputWarning(source, "import", said), stacklevel=2)
