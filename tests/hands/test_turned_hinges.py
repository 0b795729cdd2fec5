"""Axes that are turned round, and pads that lean: what a model seems to get wrong is warned of."""

import warnings

import pytest
from holdfast.errors import InputWarning
from holdfast.hands import load_hand

from .test_found_regions import BLOCK, finger, model

ROW = {"index": -0.03, "middle": -0.01, "ring": 0.01, "little": 0.03}


def turned_hinges(folder, *turned: str) -> list[str]:
    """What is warned of in a hand of four fingers and a thumb, with the axes of some joints turned round."""
    parts = [
        finger(name, -0.03, -1.0, BLOCK).replace('pos="-0.03 0', f'pos="-0.03 {y}') for name, y in ROW.items()
    ]
    text = model("".join(parts) + finger("thumb", 0.03, 1.0, BLOCK))
    for joint in turned:
        for axis in ("0 1.0 0", "0 -1.0 0"):
            other = "0 -1.0 0" if axis == "0 1.0 0" else "0 1.0 0"
            if f'name="{joint}" axis="{axis}"' in text:
                text = text.replace(f'name="{joint}" axis="{axis}"', f'name="{joint}" axis="{other}"')
                break
        else:
            raise AssertionError(joint)
    (folder / "h.xml").write_text(text, "utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        load_hand(folder / "h.xml")
    return [str(one.message).split("h.xml: ")[1] for one in caught]


@pytest.mark.parametrize(
    ("turned", "words"),
    [
        ((), None),
        (("ring_bend",), "joint ring_bend: bends the other way than the rest of its finger"),
        (("ring_base",), "joint ring_base: bends the other way than the rest of its finger"),
        (("ring_base", "ring_bend"), "joint ring_base: bends the other way than all other fingers"),
        (tuple(f"{name}_bend" for name in (*ROW, "thumb")), None),  # as some hands are built
    ],
)
def test_a_finger_that_bends_against_itself_or_all_others_is_warned_of(tmp_path, turned, words):
    said = turned_hinges(tmp_path, *turned)
    if words is None:
        assert said == []
    else:
        (told,) = said
        assert told.startswith(words) and "is its axis turned round" in told
