"""Finger structures as strings."""

import pytest
from holdfast.hands.structure import parse_structure


@pytest.mark.parametrize(
    ("text", "kinds", "leaders", "freedoms"),
    [
        ("R", "R", [None], 1),
        ("URR", "URR", [None, None, None], 4),
        ("U(RR)", "URR", [None, None, 1], 3),
        ("RU(RR)", "RURR", [None, None, None, 2], 4),
        ("(URR)", "URR", [None, 0, 0], 2),
        ("R(RRR)", "RRRR", [None, None, 1, 1], 2),
        ("UUR", "UUR", [None, None, None], 5),
        ("(RR)(RR)", "RRRR", [None, 0, None, 2], 2),
    ],
)
def test_joints_and_what_drives_them(text, kinds, leaders, freedoms):
    joints = parse_structure(text)
    assert "".join(joint.kind for joint in joints) == kinds
    assert [joint.leader for joint in joints] == leaders
    assert sum(joint.n_axes - (joint.leader is not None) for joint in joints) == freedoms


@pytest.mark.parametrize(
    "text",
    ["", "X", "U(R)", "U(RR", "URR)", "U((RR))", "U RR", "urr", "()", "R" * 9, "(RRRRRR)" * 3, "U(RR)\n"],
)
def test_other_text_is_refused(text):
    with pytest.raises(ValueError, match=r"structure|more than 8"):
        parse_structure(text)
