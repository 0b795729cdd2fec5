"""The editor's page in the browser, by viser: shows a draft, and turns clicks into changes of it.

Everything is in the object's frame. What can go wrong in a change is said in the page, and the draft stays.
"""

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ...base.machine.browser_page import close_page, open_page
from ...base.numeric.arrays import Array
from ...base.text.plain_text import counted
from ...base.text.significant import significant
from ...errors import HoldfastError
from ...objects import Fit
from .conditions_panel import ConditionsPanel
from .draft import Draft, surface_hit
from .saving import EditSource, save_task
from .scene import EditorScene

__all__ = ["EditorPage"]

_BY_CLICK = "(click on the object)"
_SMALLEST_MM, _LARGEST_MM = 1.0, 50.0


class EditorPage:
    """Serves a draft until it is stopped.

    Args:
        draft: what is edited.
        source: where it came from.
        folder: where it is saved.
        q_independent: posture (n_independent,) of the hand before anything is solved.
        host: address to listen at.
        port: to listen at; the next free one if it is taken.

    Attributes:
        url: of the page.
        hint: what the page says at the top.

    Raises:
        MissingBackend: the package viser is not installed.
    """

    def __init__(
        self,
        draft: Draft,
        source: EditSource,
        folder: Path,
        q_independent: Array,
        *,
        host: str = "127.0.0.1",
        port: int = 8080,
    ):
        self._server, self.url = open_page("the editor", host, port)
        self._draft, self._source, self._folder = draft, source, folder
        self._lock = threading.RLock()
        self._stop = threading.Event()
        self._is_filling = False
        self._number = 0
        self.hint = ""
        self._scene = EditorScene(self._server, draft, q_independent, self._on_click)
        self._build_controls()
        self._refresh("Click on the object to place the first region.")

    def stop(self) -> None:
        """Ends a search that runs, and the server."""
        self._stop.set()
        close_page(self._server)

    def _build_controls(self) -> None:
        gui, draft = self._server.gui, self._draft
        self._said = gui.add_markdown("")
        with gui.add_folder("Contacts"):
            self._pair = gui.add_dropdown("contact", ["1"])
            self._hand = gui.add_dropdown("hand region", list(draft.hand.regions))
            self._object = gui.add_dropdown("touches", [_BY_CLICK, *draft.object.regions])
            most = max(_SMALLEST_MM + 1.0, min(_LARGEST_MM, float(np.floor(500.0 * draft.object.size_m))))
            first = float(np.clip(1e3 * draft.pairs[0].radius_m, _SMALLEST_MM, most))
            self._radius = gui.add_slider("radius/mm", _SMALLEST_MM, most, 0.5, first)
            add, remove = gui.add_button("Add contact"), gui.add_button("Remove contact")
        self._conditions = ConditionsPanel(gui, draft, self._doing)
        with gui.add_folder("Solve"):
            self._candidates = gui.add_slider("candidates", 1, 32, 1, 4)
            self._seconds = gui.add_slider("seconds", 5, 300, 5, 60)
            solve, stop = gui.add_button("Solve"), gui.add_button("Stop")
            self._shown = gui.add_dropdown("show", ["apart"])
        with gui.add_folder("Save"):
            name = draft.object.name + "_" + draft.hand.name
            if self._source.task_file is not None:
                name = self._source.task_file.stem
            self._name = gui.add_text("name", name)
            self._overwrite = gui.add_checkbox("overwrite", False)
            save = gui.add_button("Save task")
        self._pair.on_update(self._doing(self._choose_pair))
        self._hand.on_update(self._doing(lambda: draft.choose_hand(self._number, self._hand.value)))
        self._object.on_update(self._doing(self._choose_object))
        self._radius.on_update(self._doing(self._resize))
        self._shown.on_update(self._doing(self._show))
        add.on_click(self._doing(self._add))
        remove.on_click(self._doing(self._remove))
        save.on_click(self._doing(self._save))
        solve.on_click(lambda _: self._solve())
        stop.on_click(lambda _: self._stop.set())

    def _doing(self, change: Callable[[], str | None]) -> Callable[[Any], None]:
        """A callback that makes a change and shows what came of it, or what was wrong."""

        def call(_: Any) -> None:
            if self._is_filling:  # the page itself has set a control
                return
            with self._lock:
                try:
                    said = change() or ""
                except (HoldfastError, OSError) as error:
                    said = f"**{error}**"
                self._refresh(said)

        return call

    def _on_click(self, event: Any) -> None:
        def place() -> str:
            at = surface_hit(
                self._draft.object.mesh, np.array(event.ray_origin), np.array(event.ray_direction)
            )
            if at is None:
                return "The click went past the object."
            return _quality(self._draft.place(self._number, at))

        self._doing(place)(event)

    def _choose_pair(self) -> None:
        self._number = list(self._pair.options).index(self._pair.value)

    def _choose_object(self) -> str | None:
        if self._object.value == _BY_CLICK:
            return "Click on the object to place the region."
        self._draft.choose_object(self._number, self._object.value)
        return None

    def _resize(self) -> str | None:
        fit = self._draft.resize(self._number, 1e-3 * float(self._radius.value))
        return _quality(fit) if fit else None

    def _add(self) -> str:
        self._number = self._draft.add()
        return "Click on the object to place the region."

    def _remove(self) -> None:
        self._draft.remove(self._number)
        self._number = max(0, self._number - 1)

    def _save(self) -> str:
        reference = save_task(
            self._draft, self._source, self._folder, self._name.value.strip(), overwrite=self._overwrite.value
        )
        self._overwrite.value = False
        return f"Saved. Run it with `holdfast run {reference}`"

    def _solve(self) -> None:
        """Outside the lock, so that the page stays alive, and Stop can be heard."""
        self._stop.clear()
        try:
            with self._lock:
                self._draft.task()
                self._refresh("Solving ...")
            result = self._draft.solve(
                candidates=int(self._candidates.value),
                budget_s=float(self._seconds.value),
                should_stop=self._stop.is_set,
            )
            said = f"{result.verdict.value}: {counted(len(result), 'configuration')}, {result.seconds:.1f} s"
        except HoldfastError as error:
            said = f"**{error}**"
        with self._lock:
            self._refresh(said, newest=True)

    def _refresh(self, said: str, *, newest: bool = False) -> None:
        """Shows the draft as it is."""
        draft = self._draft
        self._number = min(self._number, len(draft.pairs) - 1)
        pair = draft.pairs[self._number]
        self.hint = said
        self._is_filling = True
        try:
            with self._server.atomic():
                self._said.content = said or " "
                self._pair.options = [f"{i + 1}  {p}" for i, p in enumerate(draft.pairs)]
                self._pair.value = self._pair.options[self._number]
                self._hand.value = pair.hand.name
                known = pair.object is not None and pair.object.name in draft.object.regions
                self._object.value = pair.object.name if known and pair.object is not None else _BY_CLICK
                self._radius.value = float(np.clip(1e3 * pair.radius_m, self._radius.min, self._radius.max))
                before = self._shown.value
                count = len(draft.result) if draft.result is not None else 0
                options = ["apart", *(f"configuration {i + 1}" for i in range(count))]
                chosen = options[1] if newest and count else self._shown.value
                self._shown.options = options
                self._shown.value = chosen if chosen in options else "apart"
                self._place_hand()
                self._scene.draw_regions()
                # Not where a change has thrown configurations away: someone is looking at the object.
                if chosen != before:
                    self._scene.aim()
        finally:
            self._is_filling = False

    def _place_hand(self) -> None:
        result, shown = self._draft.result, list(self._shown.options).index(self._shown.value)
        self._scene.place_hand(None if result is None or shown == 0 else result[shown - 1])

    def _show(self) -> None:
        self._place_hand()
        self._scene.aim()


def _quality(fit: Fit) -> str:
    return (
        f"Patch within {significant(1e3 * fit.max_m, 2)} mm of the surface, normals within "
        f"{significant(np.degrees(fit.normal_rad), 2)} deg."
    )
