"""What the page says of failures, and how it counts."""

import pytest
from holdfast.pipeline.cli.commands.grasps.run import summary
from holdfast.pipeline.records import Direction, GraspRecord, Limit, RunRecord
from holdfast.pipeline.report import describe
from holdfast.pipeline.report.facts import counts
from holdfast.pipeline.report.why import fault, run_advice, stage_word, tally


@pytest.fixture
def best(run_record: RunRecord) -> GraspRecord:
    return run_record.grasps[0]


def changed(grasp: GraspRecord, **hold: object) -> GraspRecord:
    assert grasp.hold is not None
    return grasp.model_copy(update={"hold": grasp.hold.model_copy(update=hold)})


def test_what_held_has_no_fault(best: GraspRecord) -> None:
    assert fault(best) == ("", "") and stage_word(best, "lift") == "held"


def test_a_failed_test_says_where_and_how(best: GraspRecord) -> None:
    assert best.hold is not None
    slipped = Direction(
        gravity=(0.0, 0.0, -9.81), held=False, outcome="slipped too far", slip=0.012, rotation=0.5
    )
    others = [entry for entry in best.hold.directions if entry.gravity[2] >= 0.0]
    grasp = changed(best, held=False, directions=[slipped, *others])
    what, advice = fault(grasp)
    assert f"1 of {1 + len(others)} failed" in what
    assert "gravity −z: slipped too far (slip 12.0 mm, turn 29°)" in what and advice
    assert stage_word(grasp, "lift") == "gave way" and stage_word(grasp, "press") == "failed"
    limit = Limit(load_factor=0.5, wanted=1.0, friction=0.9, efforts=2.0, words="carries at most half")
    what, advice = fault(changed(grasp, limit=limit))
    assert "carries at most half" in what and "0.90" in advice and "2" in advice


@pytest.mark.parametrize(
    ("outcome", "said"),
    [
        ("slipped too far", "it would pass with limits 1.5 times as wide"),
        ("a contact of the task was lost", "stays within 1.5 times the limits"),
        ("did not get as far as asked", "67 % of that"),
    ],
)
def test_a_near_miss_says_what_it_came_near_to(
    best: GraspRecord, run_record: RunRecord, outcome: str, said: str
) -> None:
    assert best.hold is not None
    first, *others = best.hold.directions
    failed = first.model_copy(update={"held": False, "outcome": outcome})
    for near in (True, False):
        grasp = changed(best, held=False, near_miss=near, directions=[failed, *others])
        assert grasp.is_near_miss is near
        assert (said in fault(grasp)[0]) is near
        assert stage_word(grasp, "lift") == "gave way" + (", narrowly" if near else "")
        assert ("not held, narrowly" in describe(grasp)) is near
        record = run_record.model_copy(update={"grasps": [grasp]})
        assert ("5/6 near miss" in summary(record)) is near
        assert ((("near misses", 1)) in counts(record, "held")) is near


def test_a_squeeze_that_moves_the_object_is_named(best: GraspRecord) -> None:
    what, _ = fault(changed(best, held=False))
    assert what.startswith("The squeeze itself moved the object by")


def test_a_blocked_retraction_names_the_pair(best: GraspRecord) -> None:
    assert best.clearance is not None
    clearance = best.clearance.model_copy(
        update={"status": "failed", "after": -0.0031, "worst_pair": ("palm", "object/blade"), "reason": "so"}
    )
    grasp = best.model_copy(update={"clearance": clearance, "hold": None})
    what, advice = fault(grasp)
    assert "palm and object/blade 3.10 mm inside each other: so" in what and advice
    assert stage_word(grasp, "lift") == "penetrates"


def test_what_was_not_tried_is_told_apart_and_can_go_on(best: GraspRecord, run_record: RunRecord) -> None:
    untried = best.model_copy(update={"clearance": None, "hold": None})
    what, advice = fault(untried)
    assert what.startswith("Not tried") and "--resume" in advice
    record = run_record.model_copy(update={"grasps": [best, untried], "complete": False})
    (line,) = run_advice(record)
    assert line.startswith("1 of 2 configurations were not tried") and "--resume" in line


def test_an_unreachable_grasp_says_what_is_in_the_way(best: GraspRecord) -> None:
    assert best.approach is not None
    approach = best.approach.model_copy(
        update={"reachable": False, "opening": 0.002, "blocking": ("palm", "object/blade")}
    )
    what, _ = fault(best.model_copy(update={"approach": approach}))
    assert "2.00 mm only, stopped by palm and object/blade" in what


def test_the_tally_tells_what_is_to_be_said_against_grasps(run_record: RunRecord, best: GraspRecord) -> None:
    assert best.approach is not None
    count = len(run_record.grasps)

    def of(grasp: GraspRecord, apart_rad: float = 0.1) -> str:
        shifted = [{name: q + k * apart_rad for name, q in grasp.joints.items()} for k in range(count)]
        grasps = [grasp.model_copy(update={"joints": joints}) for joints in shifted]
        return tally(run_record.model_copy(update={"grasps": grasps}), "held")

    assert of(best) == f"{count} of {count} grasps are all three."
    assert of(best, 0.0) == f"{count} of {count} grasps are all three; 1 of them different."
    unreachable = best.model_copy(update={"approach": best.approach.model_copy(update={"reachable": False})})
    assert f"{count} without a way for the fingers" in of(unreachable)
    assert f"{count} of them held narrowly" in of(changed(best, narrow=True))
    assert f"{count} held in less than half of the trials" in of(changed(best, probability=0.2, trials=5))
    assert of(changed(best, held=False)) == ""


def test_advice_counts_what_went_wrong(run_record: RunRecord, best: GraspRecord) -> None:
    assert run_advice(run_record) == []
    untested = changed(best, held=False, directions=[], squeeze=None, reason="too weak")
    lost = run_record.model_copy(
        update={"verdict": "not held", "grasps": [untested, changed(best, held=False)]}
    )
    words = " ".join(run_advice(lost))
    assert "For 1 no squeeze" in words and "1 gave way" in words
    empty = run_record.model_copy(update={"verdict": "undecided", "grasps": []})
    assert "--budget" in " ".join(run_advice(empty))
