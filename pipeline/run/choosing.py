"""Which grasps of a run are put to the test first, where a model has learnt to choose."""

from collections.abc import Sequence

from ...grasping import ReadyGrasp
from ..records import Choosing, GraspRecord, RunRecord, to_state
from .attempts import MadeOfState, MakeState, TryState
from .chooser import Chooser
from .ranking import number
from .under_way import RunUnderWay, save

__all__ = ["tests_in_order", "with_tested"]


def tests_in_order(
    run: RunUnderWay, record: RunRecord
) -> tuple[RunRecord, list[tuple[GraspRecord, TryState]]]:
    """The grasps that have no verdict yet with their jobs, as they are to be tested.

    Without a chooser that is the order in which they were found. With one, grasps are made of all that the
    last round of the solver has found, and compared. That is done once: a resumed run goes on in the order
    that is on record, after which comes what was not ready.

    Returns:
        The record, which names what is ready in that order where a model has chosen it; and the tests.
    """
    pending = sorted((grasp for grasp in record.grasps if not grasp.is_done), key=number)
    states = {grasp.id: to_state(grasp, run.task, run.folder.record_path) for grasp in pending}
    if run.settings.chooser is None or not pending:
        return record, [(grasp, TryState(states[grasp.id])) for grasp in pending]
    rivals = _rivals(record)
    known = {} if record.choosing is None else {name: k for k, name in enumerate(record.choosing.ready)}
    if any(grasp.id in known for grasp in rivals):
        chosen = sorted(pending, key=lambda grasp: known.get(grasp.id, len(known)))
        return record, [(grasp, TryState(states[grasp.id])) for grasp in chosen]
    return _chosen(run, record, run.settings.chooser, rivals)


def _rivals(record: RunRecord) -> list[GraspRecord]:
    """What the last round of the solver has found, in the order in which it did."""
    earlier = sum(entry.found for entry in record.solve.rounds[:-1]) if record.solve else 0
    return sorted((grasp for grasp in record.grasps if number(grasp) > earlier), key=number)


def _chosen(
    run: RunUnderWay, record: RunRecord, chooser: Chooser, rivals: Sequence[GraspRecord]
) -> tuple[RunRecord, list[tuple[GraspRecord, TryState]]]:
    """Makes grasps of the rivals and compares them; returns as `tests_in_order` does."""
    jobs = [MakeState(to_state(grasp, run.task, run.folder.record_path)) for grasp in rivals]
    # What is made and not tested is worth nothing: half of the time that is left is for tests.
    enough_s = 0.5 * run.remaining_s
    made: list[MadeOfState | None] = list(
        run.crew.results(jobs, is_over=lambda: run.remaining_s <= enough_s, should_stop=run.should_stop)
    )
    if run.should_stop():
        return record, []
    ready = {k: one.outcome for k, one in enumerate(made) if one and isinstance(one.outcome, ReadyGrasp)}
    scores = dict(zip(ready, chooser.scores(list(ready.values())).tolist(), strict=True))
    # What has become no grasp needs no test, and comes last; before it what there was no time to make.
    order = sorted(range(len(rivals)), key=lambda k: (k not in scores, k < len(made), -scores.get(k, 0.0), k))
    chosen = [rivals[k].id for k in order if k in scores]
    run.console.say(f"  {chooser.policy} chooses among {len(scores)} grasps: {', '.join(chosen)}")
    known = record.choosing or Choosing(policy=chooser.policy, model=chooser.digest)
    known = known.model_copy(update={"ready": [*known.ready, *_not_in(chosen, known.ready)]})
    tests = [
        (rivals[k], TryState(jobs[k].state, made[k] if k < len(made) else None))
        for k in order
        if not rivals[k].is_done
    ]
    return save(run, record.model_copy(update={"choosing": known})), tests


def with_tested(record: RunRecord, name: str) -> RunRecord:
    """The record with what the order has brought once another grasp has its verdict.

    Args:
        record: with the verdict; as it is where no model has chosen.
        name: of the grasp.
    """
    choosing = record.choosing
    if choosing is None:
        return record
    order = [*choosing.order, *_not_in([name], choosing.order)]
    grasps = {grasp.id: grasp for grasp in record.grasps}
    left = {grasp.id for grasp in record.left_untested}
    found = choosing.model_copy(
        update={
            "order": order,
            "spared": len(left.intersection(choosing.ready)),
            "before": _failed_before([grasps[one] for one in order]),
            "before_usually": _failed_before(sorted(record.grasps, key=number)),
        }
    )
    return record.model_copy(update={"choosing": found})


def _not_in(names: Sequence[str], known: Sequence[str]) -> list[str]:
    return [name for name in names if name not in known]


def _failed_before(grasps: Sequence[GraspRecord]) -> int | None:
    """Tests that failed before the first one that was passed; None where that can't be said."""
    failed = 0
    for grasp in grasps:
        if grasp.is_good:
            return failed
        if not grasp.is_done:
            return None
        failed += grasp.hold is not None and not grasp.is_untested
    return None
