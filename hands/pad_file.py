"""What hand files of every kind say of a hand's skin and of the forces that its fingers may press with."""

from typing import Annotated, Any

from pydantic import Field, Strict

from ..base.files.fields import Positive
from ..base.files.file_model import FileModel
from .pad import Pad

__all__ = ["PadSpec", "PressingSpec"]

_DEFAULT = Pad()


class PadSpec(FileModel):
    """The pads: elastic modulus in Pa, depth of the soft layer in m."""

    modulus: Annotated[float, Strict(), Field(ge=1e3, le=1e12)] = _DEFAULT.modulus_Pa
    thickness: Annotated[float, Strict(), Field(ge=1e-5, le=0.2)] = _DEFAULT.thickness_m


class PressingSpec(FileModel):
    """Fields that all hand files share.

    Attributes:
        pad: the hand's pads.
        rated_force: normal force in N for which a fingertip is rated; reports put it beside those of a grasp.
        max_normal_force: largest normal force in N that plans may ask of any contact.
    """

    pad: PadSpec = PadSpec()
    rated_force: Positive | None = None
    max_normal_force: Positive | None = None

    def pressing(self) -> dict[str, Any]:
        """The attributes of a `Hand` that these fields give."""
        return {
            "pad": Pad(self.pad.modulus, self.pad.thickness),
            "rated_force_N": self.rated_force,
            "max_normal_force_N": self.max_normal_force,
        }
