"""Makes the environments known to Gymnasium once it and this package are imported, in whichever order.

Importing Gymnasium takes a good part of a second, which no command should wait for that has no use for it. So
where it has not been imported yet, a finder waits for that: it lets the others find the module, and registers
as soon as that has been executed.
"""

import importlib.util
import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

__all__ = ["GRASP_CHOICE", "GRASP_CHOICE_SEQUENTIAL", "register_environments"]

GRASP_CHOICE = "Holdfast/GraspChoice-v0"
GRASP_CHOICE_SEQUENTIAL = "Holdfast/GraspChoiceSequential-v0"

_GYMNASIUM = "gymnasium"
_MODULE = f"{__package__}.pipeline.env"
_ENVIRONMENTS = {
    GRASP_CHOICE: "make_grasp_choice",
    GRASP_CHOICE_SEQUENTIAL: "make_grasp_choice_sequential",
}


def register_environments() -> None:
    """Registers the environments, now or when Gymnasium is imported."""
    gymnasium = sys.modules.get(_GYMNASIUM)
    if gymnasium is None:
        sys.meta_path.insert(0, _Waiting())
    elif hasattr(gymnasium, "register"):
        _register(gymnasium)


def _register(gymnasium: Any) -> None:
    for name, maker in _ENVIRONMENTS.items():
        if name not in gymnasium.registry:
            gymnasium.register(
                id=name, entry_point=f"{_MODULE}:{maker}", vector_entry_point=f"{_MODULE}:{maker}_vector"
            )


class _Waiting:
    """A finder that knows no module, and waits for one to be looked for."""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """None, so that others are asked; for Gymnasium what they find, with a loader that registers."""
        del path, target
        if name != _GYMNASIUM:
            return None
        if self in sys.meta_path:
            sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        if spec is not None and spec.loader is not None:
            spec.loader = _ThenRegister(spec.loader)  # type: ignore[assignment]
        return spec


class _ThenRegister:
    """A loader that does what another one does, and registers.

    Args:
        loader: the other one, which the module has as its own afterwards.
    """

    def __init__(self, loader: Any):
        self._loader = loader

    def __getattr__(self, name: str) -> Any:
        return getattr(self._loader, name)

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """As the other one."""
        module: ModuleType | None = self._loader.create_module(spec)
        return module

    def exec_module(self, module: ModuleType) -> None:
        """As the other one; then the environments are registered."""
        module.__loader__ = self._loader
        if module.__spec__ is not None:
            module.__spec__.loader = self._loader
        self._loader.exec_module(module)
        _register(module)
