"""What was not shown."""

from dataclasses import dataclass

__all__ = ["NotCertified"]


@dataclass(frozen=True)
class NotCertified:
    """A statement that was not shown, which says nothing against the grasp.

    Attributes:
        statement: `stable` or `clear`.
        reason: why not.
    """

    statement: str
    reason: str

    def __bool__(self) -> bool:
        """False: it is not certified."""
        return False

    def __str__(self) -> str:
        return f"not certified {self.statement}: {self.reason}"
