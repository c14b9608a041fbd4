# mavgate. `make` alone says what there is.  GNU make 3.81 is enough (macOS ships it).

VENV   := .venv
BIN    := $(VENV)/bin
# The tools are there once `test` is installed; a plain flight needs `run` only.
RUN    := $(VENV)/.run-installed
TEST   := $(VENV)/.test-installed
DOCS   := $(VENV)/.docs-installed
# Other people's ground stations, each in an environment of its own.
CLIENTS := .clients
TESTED  := $(CLIENTS)/mavsdk/.installed $(CLIENTS)/mavsdk3/.installed $(CLIENTS)/pymavlink/.installed
SLOWER  := tests/clients/test_mavproxy.py tests/clients/test_dronekit.py
OTHERS  := $(CLIENTS)/mavproxy/.installed $(CLIENTS)/dronekit/.installed $(CLIENTS)/foxglove/.installed
# Beside the tests that compute run those in which separate processes mostly wait for real time:
# four of these at once last no longer than what computes, which gives way to them.
WAIT    := $(BIN)/python -m pytest tests/clients tests/system -n 4 --dist worksteal $(SLOWER:%=--ignore=%)
COMPUTE := nice -n 5 $(BIN)/python -m pytest --ignore=tests/clients --ignore=tests/system -n 2 --dist worksteal
FEWER   := --hypothesis-profile quick

# Without its bytecode files every worker and every program under test compiles the same again.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help demo quick test thorough check lint types contracts clients real soak oracles mutants bench docs messages wheel clean

help: ## say what there is
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-10s %s\n", $$1, $$2}' Makefile

demo: $(RUN) ## fly the demonstration: a gated, recorded flight on a simulated vehicle
	@$(BIN)/gcs demo

quick: lint contracts ## ruff, mypy, import contracts, the tests without process, socket or long flight (about a minute)
	@sh .ci/beside $(BIN)/mypy '$(BIN)/python -m pytest tests/unit -m "not slow" -n 2 --dist worksteal $(FEWER)'

test: $(TEST) $(TESTED) ## run the tests, and a share of the long ones (about 6 minutes on 2 cores)
	@sh .ci/beside '$(WAIT) -m "not thorough" $(FEWER)' '$(COMPUTE) -m "not thorough" $(FEWER)'

thorough: $(TEST) $(TESTED) ## run the long tests: exhaustive, or one thing many times over; as .ci/run does
	@sh .ci/beside '$(WAIT) -m "thorough or hypothesis"' '$(COMPUTE) -m "thorough or hypothesis"'

check: lint types contracts test ## all that a commit must pass: ruff, mypy, import contracts, tests

lint: $(TEST) ## ruff
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(TEST) ## mypy --strict
	$(BIN)/mypy

contracts: $(TEST) ## import contracts
	$(BIN)/lint-imports --no-cache

clients: $(TEST) $(TESTED) $(OTHERS) ## fly with all other ground stations: MAVSDK 4 and 3, pymavlink, MAVProxy, DroneKit, a viewer's page
	$(BIN)/python -m pytest tests/clients -v

real: $(TEST) ## fly a real PX4 and a real ArduCopter (docs/real.md), judged by their simulations; ARGS="--smoke" is short
	$(BIN)/python -m tests.real $(ARGS)

soak: $(TEST) ## the properties on new random examples, and the random runs as a whole (about 70 minutes and 15 GB on 2 cores)
	MAVGATE_SOAK=1 $(BIN)/python -m pytest tests/unit tests/loopback tests/scenarios tests/soak -n 2 --dist worksteal

oracles: $(TEST) ## after moves and renames: does every frame, record, old audit, help and gate cell stay as it was?
	$(BIN)/python -m tests.oracles $(ARGS)

mutants: $(TEST) ## alter the gate in one place at a time: does a test notice? ARGS="vehicle --share 1/20" another part
	$(BIN)/python -m tests.mutants $(ARGS)

bench: $(TEST) $(CLIENTS)/mavio/.installed ## paired speed ratios against peers, in one run
	$(BIN)/python -m tools

docs: $(DOCS) ## build the documentation site into build/site; a link that leads nowhere is an error
	$(BIN)/python -m sphinx -q -W --keep-going -b html -c docs -d build/doctrees . build/site
	@echo "build/site/docs/index.html"

messages: $(RUN) ## regenerate the message classes of gcs and vehicle_sim from the dialect
	$(BIN)/python -m gcs.wire.generate
	$(BIN)/python -m vehicle_sim.wire.generate

wheel: $(TEST) ## build the wheel into dist/
	$(BIN)/python -m pip wheel --quiet --no-deps --wheel-dir dist .

$(CLIENTS)/%/.installed: .ci/make-clients $(TEST)
	@sh .ci/make-clients $(BIN)/python $(CLIENTS) $*
	@touch $@

clean: ## remove the environment and what tools left behind
	rm -rf $(VENV) $(CLIENTS) dist build .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache

$(RUN): pyproject.toml
	@sh .ci/install $(VENV) . 60
	@touch $@

$(TEST): pyproject.toml
	@sh .ci/install $(VENV) '.[test]' 115
	@echo "compiling the tests (once, else each worker of the first run does it)"
	-@$(BIN)/python -m pytest --collect-only -qq >/dev/null 2>&1
	@touch $@ $(RUN)

$(DOCS): $(TEST)
	@sh .ci/install $(VENV) '.[docs]' 30
	@touch $@
