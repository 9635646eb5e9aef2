// Numbers, units and places in words.
const TOWARDS = { E: "East →", N: "North ↑", W: "West ←", S: "South ↓", none: "without sliding" };
const FORCE_UNITS = [["GN", 1e9], ["MN", 1e6], ["kN", 1e3], ["N", 1], ["mN", 1e-3], ["µN", 1e-6]];
const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

function raised(exponent) {
  return [...String(exponent)].map((sign) => RAISED[sign]).join("");
}

/** A number to some digits; with a power of ten where it is large or small. */
function short(value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${signed(String(Number(mantissa)))} × 10${raised(Number(exponent))}`;
  }
  return signed(String(Number(value.toPrecision(digits))));
}

function signed(text) {
  return text.replace("-", "−");
}

function forceUnit(force) {
  const rounded = Number(force.toPrecision(3));
  return FORCE_UNITS.find(([, size]) => rounded >= size) || FORCE_UNITS[FORCE_UNITS.length - 1];
}

function forceWords(force) {
  const [unit, size] = forceUnit(force);
  return `${short(force / size, 3)} ${unit}`;
}

function pressureWords(pressure) {
  return Number(pressure.toPrecision(3)) >= 1000
    ? `${short(pressure / 1000, 3)} GPa`
    : `${short(pressure, 3)} MPa`;
}

/** Greek letters and indices of the atlas's long names. */
function symbols(words) {
  return words
    .replace(/Delta_sigma/g, "Δσ")
    .replace(/Delta_g/g, "Δg")
    .replace(/sigma_0/g, "σ₀")
    .replace(/sigma_n/g, "σₙ")
    .replace(/sigma\*/g, "σ*")
    .replace(/delta_r/g, "δᵣ")
    .replace(/\bdelta\b/g, "δ")
    .replace(/w_int/g, "wᵢₙₜ")
    .replace(/A_r/g, "Aᵣ")
    .replace(/A_0/g, "A₀");
}

function unitWords(units) {
  const words = units === "1" ? "" : units;
  return words.replace("mm^-delta_sigma", "mm^−Δσ").replace("mm2", "mm²").replace("mm-1", "mm⁻¹");
}
