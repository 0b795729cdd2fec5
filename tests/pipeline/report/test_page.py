"""The page in a real browser, with the network off: it draws, plays, sorts and filters, without an error."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.hands import forward_kinematics
from holdfast.objects import load_task
from holdfast.pipeline.records import RunFolder, RunRecord
from holdfast.pipeline.report.report import render_report

from ..browser import new_page, open_browser

pytestmark = pytest.mark.filterwarnings("default")  # those of playwright are not ours
# A function of what is drawn, four bytes a pixel.
OF_BYTES = """() => {
  const canvas = document.querySelector("#viewer canvas");
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const pen = copy.getContext("2d");
  pen.drawImage(canvas, 0, 0);
  const bytes = pen.getImageData(0, 0, copy.width, copy.height).data;
"""
# Share of the drawn pixels that are red.
REDNESS = (
    OF_BYTES
    + """
  let [drawn, red] = [0, 0];
  for (let i = 0; i < bytes.length; i += 4) {
    if (bytes[i + 3] === 0) continue;
    drawn += 1;
    if (bytes[i] > 100 && bytes[i] > 2 * Math.max(bytes[i + 1], bytes[i + 2])) red += 1;
  }
  return red / drawn;
}"""
)
# Frames go by until the slider has moved on; the page's policy keeps playwright from polling.
PLAYED = """() => new Promise((done) => {
  const look = () => {
    if (Number(document.querySelector("[data-part=time]").value) > 200) done(true);
    else requestAnimationFrame(look);
  };
  look();
})"""
VIEW = "document.querySelector('#viewer').view"
DRAWN = (
    OF_BYTES
    + """
  const opacity = bytes.filter((_, i) => i % 4 === 3);
  return opacity.filter((value) => value > 0).length / opacity.length;
}"""
)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with open_browser() as found:
        yield found


class Said:
    """A page with all that it has said and asked for."""

    def __init__(self, browser: Any, path: Path, *, webgl: bool = True, **options: Any) -> None:
        self.page = new_page(browser, offline=True, **options)
        if not webgl:
            self.page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null;")
        self.errors: list[str] = []
        self.asked: list[str] = []
        self.page.on("console", lambda m: self.errors.append(m.text) if m.type == "error" else None)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(f"file://{path}")

    def start(self) -> Any:
        """The page once its 3D view stands."""
        self.page.locator("#viewer").scroll_into_view_if_needed()
        self.page.wait_for_selector("#viewer canvas")
        self.page.evaluate(f"{VIEW}.ready.then(() => true)")
        return self.page


@pytest.fixture
def said(browser: Any, run_path: Path) -> Iterator[Said]:
    said = Said(browser, run_path / "report.html", viewport={"width": 1280, "height": 900})
    yield said
    assert said.errors == []
    assert all(url.startswith(("file:", "data:", "blob:")) for url in said.asked)
    said.page.close()


def coverage(page: Any) -> float:
    """Share of the canvas that something is drawn on."""
    return float(page.evaluate(DRAWN))


def test_the_view_draws_what_the_slider_and_the_boxes_ask_for(said: Said, run_record: RunRecord) -> None:
    page = said.start()
    assert 0.02 < coverage(page) < 0.9
    slider, now = page.locator("[data-part=time]"), page.locator("[data-part=now]")
    assert now.inner_text() == "the grasp"
    poses = []
    for place in ("0", "1000"):
        slider.fill(place)
        poses.append(page.evaluate(f"{VIEW}.links.map((link) => link.matrix.elements)"))
    assert now.inner_text() == "squeezed"
    assert np.abs(np.diff(np.array(poses), axis=0)).max() > 1e-2
    # Every trial of the test can be played.
    courses = page.locator("[data-part=course] option").all_inner_texts()
    best = run_record.grasps[0]
    assert best.hold is not None and len(courses) == 1 + len(best.hold.directions)
    assert len(set(courses)) == len(courses)
    page.select_option("[data-part=course]", "1")
    page.click("[data-part=play]")
    page.evaluate(PLAYED)
    page.click("[data-part=play]")
    shown = f"() => {VIEW}.marks.children.filter((mark) => mark.visible).length"
    count = len(best.contacts)
    for layer, more in (("normals", count), ("cones", count), ("forces", count)):
        before = page.evaluate(shown)
        page.check(f"[data-layer={layer}]")
        assert page.evaluate(shown) == before + more
    page.focus("#viewer canvas")
    eye = f"() => {VIEW}.camera.position.toArray()"
    before = page.evaluate(eye)
    page.keyboard.press("ArrowLeft")
    assert np.linalg.norm(np.subtract(page.evaluate(eye), before)) > 1e-3


def test_the_place_where_bodies_overlap_is_red(said: Said) -> None:
    page = said.start()
    page.uncheck("[data-layer=regions]")
    assert page.evaluate(REDNESS) == 0.0
    # As if something sank so deep into the palm, in its middle, that the place shows on both its sides.
    page.evaluate(
        f"""() => {{
          const view = {VIEW};
          const {{ mesh }} = view.nodes.link_0_0;
          mesh.geometry.computeBoundingBox();
          const middle = mesh.geometry.boundingBox.getCenter(mesh.position.clone()).toArray();
          const places = {{ link_0: [[...middle, 0.03]] }};
          const pair = {{ bodies: ["link_0"], names: ["palm"], depth: 30, places }};
          view.grasp = {{ ...view.grasp, deep: [pair] }};
          view.layers();
        }}"""
    )
    assert 0.0 < page.evaluate(REDNESS) < 0.2, "a place, not the body"
    page.uncheck("[data-layer=penetration]")
    assert page.evaluate(REDNESS) == 0.0


def test_the_view_poses_links_as_kinematics_does(said: Said, run_record: RunRecord) -> None:
    page, task = said.start(), load_task("upholding")
    for grasp in run_record.grasps:
        page.select_option("[data-part=grasp]", grasp.id)
        found = page.evaluate(
            """() => document.querySelector("#viewer").view.links.map((link) => {
              link.updateWorldMatrix(true, false);
              return link.matrixWorld.elements;
            })"""
        )
        q = np.array([grasp.joints[name] for name in task.hand.joint_names])
        expected = forward_kinematics(task.hand, q)
        # three.js keeps matrices by columns.
        assert np.array(found).reshape(-1, 4, 4).transpose(0, 2, 1) == pytest.approx(expected, abs=1e-4)


def test_the_table_sorts_and_filters_by_keyboard(said: Said, run_record: RunRecord) -> None:
    page = said.page
    head = page.locator("#grasps th", has_text="slip, mm")
    head.get_by_role("button").focus()
    for sign, direction in ((1, "ascending"), (-1, "descending")):
        page.keyboard.press("Enter")
        assert head.get_attribute("aria-sort") == direction
        cells = page.locator("#grasps tbody tr td:nth-child(11)").all_inner_texts()
        values = [float(cell) for cell in cells if cell != "–"]
        assert len(cells) == len(run_record.grasps)
        assert all(sign * (b - a) >= 0.0 for a, b in pairwise(values))
    name = run_record.grasps[-1].id
    page.get_by_label("Find").fill(name)
    assert page.locator("#grasps tbody tr:visible").count() == 1
    assert page.locator("#shown").inner_text() == f"1 of {len(run_record.grasps)} grasps"
    page.get_by_label("Find").fill("")
    page.click(f"#grasps a[href='#{name}']")
    assert page.locator(f"#{name}").get_attribute("open") is not None


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (390, "dark")])
def test_nothing_is_wider_than_the_window(
    width: int, scheme: str, browser: Any, run_path: Path, run_record: RunRecord
) -> None:
    size = {"width": width, "height": 800}
    said = Said(browser, run_path / "report.html", viewport=size, color_scheme=scheme)
    page = said.page
    for grasp in run_record.grasps:
        page.evaluate("(id) => { document.getElementById(id).open = true; }", grasp.id)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    # Words stay whole: no cell is narrower than its longest word.
    broken = page.evaluate(
        """() => [...document.querySelectorAll("td, th, dt, li")].filter((cell) => {
          return cell.clientWidth && cell.scrollWidth > cell.clientWidth + 1;
        }).map((cell) => cell.textContent.trim())"""
    )
    assert broken == [] and said.errors == []
    page.close()


@pytest.mark.parametrize("scripts", [True, False])
def test_without_webgl_or_scripts_there_are_pictures(scripts: bool, browser: Any, run_path: Path) -> None:
    said = Said(browser, run_path / "report.html", webgl=False, java_script_enabled=scripts)
    page = said.page
    assert page.locator("#viewer img").is_visible()
    assert not page.locator("#viewer canvas").count()
    assert not page.locator("[data-part=start]").is_visible()
    assert "WebGL" in page.locator("[data-part=said]").inner_text()
    assert said.errors == []


def test_a_run_without_grasps_shows_hand_and_object(
    browser: Any, run_path: Path, run_record: RunRecord, tmp_path: Path
) -> None:
    empty = run_record.model_copy(update={"verdict": "infeasible", "grasps": []})
    page_path = tmp_path / "report.html"
    page_path.write_text(render_report(load_task("upholding"), empty, RunFolder(tmp_path).media), "utf-8")
    said = Said(browser, page_path)
    page = said.start()
    assert coverage(page) > 0.02 and said.errors == []
    assert page.locator("#grasps").count() == 0
