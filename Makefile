# RIGID: every command of a contributor. A bare machine needs python3 (3.11 or newer) and make.
.DEFAULT_GOAL := help
.PHONY: help demo test check lint format bundled bench bench-standard paper docs test-environments clean
.NOTPARALLEL:

PYTHON ?= python3
BIN := .venv/bin
WEB := $(shell find web -name node_modules -prune -o -name build -prune -o -name tests -prune -o -type f -print 2>/dev/null)

help: ## shows this list
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 16

demo: .venv/.rigid ## measures the bundled robot in three minutes: runs/demo/report.html
	$(BIN)/rigid demo

test: .venv/.dev web/node_modules/.package-lock.json ## the fast suite, Python and web
	@command -v chromium >/dev/null || { $(call apt,chromium); }
	@$(BIN)/python -c 'import sys, rigid.report.canvas as c; sys.exit(c.backend() is None)' || \
		{ $(call apt,libegl1 libgl1-mesa-dri libopengl0); }
	$(BIN)/pytest --numprocesses auto --dist loadfile --timeout 600 --timeout-method thread
	$(npm) test

check: lint test docs ## what continuous integration runs: lint, format, types, tests, documentation

lint: .venv/.dev web/node_modules/.package-lock.json
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(npm) run types

format: .venv/.dev ## formats, and mends what ruff can mend
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

bundled: .venv/.rigid ## retrains every bundled policy and data set from its seeds
	$(BIN)/python -m rigid.robots.bundled

bench: .venv/.rigid ## measures speed: benchmarks/latest.json
	$(BIN)/rigid bench --json benchmarks/latest.json

bench-standard: .venv/.rigid ## holds preset standard against preset paper: goes on from what results/standard/ keeps, ten hours in all
	$(BIN)/python -m benchmarks.standard

paper: .venv/.rigid ## the paper's experiments: results/paper/ [PRESET=demo] [ROBOT_SEEDS=0,1,2] [FOR=90m]
	$(BIN)/python -m benchmarks.paper $(if $(PRESET),--preset $(PRESET)) \
		$(if $(ROBOT_SEEDS),--robot-seeds $(ROBOT_SEEDS)) $(if $(FOR),--for $(FOR))

test-environments: .venv/.environments ## tasks of other libraries: PettingZoo, MaMuJoCo, Overcooked
	$(BIN)/pytest -m slow tests/tasks/bridges/test_strangers.py

docs: .venv/.docs ## builds the documentation: build/docs/index.html
	$(BIN)/sphinx-build --quiet --fail-on-warning --keep-going --jobs auto \
		--conf-dir docs --doctree-dir build/doctrees . build/docs
	@echo "build/docs/index.html"

clean: ## removes all that was built or cached; keeps runs/
	rm -rf .venv .cache .hypothesis .mypy_cache .pytest_cache .ruff_cache build dist docs/commands
	rm -rf src/rigid/report/static web/build web/node_modules
	find src tests -name __pycache__ -prune -exec rm -rf {} +

# The environment. Stamps in .venv/ say what was installed, so that the next call starts at once.
.venv/.rigid .venv/.dev .venv/.docs .venv/.environments: pyproject.toml hatch_build.py $(WEB) | $(BIN)/python
	@echo "installing into .venv: some minutes on the first run"
	$(BIN)/pip install --quiet --editable '.$(extras_$(@F))'
	@touch $@
extras_.dev := [test,dev]
extras_.docs := [docs]
extras_.environments := [test,environments]

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "rigid needs Python 3.11 or newer: make PYTHON=python3.11 ..." >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip' 2>/dev/null || { $(call apt,python3-venv); }
	$(PYTHON) -m venv .venv

web/node_modules/.package-lock.json: web/package-lock.json | .venv/.dev
	$(npm) ci --no-audit --no-fund --loglevel=error

# npm, with the Node of the environment.
npm = PATH="$(CURDIR)/$(BIN):$$PATH" npm --prefix web

# Installs system packages when root on Debian; else says what is missing.
apt = if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; \
	then apt-get -qq update && DEBIAN_FRONTEND=noninteractive apt-get -qq install --no-install-recommends $(1) >/dev/null; \
	else echo "missing on this machine: $(1). Run: sudo apt-get install $(1)" >&2; exit 1; fi
