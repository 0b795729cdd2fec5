"""The editor's page in the browser, by viser: shows a draft, and turns clicks into changes of it.

Everything is in the object's frame. What can go wrong in a change is said in the page, and the draft stays.
"""

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...errors import HoldfastError, MissingBackend
from ...geometry import Region, invert, pose, quaternion_from_rotation, shape_mesh
from ...hands import forward_kinematics
from ...mjcf.render import colour_of, region_arrow, region_sheet
from ...objects import Fit
from .draft import Draft, surface_hit
from .saving import EditSource, save_task

__all__ = ["EditorPage"]

_BODY, _LINK = (200, 203, 208), (150, 158, 170)
_BY_CLICK = "(click on the object)"
# Lift of a region's sheet and length of its arrow, in sizes of the object.
_LIFT, _ARROW = 0.003, 0.12
_SMALLEST_MM, _LARGEST_MM = 1.0, 50.0
# From the camera to the middle of hand and object, in sizes of both.
_DISTANCE = 1.0


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
        try:
            import viser  # an extra: only the editor needs it
        except ImportError:
            raise MissingBackend(
                "the editor needs the package viser: pip install 'holdfast[edit]', or pip install viser"
            ) from None
        self._draft, self._source, self._folder = draft, source, folder
        self._q_independent = q_independent
        self._lock = threading.RLock()
        self._stop = threading.Event()
        self._is_filling = False
        self._drawn: list[Any] = []
        self._number = 0
        self.hint = ""
        self._server: Any = viser.ViserServer(host=host, port=port, verbose=False)
        self.url = f"http://{host}:{self._server.get_port()}"
        self._server.gui.configure_theme(show_share_button=False, show_logo=False, control_layout="fixed")
        self._build_scene()
        self._build_controls()
        self._refresh("Click on the object to place the first region.")

    def stop(self) -> None:
        """Ends a search that runs, and the server."""
        self._stop.set()
        self._server.stop()

    def _build_scene(self) -> None:
        scene, obj = self._server.scene, self._draft.object
        size = obj.size_m
        scene.set_up_direction("+z")
        scene.add_frame("/axes", axes_length=0.3 * size, axes_radius=0.004 * size)
        mesh = scene.add_mesh_simple(
            "/object",
            np.asarray(obj.mesh.vertices),
            np.asarray(obj.mesh.faces),
            color=_BODY,
            flat_shading=True,
        )
        mesh.on_click(self._on_click)
        self._palm = scene.add_frame("/palm", axes_length=0.3 * size, axes_radius=0.004 * size)
        self._links = []
        for link in self._draft.hand.links:
            frame = scene.add_frame(f"/palm/{link.name}", show_axes=False)
            self._links.append(frame)
            for i, shape in enumerate(link.shapes):
                part = shape_mesh(shape)
                scene.add_mesh_simple(
                    f"/palm/{link.name}/{i}", np.asarray(part.vertices), np.asarray(part.faces), color=_LINK
                )
        low, high = self._apart_bounds()
        middle, across = 0.5 * (low + high), float(np.linalg.norm(high - low))
        camera = self._server.initial_camera
        camera.look_at = tuple(middle)
        camera.position = tuple(middle + _DISTANCE * across * np.array([0.9, 0.2, 0.4]))

    def _apart_bounds(self) -> tuple[Array, Array]:
        """Sets where the hand is put beside the object, and gives the corners of a box around both."""
        draft = self._draft
        low, high = np.asarray(draft.object.mesh.bounds)
        hand = _hand_bounds(draft, draft.hand.expand(self._q_independent))
        shift = 0.5 * (low + high - hand[0] - hand[1])
        shift[1] = high[1] - hand[0, 1] + 0.3 * draft.object.size_m
        self._T_object_palm_apart = pose(np.eye(3), shift)
        return np.minimum(low, hand[0] + shift), np.maximum(high, hand[1] + shift)

    def _build_controls(self) -> None:
        gui, draft = self._server.gui, self._draft
        self._said = gui.add_markdown("")
        with gui.add_folder("Contacts"):
            self._pair = gui.add_dropdown("contact", ["1"])
            self._hand = gui.add_dropdown("hand region", list(draft.hand.regions))
            self._object = gui.add_dropdown("touches", [_BY_CLICK, *draft.object.regions])
            most = max(_SMALLEST_MM + 1.0, min(_LARGEST_MM, 500.0 * draft.object.size_m))
            first = float(np.clip(1e3 * draft.pairs[0].radius_m, _SMALLEST_MM, most))
            self._radius = gui.add_slider("radius/mm", _SMALLEST_MM, most, 0.5, first)
            add, remove = gui.add_button("Add contact"), gui.add_button("Remove contact")
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
        self._shown.on_update(self._doing(self._place_hand))
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
            said = f"{result.verdict.value}: {len(result)} configurations, {result.seconds:.1f} s"
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
                count = len(draft.result) if draft.result is not None else 0
                options = ["apart", *(f"configuration {i + 1}" for i in range(count))]
                chosen = options[1] if newest and count else self._shown.value
                self._shown.options = options
                self._shown.value = chosen if chosen in options else "apart"
                self._place_hand()
                self._draw_regions()
        finally:
            self._is_filling = False

    def _place_hand(self) -> None:
        """The hand beside the object, or at it as the chosen configuration has it."""
        result, shown = self._draft.result, list(self._shown.options).index(self._shown.value)
        if result is None or shown == 0:
            q = self._draft.hand.expand(self._q_independent)
            T = self._T_object_palm_apart
        else:
            state = result[shown - 1].state
            q = result[shown - 1].joint_vector
            T = invert(pose(state.R_palm_object, state.p_palm_object))
        _move(self._palm, T)
        for frame, T_palm_link in zip(self._links, forward_kinematics(self._draft.hand, q), strict=True):
            _move(frame, T_palm_link)

    def _draw_regions(self) -> None:
        for handle in self._drawn:
            handle.remove()
        self._drawn = []
        for i, pair in enumerate(self._draft.pairs):
            link = self._draft.hand.links[pair.hand.link].name
            self._draw(f"/palm/{link}/region_{i}", pair.hand.region, i)
            if pair.object is not None:
                self._draw(f"/region_{i}", pair.object.region, i)

    def _draw(self, name: str, region: Region, number: int) -> None:
        size, colour = self._draft.object.size_m, colour_of(number)
        sheet = region_sheet(region, _LIFT * size)
        point, normal = region_arrow(region)
        scene = self._server.scene
        self._drawn.append(
            scene.add_mesh_simple(
                name, np.asarray(sheet.vertices), np.asarray(sheet.faces), color=colour, side="double"
            )
        )
        # Below the sheet, so that they go with it.
        scene.add_arrows(
            f"{name}/normal",
            np.array([[point, point + _ARROW * size * normal]]),
            colour,
            shaft_radius=0.004 * size,
            head_radius=0.012 * size,
            head_length=0.03 * size,
        )
        scene.add_label(f"{name}/name", f"{number + 1}", position=tuple(point + 1.1 * _ARROW * size * normal))


def _quality(fit: Fit) -> str:
    return (
        f"Patch within {1e3 * fit.max_m:.2g} mm of the surface, normals within "
        f"{np.degrees(fit.normal_rad):.2g} deg."
    )


def _hand_bounds(draft: Draft, q: Array) -> Array:
    """Corners (2, 3) of a box around the hand at a joint vector, in the palm frame."""
    corners: list[Array] = []
    for link, T in zip(draft.hand.links, forward_kinematics(draft.hand, q), strict=True):
        meshes = (shape_mesh(shape) for shape in link.shapes)
        corners += [np.asarray(mesh.vertices) @ T[:3, :3].T + T[:3, 3] for mesh in meshes]
    points = np.concatenate(corners) if corners else np.zeros((1, 3))
    return np.array([points.min(axis=0), points.max(axis=0)])


def _move(frame: Any, T: Array) -> None:
    frame.position, frame.wxyz = T[:3, 3], quaternion_from_rotation(T[:3, :3])
