# loopbook: `make` runs every notebook and writes every report, `make test` runs every test. `make help` lists the rest.

VENV   := .venv
BIN    := $(VENV)/bin
READY  := $(VENV)/ready
PYTHON ?= python3
JOBS   ?=
jobs   := $(if $(JOBS),-j $(JOBS))
SOURCES := src tests tools bench notebooks

# Bytecode is worth seconds at every kernel start; a machine that switches it off would make everything slow.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: all test check help doctor clean notebooks lint format bench verify mutants design lock
.DELETE_ON_ERROR:

# An environment that was copied or moved, or made with another PYTHON than the one named now, is made again.
ifneq ($(shell test -x $(BIN)/python && sed 1d $(READY) 2>/dev/null),$(shell pwd -P; cd $(VENV) 2>/dev/null && pwd -P))
.PHONY: $(READY)
endif
ifneq ($(origin PYTHON),file)
ifneq ($(shell cat $(VENV)/asked-for 2>/dev/null),$(PYTHON))
.PHONY: $(READY)
endif
endif
NEEDS_PYTHON = $(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3,))' >/dev/null 2>&1 || { \
	    echo "loopbook needs Python 3.11 or newer, and $(PYTHON) does not run: make PYTHON=/path/to/python3"; exit 3; }

all: $(READY) ## run all notebooks and write all reports (the default)
	@$(BIN)/loopbook build $(jobs)

test: $(READY) ## run the whole test suite
	@$(BIN)/python -m pytest -n auto --dist loadgroup

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "  make %-10s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

check: $(READY) ## the ledger in a terminal: what holds, and every row that does not
	@$(BIN)/loopbook check

doctor: ## say what of the environment is as it should be; changes nothing
	@$(NEEDS_PYTHON)
	@$(PYTHON) tools/doctor.py $(VENV)

notebooks: $(READY) ## open JupyterLab on the project's kernel
	@MATPLOTLIBRC="$(CURDIR)/src/notebook_reports/run/matplotlibrc" $(BIN)/jupyter lab notebooks

design: $(READY) ## a regulator for your own process: make design DATA=record.csv [REPORT=report.pdf]
	@test -n "$(DATA)" || { echo "make design needs a record or a model: make design DATA=record.csv"; exit 2; }
	@$(BIN)/loopbook design "$(DATA)" $(if $(REPORT),-o "$(REPORT)")

bench: $(READY) ## measure the speed against the alternatives, in one run
	@$(BIN)/python -m bench

verify: $(READY) ## build twice in two folders and compare every byte
	@$(BIN)/loopbook verify

mutants: $(READY) ## alter printed digits and rule constants and count what the checks catch
	@$(BIN)/python tools/mutants.py

lint: $(READY) ## what is not formatted, not clean or not cleared; changes nothing
	@$(BIN)/ruff format --check --quiet $(SOURCES)
	@$(BIN)/ruff check --quiet $(SOURCES)
	@$(BIN)/python tools/clear_outputs.py --check notebooks

format: $(READY) ## format, mend, clear the notebooks' outputs
	@$(BIN)/ruff check --fix $(SOURCES)
	@$(BIN)/ruff format $(SOURCES)
	@$(BIN)/python tools/clear_outputs.py notebooks

lock: ## resolve the locks for CPython 3.11 to 3.13: make lock [ONLY="environment cluster"] [UPGRADE=1]
	@$(PYTHON) -m venv .cache/lock
	@.cache/lock/bin/pip install --quiet --only-binary :all: --require-hashes -r tools/uv.txt
	@.cache/lock/bin/python tools/lock.py $(if $(UPGRADE),--upgrade) --uv .cache/lock/bin/uv $(ONLY)

clean: ## remove what was built: reports, caches and the environment
	@rm -rf $(VENV) $(VENV)-install.log .cache .pytest_cache .ruff_cache .mypy_cache .hypothesis build src/*.egg-info
	@find src tests tools bench -name __pycache__ -type d -prune -exec rm -rf {} + 2>/dev/null || true
	@find reports -mindepth 1 ! -name ledger.csv ! -name claims.csv ! -name misprints.csv -delete 2>/dev/null || true

$(READY): environment.txt tools/uv.txt pyproject.toml tools/bootstrap.py tools/pip_settings.py
	@$(NEEDS_PYTHON)
	@$(PYTHON) tools/bootstrap.py $(VENV)
	@echo "$(PYTHON)" > $(VENV)/asked-for

# What a single target needs beside environment.txt: name $(VENV)/ready-interop as its prerequisite for locks/interop.txt.
$(VENV)/ready-%: locks/%.txt $(READY)
	@$(BIN)/python tools/bootstrap.py $(VENV) $*
