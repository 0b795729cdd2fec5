"""A run whose grasps are tested in the order that a model chooses."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from holdfast.errors import InputError, UnknownName
from holdfast.grasping import ReadyGrasp
from holdfast.objects import Task, load_task
from holdfast.pipeline.batch.outcome import RunOutcome
from holdfast.pipeline.choice import OBJECT_FEATURES, candidate_specs
from holdfast.pipeline.choose import Model, ModelChooser, Provenance
from holdfast.pipeline.choose.heads import Linear
from holdfast.pipeline.choose.inputs import Input
from holdfast.pipeline.cli.commands.grasps.run import summary
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import RunFolder, RunRecord, read_run
from holdfast.pipeline.report.reproduce import command_of
from holdfast.pipeline.run import RunSettings, run_task

MODEL = Provenance(data="0" * 64, hands={"sa": ""}, objects=["a"], situations=1, candidates=2, draws=3)


def model_of(feature: str, weight: float = 1.0) -> Model:
    """A model that goes by one feature."""
    columns = [column for column in (*candidate_specs(30), *OBJECT_FEATURES) if column.name == feature]
    head = Linear(mean=[0.0], scale=[1.0], weights=[weight])
    inputs = (Input(feature=feature, form="value"),)
    return Model(f"formula:{feature}", 0, tuple(columns), inputs, np.array([1.0]), (head,), MODEL)


class Recording:
    """A chooser that goes by a model, and keeps what it was shown."""

    def __init__(self, model: Model):
        self._inner = ModelChooser(model, "model.json")
        self.policy, self.digest = self._inner.policy, self._inner.digest
        self.shown: list[Sequence[ReadyGrasp]] = []

    def check(self, task: Task) -> None:
        self._inner.check(task)

    def scores(self, made: Sequence[ReadyGrasp]) -> np.ndarray:
        self.shown.append(list(made))
        return self._inner.scores(made)


def run(path: Path, chooser: Recording, **more: object) -> RunRecord:
    settings = RunSettings(candidates=3, wanted=1, quick=True, chooser=chooser)
    return run_task("upholding", path, settings, **more)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def chosen(tmp_path_factory: pytest.TempPathFactory) -> tuple[RunRecord, Recording, Path]:
    """A run in which the weakest squeeze goes first."""
    chooser = Recording(model_of("f_force_sum", -1.0))
    path = tmp_path_factory.mktemp("chosen") / "run"
    return run(path, chooser), chooser, path


def test_the_order_is_that_of_the_scores(chosen: tuple[RunRecord, Recording, Path]) -> None:
    record, chooser, path = chosen
    assert record.choosing is not None and record.complete
    assert (record.choosing.policy, record.choosing.model) == (chooser.policy, chooser.digest)
    assert record.settings["chooser"] == chooser.digest
    # As they were made: trials may have chosen another squeeze since.
    forces = [grasp.squeeze.preload[:, 0].sum() for grasp in chooser.shown[0]]
    assert record.choosing.order == [f"g{place + 1:02}" for place in np.argsort(forces)]
    assert read_run(path / "run.json").choosing == record.choosing


def test_results_are_those_of_the_usual_order(
    chosen: tuple[RunRecord, Recording, Path], run_path: Path
) -> None:
    """What is tested first changes nothing in what comes of it."""
    usual = {grasp.id: grasp for grasp in read_run(run_path / "run.json").grasps}
    assert usual.keys() == {grasp.id for grasp in chosen[0].grasps}
    for grasp in chosen[0].grasps:
        other = usual[grasp.id]
        assert (grasp.joints, grasp.object, grasp.clearance) == (other.joints, other.object, other.clearance)
        assert grasp.hold is not None and other.hold is not None
        assert grasp.hold.directions == other.hold.directions


def test_a_resumed_run_goes_on_in_the_same_order(
    chosen: tuple[RunRecord, Recording, Path], tmp_path: Path
) -> None:
    record, chooser, _ = chosen
    path = tmp_path / "run"
    first = run(path, chooser, should_stop=lambda: bool(list(path.glob("grasps/*.json"))))
    assert not first.complete and first.choosing is not None and record.choosing is not None
    done = [grasp.id for grasp in first.grasps if grasp.is_done]
    assert first.choosing.order == done == record.choosing.order[: len(done)]
    assert 0 < len(done) < 3
    shown = len(chooser.shown)
    again = run(path, chooser, resume=True)
    assert again.choosing == record.choosing
    assert len(chooser.shown) == shown  # the order is on record: nothing is made to be compared anew
    assert [grasp.id for grasp in again.grasps] == [grasp.id for grasp in record.grasps]
    other = Recording(model_of("f_force_sum"))
    with pytest.raises(InputError, match="chooser"):
        run(path, other, resume=True)


def test_once_enough_hold_the_rest_is_left(chosen: tuple[RunRecord, Recording, Path], tmp_path: Path) -> None:
    """Interrupted or not; and a run that asks for the rest after all has it."""
    whole, chooser, _ = chosen
    assert whole.choosing is not None and len(whole.good) == 3
    path, enough = tmp_path / "run", RunSettings(candidates=3, enough=2, quick=True, chooser=chooser)
    record = run_task("upholding", path, enough)
    assert record.complete and record.choosing is not None and record.enough == 2
    assert record.choosing.ready == whole.choosing.order
    assert record.choosing.order == whole.choosing.order[:2] and record.choosing.spared == 1
    assert [grasp.id for grasp in record.left_untested] == whole.choosing.order[2:]
    assert len(list(path.glob("grasps/*.json"))) == 2
    assert "; 1 test not made, as enough hold" in record.choosing.words
    assert "; 1 left untested, as 2 should be enough" in summary(record)
    report = (path / "report.html").read_text("utf-8")
    assert "1 of 3 configurations were not tested, as 2 should be enough" in report
    assert "Not tried: enough others hold." in report
    assert "--enough 2" in command_of(record)
    # Ended after its last test, before it was whole.
    RunFolder(path).save(record.model_copy(update={"complete": False}))
    assert untimed(run_task("upholding", path, enough, resume=True)) == untimed(record)
    assert RunOutcome.of(record, "r").left == 1
    after_all = RunSettings(candidates=3, wanted=2, quick=True, chooser=chooser)
    again = run_task("upholding", path, after_all, resume=True)
    assert again.complete and again.enough is None and not again.left_untested
    assert again.choosing == whole.choosing
    for grasp in whole.grasps:
        assert next(other for other in again.grasps if other.id == grasp.id) == grasp


def untimed(record: RunRecord) -> RunRecord:
    return record.model_copy(update={"seconds": {}})


def test_enough_stands_in_place_of_wanted(capsys: pytest.CaptureFixture[str]) -> None:
    assert RunSettings(candidates=3, enough=7).grasps_wanted == 7
    with pytest.raises(InputError, match="enough: stands in place of wanted"):
        RunSettings(wanted=1, enough=1)
    with pytest.raises(InputError, match="enough"):
        RunSettings(enough=0)
    for command in (["run", "upholding"], ["batch", "upholding", "--out", "nowhere"]):
        assert main([*command, "--wanted", "1", "--enough", "1"]) == 2
        assert "not allowed with argument --wanted" in capsys.readouterr().err


def test_tests_before_the_first_pass_are_counted(chosen: tuple[RunRecord, Recording, Path]) -> None:
    from holdfast.pipeline.run.choosing import _failed_before

    record, _, _ = chosen
    assert record.choosing is not None
    good = record.good[0]
    assert good.hold is not None
    failed = good.model_copy(update={"hold": good.hold.model_copy(update={"held": False})})
    untested = good.model_copy(
        update={"hold": good.hold.model_copy(update={"held": False, "directions": []})}
    )
    unknown = good.model_copy(update={"hold": None})
    assert _failed_before([failed, untested, failed, good, failed]) == 2
    assert _failed_before([good, unknown]) == 0
    assert _failed_before([unknown, good]) is None
    assert _failed_before([failed, untested]) is None


@pytest.mark.parametrize(
    ("before", "usually", "words"),
    [
        (None, None, "none of 3 passed"),
        (1, None, "1 test failed before the first that was passed"),
        (0, 2, "no test failed before the first that was passed, 2 in the usual order: 2 saved"),
        (2, 1, "2 tests failed before the first that was passed, 1 in the usual order: 1 more"),
    ],
)
def test_what_the_order_saved_is_said(
    chosen: tuple[RunRecord, Recording, Path], before: int | None, usually: int | None, words: str
) -> None:
    assert chosen[0].choosing is not None
    found = chosen[0].choosing.model_copy(update={"before": before, "before_usually": usually})
    assert found.words == f"chosen by formula:f_force_sum: {words}"


def test_features_are_those_of_the_data(chosen: tuple[RunRecord, Recording, Path]) -> None:
    """Each grasp by itself, in any order, with a hand of any number of joints."""
    made = chosen[1].shown[0]
    force = ModelChooser(model_of("f_force_sum"), "m").scores(made)
    squeezes = [one.squeeze.preload[:, 0].sum() for one in made]
    assert force == pytest.approx(squeezes, rel=1e-6)
    assert np.array_equal(ModelChooser(model_of("f_force_sum"), "m").scores(made[::-1]), force[::-1])
    assert len(ModelChooser(model_of("f_force_sum"), "m").scores([])) == 0
    joint = ModelChooser(model_of("f_joint_29"), "m").scores(made)
    assert np.array_equal(joint, np.zeros(len(made)))
    mass = ModelChooser(model_of("o_mass"), "m").scores(made)
    assert mass == pytest.approx([made[0].configuration.task.object.inertia.mass] * len(made))


def test_a_model_that_does_not_fit_is_refused_before_anything_is_done(tmp_path: Path) -> None:
    task = load_task("upholding")
    joints = model_of("f_joint_02")
    ModelChooser(joints, "m.json").check(task)
    foreign = replace(joints, trained_on=MODEL.model_copy(update={"hands": {"shadow": ""}}))
    with pytest.raises(InputError, match="goes by features of its hands alone"):
        ModelChooser(foreign, "m.json").check(task)
    changed = replace(joints, trained_on=MODEL.model_copy(update={"hands": {"sa": "0" * 64}}))
    with pytest.raises(InputError, match="another hand by the name of 'sa'"):
        ModelChooser(changed, "m.json").check(task)
    free = replace(model_of("f_epsilon"), trained_on=foreign.trained_on)
    ModelChooser(free, "m.json").check(task)
    columns = tuple(replace(one, name="f_colour") for one in joints.columns)
    unknown = replace(joints, columns=columns, inputs=(Input(feature="f_colour", form="value"),))
    with pytest.raises(UnknownName, match="f_colour"):
        run(tmp_path / "run", Recording(unknown))
    assert not (tmp_path / "run").exists()
