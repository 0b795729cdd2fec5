"""The model that chooses which grasps are tested first, as options name it."""

from pathlib import Path

from ...run import Chooser

__all__ = ["chooser_of"]


def chooser_of(path: str | None) -> Chooser | None:
    """The chooser of a model file; None where none is named.

    Raises:
        InputError: it can't be used.
    """
    if path is None:
        return None
    from ...choose import ModelChooser  # brings what learning needs, which takes a moment

    return ModelChooser.from_file(Path(path))
