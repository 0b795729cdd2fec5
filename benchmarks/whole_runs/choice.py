"""How much better learnt choices among verified grasps are, on objects, hands and tasks never seen.

Usage: ./run bench choice [--data DIR] [--seeds N] [--policies NAMES] [--unseen object,hand,task]
                          [--json FILE]

Trains policies anew for each question and seed (see docs/choosing.md) and prints, with 95 % intervals by
resampling objects: first choices that held, of the policies, of the best formula and of the oracle, at each
load; the difference to the best formula, situation by situation; the share of the gap from formula to oracle
that is closed; AUC within situations; and tests that fail before the first grasp that holds, beside those of
the usual order. --data takes a data set of `holdfast dataset`; without it the small one that comes with the
package counts, which is too small for more than a try.
"""

import argparse
import time
from pathlib import Path

from holdfast.base.files.output_file import write_json
from holdfast.base.text.console import format_table
from holdfast.pipeline.choice import load_dataset
from holdfast.pipeline.choose import to_situations
from holdfast.pipeline.choose.study import default_policies, headline, study_data, tables


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--policies")
    parser.add_argument("--unseen", default="object,hand,task")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    begun = time.monotonic()
    situations = to_situations(load_dataset(arguments.data))
    policies = arguments.policies.split(",") if arguments.policies else default_policies(situations)
    study = study_data(
        situations, policies, unseen=arguments.unseen.split(","), seeds=arguments.seeds, say=print
    )
    print(f"\n{tables(study)}\n{headline(study)}\n")
    rows = []
    for entry in study.comparisons:
        formula = next((one for one in entry.standings if one.policy == entry.best_formula), None)
        rows += [
            (
                f"{entry.protocol} {entry.load:g}",
                one.policy,
                "yes" if one.success.low > formula.success.high else "no",
                "yes" if one.above_formula.low > 0.0 else "no",
                one.gap_closed.text(100.0, 0),
                one.auc.text(),
                one.saved.text(100.0, 0),
            )
            for one in entry.standings
            if formula is not None and one.policy in policies and not one.policy.startswith("formula:")
        ]
    header = ("unseen", "policy", "intervals apart", "pairs above 0", "gap/%", "AUC", "saved/%")
    print(format_table(header, rows))
    print(f"\n{study.objects} objects, {study.situations} situations; {time.monotonic() - begun:.0f} s")
    if arguments.json:
        write_json(arguments.json, study.as_json())


if __name__ == "__main__":
    main()
