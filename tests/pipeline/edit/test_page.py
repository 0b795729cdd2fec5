"""The editor in a real browser: click, solve, look, save."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.errors import MissingBackend
from holdfast.mjcf.hand_folder import open_posture
from holdfast.objects import PressTest, load_task
from holdfast.pipeline.edit import Draft, EditorPage, EditSource

from ..browser import new_page, open_browser


@pytest.fixture
def browser_page() -> Iterator[Any]:
    """A page of a browser without a window."""
    with open_browser() as browser:
        yield new_page(browser, viewport={"width": 760, "height": 520})


@pytest.fixture
def editor(of_block: tuple[Draft, EditSource], tmp_path: Path) -> Iterator[EditorPage]:
    pytest.importorskip("viser", reason="viser is not installed")
    draft, source = of_block
    page = EditorPage(draft, source, tmp_path / "tasks", open_posture(draft.hand), port=8431)
    yield page
    page.stop()


def test_without_the_extra_one_line_says_how_to_get_it(
    of_block: tuple[Draft, EditSource], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "viser", None)
    draft, source = of_block
    with pytest.raises(MissingBackend, match=r"pip install 'holdfast\[edit\]'"):
        EditorPage(draft, source, tmp_path, open_posture(draft.hand))


@pytest.mark.slow  # half a minute, as the browser draws without a graphics card
@pytest.mark.filterwarnings("default")  # those of viser and its libraries are not ours
def test_a_task_is_made_by_clicks(
    browser_page: Any, editor: EditorPage, of_block: tuple[Draft, EditSource], tmp_path: Path
) -> None:
    draft, page = of_block[0], browser_page
    assert editor.url.startswith("http://127.0.0.1:")
    page.goto(editor.url)
    page.wait_for_timeout(5000)  # the first picture keeps the browser busy
    page.get_by_role("button", name="Solve", exact=True).click()
    page.get_by_text("has no place yet: click on the object").wait_for()
    canvas = page.locator("canvas").first
    page.mouse.click(*_pixel(editor, canvas, np.array([0.015, 0.0, 0.0])))
    page.get_by_text("of the surface, normals within").wait_for()
    fit = draft.pairs[0].fit
    assert fit is not None and fit.centre == pytest.approx([0.015, 0.0, 0.0], abs=2e-3)
    page.get_by_role("button", name="Add contact").click()
    page.get_by_text("Click on the object to place the region.").wait_for()
    assert len(draft.pairs) == 2
    page.get_by_role("button", name="Remove contact").click()
    page.wait_for_function("() => !document.body.innerText.includes('Click on the object to place')")
    assert len(draft.pairs) == 1
    (client,) = editor._server.get_clients().values()
    before = np.array(client.camera.look_at)
    page.get_by_role("button", name="Solve", exact=True).click()
    page.get_by_text("solved: ").wait_for()
    assert draft.result is not None and all(c.certified for c in draft.result)
    assert np.array(client.camera.look_at) != pytest.approx(before), "the camera has turned to the grasp"
    page.get_by_text("Conditions", exact=True).click()
    for control, option, said in (
        ("test", "turn", "by 15 deg against 0.05 N m."),
        ("test", "press", "Tested by: press with 5 N at contacts 0."),
        ("stands on", "-z", "The object stands on its -z side."),
    ):
        page.get_by_label(control, exact=True).click()
        page.get_by_role("option", name=option, exact=True).click()
        page.get_by_text(said).wait_for()
    page.get_by_role("button", name="Save task").click()
    page.get_by_text("Saved. Run it with").wait_for()
    task = load_task(tmp_path / "tasks" / "block_sa.yaml")
    assert isinstance(task.test, PressTest) and task.support is not None
    assert np.array_equal(task.contacts[0].object.region.patch.control_points, fit.patch.control_points)
    page.get_by_role("button", name="Save task").click()
    page.get_by_text("exists: choose another name").wait_for()


def _pixel(editor: EditorPage, canvas: Any, point: np.ndarray) -> tuple[float, float]:
    """Where on the page a point of the object is, as the open page's camera has it."""
    (client,) = editor._server.get_clients().values()
    camera, box = client.camera, canvas.bounding_box()
    eye = np.array(camera.position)
    forward = np.array(camera.look_at) - eye
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    x, y, depth = np.array([right, np.cross(forward, right), forward]) @ (point - eye)
    scale = 0.5 * box["height"] / np.tan(0.5 * camera.fov) / depth
    return (
        box["x"] + 0.5 * box["width"] + float(scale * x),
        box["y"] + 0.5 * box["height"] + float(scale * y),
    )
