"""Synthetic self-affine surfaces, from a spectrum.

Their statistics are known beforehand: mathematical joints, which are Gaussian and isotropic, and
twins of specimens that are described but whose scans are not public, which may have the anisotropy
and the uneven roughness of fractured rock. They are written as ordinary scan files and enter the
program through the same door as a measured surface.
"""

import numpy as np
import scipy.fft

from ..core.limits import MOST_INTERMITTENT
from ..core.mean_plane import without_mean_plane

#: Sides of the grid of a synthetic surface, in sides of the patch cut from it. The Fourier series
#: is periodic on that grid; with two, opposite edges of the patch are as far apart as they look.
EMBEDDING = 2


def self_affine(
    shape: tuple[int, int],
    spacing: float,
    hurst: float,
    *,
    rms: float,
    seed: int,
    roll_off: float | None = None,
    anisotropy: float = 1.0,
    intermittency: float = 0.0,
) -> np.ndarray:
    """Self-affine surface that is not periodic; isotropic and Gaussian by default.

    White noise, drawn node by node with ``Generator(PCG64(seed)).standard_normal`` in (y, x) order
    on a grid of `EMBEDDING` times the longer side, is filtered to the power spectral density
    C(q) = q^(-2 (1 + H)) for q > q_r and C(q_r) below, with q_r = 2 pi / roll_off. A patch is cut
    from it, its mean plane taken off (as every specimen's is before it is used) and its heights
    scaled, so `rms` means the same before and after levelling.

    With an anisotropy a, q^2 is q_x^2 / a + q_y^2 a. With an intermittency, the noise is first
    multiplied by the exponential of a second, Gaussian field, whose variance grows by that number
    for each factor e of wavelength from the spacing to the grid's side. The noise stays white, so
    that the spectrum stays the same in the mean, but some places are rougher than others.

    Parameters
    ----------
    shape : (ny, nx)
        Cells of the patch.
    spacing : float
        Distance between cells, mm.
    hurst : float
        H = 3 - Delta_g, between 0 and 1.
    rms : float
        Root mean square height of the patch about its mean plane, mm.
    seed : int
        The same seed gives the same bits.
    roll_off : float, optional
        Wavelength above which the spectrum is flat, mm. Without it the surface is self-affine at
        every scale of the patch.
    anisotropy : float, optional
        Distance along y over the distance along x within which heights differ as much. The rms
        slope along x is that along y times its H-th power.
    intermittency : float, optional
        0 for a Gaussian surface, up to `core.limits.MOST_INTERMITTENT`. Slopes then have heavy
        tails, the heavier the shorter the distance they are taken over.

    Returns
    -------
    (ny, nx) float64
        Heights in mm.

    Raises
    ------
    ValueError
        If H, a length or the shape is out of range.

    Notes
    -----
    Spectral synthesis: Saupe in Peitgen & Saupe (1988), The Science of Fractal Images; spectrum
    with a roll-off: Persson et al., J. Phys. Condens. Matter 17 (2005) R1; intermittency: lambda^2
    of Bacry, Delour & Muzy, Phys. Rev. E 64 (2001) 026103.
    """
    check_surface(shape, hurst, spacing, rms)
    if roll_off is not None and roll_off <= 0:
        raise ValueError(f"roll_off must be positive, not {roll_off}")
    if anisotropy <= 0:
        raise ValueError(f"the anisotropy must be positive, not {anisotropy}")
    if not 0 <= intermittency <= MOST_INTERMITTENT:
        raise ValueError(
            f"the intermittency must lie between 0 and {MOST_INTERMITTENT}, not {intermittency}"
        )

    side = grid_side(shape)
    density = _power_spectral_density(side, spacing, hurst, roll_off, anisotropy)
    local = _local_roughness(side, intermittency, seed) if intermittency else None
    return levelled(filtered_noise(density, shape, seed, local), rms)


def _local_roughness(side: int, intermittency: float, seed: int) -> np.ndarray:
    """Factors (side, side) of white noise, above 0, that make some places rougher than others.

    The exponential of Gaussian noise, independent of that of :func:`filtered_noise`, of the power
    spectral density 2 pi lambda^2 / q^2, lambda^2 being the intermittency.
    """
    # In nodes: a spectrum of this power has no length of its own.
    density = 2 * np.pi * intermittency / _wave_numbers(side, 1.0) ** 2
    independent = np.random.PCG64(seed).jumped()
    noise = np.random.Generator(independent).standard_normal((side, side))
    return np.exp(_filtered(noise, density))


def band_limited(
    shape: tuple[int, int],
    spacing: float,
    hurst: float,
    *,
    prefactor: float,
    cut_off: float,
    roll_off: float | None,
    seed: int,
) -> np.ndarray:
    """Isotropic, Gaussian surface between two cut-offs, whose spectrum does not depend on its size.

    Its power spectral density is C(q) = C_0 q^(-2 (1 + H)) for q_r < q <= q_s, C(q_r) below and 0
    above, with q_r = 2 pi / roll_off and q_s = 2 pi / cut_off. The heights are not scaled: larger
    surfaces continue smaller ones in the mean, and the mean square height is the integral of C(q)
    d^2q / (2 pi)^2. Noise, patch and the other parameters are those of :func:`self_affine`.

    Parameters
    ----------
    prefactor : float
        C_0, mm^(2 - 2H).
    cut_off : float
        Shortest wavelength, mm; two spacings or more.
    roll_off : float or None
        Wavelength above which the spectrum is flat, mm; None without one.

    Notes
    -----
    Convention of the spectrum: Jacobs, Junge & Pastewka, Surf. Topogr. 5 (2017) 013001.
    """
    check_surface(shape, hurst, spacing, prefactor)
    if not 2 * spacing <= cut_off <= (roll_off or np.inf):
        raise ValueError(
            f"a cut-off of {cut_off} mm: expected two spacings ({2 * spacing} mm) or more, and no "
            f"more than the roll-off ({roll_off} mm)"
        )
    q = _wave_numbers(grid_side(shape), spacing)
    density = _band(q, hurst, prefactor, cut_off, roll_off) / spacing**2
    return without_mean_plane(filtered_noise(density, shape, seed))


def band_slope(
    shape: tuple[int, int],
    spacing: float,
    hurst: float,
    *,
    prefactor: float,
    cut_off: float,
    roll_off: float | None,
) -> float:
    """Root mean square slope h'_rms that surfaces of :func:`band_limited` have in the mean.

    Parameters as there; the sum of q^2 C(q) over the waves of the grid the patch is cut from.
    """
    side = grid_side(shape)
    q = _wave_numbers(side, spacing)
    density = _band(q, hurst, prefactor, cut_off, roll_off)
    # A real transform keeps half the plane: every wave off its edges stands for two.
    twice = np.full(q.shape[1], 2.0)
    twice[0] = 1.0
    if side % 2 == 0:
        twice[-1] = 1.0
    finite = np.where(np.isfinite(q), q, 0.0)
    return float(np.sqrt(np.sum(density * finite**2 * twice)) / (side * spacing))


def check_surface(shape: tuple[int, int], hurst: float, spacing: float, rms: float) -> None:
    """Refuse H, lengths and a shape from which no surface can be made, with ValueError."""
    if not 0 < hurst < 1:
        raise ValueError(f"the Hurst exponent must lie between 0 and 1, not {hurst}")
    if min(spacing, rms) <= 0:
        raise ValueError(f"spacing and rms must be positive, not {spacing}, {rms}")
    if min(shape) < 2:
        raise ValueError(f"a surface needs at least 2 x 2 cells, not {shape}")


def levelled(heights: np.ndarray, rms: float) -> np.ndarray:
    """Heights about their mean plane, scaled to an rms."""
    heights = without_mean_plane(heights)
    return heights * (rms / np.sqrt(np.mean(heights**2)))


def grid_side(shape: tuple[int, int]) -> int:
    """Nodes along the periodic grid from which a patch is cut."""
    return int(scipy.fft.next_fast_len(EMBEDDING * max(shape), real=True))


def filtered_noise(
    density: np.ndarray, shape: tuple[int, int], seed: int, local: np.ndarray | None = None
) -> np.ndarray:
    """Gaussian patch in mm: white noise of variance one whose spectrum is multiplied by a density.

    ``density`` (side, side // 2 + 1) is the power spectral density over the area of a cell, mm2, on
    the half plane of `scipy.fft.rfft2` of the periodic grid of :func:`grid_side` nodes. The same
    seed gives the same bits. The noise is multiplied by ``local`` (side, side) first, where it is
    given: the patch then is not Gaussian.
    """
    side = len(density)
    noise = np.random.Generator(np.random.PCG64(seed)).standard_normal((side, side))
    if local is not None:
        noise *= local
    return _filtered(noise, density)[: shape[0], : shape[1]]


def _filtered(noise: np.ndarray, density: np.ndarray) -> np.ndarray:
    """Noise (side, side) whose spectrum is multiplied by a density of its half plane."""
    # One worker: the result must not depend on how many cores there are.
    spectrum = scipy.fft.rfft2(noise, workers=1)
    spectrum *= np.sqrt(density)
    return scipy.fft.irfft2(spectrum, s=noise.shape, workers=1)


def _wave_numbers(side: int, spacing: float, anisotropy: float = 1.0) -> np.ndarray:
    """Wave numbers q on the half plane of `scipy.fft.rfft2`, 1/mm; infinite for the mean height.

    With an anisotropy those of the isotropic surface that is stretched along y.
    """
    stretch = np.sqrt(anisotropy)
    qy = 2 * np.pi * scipy.fft.fftfreq(side, spacing)[:, np.newaxis] * stretch
    qx = 2 * np.pi * scipy.fft.rfftfreq(side, spacing)[np.newaxis, :] / stretch
    q = np.hypot(qy, qx)
    q[0, 0] = np.inf
    return q


def _band(
    q: np.ndarray, hurst: float, prefactor: float, cut_off: float, roll_off: float | None
) -> np.ndarray:
    """C(q) between the cut-offs, mm^4; zero for the mean height and beyond the short one."""
    lowest = 0.0 if roll_off is None else 2 * np.pi / roll_off
    density = prefactor * np.maximum(q, lowest) ** (-2 * (1 + hurst))
    # The small number keeps a wave that is exactly as long as the cut-off.
    return np.where(q <= 2 * np.pi / cut_off * (1 + 1e-12), density, 0.0)


def _power_spectral_density(
    side: int, spacing: float, hurst: float, roll_off: float | None, anisotropy: float
) -> np.ndarray:
    """C(q) up to a factor, on the half plane of `scipy.fft.rfft2`; zero for the mean height."""
    q = _wave_numbers(side, spacing, anisotropy)
    # In units of the roll-off (or of the longest wave), so that no power under- or overflows.
    q /= 2 * np.pi / (roll_off if roll_off is not None else side * spacing)
    floor = 1.0 if roll_off is not None else 0.0
    return np.maximum(q, floor) ** (-2 * (1 + hurst))


def disc_outline(shape: tuple[int, int], spacing: float, diameter: float) -> np.ndarray:
    """Cells (ny, nx) whose centres lie within a disc at the middle of the grid; lengths in mm."""
    y, x = ((np.arange(n) - (n - 1) / 2) * spacing for n in shape)
    return np.hypot(y[:, np.newaxis], x[np.newaxis, :]) <= diameter / 2
