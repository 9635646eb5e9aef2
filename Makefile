#: Yours: make does the first, `make help` prints these lines
#:   make all                   the study config/paper.yaml, or STUDY=file; VERBOSE=yes, DROP=yes lets specimens go, EXECUTOR=local
#:   make new                   config/mine.yaml, a small study of the scans in scans/ alone; SCANS=folder, NAME=other
#:   make check-scans           what everything in scans/, or SCANS=folder, holds; nothing is solved
#:   make describe              a draft of a sidecar for each scan that needs one; SCANS=folder, FILE=one, LIKE=sidecar
#:   make dry-run               what would be done, and why
#:   make keep-going            the study, where one bad scan does not keep the others from their figures
#:   make smoke                 the small study config/smoke.yaml
#:   make slurm                 the study on a cluster
#:   make report                the result page alone, and what it is made of
#:   make notebook              docs/notebooks in the browser (JupyterLab, installed at the first call)
#:   make verify                every result against its checksum
#:
#: A developer's
#:   make test                  what the tests need, then the tests
#:   make test-all              the tests with larger ensembles
#:   make test-processors       the tests under four profiles of processor; PROFILE=one, FOLDERS='tests/flow tests/scan'
#:   make test-slurm            the smoke study on a real SLURM of one node: root on Debian alone
#:   make test-slurm-accounting the same on one that keeps accounts of what jobs used
#:   make test-browser          the pages in Debian's chromium
#:   make examples              each study of config/examples, run once
#:   make faults                kills, damage, full disks and more, replayed; FAULTS=--quick, FAULTS=--slurm
#:   make lint                  ruff, snakefmt, annotations and types, changing nothing; net lines
#:   make format                what lint finds, mended where it can be
#:   make docs                  the documentation in results/docs; warnings and broken links are errors
#:   make rule-graph            the picture of the rules, docs/chain.svg
#:   make keep                  before a change: keeps the results of smoke and paper, or of STUDY
#:   make same                  after it: what differs from those, bit for bit; AGAINST=folder, RENAMED=file
#:   make schema                schemas for editors, tables of keys and of published numbers, from their classes and rows
#:   make lock                  new pins for every package
#:   make clean                 results and Snakemake's records are removed

STUDY  ?= config/paper.yaml
CORES  ?= all
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip --disable-pip-version-check --quiet --require-virtualenv

# Read from the environment, so that a shell never sees what stands in them.
export STUDY SCANS FILE LIKE
# Looks at the study and the results first, then runs Snakemake, and ends it when told to end.
# Where it fails it ends make too, quietly, as QUIETLY does below.
RUN = exec env FRACTALCONTACT_MAKE=$$PPID $(if $(filter yes y true 1,$(DROP)),FRACTALCONTACT_DROP=yes) $(BIN)/python workflow/run.py "$$STUDY" \
  $(if $(filter yes y true 1,$(VERBOSE)),--verbose) $(if $(EXECUTOR),--executor $(EXECUTOR))
OPTIONS = -- --cores $(CORES)
# Below the sentence of a check that refuses, make would add "*** Error 1". Only where a signal ends it
# does it say nothing; and of that of a closed pipe no shell says anything.
QUIETLY = || { kill -s PIPE $$PPID; exit 1; }

.PHONY: help all study new check-scans describe dry-run keep-going smoke slurm report notebook verify test test-all test-processors test-slurm test-slurm-accounting test-browser examples faults lint format docs schema rule-graph keep same lock clean
# Two runs in one checkout would refuse each other.
.NOTPARALLEL:
all: study

help:
	@sed -n 's/^#: \{0,1\}//p' Makefile benchmarks/Makefile

smoke: override STUDY = config/smoke.yaml
study smoke: $(VENV)/installed
	@$(RUN) $(OPTIONS) $(TARGET)

report: $(VENV)/installed
	@$(RUN) $(OPTIONS) pages

keep-going: $(VENV)/installed
	@$(RUN) $(OPTIONS) --keep-going $(TARGET)

dry-run: $(VENV)/installed
	@$(RUN) --dry-run $(OPTIONS) $(TARGET)

# The scans and .venv on a file system that all nodes see.
slurm: $(VENV)/slurm-installed
	@$(RUN) --profile slurm -- -- $(TARGET)

verify: $(VENV)/installed
	@$(BIN)/python -m fractalcontact.commands.verify "$$STUDY" $(QUIETLY)

# SCANS=folder for another one than the study's.
check-scans: $(VENV)/installed
	@$(BIN)/python -m fractalcontact.commands.check_scans $${SCANS:+"$$SCANS"} --study "$$STUDY" $(QUIETLY)

# NAME by the command line alone: Windows' WSL has one in the environment.
new: $(VENV)/installed
	@$(BIN)/python -m fractalcontact.commands.new_study $(if $(findstring command,$(origin NAME)),--name="$$NAME") \
	  $${SCANS:+--scans "$$SCANS"} $(QUIETLY)

describe: $(VENV)/installed
	@$(BIN)/python -m fractalcontact.commands.describe $${SCANS:+"$$SCANS"} $${FILE:+--file "$$FILE"} \
	  $${LIKE:+--like "$$LIKE"} --study "$$STUDY" $(QUIETLY)

COMPARED = $(if $(filter file,$(origin STUDY)),config/smoke.yaml config/paper.yaml,"$$STUDY")
MAKE_COMPARED = @for study in $(COMPARED); do $(MAKE) --no-print-directory study STUDY="$$study" || exit; done
export AGAINST RENAMED
keep:
	$(MAKE_COMPARED)
	@$(BIN)/python benchmarks/same.py keep $(COMPARED)

same:
	$(MAKE_COMPARED)
	@$(BIN)/python benchmarks/same.py compare $(COMPARED) \
	  $${AGAINST:+--against "$$AGAINST"} $${RENAMED:+--renamed "$$RENAMED"}

# A process for each core, which shares costly fixtures file by file. Threads of BLAS in all of them
# would only wait for each other. Bytecode of the tests is kept, whatever the environment says.
PYTEST = OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -n auto

test: $(VENV)/tests-installed
	$(PYTEST)

test-all: $(VENV)/tests-installed
	TESTS=all $(PYTEST)

test-processors: $(VENV)/tests-installed
	PYTHONDONTWRITEBYTECODE= $(BIN)/python tests/support/processors.py $(if $(PROFILE),--only $(PROFILE)) -- $(FOLDERS)

examples: $(VENV)/tests-installed
	EXAMPLES=yes $(BIN)/python -m pytest -q tests/workflow/test_examples.py

# The pages of a small study, headless: screenshots, sizes and times go to results/browser.
test-browser: $(VENV)/browser-installed
	@chromium=$$(sh tests/support/chromium.sh) && \
	  CHROMIUM=$$chromium $(BIN)/python -m pytest tests/browser && cat results/browser/report.txt

# The study that the notebook reads.
NOTEBOOK_STUDY = @STUDY=docs/notebooks/own_joint.yaml; $(RUN) $(OPTIONS) results/own_joint/atlas.nc
docs: $(VENV)/docs-installed
	$(NOTEBOOK_STUDY)
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs results/docs
	@echo "file://$(CURDIR)/results/docs/index.html"

notebook: $(VENV)/notebook-installed
	$(NOTEBOOK_STUDY)
	$(BIN)/python -m jupyterlab docs/notebooks/own_joint.ipynb

# Its daemons, where Debian has them: who is not root, or elsewhere, is told what is missing.
HAVE_DAEMON = command -v $(1) >/dev/null || { [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null && \
  DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet=2 --no-install-recommends $(2) >/dev/null; } || true

# Of the small study, which has all rules of the chain: "dot" is of Debian's graphviz.
rule-graph: $(VENV)/installed
	@$(call HAVE_DAEMON,dot,graphviz)
	@$(BIN)/python -m snakemake --configfile config/smoke.yaml --rulegraph dot -- pages 2>/dev/null | dot -Tsvg > docs/chain.svg

test-slurm: $(VENV)/tests-installed $(VENV)/slurm-installed
	@$(call HAVE_DAEMON,slurmctld,slurm-wlm munge)
	SLURM=yes $(BIN)/python -m pytest -q tests/workflow/test_slurm.py

test-slurm-accounting: $(VENV)/tests-installed $(VENV)/slurm-installed
	@$(call HAVE_DAEMON,slurmctld,slurm-wlm munge)
	@$(call HAVE_DAEMON,slurmdbd,slurmdbd mariadb-server)
	SLURM=accounting $(BIN)/python -m pytest -q -s tests/workflow/test_slurm.py

# Schemas for editors and tables of keys, from the classes of keys.
schema: $(VENV)/installed
	$(BIN)/python -m fractalcontact.commands.write_keys

lint: $(VENV)/tests-installed
	$(BIN)/python -m ruff check .
	$(BIN)/python -m ruff format --check .
	$(BIN)/python -m snakefmt --check Snakefile workflow/rules
	$(BIN)/python tests/support/annotations.py src
	$(BIN)/python -m mypy
	$(BIN)/python tests/support/net_lines.py

format: $(VENV)/tests-installed
	$(BIN)/python -m ruff check --fix .
	$(BIN)/python -m ruff format .
	$(BIN)/python -m snakefmt Snakefile workflow/rules

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.version_info >= (3, 11) or sys.exit(f"fractalcontact needs Python 3.11 or later, {sys.executable} is {sys.version.split()[0]}: make PYTHON=python3.12")' $(QUIETLY)
	@$(PYTHON) -c 'import os, re, sys; here = os.getcwd(); re.search(r"[\s\x22\x27\\$$`&;|<>()*?\[\]#!{}]", here) and sys.exit(f"{here}: Snakemake cannot start scripts from a folder whose name has spaces or quotes in it; move the checkout to one without")' $(QUIETLY)
	$(PYTHON) -m venv $(VENV)

# Where Python finds the packages. A checkout that was copied or moved is installed again, before any
# target: else Python would run the code of the folder where it was installed, or find none.
FOUND_IN := $(shell cat $(VENV)/lib/python*/site-packages/__editable__.fractalcontact-*.pth 2>/dev/null)
.PHONY: moved
# Bytecode is compiled now: without it every job pays the imports three times over.
$(VENV)/installed: requirements/study.lock pyproject.toml $(if $(filter-out $(CURDIR)/src,$(FOUND_IN)),moved) | $(VENV)/bin/python
	$(PIP) install --require-hashes --compile -r requirements/study.lock
	$(PIP) install --no-deps --no-build-isolation --no-index -e .
	$(BIN)/python -m compileall -q src
# Compiled now too: else the first jobs of the first study would all do it.
	@$(BIN)/python -m fractalcontact.commands.compile_kernels
	@touch $@

$(VENV)/tests-installed: requirements/test.lock $(VENV)/installed
	$(PIP) install --require-hashes --compile -r requirements/test.lock
	@touch $@

$(VENV)/browser-installed: requirements/browser.lock $(VENV)/tests-installed
	$(PIP) install --require-hashes --compile -r requirements/browser.lock
	@touch $@

$(VENV)/docs-installed: requirements/docs.lock $(VENV)/installed
	$(PIP) install --require-hashes --compile -r requirements/docs.lock
	@touch $@

# Not locked, as no result depends on it.
$(VENV)/notebook-installed: pyproject.toml $(VENV)/installed
	$(PIP) install --no-build-isolation -e '.[notebook]'
	@touch $@

$(VENV)/slurm-installed: $(VENV)/installed
	$(PIP) install snakemake-executor-plugin-slurm==2.8.0
	@touch $@

# Not locked: nothing of the study depends on them, and pip leaves what is pinned as it is.
$(VENV)/peers-installed: pyproject.toml $(VENV)/installed
	$(PIP) install --no-build-isolation -e '.[peers]'
	@CMAKE_ARGS="-DASPHER_NATIVE=ON -DASPHER_USE_FFTW=ON" $(PIP) install 'aspher==0.1.3' \
	  || echo "ASPHER is left out: it does not build here (it takes cmake, a C++ compiler, Eigen and FFTW)"
	@touch $@

COMPILE = uv pip compile --universal --generate-hashes --no-emit-index-url --no-header --python-version 3.11 --quiet
lock:
	$(COMPILE) pyproject.toml --extra study --extra flow --extra install -o requirements/study.lock
	$(COMPILE) pyproject.toml --extra study --extra flow --extra install --extra test -c requirements/study.lock -o requirements/test.lock
	$(COMPILE) --group browser -c requirements/test.lock -o requirements/browser.lock
	$(COMPILE) --group docs -c requirements/test.lock -o requirements/docs.lock
	grep -v '^ *--hash=' requirements/study.lock | sed 's/ *\\$$//' > requirements/conda.txt

# Kills, damaged and replaced files, full disks, threads and forks: nothing may be wrong silently.
faults: $(VENV)/tests-installed $(if $(findstring --slurm,$(FAULTS)),$(VENV)/slurm-installed)
	$(if $(findstring --slurm,$(FAULTS)),@$(call HAVE_DAEMON,slurmctld,slurm-wlm munge))
	$(BIN)/python tests/faults.py $(FAULTS)

clean:
	rm -rf results .snakemake .snakemake.guard

include benchmarks/Makefile
