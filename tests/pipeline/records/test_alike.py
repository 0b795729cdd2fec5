"""Grasps that climbs have led to the same place count once as different ones."""

from holdfast.pipeline.records import GraspRecord, RunRecord
from holdfast.pipeline.records.alike import different


def changed(grasp: GraspRecord, **change: object) -> GraspRecord:
    return grasp.model_copy(update=change)


def test_what_differs_by_little_is_alike_and_by_more_is_not(run_record: RunRecord) -> None:
    grasp = run_record.grasps[0]
    joint = next(iter(grasp.joints))
    x, y, z = grasp.object.position
    w, *rest = grasp.object.quaternion

    def turned(by: float) -> GraspRecord:
        return changed(grasp, joints={**grasp.joints, joint: grasp.joints[joint] + by})

    def shifted(by: float) -> GraspRecord:
        return changed(grasp, object=grasp.object.model_copy(update={"position": (x, y + by, z)}))

    opposite = changed(
        grasp, object=grasp.object.model_copy(update={"quaternion": (-w, *(-c for c in rest))})
    )
    for other in (turned(0.005), shifted(0.0005), opposite):
        assert different([grasp, other]) == [grasp]
    for other in (turned(0.02), shifted(-0.002)):
        assert different([grasp, other, other]) == [grasp, other]
    assert different([]) == []


def test_a_turn_about_the_line_of_a_pinch_makes_a_different_grasp(run_record: RunRecord) -> None:
    grasp = run_record.grasps[0]
    spun = changed(grasp, object=grasp.object.model_copy(update={"quaternion": (0.0, 1.0, 0.0, 0.0)}))
    assert len(different([grasp, spun])) == 2
