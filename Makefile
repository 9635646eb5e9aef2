# make        environment, then the default study (config/paper.yaml)
# make check-scans   reads everything in scans/ and says what it holds, solving nothing
# make test   what the tests need, then the tests
# make accuracy   error against time, order of convergence, cheaper models; PEERS=1 takes in other codes
# make check-accuracy  the study against itself at full cost: numbers within their errors, and seconds
# make cost   where the time of the study went
# make bench  the contact solver timed; with PEERS=1 also against other codes, installed for it
# make scenes SCENES=5000   so many random contact problems, each state verified
# make fuzz FILES=5000     so many spoilt scan files, each read or refused in one sentence
# make lint   ruff and snakefmt, changing nothing
# make lock   new pins for every package (needs uv)

STUDY  ?= config/paper.yaml
CORES  ?= all
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip --disable-pip-version-check --quiet --require-virtualenv
SNAKEMAKE := $(BIN)/snakemake --workflow-profile workflow/profiles/default --cores $(CORES)

# A killed run leaves Snakemake's lock behind. flock knows whether that run is still alive, so the
# stale lock is taken away and a living one respected; where there is no flock, Snakemake asks.
FLOCK := $(shell command -v flock 2>/dev/null)
ifneq ($(FLOCK),)
GUARD := $(FLOCK) --nonblock --no-fork .snakemake.guard
# What is wrong with the study is said by the run itself: here it would be kept quiet.
UNLOCK = $(BIN)/snakemake --configfile $(STUDY) --unlock --quiet all;
else
GUARD :=
UNLOCK :=
endif

# What the study calls itself.
NAME = $(shell sed -n 's/^study: *//p' $(STUDY))

.PHONY: all study smoke check-scans check-accuracy cost accuracy test bench scenes fuzz lint format lock clean
all: study

study: $(VENV)/installed
	@$(GUARD) sh -c '$(UNLOCK) $(SNAKEMAKE) $(TARGET) --configfile $(STUDY)' \
	  || { s=$$?; echo "make: the study did not finish; what is done is kept, and 'make' goes on from there." >&2; exit $$s; }

smoke:
	@$(MAKE) --no-print-directory study STUDY=config/smoke.yaml

# SCANS=folder for another one than the study's.
check-scans: $(VENV)/installed
	@$(BIN)/python -m fractalcontact.check_scans $(SCANS) --study $(STUDY)

# Times are compared: let nothing else run meanwhile.
accuracy: $(if $(PEERS),$(VENV)/peers-installed)
	@$(MAKE) --no-print-directory study TARGET=accuracy \
	  STUDY=$(if $(filter file,$(origin STUDY)),config/accuracy.yaml,$(STUDY))

# The study, then all of it at full cost beside it (results/NAME_full), then the two compared.
check-accuracy: study
	@$(SNAKEMAKE) --configfile $(STUDY) --config study=$(NAME)_full accuracy=full \
	  -- results/$(NAME)_full/atlas.nc
	@$(BIN)/python benchmarks/check_accuracy.py results/$(NAME) results/$(NAME)_full

cost: study
	@$(BIN)/python benchmarks/study_cost.py results/$(NAME)

test: $(VENV)/tests-installed
	$(BIN)/python -m pytest

# Tables go to results/benchmarks. make bench BENCH=--quick, or --help, for other measurements.
bench: $(VENV)/installed $(if $(PEERS),$(VENV)/peers-installed)
	$(BIN)/python benchmarks/run.py $(BENCH)

SCENES ?= 3000
scenes: $(VENV)/tests-installed
	SCENES=$(SCENES) $(BIN)/python -m pytest -q tests/test_scenes.py -k every_state

# What failed is kept in results/fuzzing; FUZZ='--only 1234' judges one file again.
FILES ?= 5000
fuzz: $(VENV)/tests-installed
	$(BIN)/python tests/fuzzing.py --files $(FILES) $(FUZZ)

lint: $(VENV)/tests-installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check Snakefile workflow/rules

format: $(VENV)/tests-installed
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	$(BIN)/snakefmt Snakefile workflow/rules

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.version_info >= (3, 11) or sys.exit(f"fractalcontact needs Python 3.11 or later, {sys.executable} is {sys.version.split()[0]}: make PYTHON=python3.12")'
	$(PYTHON) -m venv $(VENV)

# Bytecode is compiled now: without it every job pays the imports three times over.
$(VENV)/installed: requirements.lock pyproject.toml | $(VENV)/bin/python
	$(PIP) install --require-hashes --compile -r requirements.lock
	$(PIP) install --no-deps --no-build-isolation --no-index -e .
# Compiled now too: else the first jobs of the first study would all do it.
	$(BIN)/python -m fractalcontact.compile_kernels
	@touch $@

$(VENV)/tests-installed: requirements-test.lock $(VENV)/installed
	$(PIP) install --require-hashes --compile -r requirements-test.lock
	@touch $@

# Not locked: nothing of the study depends on them, and pip leaves what is pinned as it is.
$(VENV)/peers-installed: pyproject.toml $(VENV)/installed
	$(PIP) install --no-build-isolation -e '.[peers]'
	@touch $@

COMPILE = uv pip compile --universal --generate-hashes --no-emit-index-url --no-header --python-version 3.11 --quiet pyproject.toml
lock:
	$(COMPILE) --extra install -o requirements.lock
	$(COMPILE) --extra install --extra test -c requirements.lock -o requirements-test.lock

clean:
	rm -rf results .snakemake .snakemake.guard
