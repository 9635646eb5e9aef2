"""The convolution by transforms of its own, against its plain twin, and that against sums."""

import numpy as np
import plain_twins
import pytest

from roughcontact.elastic.convolution import Convolution, fast_length


@pytest.mark.parametrize(
    ("least", "length"), [(1, 2), (7, 8), (11, 12), (1023, 1024), (1025, 1080), (1999, 2000)]
)
def test_lengths_have_small_factors_only(least, length):
    assert fast_length(least) == length


# One node, lanes half empty, a block and a lane more; lengths with every radix, and odd ones.
SHAPES = [(1, 1), (2, 33), (8, 31), (13, 32), (23, 64), (45, 70), (41, 97), (128, 5)]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("dtype", "error"), [(np.float32, 1e-6), (np.float64, 1e-14)])
def test_convolution_with_any_even_kernel(shape, dtype, error):
    ny, nx = shape
    generator = np.random.default_rng(ny * nx)
    kernel, field = generator.standard_normal((2, ny, nx))
    padded = fast_length(2 * ny - 1), fast_length(2 * nx - 1)
    y, x = np.arange(1 - ny, ny)[:, None], np.arange(1 - nx, nx)
    around = np.zeros(padded)
    around[y, x] = kernel[np.abs(y), np.abs(x)]
    spectrum = np.fft.fft2(around).real[: padded[0] // 2 + 1, : padded[1] // 2 + 1]
    image = Convolution(spectrum, shape, padded, dtype)(field.astype(dtype))
    exact = plain_twins.convolution(kernel, field)
    assert image.dtype == dtype
    np.testing.assert_allclose(image, exact, rtol=0, atol=error * np.abs(kernel).sum())


@pytest.mark.parametrize("shape", [(1, 1), (5, 8), (7, 4)])
def test_plain_twin_is_the_sum_over_all_cells(shape):
    kernel, field = np.random.default_rng(3).standard_normal((2, *shape))
    sums = np.zeros(shape)
    for y, x in np.ndindex(shape):
        for j, i in np.ndindex(shape):
            sums[y, x] += kernel[abs(y - j), abs(x - i)] * field[j, i]
    np.testing.assert_allclose(plain_twins.convolution(kernel, field), sums, rtol=0, atol=1e-13)


@pytest.mark.parametrize(("wrapped", "least"), [(False, 37), (True, 19)])
def test_the_least_length_is_named_where_one_is_too_short(wrapped, least):
    """A transform of a field of 19 cells that may wrap around need be no longer than the field."""
    spectrum = np.zeros((10, 21))
    with pytest.raises(ValueError, match=rf"of 19 cells {least} or more"):
        Convolution(spectrum, (19, 20), (18, 40), np.float64, wrapped=wrapped)
