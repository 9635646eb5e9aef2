"""Pictures written as PNG are read by others as they were."""

import io

import numpy as np
import pytest
from PIL import Image

from fractalcontact.core.png import png


@pytest.mark.parametrize("shape", [(7, 11), (1, 1), (5, 3, 3), (1, 400, 3)])
@pytest.mark.parametrize("level", [1, 9])
def test_a_picture_comes_back_as_it_was(shape, level):
    picture = np.random.default_rng(0).integers(0, 256, shape).astype(np.uint8)
    with Image.open(io.BytesIO(png(picture, level))) as found:
        assert found.mode == ("RGB" if len(shape) == 3 else "L")
        assert np.array_equal(np.asarray(found), picture)
        assert "dpi" not in found.info


def test_a_picture_says_its_resolution():
    with Image.open(io.BytesIO(png(np.zeros((2, 2), np.uint8), 3, dpi=200))) as found:
        assert found.info["dpi"] == pytest.approx((200, 200), abs=0.02)
