"""What `run.json` says of what a task's contacts can carry."""

from typing import Literal

from ...base.files.fields import Finite
from ...base.files.file_model import FileModel

__all__ = ["CarryingRecord"]


class CarryingRecord(FileModel):
    """What the contacts of a task can carry, whatever the hand does; computed, not proved.

    Attributes:
        multiple: of the weight, each contact at one point: the best of those looked at, or the first found
            that carry what a squeeze is planned for. None where nothing limits it.
        spread: the same with forces spread over the regions; None where nothing limits it.
        limit: what keeps the contacts from carrying what a squeeze is planned for; None where they do.
        forces: largest normal force of each contact in N; None where a palm takes whatever comes.
        friction: between hand and object.
        force_factor: factor on these forces that would do; None where none would, or none is needed.
        friction_needed: friction that would do; None where none up to 2 would, or none is needed.
        instead: contacts that would, as `hand region - object region`; empty where none were found or needed.
            Where these contacts do and yet no grasp of the run has such a plan, they are looked for as well.
        text: all that as a line.
    """

    multiple: Finite | None
    spread: Finite | None
    limit: Literal["finger force", "friction", "the places"] | None
    forces: list[Finite | None]
    friction: Finite
    force_factor: Finite | None = None
    friction_needed: Finite | None = None
    instead: list[str] = []
    text: str = ""
