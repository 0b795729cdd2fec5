"""Synthetic data of choices whose law is known, to test what learns from them and what shows them."""

import numpy as np
from holdfast.pipeline.choice import ChoiceData, Feature

FREE = ("span", "lean", "reach", "epsilon")
CONDITIONS = ("mass_factor", "friction_factor")


def make_choice_data(
    *,
    groups: int = 60,
    candidates: int = 8,
    draws: int = 3,
    hands: tuple[str, ...] = ("sa", "shadow"),
    tasks: tuple[str, ...] = ("lift",),
    seed: int = 0,
    noise: float = 0.3,
) -> ChoiceData:
    """Candidates that are held where span - lean^2 + a hidden push is above 0.

    `reach` says nothing, `epsilon` is a poor formula (span with much noise), and the feature `joint_0`, of
    the hand alone, goes with span as well but the other way round in every second hand. Objects are split
    60 / 20 / 20, each has one group.

    Args:
        groups: groups, and objects.
        candidates: of a group.
        draws: hidden draws of a group.
        hands: in turn, one a group.
        tasks: the same.
        seed: of everything.
        noise: size of the hidden push.
    """
    rng = np.random.default_rng(seed)
    count = groups * candidates
    span, lean, reach = rng.uniform(-1.0, 1.0, size=(3, count))
    group = np.repeat(np.arange(groups), candidates)
    which_hand = group % len(hands)
    sign = np.where(which_hand % 2 == 0, 1.0, -1.0)
    features = np.column_stack([span, lean, reach, 0.3 * span + rng.normal(size=count), sign * span])
    conditions = rng.uniform(0.7, 1.3, size=(groups, draws, 2))
    push = noise * rng.normal(size=(count, draws)) + (1.0 - conditions[group, :, 0]) * 0.3
    strength = (span - lean**2)[:, None] + push
    held = np.stack([strength > 0.0, strength > 0.5], axis=-1)
    margin = np.stack([strength, strength - 0.5], axis=-1).clip(-1.0, 1.0)
    part = np.searchsorted([0.6, 0.8], rng.permutation(groups) / groups)
    parts = np.array(["train", "valid", "test"])[part]
    hand = np.array(hands)[which_hand]
    kind = np.array(tasks)[group % len(tasks)]
    train = parts[group] != "test"
    return ChoiceData(
        features=features.clip(-3.0, 3.0).astype(np.float32),
        feature_specs=(
            *(Feature(name, "1", -3.0, 3.0, formula=int(name == "epsilon")) for name in FREE),
            Feature("joint_0", "1", -3.0, 3.0, kind="hand"),
        ),
        object_features=rng.uniform(0.05, 0.4, size=(groups, 2)).astype(np.float32),
        object_specs=(Feature("mass", "kg", 0.0, 1.0), Feature("size", "m", 0.0, 1.0)),
        group=group.astype(np.int64),
        object_index=group.astype(np.int64),
        object_ids=np.array([f"family:box:{k}" for k in range(groups)]),
        candidate_ids=np.array([f"c{k:05d}" for k in range(count)]),
        hand=hand,
        task=kind,
        held=held,
        margin=margin.astype(np.float32),
        conditions=conditions.astype(np.float32),
        condition_names=CONDITIONS,
        loads=(1.0, 2.0),
        splits={
            "object": parts[group],
            "hand": np.where(hand == hands[-1], "test", np.where(train, "train", "valid")),
            "task": np.where(kind == tasks[-1], "test", np.where(train, "train", "valid")),
        },
    )
