"""All solutions of one system by codac: HC4, interval Newton and bisection. For `solver.py`.

Reads {"variables", "equations", "cap", "centred"} from standard input and writes {"finished", "solutions",
"unproved", "boxes", "seconds"}. Centred: with codac's centred form, which is faster, but may lose solutions
(those of broydentri10, above all). Seconds are CPU time after the imports and the building of the
contractors; the median of three runs where they are short.
"""

import json
import sys
import time

import codac

SMALL = 1e-8  # width at which a box that Newton can't decide is given up
INFLATED = 1e-7
LARGEST_INVERSE = 1e10


def formulate(variables: dict, equations: list, centred: bool) -> tuple:
    x = codac.VectorVar(len(variables))
    names = {name: x[k] for k, name in enumerate(variables)}
    # The texts are of the benchmark itself, and nothing else reads like a polynomial in codac.
    rows = [eval(text, {"__builtins__": {}}, names) for text in equations]  # noqa: S307
    f = codac.AnalyticFunction([x], codac.vec(*rows))
    zero = codac.IntervalVector([[0.0, 0.0]] * len(equations))
    return f, codac.CtcInverse(f, zero, with_centered_form=centred)


def newton(f, box, solver) -> tuple:
    """A smaller box, and whether exactly one solution is proved in `box`."""
    middle = codac.IntervalVector(box.mid())
    offset = box - middle
    before = codac.IntervalVector(offset)
    slopes = f.diff(box)
    # Without an inverse of the middle Jacobian there is no preconditioner, and codac's answer would be wrong.
    inverse = slopes.mid().inverse()
    if inverse.is_nan() or not max(inverse.max_coeff(), -inverse.min_coeff()) < LARGEST_INVERSE:
        return box, False
    solver.contract(slopes, offset, -f.eval(middle))
    unique = not offset.is_empty() and offset.is_interior_subset(before)
    return (middle + offset) & box, unique


def search(f, hc4, root, cap_s: float) -> dict:
    started = time.process_time()
    solver = codac.CtcLinearPrecond(codac.CtcGaussSeidel())
    square = f.output_size() == root.size()
    waiting, found, unproved, boxes = [root], [], 0, 0
    while waiting and time.process_time() - started < cap_s:
        box = codac.IntervalVector(waiting.pop())
        boxes += 1
        if any(box.is_subset(known) for known in found):
            continue
        width = box.max_diam()
        unique = False
        while True:
            hc4.contract(box)
            if box.is_empty():
                break
            if square:
                region = codac.IntervalVector(box)
                if (
                    region.max_diam() < INFLATED
                ):  # a box down to its last digits has no room to be mapped into
                    region.inflate(0.1 * INFLATED)
                box, unique = newton(f, region, solver)
                if unique or box.is_empty():
                    break
            if box.max_diam() > 0.9 * width:
                break
            width = box.max_diam()
        if box.is_empty():
            continue
        if unique:
            # The same solution found from a neighbouring box counts once.
            if not any(box.intersects(known) for known in found):
                found.append(region)
        elif box.max_diam() < SMALL:
            unproved += 1
        else:
            waiting += box.bisect_largest()
    return {
        "finished": not waiting,
        "solutions": len(found),
        "unproved": unproved,
        "boxes": boxes,
        "seconds": time.process_time() - started,
    }


def main() -> None:
    task = json.load(sys.stdin)
    f, hc4 = formulate(task["variables"], task["equations"], task["centred"])
    ends = [[float(low), float(high)] for low, high in task["variables"].values()]
    runs = [search(f, hc4, codac.IntervalVector(ends), task["cap"])]
    if runs[0]["seconds"] < 1.0:
        runs += [search(f, hc4, codac.IntervalVector(ends), task["cap"]) for _ in range(2)]
    runs.sort(key=lambda run: run["seconds"])
    print(json.dumps(runs[len(runs) // 2]))


if __name__ == "__main__":
    main()
