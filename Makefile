# mavgate. `make` alone says what there is.  GNU make 3.81 is enough (macOS ships it).

VENV   := .venv
BIN    := $(VENV)/bin
# The tools are there once `test` is installed; a plain flight needs `run` only.
RUN    := $(VENV)/.run-installed
TEST   := $(VENV)/.test-installed
WORKERS ?= 2

.DEFAULT_GOAL := help
.PHONY: help demo test check lint types contracts soak bench wheel clean

help: ## say what there is
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-10s %s\n", $$1, $$2}' Makefile

demo: $(RUN) ## fly the demonstration: a gated, recorded flight on a simulated vehicle
	@$(BIN)/gcs demo

test: $(TEST) ## run every test (under 8 minutes on 2 cores)
	$(BIN)/python -m pytest -n $(WORKERS) --dist loadfile

check: lint types contracts test ## all that a commit must pass: ruff, mypy, import contracts, tests

lint: $(TEST) ## ruff
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(TEST) ## mypy --strict
	$(BIN)/mypy

contracts: $(TEST) ## import contracts
	$(BIN)/lint-imports --no-cache

soak: $(TEST) ## the properties on new random examples, and more of them than `test` has time for
	MAVGATE_SOAK=1 $(BIN)/python -m pytest tests/unit tests/loopback -n $(WORKERS)

bench: $(TEST) ## paired speed ratios against peers, in one run
	$(BIN)/python -m tests.bench

wheel: $(TEST) ## build the wheel into dist/
	$(BIN)/python -m pip wheel --quiet --no-deps --wheel-dir dist .

clean: ## remove the environment and what tools left behind
	rm -rf $(VENV) dist build .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache

$(RUN): pyproject.toml
	@sh .ci/make-venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e .
	@touch $@

$(TEST): pyproject.toml
	@sh .ci/make-venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[test]'
	@touch $@ $(RUN)
