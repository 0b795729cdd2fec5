"""Where links and joint axes are, in balls: over a ball of joint vectors."""

from dataclasses import dataclass

import numpy as np

from ..hands import Hand
from ..solver.interval import Balls

__all__ = ["TrueLinks", "true_links"]


@dataclass(frozen=True, eq=False)
class TrueLinks:
    """Enclosures in the palm frame.

    Attributes:
        rotations: (n_links, 3, 3)
        positions: (n_links, 3) in m.
        origins: (n_joints, 3) a point of every joint's axis, in m.
        directions: (n_joints, 3) unit vectors along the axes.
    """

    rotations: Balls
    positions: Balls
    origins: Balls
    directions: Balls


def true_links(hand: Hand, q: Balls) -> TrueLinks:
    """Enclosures over a ball of the independent joints (n_independent,), in rad or m.

    The directions of axes that a hand gives are unit vectors but for rounding; what counts is the unit vector
    along them.
    """
    joints = hand.coupling_matrix @ q + hand.coupling_offset
    cosines, sines = joints.cosine(), joints.sine()
    axes = Balls.exact(hand.tree.directions).unit()
    turns = _turns(axes, cosines, sines)
    rotations: list[Balls] = []
    positions: list[Balls] = []
    origins, directions = [], []
    k = 0
    for link in hand.links:
        R, p = Balls.exact(link.T_parent_link0[:3, :3]), Balls.exact(link.T_parent_link0[:3, 3])
        if link.parent >= 0:
            R_parent = rotations[link.parent]
            R, p = R_parent @ R, R_parent @ p + positions[link.parent]
        for axis in link.axes:
            along = R @ axes[k]
            origins.append(p)
            directions.append(along)
            if axis.kind == "prismatic":
                p = p + along * joints[k]
            else:
                R = R @ turns[k]
            k += 1
        rotations.append(R)
        positions.append(p)
    none = Balls.exact(np.zeros((0, 3)))
    return TrueLinks(
        Balls.stack(rotations),
        Balls.stack(positions),
        Balls.stack(origins) if origins else none,
        Balls.stack(directions) if directions else none,
    )


def _turns(axes: Balls, cosines: Balls, sines: Balls) -> Balls:
    """Rotations (n, 3, 3) about unit axes (n, 3): c I + s [a]x + (1 - c) a a'."""
    outer = axes[:, :, None] * axes[:, None, :]
    skew = np.zeros((len(axes.mid), 3, 3)), np.zeros((len(axes.mid), 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        for row, column, sign in ((i, j, -1.0), (j, i, 1.0)):
            skew[0][:, row, column] = sign * axes.mid[:, k]
            skew[1][:, row, column] = axes.rad[:, k]
    c, s = cosines[:, None, None], sines[:, None, None]
    return c * np.eye(3) + s * Balls(*skew) + (1.0 - c) * outer
