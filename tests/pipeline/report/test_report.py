"""The report: escaped, self-contained, and true to the record."""

import base64
import hashlib
import os
import re
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from importlib.resources import files
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from holdfast.hands import forward_kinematics
from holdfast.objects import Task, load_task
from holdfast.pipeline.cli.commands.grasps.hold import summary as hold_summary
from holdfast.pipeline.cli.commands.grasps.run import summary
from holdfast.pipeline.records import Direction, GraspFile, RunRecord, SearchStep, to_state
from holdfast.pipeline.report.cards import make_card
from holdfast.pipeline.report.charts import slip_chart, tree_chart
from holdfast.pipeline.report.report import render_report
from holdfast.pipeline.report.scene import deep_pairs
from holdfast.pipeline.report.text import describe

EVIL = "<script>alert(1)</script>\"'&"
VOID = {"meta", "img", "br", "line", "polyline", "path", "input", "rect"}
PICTURES = ("data:image/png;base64,", "data:image/webp;base64,")
SCRIPTS = ("table.js", "viewer.js")


def template(name: str) -> str:
    return files("holdfast.pipeline.report").joinpath("templates", name).read_text("utf-8")


def digest(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


class Checker(HTMLParser):
    """Collects tags, links and whether every element is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.links: list[str] = []
        self.handlers: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.links += [value or "" for name, value in attrs if name in ("src", "href", "srcset", "data")]
        self.handlers += [name for name, _ in attrs if name.startswith("on")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert tag in VOID or self.open.pop() == tag


def checked(html: str) -> Checker:
    checker = Checker()
    checker.feed(html)
    checker.close()
    assert checker.open == []
    return checker


@pytest.fixture
def task() -> Task:
    return load_task("upholding")


def test_the_page_needs_nothing_else(run_path: Path) -> None:
    html = (run_path / "report.html").read_text("utf-8")
    page = checked(html)
    # Beside what is in the page itself it names the grasps' own files.
    beside = [link for link in page.links if not link.startswith((*PICTURES, "#"))]
    assert beside and all((run_path / link).is_file() and link.startswith("grasps/") for link in beside)
    assert not {"link", "iframe", "object", "embed"} & set(page.tags)
    assert not page.handlers
    # The library names a namespace of XML, which nothing fetches.
    ours = html.replace(template("three.min.js"), "")
    assert not re.search(r"https?://|@import|url\(", ours)


def test_the_page_says_what_the_record_says(run_path: Path, run_record: RunRecord) -> None:
    html = (run_path / "report.html").read_text("utf-8")
    assert f"{len(run_record.good)} of {len(run_record.grasps)} grasps are all three" in html
    for grasp in run_record.grasps:
        assert f"<code>{grasp.id}</code>" in html
    # What stands for the 3D view; four views, film and video; of the others one view; a thumbnail each.
    assert html.count("<img") == 1 + 6 + len(run_record.grasps) - 1 + len(run_record.grasps)
    for word in ("certified", "strengthened", "re-searched", "clear", "held", "not tested", "infeasible"):
        assert f"<dt>{word}</dt>" in html


def test_a_browser_may_show_the_page_and_do_nothing_else(run_path: Path) -> None:
    html = (run_path / "report.html").read_text("utf-8")
    policy = re.search(r'<meta http-equiv="Content-Security-Policy" content="([^"]+)">', html)
    style = re.search(r"<style>(.*)</style>", html, re.DOTALL)
    assert policy is not None and style is not None
    rules = dict(rule.split(" ", 1) for rule in unescape(policy[1]).split("; "))
    assert rules["default-src"] == "'none'" and rules["img-src"] == "data:"
    assert rules["style-src"] == digest(style[1])
    # Our own scripts alone run, and the library that they start.
    assert rules["script-src"].split() == [digest(template(name)) for name in ("three.min.js", *SCRIPTS)]
    assert ' style="' not in html


def test_text_of_files_turns_nothing_round_and_does_not_flood(
    run_record: RunRecord, run_path: Path, task: Task
) -> None:
    evil = "a\x1b[2J\u202eb" + "x" * 10**5
    named = replace(task, description=evil)
    html = render_report(named, run_record.model_copy(update={"task": evil}), run_path / "media")
    assert all(c.isprintable() or c == "\n" for c in html.replace(template("three.min.js"), ""))
    assert "x" * 5000 not in html


@pytest.mark.parametrize("kind", ["link", "linked folder", "text", "cut", "pipe"])
def test_what_is_no_picture_of_the_run_is_left_out(
    kind: str, run_record: RunRecord, run_path: Path, task: Task, tmp_path: Path
) -> None:
    name = f"{run_record.grasps[0].id}_front.png"
    good, media = (run_path / "media" / name).read_bytes(), tmp_path / "media"
    media.mkdir()
    match kind:
        case "link":
            (media / name).symlink_to(run_path / "media" / name)
        case "linked folder":
            media.rmdir()
            media.symlink_to(run_path / "media")
        case "text":
            (media / name).write_text("secret", "utf-8")
        case "cut":
            (media / name).write_bytes(good[: len(good) // 2])
        case "pipe":
            os.mkfifo(media / name)
    links = checked(render_report(task, run_record, media)).links
    assert not any(link.startswith("data:") for link in links)
    assert set(links) == {"#assumed", *(f"#{grasp.id}" for grasp in run_record.grasps)}


def test_names_are_escaped(run_record: RunRecord, run_path: Path, task: Task) -> None:
    best = run_record.grasps[0]
    contact = best.contacts[0].model_copy(update={"hand": EVIL, "object": EVIL})
    assert best.hold is not None and best.clearance is not None
    hold = best.hold.model_copy(update={"reason": EVIL})
    clearance = best.clearance.model_copy(update={"worst_pair": (EVIL, EVIL), "reason": EVIL})
    grasp = best.model_copy(
        update={
            "contacts": [contact, *best.contacts[1:]],
            "hold": hold,
            "clearance": clearance,
            "joints": {EVIL: 0.0, **best.joints},
        }
    )
    record = run_record.model_copy(
        update={
            "task": EVIL,
            "hand": EVIL,
            "object": EVIL,
            "holdfast": EVIL,
            "task_fingerprint": EVIL,
            "grasps": [grasp],
            "settings": {f"hold.{EVIL}": EVIL},
        }
    )
    named = replace(task, description=EVIL, object=replace(task.object, sources={EVIL: EVIL, "mass": EVIL}))
    html = render_report(named, record, run_path / "media")
    page = checked(html)
    # The scene, the library and our two scripts.
    assert page.tags.count("script") == 2 + len(SCRIPTS) and not page.handlers
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in html and EVIL not in html


@pytest.mark.parametrize("verdict", ["held", "not held", "infeasible", "undecided"])
def test_a_run_without_grasps_or_pictures(
    verdict: str, run_record: RunRecord, task: Task, tmp_path: Path
) -> None:
    empty = run_record.model_copy(
        update={"verdict": verdict, "grasps": [], "solve": None, "complete": False, "seconds": {}}
    )
    html = render_report(task, empty, tmp_path)
    assert checked(html).links == []
    assert "What was asked for" in html and "thumb base" in html


def test_grasps_on_their_way(run_record: RunRecord, task: Task, tmp_path: Path) -> None:
    best = run_record.grasps[0]
    assert best.hold is not None and best.clearance is not None
    failed = best.clearance.model_copy(update={"status": "failed", "worst_pair": None})
    untried = {"held": False, "directions": [], "squeeze": None, "reason": "so"}
    stages: list[dict[str, object]] = [
        {"clearance": None, "hold": None},
        {"clearance": failed, "hold": None},
        {"hold": best.hold.model_copy(update=untried)},
        {"certified": False},
    ]
    for stage in stages:
        record = run_record.model_copy(update={"grasps": [best.model_copy(update=stage)]})
        checked(render_report(task, record, tmp_path))
    untried = best.model_copy(update=stages[0])
    record = run_record.model_copy(update={"grasps": [untried], "verdict": "undecided", "complete": False})
    html = render_report(task, record, tmp_path)
    assert "before one of them was held" in html and "not tried: --resume" in html


def test_the_page_does_not_claim_more_than_was_tested(
    run_record: RunRecord, task: Task, tmp_path: Path
) -> None:
    best = run_record.grasps[0]
    assert best.hold is not None
    untested = best.hold.model_copy(
        update={"held": False, "directions": [], "squeeze": None, "reason": "no squeeze: too weak"}
    )
    record = run_record.model_copy(
        update={"verdict": "not held", "grasps": [best.model_copy(update={"hold": untested})]}
    )
    text = " ".join(render_report(task, record, tmp_path).split())
    assert '<span class="badge ">not tested</span>' in text and "gave way</span>" not in text
    assert "Not tested: no squeeze: too weak. That is no proof that the hand could not do it." in text
    assert "<b>1</b><span>not tested</span>" in text


@pytest.mark.parametrize(
    ("name", "kind", "word"), [("tuning", "turn", "turned"), ("playing", "press", "pressed")]
)
def test_turns_and_presses_have_words_of_their_own(
    name: str, kind: str, word: str, run_record: RunRecord, tmp_path: Path
) -> None:
    """Nothing is said to be held, in the report or on the terminal, where nothing had to be held."""
    best = run_record.grasps[0]
    assert best.hold is not None
    trial = best.hold.directions[0].model_copy(update={"gravity": (0.0, 0.0, 0.0)})
    measured = {"margin": 1.5, "probability": 0.5, "trials": 4, "creep": 1e-6, "settings_agree": True}
    hold = best.hold.model_copy(update={"kind": kind, "directions": [trial], **measured})
    for passed in (True, False):
        grasp = GraspFile.model_validate(
            {
                **dict(best.model_copy(update={"hold": hold.model_copy(update={"held": passed})})),
                **dict.fromkeys(("holdfast", "task", "task_source", "hand", "object_name"), ""),
            }
        )
        verdict = "held" if passed else "not held"
        record = run_record.model_copy(update={"verdict": verdict, "grasps": [grasp]})
        html = render_report(load_task(name), record, tmp_path)
        body = html.partition("<body>")[2].partition("<script")[0]
        shown = re.sub(r"<[^>]*>", " ", body)
        for text in (shown, summary(record), describe(grasp), hold_summary(grasp)):
            assert re.search(rf"\b{word}\b", text) and not re.search(r"\bheld\b", text, re.IGNORECASE)


def test_the_page_says_how_a_grasp_came_about(run_record: RunRecord, task: Task, tmp_path: Path) -> None:
    best = run_record.grasps[0]
    assert best.clearance is not None
    for update, moves, words in (
        ({"strengthened": False, "restarts": 2}, ["re-searched"], "Re-searched:"),
        (
            {"strengthened": True, "restarts": 1},
            ["strengthened", "re-searched"],
            "another configuration than",
        ),
        ({"strengthened": True, "restarts": 0}, ["strengthened"], "Strengthened: it slid along its contacts"),
    ):
        clear = best.clearance.model_copy(update={"status": "clear"})
        grasp = best.model_copy(update={**update, "clearance": clear})
        html = render_report(task, run_record.model_copy(update={"grasps": [grasp]}), tmp_path)
        cell = "".join(f"<div>{move}</div>" for move in moves)
        assert f'<td class="key">{cell}</td>' in html and words in html
        assert ("Re-searched:" in html) is bool(grasp.restarts)


def test_a_page_of_hundreds_of_grasps_stays_small(run_record: RunRecord, run_path: Path, task: Task) -> None:
    """Every grasp stands in the table; the best have a card and move in 3D."""
    best = run_record.grasps[0]
    assert run_record.solve is not None
    many = [best.model_copy(update={"id": f"g{k:03d}"}) for k in range(1, 301)]
    html = render_report(task, run_record.model_copy(update={"grasps": many}), run_path / "media")
    checked(html)
    assert html.count('<tr data-stage="') == 300
    assert html.count('<details class="card grasp"') == html.count('<option value="g') == 64
    assert "236 more grasps stand in the table alone" in html
    assert len(html) < 15_000_000


def test_the_page_says_which_grasps_cannot_be_reached(
    run_record: RunRecord, task: Task, tmp_path: Path
) -> None:
    best = run_record.grasps[0]
    assert best.approach is not None
    for reachable in (True, False):
        approach = best.approach.model_copy(update={"reachable": reachable, "opening": 4.2e-3})
        grasp = best.model_copy(update={"approach": approach})
        html = render_report(task, run_record.model_copy(update={"grasps": [grasp]}), tmp_path)
        assert ("<b>1</b><span>unreachable</span>" in html) is not reachable
        assert ("unreachable: the fingers open by 4.20 mm only" in html) is not reachable


def test_the_places_of_an_overlap_lie_on_both_bodies(
    run_record: RunRecord, task: Task, tmp_path: Path
) -> None:
    """Points in the frames of link and object are one point in the palm's, where the grasp was pushed in."""
    grasp = run_record.grasps[0]
    contact = task.contacts[0]
    state = to_state(grasp, task, tmp_path)
    inwards = -np.array(grasp.contacts[0].normal)
    pushed = replace(state, p_palm_object=state.p_palm_object - 0.0008 * inwards)
    link = task.hand.links[contact.hand.link].name
    (pair,) = [pair for pair in deep_pairs(task, pushed) if link in pair["names"]]
    assert pair["depth"] == pytest.approx(0.8, abs=0.25)
    of_link, of_object = (np.array(pair["places"][body]) for body in pair["bodies"])
    T = forward_kinematics(task.hand, task.hand.expand(pushed.q))[contact.hand.link]
    there = of_link[:, :3] @ T[:3, :3].T + T[:3, 3]
    here = of_object[:, :3] @ pushed.R_palm_object.T + pushed.p_palm_object
    assert there == pytest.approx(here, abs=2e-5)
    assert np.linalg.norm(there[0] - grasp.contacts[0].point) < 0.004
    assert 1e3 * of_link[0, 3] == pytest.approx(pair["depth"], abs=0.02)


def test_what_fingertips_are_rated_for_stands_beside_fingers_alone(
    run_record: RunRecord, tmp_path: Path
) -> None:
    best, handling = run_record.grasps[0], load_task("handling")
    assert best.hold is not None and best.hold.squeeze is not None
    palm = [contact.hand.name for contact in handling.contacts].index("palm/edge")
    squeeze = best.hold.squeeze.model_copy(update={"normal_forces": [31.0, 29.0, 40.0]})
    grasp = best.model_copy(update={"hold": best.hold.model_copy(update={"squeeze": squeeze})})
    card = make_card(grasp, handling, "lift", tmp_path, tmp_path, best=False)
    assert card.rated == [None if i == palm else 30.0 for i in range(3)]
    assert card.over == [i != palm and force > 30.0 for i, force in enumerate([31.0, 29.0, 40.0])]


def test_the_page_names_the_assumed_contact_patch(run_record: RunRecord, task: Task, tmp_path: Path) -> None:
    text = " ".join(render_report(task, run_record, tmp_path).split())
    assert "soft contacts, pads of 3.5 MPa and 13 mm" in text
    assert "the hand's pads, 13 mm of 3.5 MPa" in text.replace("&#39;", "'")
    assert "are rated for 30 N" in text
    wider = {**run_record.settings, "hold.patch_radius_m": 0.008, "hold.friction": 0.3}
    changed = run_record.model_copy(update={"settings": wider})
    text = " ".join(render_report(task, changed, tmp_path).split())
    assert "a patch of radius 8 mm" in text and "resists up to 1.6 N mm of torque" in text


def direction(gravity: tuple[float, float, float], *slips: float) -> Direction:
    curve = [(0.1 * k, slip) for k, slip in enumerate(slips)]
    return Direction(gravity=gravity, held=True, slip=max(slips), rotation=0.0, curve=curve)


def test_a_chart_shows_every_sample_inside_its_frame() -> None:
    chart = slip_chart([direction((0, 0, -9.81), 0, 1e-3, 2e-3), direction((9.81, 0, 0), 0, 0.5, 1.0)], 5e-3)
    assert chart is not None
    left, top, right, bottom = chart.frame
    assert [(line.label, line.axis, line.dashed) for line in chart.lines] == [
        ("−z", "z", True),
        ("+x", "x", False),
    ]
    assert chart.unit == "mm" and chart.limit == 5.0
    for line in chart.lines:
        points = [tuple(map(float, pair.split(","))) for pair in line.points.split()]
        assert len(points) == 3
        assert all(left <= x <= right and y <= bottom for x, y in points)
        # What falls off the chart is cut just above it.
        assert all(y >= top - 0.05 * (bottom - top) for _, y in points)
    assert chart.limit_y is not None and top <= chart.limit_y <= bottom


def test_the_labels_of_equal_curves_do_not_overlap() -> None:
    chart = slip_chart([direction((9.81, 0, 0), 0, 1e-4)] * 26, 5e-3)
    assert chart is not None and chart.limit_y is None
    assert all(0.0 < line.label_y < chart.height for line in chart.lines)
    assert len({line.label for line in chart.lines}) == 26
    heights = sorted(line.label_y for line in chart.lines)
    assert all(b - a >= 12.9 for a, b in pairwise(heights))


@pytest.mark.parametrize("slips", [(0.0, 0.0), (1e-12, 1e-12), (1e6, 1e6)])
def test_a_chart_of_extremes(slips: tuple[float, float]) -> None:
    chart = slip_chart([direction((0.3, 0.4, 0), *slips)], 5e-3)
    assert chart is not None and len(chart.y_ticks) >= 2
    assert chart.lines[0].axis == "other"


def test_the_tree_is_drawn_round_by_round(run_record: RunRecord) -> None:
    assert run_record.solve is not None
    (entry, *_) = run_record.solve.rounds
    assert entry.search and entry.search[-1].boxes == entry.boxes
    steps = [
        SearchStep(boxes=boxes, open=2, depth=5, decided=share)
        for boxes, share in ((1, 0.0), (50, 0.25), (200, 1.0))
    ]
    chart = tree_chart([entry.model_copy(update={"search": part}) for part in (steps, steps[:2], [], steps)])
    assert chart is not None and [line.label for line in chart.lines] == ["round 1", "round 2", "round 4"]
    _, top, right, bottom = chart.frame
    assert chart.lines[0].end == (right, top) and chart.lines[1].end[0] < right
    assert chart.lines[1].end[1] == pytest.approx(bottom - 0.25 * (bottom - top), abs=0.1)
    assert tree_chart([entry.model_copy(update={"search": []})]) is None


def test_no_curves_no_chart() -> None:
    assert slip_chart([], 5e-3) is None
    assert slip_chart([direction((0, 0, 1), 0.0)], 5e-3) is None
