"""Pictures without a background: what was mixed with nothing comes back as it was."""

import numpy as np
from holdfast.mjcf.render.transparency import cut_out


def test_a_silhouette_tells_how_much_of_a_pixel_there_is() -> None:
    colour, shares = np.array([200.0, 100.0, 50.0]), np.array([0.0, 0.25, 0.5, 1.0])
    on_black = (shares[:, None] * colour).round().astype(np.uint8)[None]
    cut = cut_out(on_black, (255.0 * shares).round().astype(np.uint8)[None])
    assert cut.shape == (1, 4, 4)
    assert np.abs(cut[0, :, 3] - 255.0 * shares).max() <= 0.5
    assert (cut[0, 0] == 0).all()
    assert np.abs(cut[0, 1:, :3] - colour).max() <= 2.0  # rounded on the way


def test_what_is_nearly_whole_is_whole() -> None:
    on_black = np.full((1, 1, 3), 120, dtype=np.uint8)
    assert cut_out(on_black, np.full((1, 1), 253, dtype=np.uint8))[0, 0].tolist() == [120, 120, 120, 255]
