"""The card of a data set, for people: what is in it, how it was made, what it can't say."""

from math import degrees
from textwrap import fill
from typing import Any

from ..choice import ChoiceData

__all__ = ["card_text"]

_FILES = """| file | holds |
|---|---|
| `objects.parquet` | an object a row: where it comes from, and its features |
| `candidates.parquet` | a grasp a row: joints by name, pose, features, parts of the splits |
| `outcomes.parquet` | a trial a row: what was drawn, and how it ended |
| `arrays.npz` | the same as arrays, which `holdfast.pipeline.choice.load_dataset` reads |
| `situations.zip` | each grasp with its squeeze, to be simulated again |
| `dataset.json` | schema, features with units and bounds, seeds, settings, versions |
| `croissant.json` | the same for programs, in Croissant's format |"""
_PARTS = "| split | train | valid | test |\n|---|---|---|---|"


def card_text(data: ChoiceData, head: dict[str, Any]) -> str:
    """The card as Markdown, of the arrays and what `dataset.json` says."""
    counts = head["counts"]
    hands = ", ".join(f"`{hand['name']}` ({hand['hash']})" for hand in head["hands"])
    held = data.held.mean(axis=(0, 1))
    shares = ", ".join(f"{share:.0%} at load {load:g}" for load, share in zip(data.loads, held, strict=True))
    splits = [
        f"| by {name} | {parts['train']} | {parts['valid']} | {parts['test']} |"
        for name, parts in head["splits"].items()
    ]
    ranges = head["draw_ranges"]
    blocks = [
        "# Choosing among verified grasps: a data set",
        _paragraph(
            f"""{counts["candidates"]} grasps in {counts["groups"]} situations of choice, of
            {counts["objects"]} objects with the hands {hands}; each tried under {head["draws"]} hidden draws
            at loads {", ".join(map(str, head["loads"]))}, which makes {counts["outcomes"]}
            outcomes. Held: {shares}."""
        ),
        f"Licence: {head['licence']}. Made by Holdfast {head['holdfast']}:",
        f"    {head['command']}",
        "## What is in it",
        _FILES,
        _paragraph(
            """A *situation* (`group_id`) is an object, a hand and the regions that touch. All candidates of
            one were tried under the same draws, so that they can be compared."""
        ),
        "## How it was made",
        _paragraph(
            f"""Every candidate is certified (a true solution of the contact equations is proved to be near),
            clear (no two bodies overlap by more than 0.1 mm) and has a squeeze; it was strengthened for 1.5,
            1 or 0.6 times the weight, or left as it was solved, in turn. An outcome is one test in MuJoCo of
            an object that is not as planned: mass times {_range(ranges["mass"])}, friction times
            {_range(ranges["friction"])}, centre of mass off by up to {ranges["com_share"]:.0%} of the sides,
            the object off by up to {1e3 * ranges["shift_m"]:g} mm along each axis and turned by up to
            {degrees(ranges["angle_rad"]):.1f} deg, all drawn evenly. A candidate that fails at a load is
            taken to fail at larger ones."""
        ),
        "## Splits",
        _paragraph(
            """Candidates in each part. By object, seven, one and two of ten members of each family; by hand,
            the last hand is for tests; by task, the rarest kinds of tasks are."""
        ),
        "\n".join([_PARTS, *splits]),
        "## What it can't say",
        _paragraph(
            """Outcomes are of a simulation: its friction, soft contacts and servos are assumptions, stated in
            `dataset.json`. The draws are even and independent, which no real error is. Objects of families
            are generated; their masses follow from wall thickness and material, not from scales."""
        ),
    ]
    return "\n\n".join(blocks) + "\n"


def _paragraph(text: str) -> str:
    return fill(" ".join(text.split()), 110, break_long_words=False, break_on_hyphens=False)


def _range(pair: list[float]) -> str:
    return f"{pair[0]:g} to {pair[1]:g}"
