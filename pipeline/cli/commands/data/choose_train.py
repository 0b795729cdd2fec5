"""`holdfast choose train DATA --out MODEL`."""

import argparse
from pathlib import Path

import numpy as np

from .....base.text.console import Console, emit
from .....base.text.plain_text import counted
from .....errors import UnknownName
from ....choice import load_dataset
from ....choose import (
    Model,
    check_policy,
    prepare,
    provenance,
    save_model,
    to_situations,
    train,
    training_situations,
)

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Trains a policy on all but the test part of the data, and writes it."""
    console = Console(quiet=arguments.quiet)
    folder = Path(arguments.data)
    data = load_dataset(folder)
    situations = to_situations(data)
    check_policy(arguments.policy, situations.formulas)
    without = frozenset(arguments.without_hand)
    for name in sorted(without):
        if name not in data.hands:
            raise UnknownName("choose train", "--without-hand", "hand", name, data.hands)
    chosen = training_situations(data, situations, without)
    prepared = prepare(situations, free=arguments.free or bool(without))
    console.say(
        f"training {arguments.policy} on {counted(len(chosen), 'situation')} of "
        f"{counted(len(np.unique(situations.objects[chosen])), 'object')}"
    )
    trained = train(arguments.policy, prepared, chosen, seed=arguments.seed)
    model = Model.of(trained, situations, arguments.seed, provenance(folder, situations, chosen))
    save_model(Path(arguments.out), model)
    emit(arguments.out)
    return 0
