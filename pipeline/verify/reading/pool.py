"""Files that are read alike, taken together: what one grasp leaves open many decide."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...formats import Grasp, GraspFile

__all__ = ["Pool", "pooled"]


@dataclass(frozen=True, eq=False)
class Pool:
    """Files of one layout.

    Attributes:
        file: all their grasps as one file, with the first one's path.
        origin: (file, index of the grasp in it) of each grasp.
    """

    file: GraspFile
    origin: tuple[tuple[GraspFile, int], ...]


def pooled(files: Sequence[GraspFile]) -> list[Pool]:
    """Files by their layout, in the order of the first of each."""
    groups: dict[object, list[GraspFile]] = {}
    for file in files:
        groups.setdefault(_layout(file), []).append(file)
    return [_together(group) for group in groups.values()]


def _layout(file: GraspFile) -> object:
    shapes = frozenset(_shape(grasp) for grasp in file.grasps)
    return file.format, file.variant, file.unsettled, tuple(sorted(file.settled.items())), shapes


def _shape(grasp: Grasp) -> object:
    joints = grasp.grasp.joints
    scaled = grasp.object.scale is not None
    return (
        scaled,
        grasp.object_pose is not None,
        None if joints is None else (joints.names, len(joints.values)),
    )


def _together(group: list[GraspFile]) -> Pool:
    origin = tuple((file, i) for file in group for i in range(len(file.grasps)))
    grasps = tuple(file.grasps[i] for file, i in origin)
    remarks = tuple(dict.fromkeys(remark for file in group for remark in file.remarks))
    return Pool(replace(group[0], grasps=grasps, remarks=remarks), origin)
