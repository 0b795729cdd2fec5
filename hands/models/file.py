"""Hand files that import an MJCF or URDF model, and add names, servos and regions to what it says."""

from typing import Annotated, Literal

from pydantic import Field

from ...base.files.fields import Finite, Name, RegionName, Text, Vector3
from ...base.files.file_model import FileModel
from ..hand_file import HandRegionSpec
from ..joint_file import ActuatorSpec, CoupledSpec
from ..pad_file import PressingSpec

__all__ = ["FrameSpec", "ImportedHandFile"]


class FrameSpec(FileModel):
    """The palm frame in the frame of the palm's body."""

    position: Vector3 = (0.0, 0.0, 0.0)
    x_axis: Vector3 = (1.0, 0.0, 0.0)
    y_axis: Vector3 = (0.0, 1.0, 0.0)


class ImportedHandFile(PressingSpec):
    """A hand file around an MJCF or URDF model.

    Attributes:
        angle: unit of an MJCF model's angles, before what it says itself.
        palm: body of the model that is the palm; what it does not carry is left out.
        link_names: new names of bodies.
        joint_names: new names of joints.
        actuator: servo of joints for which the model has none.
        actuators: servos by (new) name of the joint, before the model's.
        coupled: couplings by (new) name of the joint that follows, before the model's.
        limits: limits in rad or m by (new) name of the joint, before the model's.
        regions: contact regions; found from the model where they are not given.
        mirror: whether the hand is the mirror image of the model.
    """

    name: Name | None = None
    description: Text = ""
    sources: dict[str, Text] = {}
    mirror: bool = False
    model: Annotated[str, Field(alias="import", min_length=1, max_length=1000)]
    angle: Literal["radian", "degree"] | None = None
    palm: Annotated[str, Field(max_length=256)] | None = None
    palm_frame: FrameSpec = FrameSpec()
    link_names: Annotated[dict[str, Name], Field(max_length=200)] = {}
    joint_names: Annotated[dict[str, Name], Field(max_length=200)] = {}
    actuator: ActuatorSpec | None = None
    actuators: Annotated[dict[Name, ActuatorSpec], Field(max_length=200)] = {}
    coupled: Annotated[dict[Name, CoupledSpec], Field(max_length=200)] = {}
    limits: Annotated[dict[Name, tuple[Finite, Finite]], Field(max_length=200)] = {}
    regions: Annotated[dict[RegionName, HandRegionSpec], Field(max_length=1000)] | None = None
