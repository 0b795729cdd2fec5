"""Which known name a slip of the pen stands for, and which words are no slip."""

import random
import string

import pytest
from holdfast.base.text.spelling import nearest_name

COMMANDS = ("run", "solve", "hold", "clear", "show", "suggest", "tasks", "hands", "--help", "--version")
OPTIONS = ("--candidates", "--seed", "--sigma", "--budget", "--hand", "--out", "--quiet", "--first")


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("rnu", "run"),
        ("slove", "solve"),
        ("help", "--help"),
        ("version", "--version"),
        ("Run", "run"),
        ("sugest", "suggest"),
        ("sugg", "suggest"),
        ("hand", "hands"),
        ("halp", "--help"),
        ("frobnicate", None),
        ("grasp", None),
        ("", None),
        ("x", None),
        ("runner", "run"),
        ("runners and others", None),
    ],
)
def test_commands(written: str, meant: str | None) -> None:
    assert nearest_name(written, COMMANDS) == meant


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("--candidate", "--candidates"),
        ("--cand", "--candidates"),
        ("--canddiates", "--candidates"),
        ("--frobnicate", None),
        ("--verbose", None),
        ("--output", "--out"),
        ("--qiuet", "--quiet"),
        ("-budget", "--budget"),
    ],
)
def test_options(written: str, meant: str | None) -> None:
    assert nearest_name(written, OPTIONS) == meant


def test_one_slip_in_a_long_name_is_always_found_and_a_random_word_never() -> None:
    letters = random.Random(0)
    known = ["".join(letters.choices(string.ascii_lowercase, k=letters.randint(6, 14))) for _ in range(200)]
    for name in known:
        i = letters.randrange(len(name) - 1)
        slips = (
            name[:i] + name[i + 1 :],
            name[:i] + "_" + name[i:],
            name[:i] + "_" + name[i + 1 :],
            name[:i] + name[i + 1] + name[i] + name[i + 2 :],
        )
        assert all(nearest_name(slip, known) == name for slip in slips)
    assert nearest_name("0123456789", known) is None


def test_the_number_of_slips_is_symmetric_and_within_its_bounds() -> None:
    from holdfast.base.text.spelling import _slips

    letters = random.Random(1)
    for _ in range(300):
        a, b = ("".join(letters.choices("abc", k=letters.randint(0, 7))) for _ in range(2))
        slips = _slips(a, b, 99)
        assert slips == _slips(b, a, 99)
        assert abs(len(a) - len(b)) <= slips <= max(len(a), len(b))
        assert (slips == 0) == (a == b)


def test_of_names_without_end_the_beginning_is_compared() -> None:
    assert nearest_name("a" * 1_000_000, ["b" * 1_000_000, "a" * 1_000_000]) == "a" * 1_000_000


def test_a_group_too_many_is_taken_away() -> None:
    tasks = ("playing", "tuning", "paper/tuning", "paper/upholding")
    assert nearest_name("paper/playing", tasks) == "playing"
    assert nearest_name("paper/tunign", tasks) == "paper/tuning"
    assert nearest_name("paper/dancing", ("upholding",)) is None
