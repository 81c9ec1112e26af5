# The project's words; CI uses the same ones. `make demo` and `make test` work on a fresh machine.
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check
PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)

# the tests start hundreds of commands: none needs to compile what another has compiled
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test lint types tests budget others thorough paper bench clean help

help:  ## these words
	@sed -n 's/^\([a-z]*\):.*## /  make \1\t/p' Makefile

demo: $(VENV)/.on-board  ## makes .venv, installs, and tells the whole story: a twin alive, then what its owner finds
	$(BIN)/twin demo

test: lint budget  ## the same with the tools of development: ruff, mypy and the tests
	@$(MAKE) --no-print-directory --jobs types others

lint: $(VENV)/.development  ## ruff
	$(BIN)/ruff check .

types: $(VENV)/.development  ## mypy on public signatures
	$(BIN)/mypy

tests: budget others  ## pytest: what is inside its budget, alone; then the rest

budget: $(VENV)/.development
	$(BIN)/python -m pytest tests/bench/test_tick.py

# what one process compiled the others need not: they start some thousand commands
export PYTHONDONTWRITEBYTECODE =

# three processes more than cores, for tests of the service wait, and so do those that start commands; five at most
SIDE_BY_SIDE = OMP_NUM_THREADS=1 $(BIN)/python -m pytest --dist loadfile -n \
	$$($(BIN)/python -c "import os; print(min(5, os.cpu_count() + 3))")

others: $(VENV)/.development
	$(SIDE_BY_SIDE) --ignore tests/bench/test_tick.py

thorough: $(VENV)/.development  ## the tests that take long and tell more of what a shorter one tells already: before a release
	$(SIDE_BY_SIDE) -m thorough

paper: $(VENV)/.development  ## the paper's tables in small, printed: two minutes
	OMP_NUM_THREADS=1 $(BIN)/twin-bench paper --quick

bench: $(VENV)/.development  ## the budget: 12 ms and 48 MB
	$(BIN)/twin-bench --steps 10000

clean:  ## takes away .venv and what the tools left
	rm -rf $(VENV) .pytest_cache .ruff_cache .mypy_cache .hypothesis *.egg-info

$(VENV)/.on-board: pyproject.toml | $(BIN)/python
	$(PIP) --editable '.[bench]'
	@touch $@

# Python compiles what it imports; to compile all that is installed takes longer than to install it
$(VENV)/.development: pyproject.toml | $(BIN)/python
	$(PIP) --no-compile --editable '.[dev]'
	@touch $@ $(VENV)/.on-board

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "Python 3.11 or newer is needed. Install it, or name it: make PYTHON=/path/to/python3"; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); echo "$(PYTHON) cannot make an environment. On Debian: apt install python3-venv"; exit 1; }
