"""What a model would grow to when it is compiled, refused before that where no hand is so large."""

import xml.etree.ElementTree as ET
from pathlib import Path

from ....errors import InputError

__all__ = ["check_size"]

# With what is replicated counted as often as it is made.
_MOST_ELEMENTS = 50_000
_MOST_SAMPLES = 1_000_000
_LARGEST_COUNT = 1_000
# Attributes that say how many numbers to make room for.
_COUNTS = {
    "general": ("actdim", "nsample"),
    "mesh": ("subdivision",),
}


def check_size(root: ET.Element, path: Path, attached: dict[str, int]) -> int:
    """Refuses counts that no hand has.

    Args:
        root: of the model.
        path: its file.
        attached: how many elements the models have that it attaches, by the names it gives them.

    Returns:
        How many elements it has, what is replicated and attached counted each time.

    Raises:
        InputError: naming the element and what is allowed.
    """
    for field in root.iter("hfield"):
        if _product(field, ("nrow", "ncol"), path) > _MOST_SAMPLES:
            raise InputError(path, "hfield", f"has more than {_MOST_SAMPLES} heights")
    for composite in root.iter("composite"):
        if _product(composite, ("count",), path) > _LARGEST_COUNT:
            raise InputError(path, "composite.count", f"makes more than {_LARGEST_COUNT} bodies")
    for tag, names in _COUNTS.items():
        for element in root.iter(tag):
            for name in names:
                _check(element, name, _LARGEST_COUNT, path)
    return _count_made(root, path, attached)


def _count_made(root: ET.Element, path: Path, attached: dict[str, int]) -> int:
    made, layer = 0, [(root, 1)]
    while layer:
        below = []
        for element, times in layer:
            made += times
            if element.tag == "attach":
                made += times * attached.get(element.get("model", ""), 0)
            if element.tag == "replicate":
                times *= max(1, _whole(element, "count", path))
            if made > _MOST_ELEMENTS or times > _MOST_ELEMENTS:
                raise InputError(path, element.tag, f"makes more than {_MOST_ELEMENTS} elements")
            below += [(child, times) for child in element]
        layer = below
    return made


def _check(element: ET.Element, name: str, largest: int, path: Path) -> None:
    if _whole(element, name, path) > largest:
        raise InputError(path, f"{element.tag}.{name}", f"must be at most {largest}")


def _whole(element: ET.Element, name: str, path: Path) -> int:
    return _product(element, (name,), path)


def _product(element: ET.Element, names: tuple[str, ...], path: Path) -> int:
    """The product of whole numbers; what is missing counts as 1."""
    product = 1
    for name in names:
        text = element.get(name, "")
        try:
            for word in text.split():
                product *= max(1, int(float(word)))
        except (ValueError, OverflowError):
            raise InputError(
                path, f"{element.tag}.{name}", f"must be a whole number, not {text[:80]!r}"
            ) from None
    return product
