import numpy as np
import pytest
from scipy import integrate

from fractalcontact.laws import theory
from fractalcontact.roughness.dimension import slope_statistics
from fractalcontact.surface.synthesis import self_affine


def test_constants_of_the_linear_laws():
    kappas = [theory.PERSSON_KAPPA, theory.BUSH_GIBSON_THOMAS_KAPPA]
    assert kappas == pytest.approx([1.596, 2.507], abs=5e-4)


def test_persson_area_starts_along_its_line_and_saturates():
    line = theory.linear_area(0.1, 1e4, 0.5, theory.PERSSON_KAPPA)
    assert theory.persson_area(0.1, 1e4, 0.5) == pytest.approx(line, rel=1e-6)
    assert theory.persson_area(1e6, 1e4, 0.5) == pytest.approx(1)


def test_the_line_of_persson_begins_at_his_kappa_and_falls():
    line = theory.persson_line(1e-4, 1.0)
    pressure, kappa = line["line_pressure"].values, line["persson_line"].values
    assert (pressure[0], pressure[-1]) == pytest.approx((1e-4, 1))
    assert kappa[0] == pytest.approx(theory.PERSSON_KAPPA, rel=1e-6)
    assert (np.diff(kappa) < 0).all()
    np.testing.assert_allclose(kappa * pressure, theory.persson_area(pressure, 1.0, 1.0))
    assert np.isnan(theory.persson_line(np.nan, np.nan)["persson_line"]).all()


def test_persson_area_is_the_diffusion_of_pressure():
    # P(p = 0) by its own definition: pressures diffuse with variance (E* h'/2)^2, absorbed at zero.
    pressure, modulus, slope = 3.0, 10.0, 0.6
    sigma = modulus * slope / 2

    def density(p):
        return (
            np.exp(-((p - pressure) ** 2) / (2 * sigma**2))
            - np.exp(-((p + pressure) ** 2) / (2 * sigma**2))
        ) / np.sqrt(2 * np.pi * sigma**2)

    touching = integrate.quad(density, 0, np.inf)[0]
    assert theory.persson_area(pressure, modulus, slope) == pytest.approx(touching)


def test_greenwood_williamson_is_the_sum_of_hertz_contacts():
    radius, deviation, modulus = 0.2, 0.01, 1e4
    # One summit of height h above the plane, exponential heights: the density falls out.
    force = integrate.quad(
        lambda h: 4 / 3 * modulus * np.sqrt(radius) * h**1.5 * np.exp(-h / deviation), 0, np.inf
    )[0]
    area = integrate.quad(lambda h: np.pi * radius * h * np.exp(-h / deviation), 0, np.inf)[0]
    found = theory.greenwood_williamson_area(force, modulus, radius, deviation)
    assert found == pytest.approx(area, rel=1e-6)


def test_summits_of_a_made_surface_are_found_by_their_moments():
    # Independent: count the summits of a smooth surface and measure them.
    z = self_affine((512, 512), 1.0, 0.99, rms=1.0, seed=2, roll_off=40.0)
    spectrum = np.fft.fft2(z)
    q = 2 * np.pi * np.hypot(*np.meshgrid(*[np.fft.fftfreq(512)] * 2, indexing="ij"))
    z = np.fft.ifft2(np.where(q < 2 * np.pi / 16, spectrum, 0)).real  # resolved by many cells
    s = slope_statistics(z, 1.0)
    found = theory.asperities(s.m0.item(), s.m2.item(), s.m4.item())
    centre = z[1:-1, 1:-1]
    around = [z[1 + i : 511 + i, 1 + j : 511 + j] for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]
    summit = np.all([centre > other for other in around], axis=0)
    assert found.height_deviation == pytest.approx(centre[summit].std(), rel=0.15)
    curvature = (4 * centre - z[2:, 1:-1] - z[:-2, 1:-1] - z[1:-1, 2:] - z[1:-1, :-2])[summit] / 2
    assert found.radius == pytest.approx(1 / curvature.mean(), rel=0.1)


def test_moments_that_no_surface_has_give_no_summit_heights():
    assert np.isnan(theory.asperities(1.0, 1.0, 0.5).height_deviation)


def test_majumdar_bhushan_is_the_sum_of_hertz_contacts_on_its_spots():
    modulus, dimension, scale, largest = 2e4, 1.3, 1e-5, 0.04

    def number(a):
        return dimension / 2 * largest ** (dimension / 2) * a ** (-dimension / 2 - 1)

    def hertz(a):
        # The bump G^(D-1) l^(2-D) cos(pi x / l) on a base l = sqrt(a), by its curvature at the top.
        length, step = np.sqrt(a), 1e-3 * np.sqrt(a)
        height = scale ** (dimension - 1) * length ** (2 - dimension)
        fall = height * (1 - np.cos(np.pi * step / length))
        radius = step**2 / (2 * fall)
        return 4 / 3 * modulus * (a / np.pi) ** 1.5 / radius

    force = integrate.quad(lambda a: hertz(a) * number(a), 0, largest)[0]
    area = integrate.quad(lambda a: a * number(a), 0, largest)[0]
    found = theory.majumdar_bhushan_area(force, modulus, dimension, scale)
    assert found == pytest.approx(area, rel=1e-5)


@pytest.mark.parametrize("dimension", [1.1, 1.2, 1.4])
def test_majumdar_bhushan_exponent(dimension):
    one, ten = theory.majumdar_bhushan_area(np.array([1.0, 10.0]), 1e4, dimension, 1e-4)
    assert np.log10(ten / one) == pytest.approx(2 / (3 - dimension))


@pytest.mark.parametrize("dimension", [1.0, 1.5, 1.7, np.nan])
def test_majumdar_bhushan_without_a_law(dimension):
    assert np.isnan(theory.majumdar_bhushan_area(1.0, 1e4, dimension, 1e-4))
    assert np.isnan(theory.roughness_scale(1e-4, 0.1, dimension))


@pytest.mark.parametrize("dimension", [1.2, 1.4])
def test_scale_of_a_made_weierstrass_mandelbrot_profile_is_found(dimension):
    scale, rng = 0.01, np.random.default_rng(1)
    frequency = theory.FREQUENCY_RATIO ** np.arange(-60.0, 30.0)
    amplitude = scale ** (dimension - 1) / frequency ** (2 - dimension)
    # Over a period of ln gamma the sum is not quite its smooth mean: lags through one of them.
    lags = np.geomspace(1, theory.FREQUENCY_RATIO, 12, endpoint=False)
    x, phase = rng.uniform(0, 1e6, 4000), rng.uniform(0, 2 * np.pi, frequency.size)

    def height(x):
        return np.cos(np.multiply.outer(x, frequency) + phase) @ amplitude

    found = [
        theory.roughness_scale(np.mean((height(x + lag) - height(x)) ** 2), lag, dimension)
        for lag in lags
    ]
    found = np.exp(np.mean(np.log(found))) ** (dimension - 1)
    assert found == pytest.approx(scale ** (dimension - 1), rel=0.03)


def test_archard_exponents():
    np.testing.assert_allclose(theory.archard_exponent([1, 2, 3]), [2 / 3, 8 / 9, 26 / 27])
