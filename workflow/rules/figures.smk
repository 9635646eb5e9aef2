# Figures of every specimen, each from its own atlas: PNG, SVG, numbers as CSV, caption as text.

FLAT = [name for name in SPECIMENS if SETTINGS[name]["opposite"] == "flat" and not is_pair(name)]
SLIDING = [name for name in SPECIMENS if name not in FLAT]


def pictures(opposite):
    """The PNG files of a specimen, each with its place in the report."""
    return [picture(name) for name in figures_of(opposite)]


def picture(name):
    path = f"{RESULTS}/figures/{{specimen}}/{name}.png"
    caption = f"../report/{name}.rst"
    # On a line of its own, `report` would be read as the directive.
    return report(path, category="{specimen}", labels={"figure": name}, caption=caption)


def beside(opposite):
    """Vector drawings, numbers and captions that go with the pictures."""
    return expand(
        f"{RESULTS}/figures/{{{{specimen}}}}/{{name}}.{{ending}}",
        name=figures_of(opposite),
        ending=("svg", "csv", "txt"),
    )


rule figures:
    input:
        rules.specimen_atlas.output[0],
    output:
        *pictures("match"),
        *beside("match"),
    log:
        f"{RESULTS}/logs/figures/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/{{specimen}}.tsv"
    wildcard_constraints:
        specimen=one_of(SLIDING),
    conda:
        "../../environment.yml"
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        names=figures_of("match"),
        code=code("figures", *figure_modules("match")),
    script:
        "../scripts/figures.py"


# A surface against a plane does not slide: fewer figures, else the same.
use rule figures as figures_against_plane with:
    output:
        *pictures("flat"),
        *beside("flat"),
    log:
        f"{RESULTS}/logs/figures/{{specimen}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figures/{{specimen}}.tsv"
    wildcard_constraints:
        specimen=one_of(FLAT),
    params:
        names=figures_of("flat"),
        code=code("figures", *figure_modules("flat")),


def collect_figures(wildcards):
    return expand(
        f"{RESULTS}/figures/{{specimen}}/{{name}}.png", specimen=SLIDING, name=figures_of("match")
    ) + expand(
        f"{RESULTS}/figures/{{specimen}}/{{name}}.png", specimen=FLAT, name=figures_of("flat")
    )
