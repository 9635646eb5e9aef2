"""Names of the stages of a study, as the rules of the workflow make them."""

import re

from places import ROOT

_FILES = sorted(ROOT.glob("workflow/rules/*.smk"))
_RULES = "".join(path.read_text(encoding="utf-8") for path in _FILES)
_OUTPUTS = re.findall(r'(?m)^ {8}(?:\w+=)?f"\{RESULTS\}/(\w+)/[^"/]*\.nc"', _RULES)
#: Stages that a study has once where it has their key, on synthetic surfaces; of measurements.
EXPERIMENTS = ("roll_off", "size_strength", "area_slope", "estimator_bias", "size_effect")
MEASUREMENTS = ("speed", "speed_growth", "convergence", "stability", "elimination")
#: Of several specimens together, made with the atlas.
TOGETHER = ("study_statements", "study_comparison")
#: Files that jobs leave to others, which are no groups of the atlas.
_PARTS = {"size_effect_parts", "stability_parts", "rows", "atlas"}
STAGES = (*dict.fromkeys(name for name in _OUTPUTS if name not in _PARTS), *TOGETHER)
#: Those of every specimen: of all, of joints that slide.
OF_SPECIMENS = tuple(
    name
    for name in STAGES
    if name not in (*EXPERIMENTS, *MEASUREMENTS, *TOGETHER, "contact_maps", "ensemble", "measured")
)
