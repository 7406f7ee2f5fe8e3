# tractionpower: everything a developer needs. Only Python 3.11+, make and a package index are assumed.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.DEFAULT_GOAL := help
.PHONY: help setup demo test lint bench docs images clean

help:          ## list the targets
	@sed -n 's/^\([a-z]*\):.*## /  make \1\t/p' $(MAKEFILE_LIST) | expand -t 16

setup: $(STAMP)  ## virtual environment in .venv with everything installed

$(STAMP): pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "tractionpower needs Python 3.11 or newer; name one: make setup PYTHON=python3.12"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[dev]'
	@touch $@

demo: setup    ## the main job on a real line: a day of trains and network of the CMK
	$(BIN)/tractionpower run cmk

lint: setup    ## style, types, import contract
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

test: lint     ## lint, then all tests
	$(BIN)/python -m tests.support.warm_up
	$(BIN)/python -m pytest --numprocesses 2 --dist loadfile --no-loadscope-reorder --durations 10
	NUMBA_DISABLE_JIT=1 $(BIN)/python -m pytest -q -m interpreted tests/kernels tests/cosimulation

bench: setup   ## measure speed beside peers; see docs/performance.md
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[dev,bench]'
	$(BIN)/python benchmarks/run.py

docs: setup    ## reference pages made from the declarations
	$(BIN)/python docs/make_reference.py
	$(BIN)/python docs/make_texts.py

images: setup  ## figures of the README drawn anew, from a day of the real line
	$(BIN)/python docs/make_images.py
	$(BIN)/python docs/make_screenshot.py

clean:         ## remove what the targets made
	rm -rf $(VENV) .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache
