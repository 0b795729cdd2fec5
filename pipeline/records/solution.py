"""A configuration in its written form, as the solver leaves it; what grasp and run files share.

Every number is in SI units (m, rad, kg, s, N); quaternions are w, x, y, z; poses and contacts are in the palm
frame. A file that is read back counts as untrusted: unknown fields, NaN and impossible values are errors.
"""

import re
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, Field

from ...base.files.fields import Vector3
from ...base.files.file_model import FileModel

__all__ = ["Contact", "Identifier", "ObjectPose", "Solution", "plain_identifier", "to_json"]

# Ids name files, so they must be plain.
_MOST_CHARACTERS = 64
Identifier = Annotated[str, Field(pattern=rf"^[A-Za-z0-9][A-Za-z0-9_-]{{0,{_MOST_CHARACTERS - 1}}}$")]


def plain_identifier(name: str) -> str:
    """An id like this name: characters that ids do not have become `_`; `grasp` where nothing is left."""
    plain = re.sub(r"[^A-Za-z0-9_-]+", "_", name).lstrip("_-")
    return plain[:_MOST_CHARACTERS] or "grasp"


def _is_unit(quaternion: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    if abs(float(np.linalg.norm(quaternion)) - 1.0) > 1e-6:
        raise ValueError("must be a unit quaternion (w, x, y, z)")
    return quaternion


Quaternion = Annotated[tuple[float, float, float, float], AfterValidator(_is_unit)]


class ObjectPose(FileModel):
    """Pose of the object in the palm frame."""

    position: Vector3
    quaternion: Quaternion


class Contact(FileModel):
    """One contact.

    Attributes:
        hand: region of the hand.
        object: region of the object.
        point: point of the object that touches.
        normal: unit outward normal of the object there.
        gap: signed distance between the bodies, the hand's link and the object's part, by the shapes that
            collide; negative where they overlap, by the depth.
        region_gap: distance between the points of the two regions that should touch, which says how well the
            equations hold; None in files of versions that wrote it as `gap`.
        normal_angle: angle between the hand's normal and the reverse of the object's.
        opposed_within_deg: no more than this at the solution that is proved, in degrees; 0 where the normals
            are exactly opposed. None without a proof.
    """

    hand: str
    object: str
    point: Vector3
    normal: Vector3
    gap: float
    region_gap: float | None = None
    normal_angle: float
    opposed_within_deg: float | None = None


class Solution(FileModel):
    """A configuration as the solver leaves it; what `holdfast solve --json` lists.

    Attributes:
        id: unique in its run.
        joints: positions of all joints, coupled ones included.
        object: pose of the object.
        parameters: where on each Bezier patch the contact lies, contact by contact, hand side first.
        contacts: the points that touch.
        certified: whether a true solution is proved to lie within `certified_radius`.
        certified_radius: in the solver's variables (cosines, sines, and lengths in its own unit).
        residual: largest absolute value of the contact equations.
    """

    id: Identifier
    joints: dict[str, float]
    object: ObjectPose
    parameters: list[Annotated[float, Field(ge=0, le=1)]] = []
    contacts: list[Contact]
    certified: bool
    certified_radius: float | None = None
    residual: float

    @property
    def gap(self) -> float:
        """The largest gap between bodies that should touch, in m; 0 where none stand apart."""
        return max((contact.gap for contact in self.contacts if contact.gap > 0.0), default=0.0)


def to_json(record: FileModel) -> dict[str, Any]:
    """The record as plain data."""
    return record.model_dump(mode="json")
