# `make` alone lists the targets. ARGS='...' is handed on to the program that a target runs.
#
# What it needs: Linux, make, and a Python of 3.11 or later with venv. It builds .venv beside this file and changes
# nothing else. Where ROS 2 Jazzy is sourced, that is used; everywhere else Jazzy comes as wheels.

SHELL := /bin/bash
VENV := .venv
BIN := $(VENV)/bin

# ROS counts as sourced where its own Python imports it; a ROS_DISTRO left behind alone does not.
SOURCED := $(shell [ "$$ROS_DISTRO" = jazzy ] && python3 -c 'import rclpy' 2>/dev/null && echo yes)

ifeq ($(SOURCED),yes)
  PYTHON ?= python3
  EXTRAS := viewer,class
  VENV_OPTIONS := --system-site-packages
  STAMP := $(VENV)/.made-for-sourced-jazzy
else
  # The first that is recent enough and can make environments (Debian splits ensurepip off into python3-venv).
  PYTHON ?= $(shell for name in python3.13 python3.12 python3.11 python3; do \
	    $$name -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
	      && echo $$name && break; \
	  done)
  EXTRAS := jazzy,class
  STAMP := $(VENV)/.made-of-wheels
  # The wheels put their libraries onto LD_LIBRARY_PATH in random order, so those of another ROS could win, and the
  # mark that they have done so is inherited from other environments. They have Fast DDS and no other middleware.
  unexport LD_LIBRARY_PATH PYTHONPATH AMENT_PREFIX_PATH COLCON_PREFIX_PATH RMW_IMPLEMENTATION
  unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE
endif

# The core of the engine.
CORE := $(wildcard physsim_ros/engine/core/*.[ch])
BUILT := $(VENV)/.core-is-built
# Python writes into it when the core is first loaded: the folder of the core would then look changed.
CACHE := physsim_ros/engine/core/__pycache__
# What the tests and tools need beside it.
TOOLS := $(VENV)/.with-tools
# Of the C library, which clang-tidy wants and a machine without a compiler has not.
HEADER := /usr/include/stdlib.h
CHECKED := $(CORE) $(wildcard tools/sanitize/*.c test/engine/core/*.[ch])
# When clang-tidy found nothing in a file.
TIDY := $(patsubst %,$(VENV)/.tidy/%,$(filter %.c,$(CHECKED)))
# How it is compiled where only mistakes are looked for.
STRICT := -std=c11 -Wall -Wextra -Wconversion -Werror -Iphyssim_ros/engine/core -DCORE_SOURCES='""'

# TypeScript's checker, for the types in the comments of the page.
TSC := npx --yes --package=typescript -- tsc

.DEFAULT_GOAL := help
.PHONY: help run class test test-all lint tables sanitize coverage mutate bench ablate evaluate gallery docs links release soak clean

# The comments after `##` are the help.
help:  ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-9s %s\n", $$1, $$2 }' Makefile
	@echo "ARGS='...' is handed on, as in: make run ARGS='-p world_file:=car', make test ARGS=test/laws"

run: $(BUILT)  ## start the demo world and print the address of its page
	@echo 'The world starts. Ctrl-C ends it. Where to look:'
	@echo '  the page  draw with pen, mouse and fingers, at the address below'
	@echo '  Rerun     opens by itself where there is a display, else by the button Rerun of the page'
	@echo '  RViz      rviz2 -d config/physsim.rviz'
	@echo '  Foxglove  layout config/foxglove.json'
	@echo '  ros2      topics and services under /physsim'
	@exec $(BIN)/physsim --ros-args -p world_file:=demo -p sketchpad:=serve $(ARGS)

# Pupils of a class, and the address at which they reach it.
PUPILS ?= 20
ADDRESS ?= 0.0.0.0

class: $(BUILT)  ## start a world for each of PUPILS=20 pupils, open to the network
	@exec $(BIN)/physsim_class --pupils $(PUPILS) --address $(ADDRESS) --ros-args -p world_file:=free_fall -p speed:=0.0 $(ARGS)

# A worker that a test takes down is replaced, but not without end.
PYTEST := $(BIN)/python -m pytest --numprocesses=auto --maxprocesses=8 --dist=worksteal --max-worker-restart=4

test: $(TOOLS)  ## run all tests but the slow ones: four minutes
	$(PYTEST) -m 'not slow' $(ARGS)

test-all: $(TOOLS)  ## run every test: a quarter of an hour
	$(PYTEST) $(ARGS)

# Side by side; ament's checks take a minute the first time, then look only at files that have changed.
LINTS := lint-ruff lint-mypy lint-imports lint-style lint-core lint-page
.PHONY: $(LINTS)
lint: $(TOOLS)  ## check style, types, imports, links of documents and the core in C
	@$(MAKE) --no-print-directory --jobs=4 --output-sync --keep-going $(LINTS)
lint-ruff:
	$(BIN)/ruff check
	$(BIN)/ruff format --check
lint-mypy:
	$(BIN)/mypy physsim_ros
lint-imports:
	$(BIN)/lint-imports
lint-style:
	$(BIN)/python -m pytest -q -n0 test/style
lint-core:
	@if [ -x $(BIN)/clang-format ]; then $(BIN)/clang-format --dry-run --Werror $(CHECKED); \
	else echo 'clang-format is not installed: the layout of the core is not checked.'; fi
	@if [ ! -x $(BIN)/clang-tidy ]; then echo 'clang-tidy is not installed: the core is not checked by it.'; \
	elif [ ! -e $(HEADER) ]; then echo 'There is no $(HEADER): clang-tidy does not check the core.'; \
	else $(MAKE) --no-print-directory --keep-going $(TIDY); fi
	@if command -v gcc >/dev/null; then gcc -fsyntax-only -O2 $(STRICT) $(filter %.c,$(CHECKED)); \
	else echo 'gcc is not installed: the core is not checked for what it warns of.'; fi
# clang-tidy takes seconds a file: it looks at those that have changed, and at all where a header has.
$(TIDY): $(VENV)/.tidy/%: % $(filter %.h,$(CHECKED)) .clang-tidy
	$(BIN)/clang-tidy --quiet $< -- $(STRICT)
	@mkdir -p $(@D) && touch $@
lint-page:
	@if $(TSC) --version >/dev/null 2>&1; then $(TSC) -p physsim_ros/sketchpad/page; \
	else echo 'Node or TypeScript is not there: the types of the page are not checked.'; fi

tables: $(BUILT)  ## write anew what docs/ and config/ repeat from the code
	$(BIN)/python -m tools.tables

# With AddressSanitizer and UndefinedBehaviorSanitizer. HISTORIES=200 unless it is given; ARGS chooses other tests.
sanitize: $(TOOLS)  ## run laws and random histories with memory checks in the core
	$(BIN)/python -m tools.sanitize $(ARGS)

# Of the tests of `make test`, unless ARGS names others.
coverage: $(TOOLS)  ## count the lines of Python and C that the tests run
	$(BIN)/python -m tools.coverage $(ARGS)

# With SEED=0 and COUNT=40 unless they are given; ONLY=10:20 tries a part of them, ARGS='engine/core/floor' files whose
# path begins so.
mutate: $(TOOLS)  ## change forty constants and operators at random; tell which of them no test notices
	$(BIN)/python -m tools.mutate $(ARGS)

bench: $(TOOLS)  ## measure what steps, frames, robots and pages cost
	$(BIN)/python -m tools.bench $(ARGS)

ablate: $(TOOLS)  ## show what goes wrong without each stage of a step, and its cost
	$(BIN)/python -m tools.ablation $(ARGS)

evaluate: $(TOOLS)  ## count how many drawn strokes are read correctly
	$(BIN)/python -m tools.evaluation $(ARGS)

# Draws the pictures of README and docs anew; needs a Vulkan driver (Debian: mesa-vulkan-drivers libvulkan1).
gallery: $(TOOLS)  ## draw the pictures of README and docs anew
	$(BIN)/python -m tools.gallery $(ARGS)

# The site, from docs/ and the docstrings; any warning, as a link that leads nowhere, fails.
docs: $(VENV)/.with-docs  ## build the site of the documents, docs/_build/html
	@rm -rf docs/api  # pages of modules that are no more
	$(BIN)/python -m sphinx --quiet --fail-on-warning --keep-going -j auto docs docs/_build/html $(ARGS)
	@echo 'Open docs/_build/html/index.html'

# Sphinx's linkcheck; where this machine reaches no other site, nothing is asked.
links: $(VENV)/.with-docs  ## ask whether the addresses in the documents still answer
	@if $(BIN)/python -c 'import socket; socket.create_connection(("www.ros.org", 443), 10)' 2>/dev/null; \
	then $(BIN)/python -m sphinx --quiet --builder linkcheck docs docs/_build/links $(ARGS); \
	else echo 'www.ros.org does not answer: links to other sites are not checked.'; fi

# With BUMP=patch, minor or major, of a new version: of package.xml, setup.py and the changelog, committed and tagged, not
# pushed. Without it nothing but dist/ changes, and the workflow tries that.
release: $(TOOLS) $(VENV)/.with-docs  ## build sdist, wheel and site into dist/; BUMP=minor first raises the version
	@if [ -n '$(BUMP)' ] && grep -q '\.invalid"' package.xml; then \
	  echo 'package.xml has a placeholder in place of the address of the maintainers.' >&2; exit 1; fi
	@[ -z '$(BUMP)' ] || $(BIN)/catkin_prepare_release --bump $(BUMP) --no-push --non-interactive
	@$(MAKE) --no-print-directory docs
	@rm -rf dist
	$(BIN)/python setup.py --quiet sdist
	$(BIN)/python -m twine check --strict dist/*.tar.gz
	$(BIN)/python tools/build/released_wheel.py
	$(BIN)/python -m twine check --strict dist/*.whl
	tar --create --gzip --file dist/site.tar.gz --directory docs/_build html

# MINUTES=30 and SEED=0 unless they are given.
soak: $(TOOLS)  ## disturb a world at random for MINUTES=30, SEED=0, and fail if it suffers
	MINUTES=$(MINUTES) SEED=$(SEED) $(BIN)/python -m tools.adversary

clean:  ## remove .venv and all that was built
	rm -rf $(VENV) physsim_ros/engine/core/*.so physsim_ros/engine/core/_declarations.py build install log dist docs/_build docs/api *.egg-info .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# The lines of pip that say what it does now; what was there already, and from where, is left out.
PROGRESS := sed -u -n -E '/^ *(Collecting|Downloading|Building|Installing|Successfully|ERROR)/ s/^ *(.{1,120}).*/  \1/p'

# Modules are compiled when they are first imported: most never are.
PIP = set -o pipefail; $(BIN)/python -m pip install --disable-pip-version-check --no-compile --use-pep517
# The step is compiled by the machine's compiler; where there is none, by that of a wheel of 101 MB.
COMPILER := $(shell command -v cc gcc clang)

# The stamp is written last, so an interrupted installation starts over; a new setup.py is installed on top.
$(STAMP): setup.py
	@[ -n '$(PYTHON)' ] || { echo 'No Python of 3.11 or later with venv; name one: make PYTHON=/path/to/python' >&2; exit 1; }
	@[ -e $@ ] || echo '1 of 2: an environment in $(VENV), beside this file.'
	@[ -e $@ ] || $(PYTHON) -m venv --clear $(VENV_OPTIONS) $(VENV)
	@echo '2 of 2: packages into it, some 130, of which Rerun is the largest (170 MB); a minute or two the first time.'
	@$(PIP) 'setuptools>=70.1,<80' 'cffi>=1.17' $(if $(COMPILER),,ziglang) | $(PROGRESS)
	@$(PIP) --no-build-isolation --editable '.[$(EXTRAS)]' | $(PROGRESS)
	@mkdir -p $(CACHE) && touch $@ $(BUILT)

# What the package needs to run: the environment, and the core as its sources are now. The folder is newer where one was
# renamed or is no more. pip has just compiled the core where it has made the environment: make does not look again.
$(BUILT): $(CORE) physsim_ros/engine/core | $(STAMP)
	@if [ ! -e $@ ] || [ -n "$$(find $^ -maxdepth 0 -newer $@)" ]; then \
	  $(BIN)/python setup.py --quiet build_ext --inplace && touch $@; fi

$(TOOLS): setup.py | $(BUILT)
	@[ -e $@ ] || echo 'Packages for tests and tools, some 50; a minute the first time.'
	@$(PIP) --no-build-isolation --editable '.[$(EXTRAS),test]' | $(PROGRESS)
	@touch $@

$(VENV)/.with-docs: setup.py | $(BUILT)
	@$(PIP) --quiet --no-build-isolation --editable '.[$(EXTRAS),docs]'
	@touch $@
