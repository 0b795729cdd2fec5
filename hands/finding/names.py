"""Names of fingers: from the words in a model's names, else from where the fingers stand."""

import re
from itertools import combinations

import numpy as np

from ...base.numeric.arrays import Array
from ..hand import Hand
from .fingers import Finger

__all__ = ["name_fingers"]

# What may follow an abbreviation such as FF in rh_FFdistal or ffj1.
_PART = r"(?=distal|middle|prox|knuckle|metacarpal|base|tip|j?\d|_|$)"
_WORDS = {
    "thumb": r"thumb|(?<![a-z])th" + _PART,
    "index": r"index|fore_?finger|pointer|(?<![a-z])ff" + _PART,
    "middle": r"(?<![a-z])middle(?!_?(phalan|link|joint))|(?<![a-z])mf" + _PART,
    "ring": r"(?<![a-z])ring|(?<![a-z])rf" + _PART,
    "little": r"little|pink(y|ie)|small|(?<![a-z])lf" + _PART,
}
_SIDES = {"left": r"left", "right": r"right"}
_ORDER = ("index", "middle", "ring", "little")
# Fingers that bend the same way; a thumb bends another.
_ALIKE = np.cos(np.radians(45.0))


def name_fingers(hand: Hand, fingers: list[Finger], facings: Array) -> list[str]:
    """A name for each finger.

    Args:
        hand: the hand.
        fingers: its fingers.
        facings: (n, 3) mean direction in which each pad looks, in the palm frame.
    """
    found = [_word(hand, finger, _WORDS) for finger in fingers]
    if len(fingers) == 2 and None in found:
        sides = [_word(hand, finger, _SIDES) for finger in fingers]
        if set(sides) == {"left", "right"}:
            return [str(side) for side in sides]
    # A word that several fingers have names none of them.
    words = [word if found.count(word) == 1 else None for word in found]
    thumb = words.index("thumb") if "thumb" in words else _thumb(facings)
    others = [i for i in range(len(fingers)) if i != thumb]
    if None not in words or thumb is None or len(fingers) < 3 or len(others) > len(_ORDER):
        return [word or f"finger_{i + 1}" for i, word in enumerate(words)]
    # Along the row of the other fingers, from the end on whose side the thumb stands.
    bases = np.array([fingers[i].base for i in others])
    row = np.linalg.svd(bases - bases.mean(axis=0))[2][0]
    row *= np.sign((fingers[thumb].base - bases.mean(axis=0)) @ row) or 1.0
    others.sort(key=lambda i: -float(fingers[i].base @ row))
    # What the model calls the thumb, as where a middle finger opposes two others, names nothing else.
    taken = words[thumb]
    names = dict(zip(others, _in_order([words[i] for i in others], taken), strict=True)) | {thumb: "thumb"}
    return [names[i] for i in range(len(fingers))]


def _in_order(words: list[str | None], taken: str | None) -> list[str]:
    """Names of fingers in a row: the words as far as there are any, the others by where they stand."""
    rows = [row for row in combinations(_ORDER, len(words)) if taken not in row] or [_ORDER[: len(words)]]
    agree = [sum(word == name for word, name in zip(words, row, strict=True)) for row in rows]
    said = sum(word is not None for word in words)
    if max(agree) == said:
        return list(rows[agree.index(said)])
    # They stand in another order than fingers do.
    free = [name for name in _ORDER if name not in words and (name != taken or len(words) == len(_ORDER))]
    return [word or free.pop(0) for word in words]


def _word(hand: Hand, finger: Finger, words: dict[str, str]) -> str | None:
    """The one word that names of the finger's links and joints hold, the last link's before the others."""
    for link in finger.links:
        names = [hand.links[link].name, *(axis.name for axis in hand.links[link].axes)]
        found = [word for word, pattern in words.items() if any(re.search(pattern, n.lower()) for n in names)]
        if len(found) == 1:
            return found[0]
    return None


def _thumb(facings: Array) -> int | None:
    """The one finger whose pad looks elsewhere than those of all others, which look alike."""
    n = len(facings)
    if n < 3:
        return None
    alike = facings @ facings.T
    for i in np.argsort(alike.sum(axis=1)):
        others = [j for j in range(n) if j != i]
        if alike[np.ix_(others, others)].min() > _ALIKE and alike[i, others].max() < _ALIKE:
            return int(i)
    return None
