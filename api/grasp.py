"""From a configuration to a grasp that can be tried, saved and exported."""

from collections.abc import Iterable
from dataclasses import dataclass, fields
from pathlib import Path

from ..arguments import check_instance, check_path
from ..base.files.output_file import write_json, write_text
from ..base.machine.backend import configure
from ..errors import InputError
from ..evidence import CertifiedClear, CertifiedStable, NotCertified, certify_clear, certify_stable
from ..grasping import ReadyGrasp, Refusal, Trial, try_hold
from ..grasping import make_grasp as make_ready_grasp
from ..mjcf import HoldResult, Noise, preset_settings
from ..mjcf import hold_many as lift_many
from ..objects import Task
from ..pipeline.records import (
    GraspFile,
    builtin_reference,
    file_head,
    load_grasp_task,
    plain_identifier,
    read_grasp,
    to_configuration,
    to_json,
)
from ..pipeline.run import new_grasp, proved, with_clearing, with_quality, with_trial
from ..retraction import RetractionSettings
from ..solver import Configuration

__all__ = ["Grasp", "hold", "hold_many", "load_configuration", "make_grasp"]


@dataclass(frozen=True, eq=False, repr=False)
class Grasp(ReadyGrasp):
    """A grasp: certified where its configuration is, free of penetration, and squeezed.

    See `grasping.ReadyGrasp` for what it is made of.
    """

    @property
    def task(self) -> Task:
        """What it was made for."""
        return self.configuration.task

    @property
    def certified(self) -> bool:
        """Whether a true solution of the contact equations was proved at its configuration."""
        return self.configuration.certified

    @property
    def joints(self) -> dict[str, float]:
        """Angle (rad) or position (m) of every joint by its name where the contacts just touch."""
        return self.configuration.joints

    @property
    def targets(self) -> dict[str, float]:
        """What the servos are told to squeeze, by independent joint, in rad or m."""
        names = self.task.hand.independent_names
        return dict(zip(names, self.squeeze.targets.tolist(), strict=True))

    def __repr__(self) -> str:
        return f"<{self}>"

    def save(self, path: str | Path, trial: Trial | None = None) -> Path:
        """Writes it as a grasp file, which `holdfast hold`, `render` and `clear` read.

        What can be proved of it beside a verdict goes with it, for `holdfast check-proof`.

        Args:
            path: the file. A regular file there is replaced, and what a link names; pipes and devices are
                written through. The grasp is named as the file is, with `_` for what names do not have.
            trial: its hold test, where it was put to one.

        Returns:
            The path.

        Raises:
            InputError: a file that can't be written.
        """
        path = check_path("path", path)
        record = new_grasp(self.configuration, plain_identifier(path.stem))
        if self.clearing is not None:
            record = with_clearing(record, self.clearing)
        if trial is not None:
            check_instance("trial", trial, Trial, "what hf.hold gives")
            record = with_quality(with_trial(record, trial), trial.grasp.quality)
        record = proved(record, self.task, self.squeeze.settings, path)
        head = file_head(self.task, builtin_reference(self.task), path)
        write_json(path, to_json(GraspFile.model_validate({**dict(record), **head})))
        return path

    def certify_stable(self) -> CertifiedStable | NotCertified:
        """Proves, where it can, that true forces balance the load inside the friction cones and efforts.

        Returns:
            The statement with its slack in N, or a `NotCertified`, which is false, says why, and says nothing
            against the grasp.
        """
        return certify_stable(self.configuration, self.squeeze)

    def certify_clear(self) -> CertifiedClear | NotCertified:
        """Proves, where it can, that nothing sinks in deeper than it may, in the grasp and on the way to it.

        Returns:
            The statement, or a `NotCertified`, which is false, says why, and says nothing against the grasp.
        """
        margin_m = 0.0 if self.clearing is None else self.clearing.margin_m
        retraction = RetractionSettings(margin_m=margin_m)
        return certify_clear(self.configuration, self.approach, retraction=retraction)

    def to_mjcf(self, path: str | Path | None = None) -> str:
        """Hand, object and grasp as a MuJoCo model, which squeezes as it is loaded and stepped.

        Args:
            path: where to write it; None to write nothing.

        Returns:
            The model as text.

        Raises:
            InputError: a file that can't be written.
        """
        target = None if path is None else check_path("path", path)
        configure()
        text = self.grasp.mjcf()
        if target is not None:
            write_text(target, text)
        return text


def make_grasp(
    configuration: Configuration, *, preset: str = "holdfast", margin_m: float = 0.0
) -> Grasp | Refusal:
    """Strengthens a configuration, frees it of penetration, and plans a squeeze that carries the task's load.

    Args:
        configuration: one that `hf.solve` found.
        preset: settings of the hold test that the squeeze is planned for, by name.
        margin_m: distance asked for between bodies that should not touch.

    Returns:
        A `Grasp`, or a `Refusal`, which is false and says why.

    Raises:
        InputError: something else than a configuration, an unknown preset, or a margin that can't be.
    """
    configuration = check_instance(
        "configuration", configuration, Configuration, "a configuration, such as hf.solve(task)[0]"
    )
    configure()
    made = make_ready_grasp(
        configuration,
        settings=preset_settings(preset, configuration.task),
        retraction=RetractionSettings(margin_m=margin_m),
    )
    if isinstance(made, Refusal):
        return made
    return Grasp(**{entry.name: getattr(made, entry.name) for entry in fields(ReadyGrasp)})


def hold(
    grasp: ReadyGrasp,
    *,
    preset: str | None = None,
    margin: bool = False,
    agreement: bool = False,
    noise_trials: int = 0,
    seed: int = 0,
) -> Trial:
    """Puts a grasp to the physical test of its task.

    Args:
        grasp: what `hf.make_grasp` gave.
        preset: settings of the test by name; None takes those that the squeeze was planned for.
        margin: whether to look for the load at which it first fails.
        agreement: whether to repeat the test with other numerical settings.
        noise_trials: how often to repeat it with noise, for the probability of passing.
        seed: of the noise.

    Raises:
        InputError: something else than a grasp, a refusal among others; an unknown preset.
    """
    if isinstance(grasp, Refusal):
        check_instance("grasp", grasp, ReadyGrasp, f"a grasp, and this is a refusal ({grasp})")
    grasp = check_instance("grasp", grasp, ReadyGrasp, "a grasp, as hf.make_grasp gives it")
    configure()
    return try_hold(
        grasp,
        settings=None if preset is None else preset_settings(preset, grasp.configuration.task),
        margin=margin,
        agreement=agreement,
        noise=Noise(trials=noise_trials, seed=seed) if noise_trials else None,
    )


def hold_many(
    grasps: Iterable[ReadyGrasp], *, preset: str = "no_noslip", device: str | None = None
) -> list[Trial]:
    """Puts grasps to the lift of their tasks side by side, in MuJoCo Warp; needs `holdfast[gpu]`.

    Args:
        grasps: what `hf.make_grasp` gave.
        preset: settings of the test by name.
        device: Warp's name of where to simulate, such as `cuda:0` or `cpu`; None takes a GPU if there is one.

    Raises:
        InputError: something else than grasps to lift, an unknown preset, or a device that isn't there.
        MissingBackend: MuJoCo Warp is not installed.
    """
    if not isinstance(grasps, Iterable):
        raise InputError("grasps", "", "must be grasps, as hf.make_grasp gives them")
    grasps = list(grasps)  # also of a generator, which can be gone through once
    for i, grasp in enumerate(grasps):
        check_instance(f"grasps.{i}", grasp, ReadyGrasp, "a grasp, as hf.make_grasp gives it")
    configure()
    by_task: dict[int, list[int]] = {}
    for i, grasp in enumerate(grasps):
        by_task.setdefault(id(grasp.configuration.task), []).append(i)
    results: dict[int, HoldResult] = {}
    for rows in by_task.values():
        settings = preset_settings(preset, grasps[rows[0]].configuration.task)
        found = lift_many([grasps[i].grasp for i in rows], settings=settings, device=device)
        results |= dict(zip(rows, found, strict=True))
    return [Trial(grasp, results[i]) for i, grasp in enumerate(grasps)]


def load_configuration(path: str | Path, task: Task | str | None = None) -> Configuration:
    """The configuration of a grasp file, certified anew.

    Args:
        path: the file.
        task: the task that it is for; None where the file names it.

    Raises:
        InputError: a file or a task that can't be used, or that do not go together.
    """
    path = check_path("path", path)
    record = read_grasp(path)
    loaded = task if isinstance(task, Task) else load_grasp_task(record, path, task)
    return to_configuration(record, loaded, path)
