# Figures of every specimen, each from its own atlas; PNG, SVG, and the numbers as CSV beside them.


def figure_files(specimen, ending):
    opposite = SETTINGS[specimen]["opposite"]
    if specimen in SCANS and SCANS[specimen].upper is not None:
        opposite = "scanned"
    return expand(
        f"{RESULTS}/figures/{specimen}/{{name}}.{ending}", name=figures_of(opposite)
    )


def collect_figures(wildcards):
    return [path for specimen in SPECIMENS for path in figure_files(specimen, "png")]


# One rule a specimen, because the files differ: a surface against a plane has no dilatancy.
for specimen in SPECIMENS:

    rule:
        name:
            f"figures_of_{re.sub(r'[^A-Za-z0-9_]', '_', specimen)}"
        input:
            expand(rules.specimen_atlas.output, specimen=specimen),
        output:
            report(
                figure_files(specimen, "png"),
                category=specimen,
                labels=figure_labels,
                caption="../report/figure.rst",
            ),
            [figure_files(specimen, ending) for ending in ("svg", "csv")],
        params:
            folder=f"{RESULTS}/figures/{specimen}",
            specimen=specimen,
            names=[Path(path).stem for path in figure_files(specimen, "png")],
            code=code("figures"),
        log:
            f"{RESULTS}/logs/figures/{specimen}.log",
        benchmark:
            f"{RESULTS}/benchmarks/figures/{specimen}.tsv"
        resources:
            mem_mb=2000,
            runtime=10,
        conda:
            "../../environment.yml"
        script:
            "../scripts/figures.py"
