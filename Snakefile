# From scans of cracks to the figures of Borri-Brunetto, Carpinteri and Chiaia (1999).
# A study is its configuration: snakemake --cores all --configfile config/mine.yaml
from snakemake.utils import min_version

min_version("9.27")

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


# Before Snakemake looks at what there is, in a dry run too: results of which it has lost the record are made again.
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
    # Without it some hundred names are printed.
    message:
        "everything of the study"
