"""Pictures of candidates, as arrays or in a window."""

import sys
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...base.machine.backend import configure
from ...base.text.console import Console

if TYPE_CHECKING:
    from ...mjcf.render import Studio
    from ...objects import Task
    from ...solver import Configuration

__all__ = ["Painter"]

_HEIGHT, _WIDTH = 240, 320


class Painter:
    """Draws configurations, of one task after another; renderer and window are set up with the first."""

    def __init__(self) -> None:
        self._studio: Studio | None = None
        self._task: Task | None = None
        self._window: Any = None
        self._has_told = False

    def __getstate__(self) -> dict[str, Any]:
        # Renderer and window belong to a process.
        return {}

    def __setstate__(self, state: dict[str, Any]) -> None:
        del state
        self.__init__()  # type: ignore[misc]

    def picture(self, configuration: "Configuration | None") -> NDArray[np.uint8]:
        """A picture (240, 320, 3); grey where there is nothing to show."""
        if configuration is None:
            return np.full((_HEIGHT, _WIDTH, 3), 127, dtype=np.uint8)
        configure()
        from ...mjcf.render import (
            Studio,
        )  # takes seconds to import, which an environment without pictures spares

        if self._studio is None or self._task is not configuration.task:
            if self._studio is not None:
                self._studio.close()
            self._studio, self._task = Studio(configuration.task), configuration.task
        return self._studio.view(configuration, width=_WIDTH, height=_HEIGHT)

    def show(self, configuration: "Configuration | None", caption: str) -> None:
        """Shows a picture in a window, where there is a display; says once where there is none."""
        if self._window is None and not self._has_told:
            self._window = _open_window()
        if self._window is None:
            if not self._has_told:
                Console(stream=sys.stderr).say(
                    "no display: the pictures of render_mode 'human' are not shown"
                )
            self._has_told = True
            return
        self._window.show(self.picture(configuration), caption)

    def close(self) -> None:
        """Frees renderer and window."""
        if self._studio is not None:
            self._studio.close()
        if self._window is not None:
            self._window.close()
        self._studio = self._task = self._window = None


class _Window:
    """A window of Tk's with a picture in it."""

    def __init__(self, tk: Any):
        self._tk = tk
        self._root = tk.Tk()
        self._label = tk.Label(self._root)
        self._label.pack()
        self._image: Any = None

    def show(self, picture: NDArray[np.uint8], caption: str) -> None:
        """Puts a picture in; a window that a person has closed stays closed."""
        height, width, _ = picture.shape
        data = b"P6 %d %d 255 " % (width, height) + np.ascontiguousarray(picture).tobytes()
        try:
            self._image = self._tk.PhotoImage(master=self._root, data=data, format="PPM")
            self._label.configure(image=self._image)
            self._root.title(caption)
            self._root.update()
        except self._tk.TclError:
            return

    def close(self) -> None:
        """Closes it."""
        try:
            self._root.destroy()
        except self._tk.TclError:
            return


def _open_window() -> _Window | None:
    """A window; None where Tk is not installed or there is no display."""
    try:
        import tkinter
    except ImportError:
        return None
    try:
        return _Window(tkinter)
    except tkinter.TclError:
        return None
