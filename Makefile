# make        environment, then the default study (config/paper.yaml)
# make STUDY=config/mine.yaml   another study; DROP=yes lets its atlas lose specimens that it had
# make new      writes config/mine.yaml, a small study of the scans in scans/ alone, with drafts of the sidecars
#   that they lack; SCANS=folder, NAME=other for config/other.yaml
# make dry-run  says what would be done, and why; VERBOSE=yes for any of these shows all Snakemake says
# make keep-going   one bad scan does not keep the others from their figures
# make slurm    the same on a cluster
# make report   the result page alone, and what it is made of
# make verify   every result against its checksum
# make faults   kills, damage, full disks and more, replayed; FAULTS=--quick for a few of each, FAULTS=--slurm on a SLURM
# make check-scans   reads everything in scans/ and says what it holds, solving nothing
# make describe   drafts a sidecar for each scan that needs one, with a picture of what would be read;
#   SCANS=folder, FILE=one of them, LIKE=sidecar that is to hold for all files of one instrument
# make test   what the tests need, then the tests; make test-all takes larger ensembles
# make test-processors   the tests under four profiles of processor, and a table of what fails: 40 minutes;
#   PROFILE=oldest one of them, FOLDERS='tests/stages tests/flow' these alone
# make examples   each study of config/examples, run once: some minutes
# make test-slurm   the smoke study on a real SLURM of one node, started for it: root on Debian alone
# make test-slurm-accounting   the same on one that keeps accounts, which says what jobs asked for and used
# make test-browser   the pages in Debian's chromium, which it installs where it may
# make docs   the documentation in results/docs, every warning and broken link an error
# make accuracy   error against time, order of convergence, cheaper models; PEERS=1 takes in other codes
# make check-accuracy  the study against itself at full cost: numbers within their errors, and seconds
# make keep, before a change, and make same, after it: what differs, bit for bit, in the smoke study
#   and the default one (or STUDY); AGAINST=folder of other results; RENAMED=file of new names
# make calibration   stated half-widths over those seen, and coverage: Delta_sigma, closure, gap, area, stiffness (20 minutes)
# make cost   where the time of the study went
# make campaign SPECIMENS=1000   the scans and the study of that many small twins, in results/campaigns
# make bench  the contact solver timed; with PEERS=1 also against other codes, installed for it
# make grid-table   elastic and capped contact on four grids: the table of docs/verification.md
# make bench-flow  the flow through gaps timed, with PEERS=1 also against reynoldsflow
# make problems PROBLEMS=5000   PROBLEMS random contact problems, each state verified
# make extremes   synthetic extremes and real scans through the whole chain, all figures: many minutes
# make fuzz FILES=5000     FILES damaged scan files, each read or refused in one sentence
# make fuzz-dialects FILES=5000  FILES ways to write a known surface as text, each read right or refused
# make lint   ruff, snakefmt, annotations and types, changing nothing; make format mends what it can
# make lock   new pins for every package (needs uv)

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
  $(if $(filter yes y true 1,$(VERBOSE)),--verbose)
OPTIONS = -- --cores $(CORES)
# Below the sentence of a check that refuses, make would add "*** Error 1". Only where a signal ends it
# does it say nothing; and of that of a closed pipe no shell says anything.
QUIETLY = || { kill -s PIPE $$PPID; exit 1; }

.PHONY: new describe all study campaign report smoke size-effect-small keep-going slurm dry-run verify faults check-scans check-accuracy calibration keep same cost accuracy test test-all test-processors examples test-browser test-slurm test-slurm-accounting docs bench bench-flow problems grid-table extremes fuzz fuzz-dialects lint format lock clean
# Two runs in one checkout would refuse each other.
.NOTPARALLEL:
all: study

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

# The experiment on the size effect in minutes, and its page in results/size_effect_small.
size-effect-small: override STUDY = config/size_effect_small.yaml
size-effect-small: $(VENV)/installed
	@$(RUN) $(OPTIONS) $(TARGET)
	@$(BIN)/python -m contactlab.commands.size_effect_page \
	  results/size_effect_small/atlas.nc results/size_effect_small/size_effect.md

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

# Times are compared: let nothing else run meanwhile.
accuracy: STUDY := $(if $(filter file,$(origin STUDY)),config/accuracy.yaml,$(STUDY))
accuracy: $(VENV)/installed $(if $(PEERS),$(VENV)/peers-installed)
	@$(RUN) $(OPTIONS) $(TARGET)

# The study, then all of it at full cost beside it (results/NAME_full), then the two compared.
check-accuracy: study
	@$(RUN) --full $(OPTIONS) -- atlas
	@$(BIN)/python benchmarks/check_accuracy.py "$$STUDY"

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

calibration: $(VENV)/installed
	@$(BIN)/python benchmarks/calibration.py --output results/calibration.csv
	@$(BIN)/python benchmarks/calibration_sampling.py --output results/calibration_sampling.csv

cost: study
	@$(BIN)/python benchmarks/study_cost.py "$$STUDY"

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

docs: $(VENV)/docs-installed
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs results/docs
	@echo "file://$(CURDIR)/results/docs/index.html"

# Its daemons, where Debian has them: who is not root, or elsewhere, is told what is missing.
HAVE_DAEMON = command -v $(1) >/dev/null || { [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null && \
  DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet=2 --no-install-recommends $(2) >/dev/null; } || true

test-slurm: $(VENV)/tests-installed $(VENV)/slurm-installed
	@$(call HAVE_DAEMON,slurmctld,slurm-wlm munge)
	SLURM=yes $(BIN)/python -m pytest -q tests/workflow/test_slurm.py

test-slurm-accounting: $(VENV)/tests-installed $(VENV)/slurm-installed
	@$(call HAVE_DAEMON,slurmctld,slurm-wlm munge)
	@$(call HAVE_DAEMON,slurmdbd,slurmdbd mariadb-server)
	SLURM=accounting $(BIN)/python -m pytest -q -s tests/workflow/test_slurm.py

# Tables go to results/benchmarks. make bench BENCH=--quick, or --help, for other measurements.
bench: $(VENV)/installed $(if $(PEERS),$(VENV)/peers-installed)
	$(BIN)/python benchmarks/beside_peers.py $(BENCH)

# The flow solvers that are installed; with PEERS=1 also CHOLMOD and reynoldsflow. FLOW='--sizes 512', or --help.
bench-flow: $(VENV)/installed $(if $(PEERS),$(VENV)/peers-installed)
	$(BIN)/python benchmarks/flow.py $(FLOW)

# CAMPAIGN=--measure: what the workflow takes for that many (after SPECIMENS=6 CAMPAIGN=--run).
SPECIMENS ?= 100
campaign: $(VENV)/installed
	$(BIN)/python benchmarks/campaign.py $(SPECIMENS) $(CAMPAIGN)

# Into docs/grid_table.csv and docs/verification.md; GRID_SPECIMENS=granite: of a scan of the study.
grid-table: $(VENV)/installed
	$(BIN)/python benchmarks/grid_table.py --study "$$STUDY" $(if $(GRID_SPECIMENS),--specimens $(GRID_SPECIMENS))

extremes: $(VENV)/tests-installed
	EXTREMES=all $(PYTEST) tests/figures/test_extremes.py

PROBLEMS ?= 3000
problems: $(VENV)/tests-installed
	PROBLEMS=$(PROBLEMS) $(BIN)/python -m pytest -q tests/contactlab/accuracy/test_random_problems.py -k every_state

# What failed is kept in results/fuzzing; FUZZ='--only 1234' judges one file again.
FILES ?= 5000
fuzz: $(VENV)/tests-installed
	$(BIN)/python tests/support/fuzzing.py --files $(FILES) $(FUZZ)

# What failed is kept in results/dialects.
fuzz-dialects: $(VENV)/tests-installed
	$(BIN)/python tests/support/dialect_fuzzing.py --files $(FILES) $(FUZZ)

lint: $(VENV)/tests-installed
	$(BIN)/python -m ruff check .
	$(BIN)/python -m ruff format --check .
	$(BIN)/python -m snakefmt --check Snakefile workflow/rules
	$(BIN)/python tests/support/annotations.py src
	$(BIN)/python -m mypy

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
$(VENV)/installed: requirements.lock pyproject.toml $(if $(filter-out $(CURDIR)/src,$(FOUND_IN)),moved) | $(VENV)/bin/python
	$(PIP) install --require-hashes --compile -r requirements.lock
	$(PIP) install --no-deps --no-build-isolation --no-index -e .
	$(BIN)/python -m compileall -q src
# Compiled now too: else the first jobs of the first study would all do it.
	@$(BIN)/python -m fractalcontact.commands.compile_kernels
	@touch $@

$(VENV)/tests-installed: requirements-test.lock $(VENV)/installed
	$(PIP) install --require-hashes --compile -r requirements-test.lock
	@touch $@

$(VENV)/browser-installed: requirements-browser.lock $(VENV)/tests-installed
	$(PIP) install --require-hashes --compile -r requirements-browser.lock
	@touch $@

$(VENV)/docs-installed: requirements-docs.lock $(VENV)/installed
	$(PIP) install --require-hashes --compile -r requirements-docs.lock
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
	$(COMPILE) pyproject.toml --extra study --extra flow --extra install -o requirements.lock
	$(COMPILE) pyproject.toml --extra study --extra flow --extra install --extra test -c requirements.lock -o requirements-test.lock
	$(COMPILE) --group browser -c requirements-test.lock -o requirements-browser.lock
	$(COMPILE) --group docs -c requirements-test.lock -o requirements-docs.lock
	grep -v '^ *--hash=' requirements.lock | sed 's/ *\\$$//' > requirements-conda.txt

# Kills, damaged and replaced files, full disks, threads and forks: nothing may be wrong silently.
faults: $(VENV)/tests-installed $(if $(findstring --slurm,$(FAULTS)),$(VENV)/slurm-installed)
	$(if $(findstring --slurm,$(FAULTS)),@$(call HAVE_DAEMON,slurmctld,slurm-wlm munge))
	$(BIN)/python tests/faults.py $(FAULTS)

clean:
	rm -rf results .snakemake .snakemake.guard
