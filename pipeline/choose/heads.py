"""How a policy scores candidates once it is trained: plain numbers, which a model file holds as they are.

A head reads inputs (see `inputs.compute_inputs`) and gives each candidate a score, by itself and in NumPy
alone; what trained it need not be installed. What comes from a file is checked as it is built: sizes agree,
indices exist, and trees lead downward, so that no file makes a walk through them endless.
"""

from functools import cached_property
from typing import Annotated, Literal, Protocol, Self

import numpy as np
from pydantic import Field, model_validator

from ...base.files.fields import Finite
from ...base.files.file_model import FileModel
from ...base.numeric.arrays import Array, Indices

__all__ = ["AnyHead", "Flat", "Head", "Layer", "Linear", "Network", "Order", "Sum", "Trees", "sigmoid"]

# Nodes that are walked at once, rows times trees.
_AT_ONCE = 2**20
_DEEPEST = 64
_MOST_TREES = 20_000
_MOST_PARTS = 16
Index = Annotated[int, Field(strict=True, ge=0, le=10**9)]


class Head(Protocol):
    """Scores candidates."""

    @property
    def width(self) -> int:
        """How many inputs it reads."""

    @property
    def is_chance(self) -> bool:
        """Whether a score is the chance to hold."""

    def scores(self, inputs: Array, place: Indices) -> Array:
        """Scores (N,) of candidates by their inputs (N, I) and their places in the usual order (N,)."""


class Flat(FileModel):
    """All candidates alike: lots are drawn."""

    kind: Literal["flat"] = "flat"

    @property
    def width(self) -> int:
        """None."""
        return 0

    @property
    def is_chance(self) -> bool:
        """No."""
        return False

    def scores(self, inputs: Array, place: Indices) -> Array:
        """Zeros."""
        return np.zeros(len(place))


class Order(FileModel):
    """The usual order, in which the run finds the candidates."""

    kind: Literal["order"] = "order"

    @property
    def width(self) -> int:
        """None."""
        return 0

    @property
    def is_chance(self) -> bool:
        """No."""
        return False

    def scores(self, inputs: Array, place: Indices) -> Array:
        """The sooner, the higher."""
        return -place.astype(np.float64)


class Linear(FileModel):
    """A weighted sum of standardised inputs.

    Attributes:
        mean: taken from each input.
        scale: by which what remains is divided.
        weights: of the results.
        constant: added to the sum.
        link: `chance` where the sum is the logarithm of the odds, `none` where only the order counts.
    """

    kind: Literal["linear"] = "linear"
    mean: list[Finite]
    scale: list[Annotated[Finite, Field(gt=0.0)]]
    weights: list[Finite]
    constant: Finite = 0.0
    link: Literal["chance", "none"] = "none"

    @model_validator(mode="after")
    def _of_one_size(self) -> Self:
        if not len(self.mean) == len(self.scale) == len(self.weights):
            raise ValueError("mean, scale and weights must have the same length")
        return self

    @property
    def width(self) -> int:
        """How many inputs it reads."""
        return len(self.weights)

    @property
    def is_chance(self) -> bool:
        """Whether a score is the chance to hold."""
        return self.link == "chance"

    def scores(self, inputs: Array, place: Indices) -> Array:
        """The sums, or chances."""
        slopes = np.array(self.weights) / np.array(self.scale)
        # Row by row, where a product of matrices would round by the place of a row.
        total = ((inputs - np.array(self.mean)) * slopes).sum(axis=1) + self.constant
        return sigmoid(total) if self.is_chance else total


class Trees(FileModel):
    """A sum of decision trees.

    Attributes:
        inputs: how many inputs there are.
        roots: node at which each tree begins.
        feature: by node, the input that is asked, or -1 at a leaf.
        threshold: by node; an input that is no larger goes left.
        left: by node, where to go on; a node that stands later in the list.
        right: the same.
        value: by node, what a leaf adds.
        link: `chance` where the sum is the logarithm of the odds, `none` where only the order counts.
    """

    kind: Literal["trees"] = "trees"
    inputs: Index
    roots: Annotated[list[Index], Field(min_length=1, max_length=_MOST_TREES)]
    feature: list[Annotated[int, Field(strict=True, ge=-1, le=10**9)]]
    threshold: list[Annotated[float, Field(strict=True)]]
    left: list[Index]
    right: list[Index]
    value: list[Finite]
    link: Literal["chance", "none"] = "none"

    @model_validator(mode="after")
    def _leads_downward(self) -> Self:
        count = len(self.feature)
        if not all(len(part) == count for part in (self.threshold, self.left, self.right, self.value)):
            raise ValueError("feature, threshold, left, right and value must have the same length")
        if any(root >= count for root in self.roots):
            raise ValueError(f"roots must be below {count}, the number of nodes")
        if any(feature >= self.inputs for feature in self.feature):
            raise ValueError(f"feature must be below {self.inputs}, the number of inputs")
        depth = [0] * count
        for node in range(count):
            if self.feature[node] < 0:
                continue
            for child in (self.left[node], self.right[node]):
                if not node < child < count:
                    raise ValueError(f"left and right of node {node} must be later nodes, below {count}")
                depth[child] = max(depth[child], depth[node] + 1)
                if depth[child] > _DEEPEST:
                    raise ValueError(f"trees must be no deeper than {_DEEPEST}")
        return self

    @property
    def width(self) -> int:
        """How many inputs it reads."""
        return self.inputs

    @property
    def is_chance(self) -> bool:
        """Whether a score is the chance to hold."""
        return self.link == "chance"

    def scores(self, inputs: Array, place: Indices) -> Array:
        """The sums, or chances."""
        total = np.zeros(len(inputs))
        step = max(1, _AT_ONCE // len(self.roots))
        for start in range(0, len(inputs), step):
            total[start : start + step] = self._sums(inputs[start : start + step])
        return sigmoid(total) if self.is_chance else total

    @cached_property
    def _nodes(self) -> tuple[Indices, Array, Indices, Indices, Array]:
        own = np.arange(len(self.feature))
        leaf = np.array(self.feature, dtype=np.int64) < 0
        return (
            np.array(self.feature, dtype=np.int64),
            np.array(self.threshold, dtype=np.float64),
            # Who has arrived stays.
            np.where(leaf, own, np.array(self.left, dtype=np.int64)),
            np.where(leaf, own, np.array(self.right, dtype=np.int64)),
            np.array(self.value, dtype=np.float64),
        )

    def _sums(self, inputs: Array) -> Array:
        feature, threshold, left, right, value = self._nodes
        rows = np.arange(len(inputs))[:, None]
        node = np.tile(np.array(self.roots, dtype=np.int64), (len(inputs), 1))
        while (feature[node] >= 0).any():
            goes_left = inputs[rows, np.maximum(feature[node], 0)] <= threshold[node]
            node = np.where(goes_left, left[node], right[node])
        return value[node].sum(axis=1)


class Layer(FileModel):
    """A layer of a network: a matrix, and what is added.

    Attributes:
        weights: (outputs, inputs).
        bias: (outputs,).
    """

    weights: list[list[Finite]]
    bias: list[Finite]

    @model_validator(mode="after")
    def _of_one_size(self) -> Self:
        width = len(self.weights[0]) if self.weights else 0
        if not self.weights or len(self.weights) != len(self.bias):
            raise ValueError("weights must have a row for each entry of bias")
        if any(len(row) != width for row in self.weights):
            raise ValueError("rows of weights must have the same length")
        return self


class Network(FileModel):
    """A network with tanh between its layers, which sees one candidate at a time.

    Attributes:
        mean: taken from each input.
        scale: by which what remains is divided.
        layers: the last one has one output, the score.
    """

    kind: Literal["network"] = "network"
    mean: list[Finite]
    scale: list[Annotated[Finite, Field(gt=0.0)]]
    layers: list[Layer]

    @model_validator(mode="after")
    def _fits(self) -> Self:
        width = len(self.mean)
        if len(self.scale) != width or not self.layers:
            raise ValueError("mean and scale must have the same length, and there must be a layer")
        for layer in self.layers:
            if len(layer.weights[0]) != width:
                raise ValueError(f"a layer must take the {width} numbers that come to it")
            width = len(layer.bias)
        if width != 1:
            raise ValueError("the last layer must have one output")
        return self

    @property
    def width(self) -> int:
        """How many inputs it reads."""
        return len(self.mean)

    @property
    def is_chance(self) -> bool:
        """No: it says no more than the order."""
        return False

    def scores(self, inputs: Array, place: Indices) -> Array:
        """The outputs."""
        here = (inputs - np.array(self.mean)) / np.array(self.scale)
        for number, layer in enumerate(self.layers):
            if number:
                here = np.tanh(here)
            weights = np.array(layer.weights)
            here = np.stack([(here * row).sum(axis=1) for row in weights], axis=1) + np.array(layer.bias)
        return here[:, 0]


class Sum(FileModel):
    """The sum of what several heads say of the same inputs.

    Attributes:
        parts: they are no chances, which could not be added.
    """

    kind: Literal["sum"] = "sum"
    parts: Annotated[
        list[Annotated[Linear | Trees | Network, Field(discriminator="kind")]],
        Field(min_length=1, max_length=_MOST_PARTS),
    ]

    @model_validator(mode="after")
    def _can_be_added(self) -> Self:
        if len({part.width for part in self.parts}) > 1 or any(part.is_chance for part in self.parts):
            raise ValueError("parts must read the same number of inputs, and give no chances")
        return self

    @property
    def width(self) -> int:
        """How many inputs they read."""
        return self.parts[0].width

    @property
    def is_chance(self) -> bool:
        """No: it says no more than the order."""
        return False

    def scores(self, inputs: Array, place: Indices) -> Array:
        """The sums."""
        return np.sum([part.scores(inputs, place) for part in self.parts], axis=0)


AnyHead = Annotated[Flat | Order | Linear | Trees | Network | Sum, Field(discriminator="kind")]


def sigmoid(x: Array) -> Array:
    """The chance with these logarithms of the odds."""
    return 0.5 * (1.0 + np.tanh(0.5 * x))
