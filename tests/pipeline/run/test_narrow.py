"""What a run says of grasps that are held narrowly: exit code, table, lines, page."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from holdfast.objects import load_task
from holdfast.pipeline.cli.commands.grasps.run import exit_code, summary
from holdfast.pipeline.records import FingerFirst, GraspRecord, LessSpin, RunRecord
from holdfast.pipeline.report import describe
from holdfast.pipeline.report.report import render_report
from holdfast.pipeline.run import RunSettings
from holdfast.pipeline.run.rounds import wants_more

SETTINGS = RunSettings(wanted=1)
LOST = FingerFirst(finger="thumb", slip=2e-3, rotation=0.25, kept=False)
SHIFTED = FingerFirst(finger="index", slip=7e-3, rotation=0.01, kept=False)
KEPT = FingerFirst(finger="ring", slip=1e-3, rotation=0.01, kept=True)


def with_fingers(grasp: GraspRecord, *fingers: FingerFirst) -> GraspRecord:
    assert grasp.hold is not None
    found = {"held": True, "fingers": list(fingers), "narrow": not all(entry.kept for entry in fingers)}
    return grasp.model_copy(update={"hold": grasp.hold.model_copy(update=found), "certified": True})


@pytest.fixture
def narrow(run_record: RunRecord) -> RunRecord:
    best = with_fingers(run_record.grasps[0], KEPT, LOST, SHIFTED)
    return run_record.model_copy(update={"grasps": [best], "verdict": "held", "narrow": True})


def test_a_narrow_hold_is_a_hold_but_not_what_a_script_waits_for(narrow: RunRecord) -> None:
    assert narrow.good == narrow.grasps and narrow.firm == []
    assert exit_code(narrow) == 4
    firm = narrow.model_copy(update={"grasps": [with_fingers(narrow.grasps[0], KEPT)], "narrow": False})
    assert firm.firm == firm.grasps and exit_code(firm) == 0
    both = narrow.model_copy(update={"grasps": [*firm.grasps, *narrow.grasps], "narrow": False})
    assert exit_code(both) == 0


def test_the_table_and_the_line_say_so_and_what_it_leans_on(narrow: RunRecord) -> None:
    text = summary(narrow)
    assert "held, narrowly" in text and "1 of them narrowly" in text and "6/6 narrowly" in text
    line = describe(narrow.grasps[0])
    assert "held, narrowly" in line
    turned, moved = line.split("; ")[-2:]
    assert turned == "leans on thumb: where it comes first, the object turns 14 deg"
    assert moved == "leans on index: where it comes first, the object moves 7.0 mm"
    assert "narrowly" not in describe(with_fingers(narrow.grasps[0], KEPT))


def test_a_squeeze_that_moves_the_object_is_said(narrow: RunRecord) -> None:
    hold = narrow.grasps[0].hold
    assert hold is not None and hold.squeeze is not None
    limit = hold.settings["firm_limit_m"]
    assert limit == 0.0015
    for slip, said in ((0.003, True), (0.001, False)):
        squeeze = hold.squeeze.model_copy(update={"slip": slip})
        moved = narrow.grasps[0].model_copy(update={"hold": hold.model_copy(update={"squeeze": squeeze})})
        assert ("leans on its squeeze, which moves the object 3.0 mm" in describe(moved)) == said


@pytest.mark.parametrize(
    ("figures", "says"),
    [
        ({"slip": 0.0036}, "leans on the limits: its load moves the object 3.6 mm"),
        (
            {"slip": 0.001, "rotation": np.radians(8.0)},
            "leans on the limits: its load turns the object 8.0 deg",
        ),
        ({"slip": 0.001, "rotation": np.radians(5.0)}, None),
    ],
)
def test_a_load_that_takes_much_of_a_limit_is_said(
    narrow: RunRecord, figures: dict[str, float], says: str | None
) -> None:
    hold = narrow.grasps[0].hold
    assert hold is not None
    moved = [direction.model_copy(update=figures) for direction in hold.directions]
    line = describe(
        narrow.grasps[0].model_copy(update={"hold": hold.model_copy(update={"directions": moved})})
    )
    assert ("leans on the limits" in line) == (says is not None)
    assert says is None or says in line


def test_leaning_on_spin_is_said(narrow: RunRecord, tmp_path: Path) -> None:
    hold = narrow.grasps[0].hold
    assert hold is not None
    said = "leans on the spin friction of 2 contacts: with 70 % of it the object turns 11 deg"
    for held in (True, False):
        spin = LessSpin(share=0.7, gravity=(0.0, 0.0, 9.81), slip=1e-3, rotation=0.19, held=held)
        grasp = narrow.grasps[0].model_copy(update={"hold": hold.model_copy(update={"less_spin": spin})})
        assert (said in describe(grasp)) is not held
        page = render_report(load_task("upholding"), narrow.model_copy(update={"grasps": [grasp]}), tmp_path)
        line = "With 70 % of the spin friction: slip 1.00 mm, turn 10.9°"
        assert line + ("." if held else ", not held.") in " ".join(page.split())


def test_the_page_shows_each_finger(narrow: RunRecord, tmp_path: Path) -> None:
    html = " ".join(render_report(load_task("upholding"), narrow, tmp_path).split())
    assert "<b>1</b><span>narrowly</span>" in html
    assert "leans on thumb: where it comes first" in html
    assert '<td>ring</td><td class="n">1.00</td><td class="n">0.6</td><td>stays</td>' in html
    assert '<td>index</td><td class="n">7.00</td><td class="n">0.6</td><td>too far</td>' in html


def test_a_grasp_that_was_not_tried_so_is_not_narrow(run_record: RunRecord) -> None:
    grasp = run_record.grasps[0]
    assert grasp.hold is not None
    untried = grasp.model_copy(update={"hold": grasp.hold.model_copy(update={"narrow": None, "fingers": []})})
    assert not untried.is_narrow


def test_one_more_round_is_made_where_all_that_hold_do_so_narrowly(narrow: RunRecord) -> None:
    assert narrow.solve is not None
    task = load_task("upholding")

    def goes_on(record: RunRecord, rounds: int) -> bool:
        run = SimpleNamespace(is_over=False, gives_up=lambda _: False, settings=SETTINGS, task=task)
        solve = record.solve.model_copy(update={"rounds": record.solve.rounds[:1] * rounds})
        return wants_more(run, record.model_copy(update={"solve": solve}))

    assert [goes_on(narrow, rounds) for rounds in (1, 2, 3)] == [True, False, False]
    firm = narrow.model_copy(update={"grasps": [with_fingers(narrow.grasps[0], KEPT)]})
    assert not goes_on(firm, 1)
    lost = narrow.model_copy(update={"grasps": []})
    assert [goes_on(lost, rounds) for rounds in (1, 3, 4)] == [True, True, False]


def test_a_terminal_shows_the_best_of_very_many_grasps(narrow: RunRecord) -> None:
    many = [narrow.grasps[0].model_copy(update={"id": f"g{k:04d}"}) for k in range(1, 1001)]
    text = summary(narrow.model_copy(update={"grasps": many}))
    assert "g0100 " in text and "g0101 " not in text
    assert text.endswith("and 900 more grasps, in the report\n")
    assert "more grasp" not in summary(narrow.model_copy(update={"grasps": many[:100]}))


def test_a_terminal_says_which_good_grasps_are_unreachable(narrow: RunRecord) -> None:
    best = narrow.grasps[0]
    assert best.approach is not None and best.clearance is not None

    def shown(reachable: bool) -> str:
        approach = best.approach.model_copy(update={"reachable": reachable})
        return summary(narrow.model_copy(update={"grasps": [best.model_copy(update={"approach": approach})]}))

    assert "held, 1 of them narrowly, 1 of them unreachable;" in shown(False)
    assert f"{best.clearance.status}, unreachable " in shown(False)
    assert "unreachable" not in shown(True)
