# From scans of cracks to the figures of Borri-Brunetto, Carpinteri and Chiaia (1999).
# A study is its configuration: snakemake --cores all --configfile config/mine.yaml
from snakemake.utils import min_version

min_version("9.27")

# Not as a default of `--configfile`, which would merge a study into it.
if not workflow.configfiles:

    configfile: "config/paper.yaml"


# What `snakemake --report` begins with.
report: "workflow/report/start.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/specimens.smk"
include: "workflow/rules/contact.smk"
include: "workflow/rules/laboratory.smk"
include: "workflow/rules/atlas.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/pages.smk"
include: "workflow/rules/records.smk"


# Results whose record Snakemake has lost are made again. Mark them before Snakemake looks at the files, in a
# dry run too.
remake_without_record()


onstart:
    begin()


onsuccess:
    end()


onerror:
    end()


rule all:
    default_target: True
    input:
        rules.atlas.output,
        collect_everything,
        expand(rules.refused.output, refused=range(len(REFUSED))),
    # Snakemake would else print some hundred names of files.
    message:
        "everything of the study"
