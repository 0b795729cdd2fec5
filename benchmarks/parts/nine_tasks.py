"""The nine tasks of the paper, in its order."""

__all__ = ["TASKS"]

TASKS = (
    "upholding",
    "handling",
    "incision",
    "lid_lifting",
    "service",
    "transportation",
    "tuning",
    "playing",
    "holding",
)
