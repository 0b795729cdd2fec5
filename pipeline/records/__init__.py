"""What runs leave in files, and the way between records and the values they stand for."""

from .approach import approach_record, to_approach
from .carrying import CarryingRecord
from .choosing import Choosing
from .configuration import as_written, to_configuration, to_solution, to_state, vector3
from .difference import difference, setting_difference
from .evidence import EvidenceRecord, evidence_record, seal_of
from .explained import Explained, Relaxed
from .fingerprint import fingerprint
from .grasp import Approach, Clearance, GraspFile, GraspRecord, read_grasp, updated
from .hold import Direction, FingerFirst, Hold, LessSpin, Limit, Setting, Squeeze
from .made import Made
from .motion import thinned
from .run import MOST_SHOWN, Round, RunRecord, SearchStep, Solve, read_run
from .run_folder import RunFolder
from .solution import Contact, ObjectPose, Solution, plain_identifier, to_json
from .task_source import (
    builtin_reference,
    existing_source,
    file_head,
    load_grasp_task,
    relative_source,
    resolve_source,
    write_solutions,
)

__all__ = [
    "MOST_SHOWN",
    "Approach",
    "CarryingRecord",
    "Choosing",
    "Clearance",
    "Contact",
    "Direction",
    "EvidenceRecord",
    "Explained",
    "FingerFirst",
    "GraspFile",
    "GraspRecord",
    "Hold",
    "LessSpin",
    "Limit",
    "Made",
    "ObjectPose",
    "Relaxed",
    "Round",
    "RunFolder",
    "RunRecord",
    "SearchStep",
    "Setting",
    "Solution",
    "Solve",
    "Squeeze",
    "approach_record",
    "as_written",
    "builtin_reference",
    "difference",
    "evidence_record",
    "existing_source",
    "file_head",
    "fingerprint",
    "load_grasp_task",
    "plain_identifier",
    "read_grasp",
    "read_run",
    "relative_source",
    "resolve_source",
    "seal_of",
    "setting_difference",
    "thinned",
    "to_approach",
    "to_configuration",
    "to_json",
    "to_solution",
    "to_state",
    "updated",
    "vector3",
    "write_solutions",
]
