"""Code blocks of the documents: each is run by a test, or named here with the reason why not."""

import ast
import re
import textwrap
from typing import NamedTuple

from places import ROOT

#: Documents whose blocks are run.
DOCUMENTS = [
    ROOT / "README.md",
    ROOT / "packages/roughcontact/README.md",
    *sorted(ROOT.glob("packages/roughcontact/docs/*.md")),
    *sorted(ROOT.glob("docs/*.md")),
]

INSTALLS = "installs the environment and runs the paper study: some minutes and a network"
BY_CI = "a target of the Makefile: that it exists is tested with the documents"
CLUSTER = "for a cluster with a queue: `make test-slurm` starts one"
HOURS = "takes hours"
#: Blocks that no test runs as they stand, by document and the words they begin with, and why.
NOT_RUN = {
    ("README.md", "make            # environment"): INSTALLS,
    ("README.md", "label: granite"): "a sidecar: read in tests/test_documents.py",
    (
        "README.md",
        "make new",
    ): "run with other scans in tests/commands/test_new_study.py and tests/workflow/test_smoke.py",
    (
        "packages/roughcontact/README.md",
        "pip wheel",
    ): "built in tests/roughcontact/test_distribution.py",
    (
        "packages/roughcontact/README.md",
        "space = HalfSpace(topography",
    ): "tests/roughcontact/contact/test_state.py",
    (
        "packages/roughcontact/README.md",
        "<ContactState",
    ): "printed by the first script: compared in tests/roughcontact/test_distribution.py",
    (
        "packages/roughcontact/docs/solver_speed.md",
        ".venv/bin/python benchmarks/beside_peers.py",
    ): f"{HOURS}, beside others",
    (
        "docs/card.md",
        "python -m fractalcontact.commands.export_constants",
    ): "run with a card of a test in tests/cards/test_exports.py",
    (
        "docs/card.md",
        "python -m fractalcontact.commands.profile_card",
    ): "run with a made profile in tests/cards/test_profiles.py",
    ("docs/cluster.md", "make slurm"): CLUSTER,
    ("docs/cluster.md", ".venv/bin/python workflow/run.py config/mine.yaml"): CLUSTER,
    ("docs/cluster.md", "cp -r workflow/profiles/slurm"): CLUSTER,
    (
        "docs/extending.md",
        "stiffness:",
    ): "a caption: tests/figures/test_atlas_examples.py",
    (
        "docs/extending_stages.md",
        '"""Summits of the composite topographies of a specimen',
    ): "a script: run in tests/workflow/test_added_stage.py",
    (
        "docs/extending_stages.md",
        "rule summits:",
    ): "a rule: run in tests/workflow/test_added_stage.py",
    (
        "docs/flow.md",
        "python -m fractalcontact.commands.export_aperture",
    ): "run with the atlas of a test in tests/cards/test_apertures.py",
    ("docs/flow.md", "kind: aperture"): "a sidecar: tests/scan/test_aperture.py reads its keys",
    (
        "docs/flow.md",
        "import numpy as np\nimport porepy",
    ): "a model of another program",
    (
        "docs/library.md",
        ".venv/bin/python -m fractalcontact.commands.gap_of_scans",
    ): "run with two faces of a test in tests/commands/test_gap_of_scans.py",
    ("docs/first_hour.md", "make new"): BY_CI,
    ("docs/first_hour.md", "kind: face"): "a sidecar: read in tests/test_documents.py",
    ("docs/first_hour.md", "make check-scans"): BY_CI,
    (
        "docs/first_hour.md",
        "make STUDY=",
    ): "the study of make new: tests/commands/test_new_study.py",
    ("docs/gallery.md", ".venv/bin/python docs/gallery/"): "scripts: run by tests of the gallery",
    ("docs/size_effect.md", "make STUDY=config/size_effect.yaml"): HOURS,
    ("docs/first_hour.md", "measured:"): "read in tests/study/test_laboratory_tests.py",
    ("docs/laboratory.md", "# scans/granite.yaml"): "read in tests/study/test_laboratory_tests.py",
    ("docs/verification.md", "make grid-table"): BY_CI,
    ("packages/roughcontact/docs/solver.md", "p, u, w <- a start"): "pseudo-code",
    (
        "docs/workflow.md",
        ".venv/bin/python -m snakemake --cores 2",
    ): "options on another study: tests/workflow/test_snakemake_user.py",
    ("docs/workflow.md", "module fractalcontact:"): "tests/workflow/test_snakemake_user.py",
    (
        "packages/roughcontact/docs/solver_parts.md",
        "python benchmarks/solver_gains.py",
    ): "takes minutes of a quiet machine",
    (
        "packages/roughcontact/docs/solver_speed.md",
        "OMP_NUM_THREADS=1 python benchmarks/capped.py",
    ): "takes minutes of a quiet machine",
    (
        "packages/roughcontact/docs/solver_speed.md",
        "make bench PEERS=1",
    ): f"{HOURS}, installs other programs",
    (
        "packages/roughcontact/docs/solver_speed.md",
        "OMP_NUM_THREADS=1 python benchmarks/periodic_peers.py",
    ): "on a small surface in tests/benchmarks/test_periodic_peers.py",
}


class Block(NamedTuple):
    """A code block: its document, the heading above it, its language if stated, and its text."""

    document: str
    heading: str
    language: str
    text: str

    @property
    def why_not_run(self):
        """Why no test runs it; empty where one does."""
        if self.language.startswith("{"):
            return "a directive: `make docs` fails if it cannot be followed"
        for (document, words), reason in NOT_RUN.items():
            if self.document == document and self.text.startswith(words):
                return reason
        return ""


def blocks(document):
    """Code blocks of a document, fenced or indented, in order."""
    found, heading = [], ""
    pattern = re.compile(
        r"^#+ (?P<heading>.+)$"
        r"|^```(?P<language>.*)\n(?P<fenced>(?:.*\n)*?)^```$"
        r"|(?:(?<=\n\n)|\A)(?P<indented>(?:    .*\n|\n(?=\n*    ))+)",
        re.MULTILINE,
    )
    for part in pattern.finditer((ROOT / document).read_text(encoding="utf-8")):
        if part["heading"]:
            heading = part["heading"]
        else:
            text = part["fenced"] if part["indented"] is None else textwrap.dedent(part["indented"])
            found.append(Block(str(document), heading, part["language"] or "", text))
    return found


def code(document, heading=None):
    """Python blocks of a document, or of what stands under one heading, as one program."""
    chosen = [
        block.text
        for block in blocks(document)
        if heading in (None, block.heading) and not block.why_not_run
    ]
    assert chosen, (document, heading)
    return "\n".join(chosen)


def run_code(document, heading=None, package="", replaced=(), **names):
    """Run the Python blocks of a document; what they leave behind.

    Parameters
    ----------
    document, heading
        As of :func:`code`.
    package : str
        The package that the module of the block is said to be in, for its imports.
    replaced : sequence of (str, str)
        Words that stand for others in a test: names of specimens, offsets.
    **names
        What the text around the block says is there.
    """
    program = code(document, heading)
    for words, others in replaced:
        assert words in program, (document, words)
        program = program.replace(words, others)
    names |= {"__package__": package, "__name__": f"{package}.added" if package else "__main__"}
    exec(compile(program, document, "exec"), names)
    return names


def runs():
    """Documents and headings that calls of :func:`run_code` in the tests name."""
    found = set()
    for path in ROOT.glob("tests/**/*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "run_code":
                document, *heading = (ast.literal_eval(one) for one in node.args)
                found.add((document, *(heading or [None])))
    return found
