# Experiments on synthetic surfaces, and how fast and how exact the solver is, each where the study
# has its key: src/contactlab/jobs.py says which jobs that are.
from contactlab.jobs import jobs_of

try:
    LABORATORY = jobs_of(config, SOLVER, SOURCE)
except InputError as error:
    raise WorkflowError(str(error))
LABORATORY_FILES = {name: f"{RESULTS}/{name}.nc" for name in LABORATORY}
#: What the study has once, by stage of its atlas.
STUDY_FILES = {}
for name, path in LABORATORY_FILES.items():
    if (folder := name.partition("/")[0]) in stages.STAGES:
        STUDY_FILES.setdefault(folder, []).append(path)


def laboratory_parts(wildcards):
    """Files of other jobs that a job of the laboratory takes, by argument."""
    parts = LABORATORY[wildcards.made].parts
    return {key: [LABORATORY_FILES[name] for name in names] for key, names in parts.items()}


rule laboratory:
    input:
        unpack(laboratory_parts),
    output:
        f"{RESULTS}/{{made}}.nc",
    log:
        f"{RESULTS}/logs/{{made}}.log",
    wildcard_constraints:
        made=alternation(LABORATORY),
    priority: lambda wc: LABORATORY[wc.made].priority
    threads: lambda wc: workflow.cores if LABORATORY[wc.made].alone else 1
    resources:
        mem_mb=doubled(lambda wc: LABORATORY[wc.made].megabytes),
        runtime=doubled(lambda wc: LABORATORY[wc.made].minutes),
    params:
        function=lambda wc: LABORATORY[wc.made].function,
        arguments=lambda wc: LABORATORY[wc.made].arguments,
        peers=lambda wc: LABORATORY[wc.made].peers,
        code=lambda wc: code("stage", module_of(LABORATORY[wc.made].function))(wc),
    message:
        "laboratory: {wildcards.made}"
    script:
        "../scripts/stage.py"
