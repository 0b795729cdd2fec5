"""A study in words and tables for the terminal."""

from collections.abc import Sequence

from ....base.text.console import format_table
from ....base.text.significant import significant
from ..policies import FORMULA, SPRINGS
from .evaluation import ORACLE, OTHER_DRAWS, Comparison, Standing
from .learning_curve import CurvePoint
from .study import Study

__all__ = ["best_learner", "headline", "load_words", "tables"]

_PLAIN = {"random", "first", SPRINGS, ORACLE, OTHER_DRAWS}


def best_learner(entry: Comparison) -> Standing | None:
    """The policy that has learnt with the most success; None where none has."""
    learned = [
        one for one in entry.standings if one.policy not in _PLAIN and not one.policy.startswith(FORMULA)
    ]
    return max(learned, key=lambda one: one.success.value, default=None)


def headline(study: Study) -> str:
    """The first comparison in a sentence or two."""
    if not study.comparisons:
        return "Nothing in the data could be left out to be tested on."
    entry = study.comparisons[0]
    best = best_learner(entry)
    shown = [
        ("" if best is None else best.policy, best),
        (
            f"the best formula ({(entry.best_formula or '').removeprefix(FORMULA)})",
            _named(entry, entry.best_formula),
        ),
        ("lots", _named(entry, "random")),
        ("the oracle", _named(entry, ORACLE)),
    ]
    words = [f"{words} {one.success.text(100.0, 0)} %" for words, one in shown if one is not None]
    shares = ", ".join(words)
    return f"On an unseen {entry.protocol}, the first choice held under {load_words(entry.load)}: {shares}."


def load_words(load: float) -> str:
    """A multiple of the load in words."""
    if load in (1.0, 2.0):
        return "the load" if load == 1.0 else "twice the load"
    return f"{significant(load, 3)} times the load"


def tables(study: Study) -> str:
    """A table for each comparison, and one of the learning curve."""
    found = [_table(entry) for entry in study.comparisons]
    return "\n".join([*found, _curve_table(study.curve)] if study.curve else found)


def _curve_table(curve: Sequence[CurvePoint]) -> str:
    rows = [
        (
            point.policy,
            significant(point.load, 3),
            f"{point.objects:.0f}",
            point.success.text(100.0, 1),
            point.auc.text(1.0, 2),
        )
        for point in sorted(curve, key=lambda point: (point.load, point.policy, point.objects))
    ]
    table = format_table(("policy", "load", "objects trained on", "first/%", "AUC"), rows)
    return f"learning curve, unseen objects\n\n{table}\n"


def _table(entry: Comparison) -> str:
    head = (
        f"unseen {entry.protocol}, load {significant(entry.load, 3)}: {entry.situations} situations of "
        f"{entry.objects} objects"
    )
    header = ("policy", "first/%", "above formula", "gap/%", "AUC", "before", "saved/%", "Brier")
    rows = [_row(one) for one in sorted(entry.standings, key=lambda one: -one.success.value)]
    return f"{head}\n\n{format_table(header, rows)}\n"


def _row(one: Standing) -> Sequence[str]:
    return (
        one.policy,
        one.success.text(100.0, 1),
        one.above_formula.text(100.0, 1),
        one.gap_closed.text(100.0, 0),
        one.auc.text(1.0, 2),
        one.before.text(1.0, 2),
        one.saved.text(100.0, 0),
        "-" if one.calibration is None else f"{one.calibration.brier:.3f}",
    )


def _named(entry: Comparison, name: str | None) -> Standing | None:
    return next((one for one in entry.standings if one.policy == name), None)
