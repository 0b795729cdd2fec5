"""A data set as a source of training: what identifies it, and which objects may be learnt from."""

from hashlib import sha256
from pathlib import Path

import numpy as np

from ...base.files.json_file import read_json
from ...base.numeric.arrays import Indices
from ...errors import InputError
from ..choice import ARRAYS_FILE, DATASET_FILE, ChoiceData
from .model_file import Provenance
from .situations import Situations

__all__ = ["provenance", "training_situations"]


def training_situations(data: ChoiceData, situations: Situations, without_hands: frozenset[str]) -> Indices:
    """Situations to train on: those outside the test part by object, of the hands that are not left out.

    Raises:
        InputError: none is left.
    """
    begins = data.starts[:-1]
    chosen = np.flatnonzero(
        (data.splits["object"][begins] != "test") & ~np.isin(situations.hands, sorted(without_hands))
    )
    if not len(chosen):
        raise InputError("choose", "", "no situation of the data is left to train on")
    return chosen


def provenance(folder: Path, situations: Situations, chosen: Indices) -> Provenance:
    """What a model says of the data that it was trained on.

    Args:
        folder: of the data set.
        situations: all of its situations.
        chosen: those that were trained on.
    """
    kept = situations.take(chosen)
    hands = set(np.unique(kept.hands).tolist())
    known = read_json(folder / DATASET_FILE).get("hands")
    hashes = {
        str(entry["name"]): str(entry["hash"])
        for entry in (known if isinstance(known, list) else [])
        if isinstance(entry, dict) and {"name", "hash"} <= entry.keys()
    }
    return Provenance(
        data=sha256((folder / ARRAYS_FILE).read_bytes()).hexdigest(),
        hands={name: hashes.get(name, "")[:200] for name in sorted(hands)},
        objects=sorted(set(kept.objects.tolist())),
        situations=len(kept),
        candidates=len(kept.features),
        draws=kept.held.shape[1],
    )
