"""The data set as one of Minari's: an episode a group and draw, the choice that of whoever made the data."""

import warnings
from typing import Any

import numpy as np

from ..choice import ChoiceData, bounds

__all__ = ["to_minari"]


def to_minari(data: ChoiceData, name: str, licence: str) -> None:
    """Puts the data among Minari's local data sets, a one-step episode for each candidate and draw.

    Observations are those of the environment over a table, with as many rows as the largest group has
    candidates; rewards are 1 where the candidate was held at the first load.

    Args:
        data: the data.
        name: such as `holdfast/choice-v0`.
        licence: of the data.

    Raises:
        MissingBackend: Minari's own parts that it needs are not installed.
    """
    import minari
    from gymnasium import spaces
    from minari.data_collector import EpisodeBuffer

    most = int(data.sizes.max())
    low, high = bounds(data.feature_specs)
    object_low, object_high = bounds(data.object_specs)
    observation_space = spaces.Dict(
        {
            "candidates": spaces.Box(np.tile(low, (most, 1)), np.tile(high, (most, 1)), dtype=np.float32),
            "object": spaces.Box(object_low, object_high, dtype=np.float32),
            "mask": spaces.Box(0, 1, (most,), np.int8),
        }
    )
    buffer: list[Any] = []
    for rows in data.groups():
        observation = _observation(data, rows, most)
        for draw in range(data.held.shape[1]):
            for action in range(rows.stop - rows.start):
                reward = float(data.held[rows.start + action, draw, 0])
                buffer.append(
                    EpisodeBuffer(
                        id=len(buffer),
                        observations={key: [value, value] for key, value in observation.items()},
                        actions=[np.int64(action)],
                        rewards=[reward],
                        terminations=[True],
                        truncations=[False],
                        infos={},
                    )
                )
    with warnings.catch_warnings():
        # It asks for links to code and mail, which the user's data has none of.
        warnings.simplefilter("ignore", UserWarning)
        minari.create_dataset_from_buffers(
            name,
            buffer,
            algorithm_name="every candidate",
            author="made with Holdfast",
            description=f"Choosing among verified grasps; licence {licence}",
            observation_space=observation_space,
            action_space=spaces.Discrete(most),
        )


def _observation(data: ChoiceData, rows: slice, most: int) -> dict[str, Any]:
    count = rows.stop - rows.start
    candidates = np.zeros((most, data.features.shape[1]), dtype=np.float32)
    candidates[:count] = data.features[rows]
    mask = np.zeros(most, dtype=np.int8)
    mask[:count] = 1
    return {
        "candidates": candidates,
        "object": data.object_features[data.object_index[rows.start]],
        "mask": mask,
    }
