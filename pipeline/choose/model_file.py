"""Model files: a trained policy as JSON, with all that tells whether it fits what it is asked about.

A file that comes from elsewhere is numbers and nothing else: none of it is run, and what does not fit is
refused before anything is computed with it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from ... import __version__
from ...base.files.fields import Count, Finite, Positive
from ...base.files.file_model import FileModel, parse
from ...base.files.json_file import read_json
from ...base.files.output_file import write_json
from ...base.numeric.arrays import Array, Indices
from ...errors import InputError, UnknownName
from ..choice import Feature, FeatureKind
from .heads import AnyHead
from .inputs import Input, compute_inputs
from .policies import Trained
from .situations import Situations

__all__ = ["Model", "Provenance", "load_model", "save_model"]

_FORMAT: Literal["holdfast choice model"] = "holdfast choice model"
_VERSION: Literal[1] = 1
_MOST_OBJECTS = 1_000_000
Words = Annotated[str, Field(max_length=200)]
Digest = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]


class _Feature(FileModel):
    name: Words
    unit: Words
    low: Finite
    high: Finite
    kind: FeatureKind


class _LoadHead(FileModel):
    load: Positive
    head: AnyHead


class Provenance(FileModel):
    """What a policy was trained on.

    Attributes:
        data: hash of the data set.
        hands: hash of each hand's model, by its name.
        objects: names of the objects; where the model is judged these don't count as unseen.
        situations: number of situations.
        candidates: of candidates.
        draws: of draws of the hidden conditions, for each of them.
    """

    data: Digest
    hands: dict[Words, Words]
    objects: Annotated[list[Words], Field(max_length=_MOST_OBJECTS)]
    situations: Count
    candidates: Count
    draws: Count


class _ModelFile(FileModel):
    format: Literal["holdfast choice model"]
    version: Literal[1]
    holdfast: Words
    policy: Words
    seed: Count
    features: list[_Feature]
    inputs: list[Input]
    heads: Annotated[list[_LoadHead], Field(min_length=1)]
    trained_on: Provenance

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        names = [feature.name for feature in self.features]
        if len(set(names)) != len(names):
            raise ValueError("features: a name stands twice")
        for i, entry in enumerate(self.inputs):
            if entry.feature not in names:
                raise ValueError(f"inputs.{i}.feature must be the name of a feature, not {entry.feature!r}")
        for i, entry_head in enumerate(self.heads):
            if entry_head.head.width not in (0, len(self.inputs)):
                raise ValueError(
                    f"heads.{i} takes {entry_head.head.width} inputs, but there are {len(self.inputs)}"
                )
        loads = [entry_head.load for entry_head in self.heads]
        if len(set(loads)) != len(loads):
            raise ValueError("heads: a load stands twice")
        return self


@dataclass(frozen=True, eq=False)
class Model:
    """A policy with what it was trained on.

    Attributes:
        policy: its name.
        seed: with which it was trained.
        columns: the features that it needs.
        inputs: what it computes of them.
        loads: multiples of the weight for which it was trained, (L,).
        heads: one for each load.
        trained_on: the data.
    """

    policy: str
    seed: int
    columns: tuple[Feature, ...]
    inputs: tuple[Input, ...]
    loads: Array
    heads: tuple[AnyHead, ...]
    trained_on: Provenance

    @classmethod
    def of(cls, trained: Trained, situations: Situations, seed: int, trained_on: Provenance) -> "Model":
        """What `train` has made of situations."""
        used = {entry.feature for entry in trained.inputs}
        # What a person would do with a feature, and its words, don't count.
        columns = tuple(
            replace(column, formula=0, words="") for column in situations.columns if column.name in used
        )
        return cls(trained.policy, seed, columns, trained.inputs, situations.loads, trained.heads, trained_on)

    @property
    def is_chance(self) -> bool:
        """Whether its scores are chances to hold."""
        return all(head.is_chance for head in self.heads)

    @property
    def digest(self) -> str:
        """Hash of all that the scores depend on."""
        return sha256(_as_file(self).model_dump_json(exclude={"holdfast", "trained_on"}).encode()).hexdigest()

    def check_fits(self, units: Mapping[str, str], source: str | Path) -> None:
        """Looks whether features of these names and units are what it needs.

        Args:
            units: unit of each feature that there is, by name.
            source: where the model came from, for the message.

        Raises:
            UnknownName: a feature is missing.
            InputError: one has another unit.
        """
        for column in self.columns:
            if column.name not in units:
                raise UnknownName(source, "features", "feature", column.name, units)
            if units[column.name] != column.unit:
                raise InputError(
                    source,
                    f"features.{column.name}",
                    f"is in {column.unit}, but here it is in {units[column.name]}",
                )

    def scores(self, names: Sequence[str], features: Array, first: Indices, load: float = 1.0) -> Array:
        """Scores (N,) of candidates, the higher the better.

        Args:
            names: of the features, F of them.
            features: (N, F).
            first: (G + 1,), where the candidates of each situation begin, and N.
            load: multiple of the weight; the nearest one that it was trained for counts.
        """
        head = self.heads[int(np.abs(self.loads - load).argmin())]
        values = compute_inputs(self.inputs, names, features, first)
        place = np.arange(len(features)) - np.repeat(first[:-1], np.diff(first))
        return head.scores(values, place)


def save_model(path: Path, model: Model) -> None:
    """Writes a model file, whole or not at all."""
    write_json(path, _as_file(model).model_dump(mode="json"))


def load_model(path: Path) -> Model:
    """Reads a model file.

    Raises:
        InputError: it is no model file, one of another version, or damaged.
    """
    data = read_json(path)
    if data.get("format") != _FORMAT:
        raise InputError(path, "format", f"must be {_FORMAT!r}: this is no model of `holdfast choose train`")
    if data.get("version") != _VERSION:
        raise InputError(path, "version", f"must be {_VERSION}; train the model anew")
    file = parse(_ModelFile, data, path)
    return Model(
        policy=file.policy,
        seed=file.seed,
        columns=tuple(Feature(**dict(feature)) for feature in file.features),
        inputs=tuple(file.inputs),
        loads=np.array([entry.load for entry in file.heads]),
        heads=tuple(entry.head for entry in file.heads),
        trained_on=file.trained_on,
    )


def _as_file(model: Model) -> _ModelFile:
    return _ModelFile(
        format=_FORMAT,
        version=_VERSION,
        holdfast=__version__,
        policy=model.policy,
        seed=model.seed,
        features=[
            _Feature.model_validate({name: getattr(column, name) for name in _Feature.model_fields})
            for column in model.columns
        ],
        inputs=list(model.inputs),
        heads=[
            _LoadHead(load=float(load), head=head)
            for load, head in zip(model.loads, model.heads, strict=True)
        ],
        trained_on=model.trained_on,
    )
