"""The columns of a table of grasps: name, kind, and what each says. The one place that defines the schema."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

__all__ = ["COLUMNS", "SCHEMA_VERSION", "Column", "Kind"]

SCHEMA_VERSION = 1
"""Raised whenever a column is added, removed or given another meaning."""

Kind: TypeAlias = Literal[
    "text", "texts", "whole", "number", "numbers", "truth", "numbers by name", "texts by name",
    "contacts", "directions",
]  # fmt: skip


@dataclass(frozen=True)
class Column:
    """A column.

    Attributes:
        name: in SI units where it ends with one.
        kind: what its values are; all but `row` and the texts that identify may be missing.
        says: its meaning.
    """

    name: str
    kind: Kind
    says: str


COLUMNS = (
    Column("row", "whole", "number of the row, from 0; what `holdfast check FILE --row N` takes"),
    Column("schema_version", "whole", "version of this list of columns"),
    Column("holdfast", "text", "version that made the run"),
    Column("versions", "texts by name", "versions of the libraries that decide the figures"),
    Column("run", "text", "the run folder, as a path from the table's folder"),
    Column("grasp", "text", "name of the grasp in its run"),
    Column("task", "text", "name of the task"),
    Column("task_source", "text", "what loads the task: a name, or a path from the table's folder"),
    Column("task_hash", "text", "hash of all of the task that a result depends on"),
    Column("hand", "text", "name of the hand"),
    Column("hand_hash", "text", "hash of the hand's model"),
    Column("object", "text", "name of the object"),
    Column("object_hash", "text", "hash of the object's model"),
    Column("seed", "whole", "random seed of the run"),
    Column("settings", "texts by name", "settings of the run and of its hold test, each as JSON"),
    Column("run_verdict", "text", "held, not held, infeasible or undecided"),
    Column("run_complete", "truth", "whether the run came to its end"),
    Column("solve_verdict", "text", "what the solver said: solved, infeasible or undecided"),
    Column("joints", "numbers by name", "position of every joint, coupled ones included, in rad or m"),
    Column("object_position_m", "numbers", "of the object in the palm frame"),
    Column("object_quaternion", "numbers", "of the object in the palm frame: w, x, y, z"),
    Column("parameters", "numbers", "where on each Bezier patch the contact lies, hand side first"),
    Column(
        "contacts",
        "contacts",
        "regions, point and outward normal of the object in the palm frame, gap and angle",
    ),
    Column("certified", "truth", "whether a true solution is proved to lie within certified_radius"),
    Column("certified_radius", "number", "in the solver's variables"),
    Column("residual_m", "number", "largest absolute value of the contact equations"),
    Column("strengthened", "truth", "whether it slid to where a squeeze carries more"),
    Column("clear", "truth", "whether nothing sinks in"),
    Column("clearance_status", "text", "clear, retracted or failed"),
    Column("clearance_before_m", "number", "least distance of bodies that should not touch, as solved"),
    Column("clearance_m", "number", "the same after retraction; negative where they overlap"),
    Column("clearance_pair", "texts", "the two bodies nearest to each other"),
    Column("reachable", "truth", "whether the fingers' way there is clear"),
    Column("tested", "truth", "whether it was simulated"),
    Column("test", "text", "lift, turn or press"),
    Column("preset", "text", "settings of the test by name"),
    Column("held", "truth", "whether it passed its test"),
    Column("narrow", "truth", "whether it passed, but not where one finger arrives first"),
    Column("good", "truth", "certified, clear and held"),
    Column("margin", "number", "multiple of the load up to which it passes"),
    Column("settings_agree", "truth", "whether other numerical settings say the same"),
    Column("slip_m", "number", "largest over the directions of gravity"),
    Column("turn_rad", "number", "largest over the directions of gravity"),
    Column("creep_m_s", "number", "largest over the directions of gravity"),
    Column("directions", "directions", "the test by direction of gravity in the palm frame"),
    Column("reason", "text", "why it was not tested, or what failed first"),
    Column("squeeze_N", "number", "largest normal force of the squeeze"),
    Column("load_factor", "number", "multiples of the load that the squeeze balances by plan"),
    Column("slack_N", "number", "proved: what every contact may lose before it slips"),
    Column("proved_clear", "truth", "whether it is proved that nothing sinks in"),
    Column("proved_approach", "truth", "whether the way there is in that proof"),
    Column("quality", "numbers by name", "analytic measures"),
    Column("record", "text", "the whole grasp as in run.json, as JSON, without slip curves"),
    Column("seal", "text", "SHA-256 over the other columns, which shows any later change"),
)
