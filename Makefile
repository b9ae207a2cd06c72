# loopbook: `make` runs every notebook and writes every report, `make test` runs every test. `make help` lists the rest.

VENV   := .venv
BIN    := $(VENV)/bin
READY  := $(VENV)/ready
PYTHON ?= python3
JOBS   ?=
jobs   := $(if $(JOBS),-j $(JOBS))
BROWSER_TESTS := tests/loopbook/tuner_page/test_browser.py $(addprefix tests/notebook_reports/export/,test_browser.py test_page_in_browser.py)
SOURCES := src tests tools bench notebooks

# Bytecode is worth seconds at every kernel start; a machine that switches it off would make everything slow.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: all docs difference dist core test quick check help doctor clean notebooks lint format bench profile verify chaos mutants prove prove-design prove-plant prove-identification prove-scaling prove-course interop prove-tuner browser lock
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
	@$(BIN)/loopbook --root . build $(jobs) $(if $(FROZEN),--frozen)

test: $(READY) ## run the tests, of long surveys a seeded share; make test WHOLE=1: every survey whole
	@$(BIN)/python -m pytest -n auto --dist loadfile $(if $(WHOLE),--whole)

quick: $(READY) ## while you work: no kernel, no compiler, nothing that takes long
	@$(BIN)/python -m pytest -n auto --dist loadfile --quick

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-13s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

check: $(READY) ## the ledger in a terminal: what holds, and every row that does not
	@$(BIN)/loopbook --root . check

doctor: ## say what of the environment is as it should be; changes nothing
	@$(NEEDS_PYTHON)
	@$(PYTHON) tools/doctor.py $(VENV)

notebooks: $(READY) ## open JupyterLab on the project's kernel
	@MATPLOTLIBRC="$(CURDIR)/src/notebook_reports/run/matplotlibrc" $(BIN)/jupyter lab notebooks

prove-plant: $(VENV)/ready-cluster ## 2,000 synthetic records on a cluster whose workers are killed: the bad ten stand first (RECORDS=...)
	@$(BIN)/python tests/loopbook/design/acceptance/prove_plant.py $(or $(RECORDS),2000)

prove-design: $(READY) ## design for 300 synthetic records and run every loop on its true process
	@$(BIN)/python tests/loopbook/design/acceptance/prove_design.py 300

prove-identification: $(READY) ## identify 50 simulated plants of each kind: the stated intervals hold the truth in nine of ten
	@$(BIN)/python tests/loopbook/identification/acceptance/prove_identification.py 50

docs: all $(VENV)/ready-docs ## the documentation as a site that works offline: build/site/index.html
	@PYTHONPATH=tools $(BIN)/python -m docs_site.build

difference: $(READY) $(VENV)/ready-docs ## what changed in ledger and pages since a commit: make difference REF=main [OLD=its reports] [ACCEPT=1]
	@mkdir -p build/difference
	@: > build/difference/difference.txt
	@$(BIN)/loopbook --root . build $(jobs) $(if $(ACCEPT),--accept) > build/difference/build.txt 2>&1 || { \
	    echo "The build of this state fails." && sed -n '/ failed:$$/,$$p' build/difference/build.txt && echo; \
	    } > build/difference/difference.txt
	@$(BIN)/loopbook --root . diff "$(or $(REF),HEAD)" $(if $(OLD),--reports "$(OLD)" --pictures build/difference/pages) \
	    >> build/difference/difference.txt || test $$? -eq 1
	@cat build/difference/difference.txt

dist: all ## wheel, source distribution and the reports, as a release has them: build/dist
	@$(BIN)/python tools/distribute.py build/dist

core: dist ## the core's tests against the wheel in an environment with NumPy, SciPy, SymPy and matplotlib alone
	@$(PYTHON) -m venv build/core
	@build/core/bin/python -m pip install --quiet build/dist/*.whl pytest hypothesis
	@build/core/bin/python tools/core_tests.py

prove-scaling: $(READY) ## 2,000 seeded loops in other units of time, y and u: what comes out otherwise
	@$(BIN)/python tests/loopbook/scaling/prove_scaling.py 2000

prove-course: $(READY) ## every exercise sheet at 10,000 draws: solved, as by hand, borne by rounded inputs (DRAWS=...)
	@$(BIN)/python tests/loopbook/course/proof/prove_course.py $(or $(DRAWS),10000) $(SHEETS)

interop: $(VENV)/ready-interop ## exercise sheets in the hands of the real nbgrader and otter
	@$(BIN)/python tests/loopbook/course/interop/prove_interop.py

prove-tuner: $(READY) ## the tuner's page in V8 against Python: 500 loops, margins, responses, verdicts
	@$(BIN)/python tests/loopbook/tuner_page/golden/compare.py

browser: $(VENV)/ready-browser ## what pages do in a browser; needs a chromium (apt-get install chromium)
	@$(BIN)/python -m pytest -q $(BROWSER_TESTS)

bench: $(READY) ## measure the speed against the alternatives, in one run
	@$(BIN)/python -m bench

profile: $(READY) ## the slowest cells and imports of the notebooks: make profile [ONLY=pid_report]
	@$(BIN)/python tools/slow_cells.py $(ONLY)

verify: $(READY) ## build twice under other folders, homes, users, languages and compare every byte
	@$(BIN)/loopbook --root . verify

chaos: $(READY) ## faults at random during builds: what is wrong, what is not mended
	@$(BIN)/python tools/chaos.py

mutants: $(READY) ## alter printed digits, words of statements and derivations, and count what the checks catch
	@$(BIN)/python tools/mutants.py

prove: $(READY) ## the emitted controllers against the references, 100,000 samples each (SAMPLES=...)
	@$(BIN)/python tests/loopbook/code/proof/prove.py $(or $(SAMPLES),100000)

lint: $(READY) ## what is not formatted, clean, typed or cleared; changes nothing
	@$(BIN)/ruff format --check --quiet $(SOURCES)
	@$(BIN)/ruff check --quiet $(SOURCES)
	@$(BIN)/mypy --no-error-summary
	@$(BIN)/python tools/clear_outputs.py --check notebooks

format: $(READY) ## format, mend, clear the notebooks' outputs
	@$(BIN)/ruff check --fix $(SOURCES)
	@$(BIN)/ruff format $(SOURCES)
	@$(BIN)/python tools/clear_outputs.py notebooks

printed: $(READY) ## print what is derived in symbols anew, for everything that runs without SymPy
	@$(BIN)/python -m loopbook.printed

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
