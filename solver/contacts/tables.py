"""A task's contacts as arrays, as compiled loops take them."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...base.numeric.arrays import Array, Indices, Mask, offsets
from ...geometry import Cap, Patch, PointRegion, Region, perpendicular
from ...hands import KinematicTree
from ...objects import Task

__all__ = ["CAP", "PATCH", "POINT", "ContactTables", "contact_tables", "region_params"]


POINT, PATCH, CAP = 0, 1, 2

# How far inside a cap, or a right angle between facing normals, searches aim, in terms of the cosine.
_COSINE_ROOM = 0.01
# The share of the room for opposed normals that they leave unused.
_ROOM_SHARE = 0.5


class ContactTables(NamedTuple):
    """The hand, and the two sides of every contact: contact by contact, the hand's side first.

    Attributes:
        tree: those links of the hand that carry a contact or a link that does, with their axes.
        coupling: (n_joints, n_q), as `Hand.coupling_matrix`, for the joints of these links.
        coupling_offset: (n_joints,)
        kind: (n_sides,) POINT, PATCH or CAP.
        link: (n_sides,) which of these links a side is fixed on; -1 for the object's.
        first_param: (n_sides,) where a patch's two parameters stand among those of the state.
        point: (n_sides, 3) in the body's frame, in m: a point, or the centre of a cap; not of patches.
        directions: (n_sides, 3, 3) there, in rows: the normal, or the axis of a cap, and two tangents; not of
            patches.
        radius: (n_sides,) of a cap, in m; else 0.
        cos_half_angle: (n_sides,) of a cap; else 0.
        net_start: (n_sides,) where a patch's control points begin.
        net_shape: (n_sides, 2) rows and columns of its net.
        nets: (n, 3) control points of all patches in their bodies' frames, row by row.
        T_fixed: (1, 4, 4) pose of the object in the palm frame where the task fixes it; else (0, 4, 4).
        lower: (n_q + n_params,) lower limits of joints and parameters.
        upper: (n_q + n_params,) upper limits.
        sine_room: (n_contacts,) sine of the angle by which a contact's normals may fail to be opposed; 0
            where equations say that they are.
        aim: (n_inequalities,) how far inside its inequalities a search aims.
        first_row: (n_contacts + 1,) where a contact's equations begin, and last those of a fixed object.
        n_rows: number of equations.
        n_inequalities: number of inequalities.
    """

    tree: KinematicTree
    coupling: Array
    coupling_offset: Array
    kind: Indices
    link: Indices
    first_param: Indices
    point: Array
    directions: Array
    radius: Array
    cos_half_angle: Array
    net_start: Indices
    net_shape: Indices
    nets: Array
    T_fixed: Array
    lower: Array
    upper: Array
    sine_room: Array
    aim: Array
    first_row: Indices
    n_rows: int
    n_inequalities: int


def contact_tables(task: Task, *, exact: bool = False) -> ContactTables:
    """The tables of a task.

    Args:
        task: the task.
        exact: whether normals are exactly opposed even where the task leaves them room.
    """
    links, joints = _moving(task)
    regions = [side.region for contact in task.contacts for side in (contact.hand, contact.object)]
    kind = np.array([_kind(region) for region in regions], dtype=np.int64)
    caps = (kind.reshape(-1, 2) == CAP).sum(axis=1)
    room = np.array([0.0 if exact else contact.align_within_rad for contact in task.contacts])
    first_row = offsets(np.where(room > 0.0, 3, np.array([5, 3, 1])[caps]))
    aims = [_aims(n, angle) for n, angle in zip(caps, room, strict=True)]
    first_param = _param_offsets(kind.tolist())
    n_params = int(first_param[-1])
    nets = [region.patch.control_points for region in regions if isinstance(region, Patch)]
    sizes = [r.patch.control_points[..., 0].size if isinstance(r, Patch) else 0 for r in regions]
    frames = np.array([_frame(region) for region in regions]).reshape(-1, 4, 3)
    fixed = task.T_palm_object
    return ContactTables(
        tree=_part(task.hand.tree, links, joints),
        coupling=task.hand.coupling_matrix[joints],
        coupling_offset=task.hand.coupling_offset[joints],
        kind=kind,
        link=np.array([i for c in task.contacts for i in (links.index(c.hand.link), -1)], dtype=np.int64),
        first_param=first_param[:-1].copy(),
        point=frames[:, 0].copy(),
        directions=frames[:, 1:].copy(),
        radius=np.array([r.radius if isinstance(r, Cap) else 0.0 for r in regions]),
        cos_half_angle=np.array([np.cos(r.half_angle_rad) if isinstance(r, Cap) else 0.0 for r in regions]),
        net_start=offsets(sizes)[:-1].copy(),
        net_shape=np.array([_net_shape(region) for region in regions], dtype=np.int64).reshape(-1, 2),
        nets=np.concatenate([np.zeros((0, 3)), *(net.reshape(-1, 3) for net in nets)]),
        T_fixed=np.zeros((0, 4, 4)) if fixed is None else np.array(fixed, dtype=float).reshape(1, 4, 4),
        lower=np.concatenate([task.limits[:, 0], np.zeros(n_params)]),
        upper=np.concatenate([task.limits[:, 1], np.ones(n_params)]),
        sine_room=np.sin(room),
        aim=np.concatenate(aims),
        first_row=first_row,
        n_rows=int(first_row[-1]) + (0 if fixed is None else 6),
        n_inequalities=sum(map(len, aims)),
    )


def region_params(task: Task) -> list[tuple[slice, slice]]:
    """For each contact which of a state's parameters say where on the hand's and the object's region it is.

    Two of them on a patch, none elsewhere.
    """
    ends = _param_offsets([_kind(side.region) for c in task.contacts for side in (c.hand, c.object)]).tolist()
    sides = [slice(*pair) for pair in pairwise(ends)]
    return list(zip(sides[0::2], sides[1::2], strict=True))


def _param_offsets(kinds: Sequence[int]) -> Indices:
    return offsets(2 * (np.array(kinds, dtype=np.int64) == PATCH))


def _aims(n_caps: int, room_rad: float) -> Array:
    """How far inside its inequalities (k,) a search aims, for one contact: the edge is of little use."""
    cosines = np.full(2 if n_caps == 2 else 1, _COSINE_ROOM)
    return np.append(cosines, _ROOM_SHARE * np.sin(room_rad)) if room_rad > 0.0 else cosines


def _moving(task: Task) -> tuple[list[int], Mask]:
    """Links that carry contacts with all links before them, and which joints (n_joints,) are theirs."""
    tree = task.hand.tree
    links: set[int] = set()
    for contact in task.contacts:
        link = contact.hand.link
        while link >= 0:
            links.add(link)
            link = int(tree.parents[link])
    owner = np.repeat(np.arange(len(tree.parents)), tree.n_axes)
    return sorted(links), np.isin(owner, sorted(links))


def _part(tree: KinematicTree, links: list[int], joints: Mask) -> KinematicTree:
    """The tree of some links, parents included, and of their joints."""
    parents = [links.index(p) if p >= 0 else -1 for p in tree.parents[links]]
    return KinematicTree(
        np.array(parents, dtype=np.int64),
        tree.n_axes[links],
        tree.T_parent_link0[links],
        tree.directions[joints],
        tree.prismatic[joints],
        np.ascontiguousarray(tree.moves[links][:, joints]),
    )


def _kind(region: Region) -> int:
    match region:
        case Patch():
            return PATCH
        case Cap():
            return CAP
        case PointRegion():
            return POINT


def _frame(region: Region) -> Array:
    """Point and directions (4, 3) of a region that has no parameters."""
    match region:
        case Patch():
            return np.zeros((4, 3))
        case Cap():
            return np.vstack([region.centre, region.axis, perpendicular(region.axis)])
        case PointRegion():
            return np.vstack([region.point, region.normal, perpendicular(region.normal)])


def _net_shape(region: Region) -> tuple[int, int]:
    if not isinstance(region, Patch):
        return 0, 0
    rows, columns = region.patch.control_points.shape[:2]
    return rows, columns
