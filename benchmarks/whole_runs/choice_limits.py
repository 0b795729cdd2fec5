"""How well any choice among verified grasps could do: situations of a data set tried again under new draws.

Usage: ./run bench choice_limits --data DIR [--situations N] [--draws N] [--from-seed N]
                                 [--policies NAMES] [--seeds N] [--outcomes DIR] [--json FILE]

What becomes of a grasp depends on hidden draws, which nobody knows who chooses. So the oracle of a few draws,
who takes the grasp that held in most of them, owes much to luck. Here situations drawn at random, each of
another object (with --from-seed, of members of families with seeds from there on), are tried again under
many draws that no policy has seen. Whoever goes by tests of every candidate in all draws but the one that
counts does no better than the oracle of expectations, who knows each candidate's chance to hold; the oracle
of these draws does no worse. Policies are trained on the draws of the data, each fold of objects on the
others. Beside success, AUC within situations (in each draw, and by what becomes of a candidate in most draws)
and the failing tests saved there are two shares: of the gap from the best formula to the oracle of the draws,
and of that to whoever has made all those tests. Between them lies the share of the gap to the oracle of
expectations. --outcomes keeps what became of each situation, so that an interrupted benchmark goes on.
"""

import argparse
import re
import time
import zlib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from holdfast.base.files.json_file import read_json
from holdfast.base.files.output_file import write_json
from holdfast.base.machine.backend import configure
from holdfast.base.numeric.arrays import Array, Indices
from holdfast.base.text.console import format_table
from holdfast.base.text.plain_text import counted
from holdfast.pipeline.choice import DATASET_FILE, DrawRanges, draw, load_dataset, read_head, try_under
from holdfast.pipeline.choose import to_situations
from holdfast.pipeline.choose.policies import FORMULA, is_learned, prepare
from holdfast.pipeline.choose.situations import Situations
from holdfast.pipeline.choose.study import default_policies
from holdfast.pipeline.choose.study.evaluation import unseen_scores
from holdfast.pipeline.choose.study.intervals import Estimate, mean_over_objects, ratio_over_objects
from holdfast.pipeline.choose.study.measures import Figures, figures, figures_by_other_draws, oracle_scores
from holdfast.pipeline.choose.study.splits import PROTOCOLS
from holdfast.pipeline.environment.stored import StoredSituations

_TESTS = (1, 3, 7, 15)
_SEED = 21


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--situations", type=int, default=48)
    parser.add_argument("--draws", type=int, default=8, choices=range(2, 65), metavar="N")
    parser.add_argument("--from-seed", type=int, default=0)
    parser.add_argument("--policies")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--outcomes", type=Path)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    configure()
    started = time.process_time()
    whole = to_situations(load_dataset(arguments.data))
    chosen = _chosen(whole, arguments.situations, arguments.from_seed)
    loads = tuple(float(load) for load in whole.loads)
    found = [
        _outcomes(arguments.data, int(g), _name(whole, int(g)), arguments.draws, loads, arguments.outcomes)
        for g in chosen
    ]
    tested = replace(
        whole.take(chosen),
        held=np.concatenate([outcomes[..., 0] for outcomes in found]) > 0.5,
        margin=np.concatenate([outcomes[..., 1] for outcomes in found]),
    )
    named = arguments.policies.split(",") if arguments.policies else default_policies(whole)
    formulas = [FORMULA + formula.name for formula in whole.formulas]
    policies = list(dict.fromkeys(["first", *formulas, *named]))
    scores = _scores(whole, policies, whole.rows(chosen), arguments.seeds)
    print(f"{len(tested)} situations, {tested.held[..., 0].size} tests at loads {loads}")
    results = []
    for load, times in enumerate(loads):
        rows = _rows(tested, scores, load)
        table = [(name, *(value.text(*scale) for value, scale in entries)) for name, entries in rows]
        print(f"\nload {times:g}\n{format_table(('goes by', *_HEADER), table)}")
        results.append(
            {"load": times, "rows": {name: [value.as_list for value, _ in row] for name, row in rows}}
        )
    print(f"\n{time.process_time() - started:.0f} s of the processor")
    if arguments.json:
        write_json(arguments.json, {"columns": list(_HEADER), "loads": results})


_HEADER = ("first/%", "of oracle/%", "of all tests/%", "AUC", "AUC of most", "saved/%")


def _chosen(whole: Situations, count: int, from_seed: int) -> Indices:
    """Situations of as many objects, in random order."""
    seeds = [int(name.rsplit(":", 1)[1]) if name.count(":") == 2 else from_seed for name in whole.objects]
    order = np.random.default_rng(_SEED).permutation(np.flatnonzero(np.array(seeds) >= from_seed))
    _, first = np.unique(whole.objects[order], return_index=True)
    return np.sort(order[np.sort(first)][:count])


def _name(whole: Situations, number: int) -> str:
    """Of a situation, the same in every data set."""
    return f"{whole.objects[number]} with {whole.hands[number]}"


def _outcomes(
    data: Path, number: int, name: str, draws: int, loads: Sequence[float], kept: Path | None
) -> Array:
    """Whether each candidate of a situation held, and its margin (K, D, L, 2)."""
    path = None if kept is None else kept / f"{re.sub(r'[^A-Za-z0-9]+', '-', name)}.json"
    if path is not None and path.exists():
        return np.array(read_json(path)["outcomes"], dtype=np.float64)
    stored = StoredSituations.of(data)
    if stored is None:
        raise SystemExit(f"{data}: holds no situations to be tried again")
    ranges = DrawRanges.from_record(read_head(data / DATASET_FILE)["draw_ranges"], str(data))
    pool = stored.pool(stored.names[number])
    rng = np.random.default_rng([_SEED, zlib.crc32(name.encode())])
    conditions = [draw(rng, pool.task.object, ranges) for _ in range(draws)]
    found = [
        [
            [(float(one.held), one.margin) for one in try_under(pool.grasp(k), drawn, loads, pool.settings)]
            for drawn in conditions
        ]
        for k in range(len(pool.candidates))
    ]
    if path is not None:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_json(path, {"situation": name, "outcomes": found})
    return np.array(found)


def _scores(whole: Situations, policies: Sequence[str], rows: Indices, seeds: int) -> dict[str, list[Array]]:
    """Scores (L, N) of the candidates by each policy, with each seed, trained on other objects."""
    prepared = prepare(whole)
    protocol = next(one for one in PROTOCOLS if one.name == "object")
    splits = [list(protocol.splits(whole, seed)) for seed in range(seeds)]
    return {
        name: [
            unseen_scores(name, prepared, splits[seed], seed)[0][:, rows]
            for seed in range(seeds if is_learned(name) else 1)
        ]
        for name in policies
    }


def _rows(
    tested: Situations, scores: dict[str, list[Array]], load: int
) -> list[tuple[str, list[tuple[Estimate, tuple[float, int]]]]]:
    # With what becomes of a candidate in most draws in place of each.
    most = replace(tested, held=tested.held.mean(axis=1, keepdims=True) > 0.5)
    means = {}
    for name, seeds in scores.items():
        means[name] = _mean([figures(tested, one[load], load) for one in seeds])
        means[name]["of_most"] = np.mean([figures(most, one[load], load).auc for one in seeds], axis=0)
    formulas = [name for name in means if name.startswith(FORMULA)]
    best = max(formulas, key=lambda name: float(means[name]["success"].mean()))
    draws = tested.held.shape[1]
    foresight: dict[str, Array] = {}
    for count in sorted({*(k for k in _TESTS if k < draws - 1), draws - 1}):
        found = figures_by_other_draws(tested, load, count)
        assert found is not None  # there are two draws at least
        foresight = means[counted(count, "test")] = _mean([found])
    oracle = _mean([figures(tested, oracle_scores(tested, load), load)])
    held = tested.padded(tested.held[:, :, load]).values.astype(np.bool_)
    means["oracle of the draws"] = oracle
    nothing = np.full(len(tested), np.nan)
    means["knows each draw"] = {"success": held.any(axis=1).mean(axis=1), "auc": nothing, "before": nothing}
    formula, usual = means[best]["success"], means["first"]["before"]
    rows = []
    for name, mean in means.items():
        if name.startswith(FORMULA) and name != best:
            continue
        above = mean["success"] - formula
        entries = [
            (mean_over_objects(mean["success"], tested.objects), (100.0, 0)),
            (ratio_over_objects(above, oracle["success"] - formula, tested.objects), (100.0, 0)),
            (ratio_over_objects(above, foresight["success"] - formula, tested.objects), (100.0, 0)),
            (mean_over_objects(mean["auc"], tested.objects), (1.0, 2)),
            (mean_over_objects(mean.get("of_most", nothing), tested.objects), (1.0, 2)),
            (ratio_over_objects(usual - mean["before"], usual, tested.objects), (100.0, 0)),
        ]
        rows.append((name, entries))
    return sorted(rows, key=lambda row: -row[1][0][0].value)


def _mean(found: Sequence[Figures]) -> dict[str, Array]:
    return {name: np.mean([one.by_name[name] for one in found], axis=0) for name in found[0].by_name}


if __name__ == "__main__":
    main()
