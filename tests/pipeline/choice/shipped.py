"""Candidates of the data set that comes with the package, as it keeps them."""

import json
import zipfile

from holdfast.pipeline.choice import SITUATIONS_FILE, Situation, StoredCandidate, shipped_dataset


def shipped_situation(number: int) -> tuple[Situation, list[StoredCandidate]]:
    """One of its situations."""
    with zipfile.ZipFile(shipped_dataset() / SITUATIONS_FILE) as archive:
        content = json.loads(archive.read(f"{number:05d}.json"))
    candidates = [StoredCandidate.model_validate(candidate) for candidate in content["candidates"]]
    return Situation.model_validate(content["situation"]), candidates
