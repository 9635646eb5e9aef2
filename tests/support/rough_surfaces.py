"""Self-affine surfaces for tests of the solver, which run without the rest of the project."""

import numpy as np
from scipy import fft


def self_affine(shape, spacing, hurst, *, rms, seed, roll_off=None):
    """Heights, (ny, nx), by the recipe of `fractalcontact.self_affine`."""
    side = fft.next_fast_len(2 * max(shape), real=True)
    qy = 2 * np.pi * fft.fftfreq(side, spacing)[:, np.newaxis]
    qx = 2 * np.pi * fft.rfftfreq(side, spacing)[np.newaxis, :]
    q = np.hypot(qy, qx)
    q[0, 0] = np.inf
    q /= 2 * np.pi / (side * spacing if roll_off is None else roll_off)
    density = np.maximum(q, 0.0 if roll_off is None else 1.0) ** (-2 * (1 + hurst))
    noise = np.random.Generator(np.random.PCG64(seed)).standard_normal((side, side))
    spectrum = fft.rfft2(noise, workers=1)
    spectrum *= np.sqrt(density)
    surface = fft.irfft2(spectrum, s=(side, side), workers=1)[: shape[0], : shape[1]]
    y, x = (np.arange(n) - (n - 1) / 2 for n in shape)
    surface = surface - surface.mean()
    slope_y = np.sum(surface.sum(axis=1) * y) / (shape[1] * np.sum(y * y))
    slope_x = np.sum(surface.sum(axis=0) * x) / (shape[0] * np.sum(x * x))
    surface -= slope_y * y[:, np.newaxis]
    surface -= slope_x * x
    return surface * (rms / np.sqrt(np.mean(surface**2)))
