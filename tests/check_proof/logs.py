"""Proof logs for the tests: how they are read, forged and sealed, and small systems and tasks to refute."""

import copy
import dataclasses
import gzip
import hashlib
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from holdfast.check_proof import check_proof
from holdfast.geometry import BezierPatch, Patch
from holdfast.objects import Contact, ObjectRegion, Task, load_task
from holdfast.solver.contraction.prune import Pruner
from holdfast.solver.interval import COSINE, SINE
from holdfast.solver.polynomial.canonical import canonical_form
from holdfast.solver.polynomial.system import PolynomialSystem, SystemBuilder
from holdfast.solver.proof.log import BoxRecord, BoxTrace, ProofWriter

Records = list[dict[str, Any]]


def read(path: Path) -> Records:
    return [json.loads(line) for line in gzip.decompress(path.read_bytes()).splitlines()]


def line(record: dict[str, Any]) -> bytes:
    return json.dumps(record, separators=(",", ":")).encode() + b"\n"


def write(path: Path, records: Records) -> Path:
    path.write_bytes(gzip.compress(b"".join(map(line, records)), 1))
    return path


def sealed(records: Records) -> Records:
    """With counts and checksum to match, as a forger would write them."""
    body = [r for r in records if "end" not in r]
    digest = hashlib.sha256()
    for record in body:
        digest.update(line(record))
    boxes = [r for r in body if "box" in r]
    steps = sum(len(r["steps"]) for r in boxes)
    end = {"boxes": len(boxes), "steps": steps, "sha256": digest.hexdigest()}
    return [*body, {"end": end}]


def boxes_of(records: Records) -> Records:
    return [r for r in records if "box" in r]


def steps_of(records: Records, kind: str) -> list[list[Any]]:
    return [s for r in boxes_of(records) for s in r["steps"] if s[0] == kind]


def circle(product: float, *, at: tuple[float, float] = (0.5, 0.75)) -> PolynomialSystem:
    """x^2 + y^2 = 13/16 with x y = `product`: at most 13/32; (1/2, 3/4) solves it for 3/8."""
    builder = SystemBuilder()
    x, y = (builder.variable(name, -2.0, 2.0) for name in "xy")
    builder.equate(x * x + y * y - (at[0] ** 2 + at[1] ** 2))
    builder.equate(x * y - product)
    return builder.build()


def saddle(height: float) -> PolynomialSystem:
    """z = f(u, v), a biquadratic, and u v = 1/8 with z = `height`; 11/32 is f at (1/4, 1/2)."""
    builder = SystemBuilder()
    u, v = builder.variable("u", 0.0, 1.0), builder.variable("v", 0.0, 1.0)
    z = builder.bernstein("z", u, v, np.array([[0.0, 0.5, 0.0], [0.5, 0.25, 0.75], [0.0, 1.0, 0.5]]))
    builder.equate(u * v - 0.125)
    builder.equate(z - height)
    return builder.build()


def search(system: PolynomialSystem, path: Path, tightened: int = 2, most: int = 200) -> bool:
    """Branch and prune with a log; a box that can't be refuted is called empty, which gives False."""
    form = canonical_form(system)
    pruner = Pruner(form, system.inputs)
    writer = ProofWriter(path, form, "toy")
    stack, honest = [pruner.root], True
    while stack:
        box = stack.pop()
        trace = BoxTrace(form)
        pruned = pruner.prune(box, tightened=tightened, trace=trace)
        most -= 1
        is_small = pruned is not None and bool(np.all((pruned.upper - pruned.lower)[system.inputs] < 0.05))
        if pruned is None or is_small or most < 0:
            honest &= pruned is None
            writer.add(BoxRecord(box.path, trace.steps, None))
        else:
            writer.add(BoxRecord(box.path, trace.steps, pruner.cut(pruned)))
            stack.extend(pruner.split(pruned))
    writer.finish()
    return honest


def linkage(reach: float, ratio: float = 1.05851325) -> PolynomialSystem:
    """Two rods, the second turning by more than the first: cos x + cos(ratio x + 0.1) = `reach`.

    With x from 0.2 to 1.2 the sum goes from 1.9326 down to 0.5138, and so comes to each value between.
    """
    builder = SystemBuilder()
    x = builder.variable("x", 0.2, 1.2)
    y = builder.variable("y", 0.0, 2.0)
    (c, s), (d, t) = (
        [builder.trig(f"{kind}", x, kind, r, offset) for kind in (COSINE, SINE)]
        for r, offset in ((1.0, 0.0), (ratio, 0.1))
    )
    builder.equate(c + d - y)
    builder.equate(s * d + c * t - builder.trig("sum", x, SINE, 1.0 + ratio, 0.1))
    builder.equate(y - reach)
    return builder.build()


INFEASIBLE = {"circle": circle(0.41), "saddle": saddle(0.37)}
FEASIBLE = {"circle": circle(0.375), "saddle": saddle(11 / 32)}


@cache
def _upholding() -> Task:
    return load_task("upholding")


def plates(half_thickness: float, degree: int = 1) -> Task:
    """Index and thumb on opposite faces of a plate, 40 mm square, plane or bulging by 3 mm."""
    w, side = 0.02, np.linspace(-1.0, 1.0, degree + 1)
    x, y = np.meshgrid(side, side, indexing="ij")
    bulge = 0.003 * (1.0 - x**2) * (1.0 - y**2)
    top = np.stack([w * x, w * y, half_thickness + bulge], axis=-1)
    bottom = (top * np.array([1.0, 1.0, -1.0]))[:, ::-1]
    task = _upholding()
    contacts = tuple(
        Contact(task.hand.regions[hand], ObjectRegion(name, Patch(BezierPatch(net), off_surface=True)))
        for hand, name, net in (("index/tip", "r0", bottom), ("thumb/tip", "r1", top))
    )
    return dataclasses.replace(task, contacts=contacts)


def check(records: Records, folder: Path) -> str:
    """The reason why forged records are rejected; empty where they are not."""
    return check_proof(write(folder / "forged.proof", records)).reason


def forged(records: Records, change: Callable[[list[Any]], object]) -> Records:
    """The log with each plane `[function, slope, slope]` changed in place."""
    records = copy.deepcopy(records)
    for *_, planes in steps_of(records, "over"):
        for plane in planes:
            change(plane)
    return sealed(records)
