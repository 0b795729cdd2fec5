"""Where, when and with what a run was made."""

from ...base.files.file_model import FileModel

__all__ = ["Made"]


class Made(FileModel):
    """What beside task, seed and settings a run may depend on, for whoever makes it again.

    Attributes:
        date: when it was begun, in UTC, as ISO 8601 has it.
        system: operating system and kind of processor.
        processor: name of the processor; empty where the system does not tell.
        cores: that it could use.
        workers: processes that were asked for; grasps do not depend on them.
        budget: wall-clock time after which nothing new is begun, in s.
        versions: of Python and the packages that compute, by name.
    """

    date: str
    system: str
    processor: str = ""
    cores: int
    workers: int
    budget: float
    versions: dict[str, str]
