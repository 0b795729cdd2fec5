"""Rounds of the solver: where grasps of a run begin."""

import time
from collections.abc import Sequence

import numpy as np

from ...base.text.plain_text import counted
from ...grasping import Starts, solve_for_starts
from ...mjcf import kind_of_test
from ...mjcf.hold import passed_word
from ...solver import Configuration, Progress, pad_misfits
from ...solver.contacts import DistinctStates, spread
from ..records import GraspRecord, Round, RunRecord, SearchStep, Solve, to_state
from .stages import new_grasp
from .statics import refuted_by_statics
from .under_way import RunUnderWay, save, timed

__all__ = ["ask_solver", "wants_more"]

# The solver is asked again, with other seeds, while too few of its configurations survive.
_MOST_ROUNDS = 4
# Where enough hold, but all of them narrowly, one more round tells whether that is the task's way.
_MOST_IF_NARROW = 2
# Configurations nearer to each other than this, by the solver's distance, make the same grasp.
_SAME = 0.02
# Steps of a search that are recorded, and that are kept meanwhile.
_STEPS, _MOST_KEPT = 41, 4096


def wants_more(run: RunUnderWay, record: RunRecord) -> bool:
    """Whether the solver should be asked (again)."""
    if run.is_over or run.gives_up(record):
        return False
    if record.solve is None:
        return True
    rounds = record.solve.rounds
    most = _MOST_ROUNDS if len(record.good) < run.settings.grasps_wanted else _MOST_IF_NARROW
    return _lacks(run, record) != "" and len(rounds) < most and rounds[-1].found > 0


def _lacks(run: RunUnderWay, record: RunRecord) -> str:
    """Why the grasps so far are not enough; empty where they are."""
    wanted, passed = run.settings.grasps_wanted, passed_word(kind_of_test(run.task))
    if len(record.good) < wanted:
        return f"{len(record.good)} of {len(record.grasps)} grasps {passed}, and {wanted} are wanted"
    return f"all that {passed} did so narrowly" if wanted > 0 and not record.firm else ""


def ask_solver(run: RunUnderWay, record: RunRecord) -> RunRecord:
    """A round of the solver: the record with what is new in it."""
    settings, console = run.settings, run.console
    rounds = record.solve.rounds if record.solve else []
    # Rounds far apart, so that runs with neighbouring seeds do not share any.
    seed = settings.seed + 1_000_000 * len(rounds)
    again = f", round {len(rounds) + 1}: {_lacks(run, record)}" if rounds else ""
    console.say(f"solving {record.task}{again}")
    started = time.monotonic()
    steps: list[Progress] = []
    starts = _look(run, seed, steps, is_first=not rounds)
    result = starts.result
    grasps, tried = _with_new(run, record.grasps, starts.configurations)
    entry = Round(
        seed=seed,
        verdict=result.verdict.value,
        seconds=result.seconds,
        boxes=result.boxes,
        lps=result.lps,
        solved=len(result),
        found=len(tried),
        whole=not run.should_stop(),
        spread=spread(tried),
        reason="friction" if result.lacks_friction else None,
        search=_thinned([*steps, result.progress]),
    )
    console.say(
        f"  {entry.verdict}: {entry.solved} solved, {entry.found} of them to be tried; "
        f"{counted(entry.boxes, 'box', 'boxes')}, {counted(entry.lps, 'LP')}, {entry.seconds:.1f} s"
    )
    for misfit in pad_misfits(run.task) if entry.verdict == "infeasible" and not entry.reason else ():
        console.say(f"  {misfit}")
    record = timed(record, "solve", time.monotonic() - started)
    return save(
        run,
        record.model_copy(update={"solve": Solve.of([*rounds, entry], settings.sigma), "grasps": grasps}),
    )


def _look(run: RunUnderWay, seed: int, steps: list[Progress], *, is_first: bool) -> Starts:
    """Configurations to begin at; at first, whether the regions can hold the load at all.

    Args:
        run: for which they are.
        seed: of the round.
        steps: takes how the search goes on.
        is_first: whether nothing was asked before.
    """
    settings, console = run.settings, run.console

    def go_on(progress: Progress) -> None:
        steps.append(progress)
        if len(steps) > _MOST_KEPT:  # of a long search every other step will do
            del steps[::2]
        p = progress
        console.pass_by(
            f"  {p.found} found of {settings.candidates} and more to choose from, {p.boxes} boxes done, "
            f"{p.open} open, {p.seconds:.0f} s"
        )

    if is_first:
        refuted = refuted_by_statics(run.task, settings, run.hold, should_stop=run.should_stop)
        if refuted is not None:
            console.say(f"  {refuted.statics}")
            return Starts(refuted, ())
    run.crew.get_ready(settings.candidates)
    return solve_for_starts(
        run.task,
        count=settings.candidates,
        choice=settings.choice,
        settings=run.hold,
        seed=seed,
        sigma=settings.sigma,
        budget_s=max(1.0, run.remaining_s),
        on_progress=go_on,
        should_stop=run.should_stop,
    )


def _thinned(steps: Sequence[Progress]) -> list[SearchStep]:
    """Some of the steps, about evenly apart by boxes, the last one among them."""
    wanted = np.linspace(0.0, steps[-1].boxes, _STEPS)
    boxes = [step.boxes for step in steps]
    chosen = dict.fromkeys(np.searchsorted(boxes, wanted).tolist())
    return [
        SearchStep(
            boxes=steps[k].boxes, open=steps[k].open, depth=steps[k].depth, decided=round(steps[k].decided, 6)
        )
        for k in chosen
    ]


def _with_new(
    run: RunUnderWay, grasps: list[GraspRecord], starts: Sequence[Configuration]
) -> tuple[list[GraspRecord], list[Configuration]]:
    """The grasps, and behind them the first of the configurations that are none of them; and these."""
    found = list(grasps)
    tried: list[Configuration] = []
    known = DistinctStates(_SAME)
    for grasp in grasps:
        known.keep(to_state(grasp, run.task, run.folder.record_path))
    for configuration in starts:
        if len(tried) < run.settings.candidates and known.add(configuration.state):
            found.append(new_grasp(configuration, f"g{len(found) + 1:02d}"))
            tried.append(configuration)
    return found, tried
