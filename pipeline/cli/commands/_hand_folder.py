"""`holdfast hands NAME --mjcf DIR`: a hand as a folder of its own for plain MuJoCo."""

from pathlib import Path

from ....backend import configure
from ....console import emit
from ....hands import HAND_SUFFIXES, load_hand, mirrored
from ....input_file import read_text
from ....library import FILE_SUFFIXES
from ....mjcf.hand_folder import export_hand
from ..catalogue import find_entry

__all__ = ["write_hand"]

_LARGEST_BYTES = 4 * 1024 * 1024


def write_hand(name: str, folder: Path, *, mirror: bool = False) -> None:
    """Writes the folder of a hand by its name or path, or of its mirror image, and prints the paths.

    Raises:
        InputError: no such hand, or a name in it that a model can't carry.
    """
    configure()
    hand = load_hand(name)
    if mirror:
        hand = mirrored(hand)
    source = Path(name) if name.lower().endswith(HAND_SUFFIXES) else find_entry("hand", name).path
    for path in export_hand(hand, folder, sources=_head_comment(source)):
        emit(str(path))


def _head_comment(path: Path) -> str:
    """The comment at the top of a hand file, where it says what its numbers come from."""
    lines = []
    if path.suffix.lower() not in FILE_SUFFIXES:
        return ""
    for line in read_text(path, _LARGEST_BYTES).splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.removeprefix("#").strip())
    return "\n".join(lines)
