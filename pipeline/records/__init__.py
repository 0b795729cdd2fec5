"""What runs leave in files, and the way between records and the values they stand for."""

from .convert import (
    approach_record,
    file_head,
    load_grasp_task,
    relative_source,
    resolve_source,
    to_approach,
    to_configuration,
    to_solution,
    updated,
    vector3,
)
from .fingerprint import fingerprint
from .records import (
    Direction,
    GraspFile,
    GraspRecord,
    Hold,
    Round,
    RunRecord,
    Setting,
    Solution,
    Solve,
    read_grasp,
    to_json,
)
from .run_folder import RunFolder

__all__ = [
    "Direction",
    "GraspFile",
    "GraspRecord",
    "Hold",
    "Round",
    "RunFolder",
    "RunRecord",
    "Setting",
    "Solution",
    "Solve",
    "approach_record",
    "file_head",
    "fingerprint",
    "load_grasp_task",
    "read_grasp",
    "relative_source",
    "resolve_source",
    "to_approach",
    "to_configuration",
    "to_json",
    "to_solution",
    "updated",
    "vector3",
]
