# Everything runs in .venv, made here on first use. Needs python3 (3.11 or newer), python3-venv, make.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

# Figures are written to files; no display is needed, or asked for.
export MPLBACKEND := Agg

.PHONY: help install study test validation lint format bench docs notebooks clean

help:
	@echo "make install     .venv with the propmdao command (edits to the source take effect at once)"
	@echo "make study       the low-noise design study: tables and figures in results/"
	@echo "make test        the tests, without the slow ones"
	@echo "make validation  the slow tests and the comparisons with experiment and other codes;"
	@echo "                 PROPMDAO_REFERENCE_DATA names the folder of reference data"
	@echo "make lint        ruff and mypy"
	@echo "make format      rewrite the source as 'make lint' wants it"
	@echo "make bench       benchmarks, a JSON file of each run in build/benchmarks"
	@echo "make docs        the documentation site in build/site; its code runs, warnings are errors"
	@echo "make notebooks   its pages with code as Jupyter notebooks in build/notebooks"
	@echo "make clean       remove .venv and everything built"

install: $(VENV)/installed

study: $(VENV)/installed
	$(BIN)/python studies/design/low_noise_design.py

# Each process gets one half of the tests and the rest of the other's: neighbours share what is compiled.
test: $(VENV)/dev
	$(BIN)/python -m pytest -m "not slow" -n 2 --dist worksteal

# Reference data that stands beside the checkout is found without being named.
ifneq ($(wildcard ../shared/data),)
validation: export PROPMDAO_REFERENCE_DATA ?= $(realpath ../shared/data)
endif
validation: $(VENV)/dev
	$(BIN)/python -m pytest -m "slow or validation" -n 2

lint: $(VENV)/dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: $(VENV)/dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(VENV)/dev
	mkdir -p build/benchmarks
	$(BIN)/python -m pytest benchmarks --benchmark-only \
	  --benchmark-json=build/benchmarks/$$(date +%Y-%m-%d-%H%M%S).json

# Pages run the propmdao command and show figures as a notebook does, so not with the backend above.
docs: $(VENV)/docs
	env -u MPLBACKEND PATH="$(CURDIR)/$(BIN):$$PATH" \
	  $(BIN)/python -m sphinx -j auto -W --keep-going -q -b html docs build/site

notebooks: $(VENV)/docs
	mkdir -p build/notebooks
	for page in $$(grep -rl '^jupytext:' docs --include='*.md'); do \
	  $(BIN)/jupytext --quiet --to ipynb --output build/notebooks/$$(basename $$page .md).ipynb $$page || exit 1; \
	done

clean:
	rm -rf $(VENV) build dist *.egg-info .pytest_cache .mypy_cache .ruff_cache .benchmarks

# Stamp files: a second call finds the work done. pyproject.toml holds what has to be installed,
# propmdao/__init__.py the version, which the installation keeps.
INSTALLED_FROM := pyproject.toml propmdao/__init__.py

$(VENV)/created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "propmdao needs Python 3.11 or newer; $(PYTHON) is not that: make $(MAKECMDGOALS) PYTHON=..." >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
	  { echo "$(PYTHON) cannot make virtual environments: apt install python3-venv" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	@touch $@

$(VENV)/installed: $(VENV)/created $(INSTALLED_FROM)
	$(PIP) install --editable '.[plots]'
	@touch $@

$(VENV)/dev: $(VENV)/created $(INSTALLED_FROM)
	$(PIP) install --editable '.[plots,test,lint]'
	@touch $(VENV)/installed $@

$(VENV)/docs: $(VENV)/created $(INSTALLED_FROM)
	$(PIP) install --editable '.[plots,docs]'
	@touch $(VENV)/installed $@
