"""Named settings of the hold test, from `data/presets.yaml`."""

from dataclasses import replace
from functools import cache
from importlib.resources import as_file, files
from math import radians
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, Strict, model_validator

from ...base.files.fields import Finite, Mass, Positive, Text
from ...base.files.file_model import FileModel, parse
from ...base.files.yaml_file import read_yaml
from ...errors import InputError, UnknownName
from ...objects import Task
from ..directions import DirectionSet, directions
from ..model import payload
from ..settings import HoldSettings

__all__ = ["PRESETS_FILE", "PresetSpec", "preset_names", "preset_settings", "preset_specs", "read_presets"]

PRESETS_FILE = files("holdfast.mjcf.hold") / "data" / "presets.yaml"

_Share = Annotated[float, Strict(), Field(gt=0, le=1)]
_Seconds = Annotated[float, Strict(), Field(gt=0, le=60)]
_Length = Annotated[float, Strict(), Field(gt=0, le=1)]


class PresetSpec(FileModel):
    """One entry of a presets file; what is left out is as in `holdfast`.

    Fields are those of `HoldSettings` without units in their names, but for `force`: a load in N that stands
    in place of gravity.
    """

    description: Text = ""
    directions: DirectionSet = "task"
    friction: Annotated[float, Strict(), Field(gt=0, le=20)] | None = None
    object_mass: Mass | None = None
    patch_radius: Annotated[float, Strict(), Field(gt=0, le=0.2)] | None = None
    soft_pads: bool | None = None
    fingers_first: bool | None = None
    firm_limit: _Length | None = None
    firm_spin: _Share | None = None
    firm_share: _Share | None = None
    near_limit: Annotated[float, Strict(), Field(ge=1, le=10)] | None = None
    gravity: Annotated[float, Strict(), Field(gt=0, le=1000)] | None = None
    force: Positive | None = None
    hand_weight: bool = False
    close: _Seconds | None = None
    squeeze: _Seconds | None = None
    settle: _Seconds | None = None
    hold: _Seconds | None = None
    turn: _Seconds | None = None
    rest: _Seconds | None = 0.1
    slip_limit: _Length | None = None
    slip_of: Literal["contact", "centre"] | None = None
    rotation_limit_deg: Annotated[float, Strict(), Field(gt=0, le=180)] | None = 10.0
    must_touch: Literal["all", "any", "none"] | None = None
    penetration_limit: _Length | None = None
    gap_limit: _Length | None = None
    creep_budget: Positive | None = None
    creep_budget_deg: Positive | None = None
    margin_cap: Annotated[float, Strict(), Field(ge=1, le=1000)] | None = None
    margin_resolution: Annotated[float, Strict(), Field(ge=0.001, le=0.5)] | None = None
    planned_load: Annotated[float, Strict(), Field(gt=0, le=100)] | None = None
    planned_force: Positive | None = None
    planned_effort: _Share | None = None
    planned_friction: _Share | None = None
    timestep: Annotated[float, Strict(), Field(ge=1e-5, le=0.01)] | None = None
    impratio: Annotated[float, Strict(), Field(ge=0.01, le=1e4)] | None = None
    noslip_iterations: Annotated[int, Strict(), Field(ge=0, le=1000)] | None = None
    solver: Literal["Newton", "CG", "PGS"] | None = None
    contact_solref: tuple[Positive, Positive] | None = None
    contact_solimp: tuple[_Share, _Share, Positive, _Share, Finite] | None = None

    @model_validator(mode="after")
    def _one_load(self) -> "PresetSpec":
        if self.force is not None and self.gravity is not None:
            raise ValueError("gravity and force exclude each other")
        return self


# Fields whose name in the settings says the unit, and those that need more than a copy.
_RENAMED = {
    "object_mass": "object_mass_kg",
    "patch_radius": "patch_radius_m",
    "close": "close_s",
    "squeeze": "squeeze_s",
    "settle": "settle_s",
    "hold": "hold_s",
    "turn": "turn_s",
    "rest": "rest_s",
    "slip_limit": "slip_limit_m",
    "firm_limit": "firm_limit_m",
    "penetration_limit": "penetration_limit_m",
    "gap_limit": "gap_limit_m",
    "creep_budget": "creep_budget_m_s",
    "planned_force": "planned_force_N",
    "timestep": "timestep_s",
}
_IN_DEGREES = {"rotation_limit_deg": "rotation_limit_rad", "creep_budget_deg": "creep_budget_rad_s"}
_APART = ("description", "directions", "force")


def preset_names() -> tuple[str, ...]:
    """Names of the built-in presets."""
    return tuple(preset_specs())


@cache
def preset_specs() -> dict[str, PresetSpec]:
    """The built-in presets by name."""
    with as_file(PRESETS_FILE) as path:
        return read_presets(path)


def read_presets(path: Path) -> dict[str, PresetSpec]:
    """Reads a file of presets.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    found = {}
    for name, entry in read_yaml(path).items():
        if not isinstance(entry, dict):
            raise InputError(path, str(name), "must be a mapping")
        try:
            found[str(name)] = parse(PresetSpec, entry, path)
        except InputError as error:
            field = f"{name}.{error.field}" if error.field else str(name)
            raise InputError(path, field, error.allowed) from None
    return found


def preset_settings(
    name: str, task: Task, *, directions_name: str | None = None, specs: dict[str, PresetSpec] | None = None
) -> HoldSettings:
    """The settings of a preset for a task.

    Args:
        name: of the preset.
        task: whose directions and object are meant.
        directions_name: a set of directions in place of the preset's; see `directions`.
        specs: presets to choose from; None takes the built-in ones.

    Raises:
        UnknownName: no such preset, or no such set of directions.
    """
    specs = preset_specs() if specs is None else specs
    if name not in specs:
        raise UnknownName("preset", "", "preset", name, specs)
    spec = specs[name]
    settings = replace(
        HoldSettings(),
        preset=name,
        directions=directions(directions_name or spec.directions, task),
        **_own_fields(spec),
    )
    if spec.force is None:
        return settings
    return replace(settings, gravity=spec.force / payload(task, settings).inertia.mass)


def _own_fields(spec: PresetSpec) -> dict[str, Any]:
    """What the preset says, by the names of the settings."""
    fields: dict[str, Any] = {}
    for name in spec.model_fields_set.difference(_APART):
        value = getattr(spec, name)
        if name in _IN_DEGREES:
            fields[_IN_DEGREES[name]] = None if value is None else radians(value)
        else:
            fields[_RENAMED.get(name, name)] = value
    return fields
