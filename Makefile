# loopbook: `make` runs every notebook and writes every report, `make test` runs every test. `make help` lists the rest.

VENV   := .venv
BIN    := $(VENV)/bin
READY  := $(VENV)/ready
PYTHON ?= python3
JOBS   ?=
UV     := 0.13.9
jobs   := $(if $(JOBS),-j $(JOBS))

# Bytecode is worth seconds at every kernel start; a machine that switches it off would make everything slow.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: all test reports check help doctor clean notebooks lint format bench verify mutants design lock
.DELETE_ON_ERROR:

all: $(READY) ## run all notebooks and write all reports (the default)
	@$(BIN)/loopbook build $(jobs)

test: $(READY) ## run the whole test suite
	@$(BIN)/python -m pytest -n auto --dist loadgroup

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "  make %-10s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

check: $(READY) ## the ledger in a terminal: what holds, and every row that does not
	@$(BIN)/loopbook check

doctor: $(READY) ## say what of the environment is as it should be
	@$(BIN)/loopbook doctor

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

lint: $(READY) ## ruff: format and lint, nothing changed
	@$(BIN)/ruff format --check src tests tools bench
	@$(BIN)/ruff check src tests tools bench

format: $(READY) ## ruff: format and mend
	@$(BIN)/ruff check --fix src tests tools bench
	@$(BIN)/ruff format src tests tools bench

lock: ## resolve environment.txt anew for CPython 3.11 to 3.13
	@$(PYTHON) -m venv .cache/lock && .cache/lock/bin/pip install --quiet uv==$(UV)
	@.cache/lock/bin/uv pip compile pyproject.toml --extra dev --universal --python-version 3.11 --upgrade \
	    --fork-strategy fewest --generate-hashes --no-annotate --no-header --quiet --output-file environment.txt
	@echo "environment.txt: $$(grep -c '==' environment.txt) packages"

clean: ## remove what was built: reports, caches and the environment
	@rm -rf $(VENV) .cache .pytest_cache .ruff_cache .hypothesis src/*.egg-info
	@find src tests tools bench -name __pycache__ -type d -prune -exec rm -rf {} + 2>/dev/null || true
	@find reports -mindepth 1 ! -name ledger.csv ! -name claims.csv ! -name misprints.csv -delete 2>/dev/null || true

$(READY): environment.txt pyproject.toml tools/bootstrap.py
	@command -v $(PYTHON) >/dev/null 2>&1 || { \
	    echo "loopbook needs Python 3.11 or newer: install it, or name it with make PYTHON=/path/to/python3"; exit 3; }
	@$(PYTHON) tools/bootstrap.py $(VENV)
