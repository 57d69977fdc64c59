# On a fresh Debian 12 with git, python3 and make, `make demo` and `make test` install what they need and run.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help

PYTHON ?= python3
JOBS ?= $(shell nproc)
BUILD_TYPE ?= Release

APT_PACKAGES := g++ cmake ninja-build libopenmesh-dev libeigen3-dev libcgal-dev libmetis-dev doctest-dev \
  python3-venv python3-dev libgl1 libegl1 libgl1-mesa-dri libosmesa6
# A browser, for the tests of interactive pages.
TEST_APT_PACKAGES := chromium chromium-driver
SUDO := $(if $(filter 0,$(shell id -u)),,sudo)

VENV := .venv
BIN := $(VENV)/bin
STAMPS := $(VENV)/build
CPP_BUILD := build/cpp
TIDY_BUILD := build/tidy

PIP_INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check
# Folders too: a file that goes away changes its folder.
PACKAGE_SOURCES := CMakeLists.txt pyproject.toml \
  $(shell find bindings cpp/include cpp/src cpp/*.in python -not -name __pycache__ -not -name '*.pyc')
CPP_FILES := $(shell find cpp bindings tests/cpp -name '*.[ch]pp' -o -name '*.inl')

.PHONY: help
help:  ## show this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):[^#]*## */  make \1\t/' | expand -t 20

.PHONY: demo
demo: $(STAMPS)/installed  ## make both atria with their fibres, pictures, a page and files
	@$(BIN)/pectinate demo --out demo

.PHONY: test
test: test-cpp test-python  ## run all tests

.PHONY: test-cpp
test-cpp: | system  ## build and test the C++ library
	@cmake -S . -B $(CPP_BUILD) -G Ninja -DCMAKE_BUILD_TYPE=$(BUILD_TYPE) -DPECTINATE_BUILD_TESTS=ON
	@cmake --build $(CPP_BUILD) --parallel $(JOBS)
	@ctest --test-dir $(CPP_BUILD) --output-on-failure --parallel $(JOBS)

.PHONY: test-python
test-python: $(STAMPS)/installed  ## test the Python package
	@$(MAKE) --no-print-directory system-test || echo "no browser: the tests that need one will be skipped" >&2
	@$(BIN)/python -m pytest

.PHONY: lint
lint: lint-python lint-cpp  ## run the linters

.PHONY: lint-python
lint-python: $(STAMPS)/lint
	@$(BIN)/ruff check
	@$(BIN)/ruff format --check
	@$(BIN)/mypy

.PHONY: lint-cpp
lint-cpp: $(STAMPS)/lint $(TIDY_BUILD)/compile_commands.json
	@$(BIN)/clang-format --dry-run -Werror $(CPP_FILES)
	@find cpp/src bindings -name '*.cpp' -print0 \
	  | xargs -0 -n 1 -P $(JOBS) $(BIN)/clang-tidy -p $(TIDY_BUILD) --quiet --extra-arg=-fdelayed-template-parsing

.PHONY: format
format: $(STAMPS)/lint  ## format all sources in place
	@$(BIN)/ruff check --fix-only --quiet
	@$(BIN)/ruff format
	@$(BIN)/clang-format -i $(CPP_FILES)

.PHONY: bench
bench: $(STAMPS)/installed  ## measure time, memory and quality
	@$(BIN)/python benchmarks/run.py

.PHONY: pictures
pictures: $(STAMPS)/installed  ## draw the pictures of the documentation anew
	@$(BIN)/python benchmarks/pictures.py

.PHONY: setup
setup: $(STAMPS)/installed  ## install system packages and the Python package into .venv

.PHONY: clean
clean:  ## remove everything that was made
	rm -rf $(VENV) build demo

# Installs the Debian packages that are missing; asks nothing of the network when there are none.
.PHONY: system system-test
system: PACKAGES := $(APT_PACKAGES)
system-test: PACKAGES := $(TEST_APT_PACKAGES)
system system-test:
	@command -v dpkg-query >/dev/null || { echo "not a Debian system: install by hand: $(PACKAGES)"; exit 0; }; \
	missing=; \
	for package in $(PACKAGES); do \
	  [[ "$$(dpkg-query -W -f '$${db:Status-Status}' $$package 2>/dev/null)" == installed ]] || missing+=" $$package"; \
	done; \
	[[ -n "$$missing" ]] || exit 0; \
	echo "installing Debian packages:$$missing"; \
	if [[ -n "$(SUDO)" ]] && ! command -v sudo >/dev/null; then \
	  echo "as root, run: apt-get update && apt-get install$$missing" >&2; exit 1; \
	fi; \
	$(SUDO) apt-get update -qq || echo "apt-get update failed: trying with the lists at hand" >&2; \
	$(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -qq --yes --no-install-recommends $$missing >/dev/null

$(STAMPS)/environment: | system
	@$(PYTHON) -m venv --clear $(VENV)
	@$(PIP_INSTALL) --upgrade pip
	@mkdir -p $(STAMPS)
	@touch $@

$(STAMPS)/requirements: pyproject.toml .ci/requirements $(STAMPS)/environment
	@echo "installing what pectinate needs into $(VENV)"
	@$(BIN)/python .ci/requirements vtk figures tables test >$@.txt
	@$(PIP_INSTALL) -r $@.txt
	@touch $@

# Built without isolation, so that an unchanged source is compiled once only, and without the network.
$(STAMPS)/installed: $(PACKAGE_SOURCES) $(STAMPS)/requirements
	@echo "building pectinate"
	@$(PIP_INSTALL) --no-build-isolation --no-deps .
	@touch $@

$(STAMPS)/lint: pyproject.toml .ci/requirements $(STAMPS)/requirements
	@$(BIN)/python .ci/requirements lint >$@.txt
	@$(PIP_INSTALL) -r $@.txt
	@touch $@

# Only configured: clang-tidy reads how each file would be compiled.
$(TIDY_BUILD)/compile_commands.json: CMakeLists.txt bindings/CMakeLists.txt | $(STAMPS)/requirements
	@cmake -S . -B $(TIDY_BUILD) -G Ninja -DPECTINATE_BUILD_PYTHON=ON -DPECTINATE_BUILD_TESTS=OFF \
	  -DPython_EXECUTABLE=$(abspath $(BIN)/python) -DPYTHON_EXECUTABLE=$(abspath $(BIN)/python) \
	  -Dpybind11_DIR="$$($(BIN)/python -m pybind11 --cmakedir)" >/dev/null
	@touch $@
