"""What a run says of the order in which its grasps were put to the test."""

from ...base.files.fields import Count
from ...base.files.file_model import FileModel
from ...base.text.plain_text import counted
from .solution import Identifier

__all__ = ["Choosing"]


class Choosing(FileModel):
    """A model has chosen which grasps are tested first.

    Attributes:
        policy: its policy's name.
        model: hash of what its choices depend on.
        order: ids of the grasps in the order in which they came to the test.
        ready: ids of the grasps that could be tested, in the order in which the model would have them tested.
        spared: how many of these were not tested, as enough held.
        before: tests that failed before the first one that was passed; None where none was.
        before_usually: the same in the usual order, in which the solver found them; None where none was
            passed, or a grasp that comes before the first one has no verdict.
    """

    policy: str
    model: str
    order: list[Identifier] = []
    ready: list[Identifier] = []
    spared: Count = 0
    before: Count | None = None
    before_usually: Count | None = None

    @property
    def saved(self) -> int | None:
        """Tests that the order has saved on the way to the first pass; negative where it cost some."""
        if self.before is None or self.before_usually is None:
            return None
        return self.before_usually - self.before

    @property
    def words(self) -> str:
        """A line for people."""
        if not self.order:
            return f"chosen by {self.policy}: no test was made"
        if self.before is None:
            return f"chosen by {self.policy}: none of {len(self.order)} passed"
        line = f"chosen by {self.policy}: {_tests(self.before)} failed before the first that was passed"
        if self.saved is not None:
            saved = f"{self.saved} saved" if self.saved >= 0 else f"{-self.saved} more"
            line += f", {self.before_usually} in the usual order: {saved}"
        if self.spared:
            line += f"; {_tests(self.spared)} not made, as enough hold"
        return line


def _tests(count: int) -> str:
    return counted(count, "test") if count else "no test"
