"""A run that gives up after some grasps leaves the others to whoever goes on with it."""

from dataclasses import replace
from pathlib import Path

import pytest
from holdfast.errors import InputError
from holdfast.pipeline.report import EarlierSet
from holdfast.pipeline.run import RunSettings, run_task
from PIL import Image

# A load that no plan carries: every grasp fails without a simulation.
HEAVY = RunSettings(
    candidates=3, choice=1, wanted=1, quick=True, budget_s=600.0, hold={"object_mass_kg": 300.0}
)


def done(record: object) -> list[str]:
    return sorted(grasp.id for grasp in record.grasps if grasp.is_done)  # type: ignore[attr-defined]


def test_the_rest_is_left_untried_and_can_be_gone_on_with(tmp_path: Path) -> None:
    brief = replace(HEAVY, give_up_after=2, quick=False)
    drawn = tmp_path / "drawn.png"
    Image.new("RGB", (4, 3)).save(drawn)
    others = (EarlierSet("others", "4 tried, 4 clear, 0 held", drawn), EarlierSet("bare", "<b> sinks in"))
    record = run_task("upholding", tmp_path / "run", brief, earlier=others)
    assert done(record) == ["g01", "g02"] and len(record.grasps) == 3
    assert not record.complete and record.solve is not None and len(record.solve.rounds) == 1
    # One picture of what failed, and those of the contacts that were run before.
    media = sorted(path.name for path in (tmp_path / "run" / "media").iterdir())
    assert media == ["earlier.json", "earlier_1.png", f"{record.grasps[0].id}_front.png"]
    page = (tmp_path / "run" / "report.html").read_text()
    assert "4 tried, 4 clear, 0 held" in page and 'alt="a grasp of others"' in page
    assert "&lt;b&gt; sinks in" in page and 'alt="a grasp of bare"' not in page
    again = run_task("upholding", tmp_path / "run", brief, resume=True)
    assert done(again) == done(record) and again.grasps == record.grasps
    # Who gives up later goes on with the same run: it is no other one.
    later = run_task("upholding", tmp_path / "run", replace(HEAVY, give_up_after=3), resume=True)
    assert done(later) == ["g01", "g02", "g03"]


def test_giving_up_before_anything_is_tried_is_refused() -> None:
    with pytest.raises(InputError, match="give_up_after"):
        RunSettings(give_up_after=0)
