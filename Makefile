# `make` alone lists the targets. A target hands ARGS='...' on to the program that it runs.
#
# It needs Linux, make, and Python 3.11 or later with venv. It builds .venv beside this file and changes nothing else.
# If ROS 2 Jazzy is sourced, it uses that; otherwise it installs Jazzy as wheels.

SHELL := /bin/bash
VENV := .venv
BIN := $(VENV)/bin

# ROS counts as sourced if the machine's Python imports it. ROS_DISTRO alone may be left over from another shell.
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
# Python makes this folder when the core is first loaded, which changes the time of the folder of the core.
CACHE := physsim_ros/engine/core/__pycache__
# The stamp of the packages that tests and tools need.
TOOLS := $(VENV)/.with-tools
# clang-tidy needs the headers of the C library, which a machine without a compiler may lack.
HEADER := /usr/include/stdlib.h
CHECKED := $(CORE) $(wildcard tools/sanitize/*.c test/engine/core/*.[ch])
# A stamp for each file in which clang-tidy has found nothing.
TIDY := $(patsubst %,$(VENV)/.tidy/%,$(filter %.c,$(CHECKED)))
# The options of compilers that only check the core.
STRICT := -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Wconversion -Werror -Iphyssim_ros/engine/core -DCORE_SOURCES='""'

# TypeScript checks the types that stand in comments of the page's scripts.
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

# The number of pupils of a class, and the address at which they reach it.
PUPILS ?= 20
ADDRESS ?= 0.0.0.0

class: $(BUILT)  ## start a world for each of PUPILS=20 pupils, open to the network
	@exec $(BIN)/physsim_class --pupils $(PUPILS) --address $(ADDRESS) --ros-args -p world_file:=free_fall -p speed:=0.0 $(ARGS)

# pytest replaces a worker that a test has ended, at most four times.
PYTEST := $(BIN)/python -m pytest --numprocesses=auto --maxprocesses=8 --dist=worksteal --max-worker-restart=4

test: $(TOOLS)  ## run all tests but the slow ones
	$(PYTEST) -m 'not slow' $(ARGS)

test-all: $(TOOLS)  ## run every test: a quarter of an hour
	$(PYTEST) $(ARGS)

# The checks run side by side. Those of ament take a minute the first time, and then check only changed files.
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
# clang-tidy takes seconds for a file, so it checks only changed files, and all if a header has changed.
$(TIDY): $(VENV)/.tidy/%: % $(filter %.h,$(CHECKED)) .clang-tidy
	$(BIN)/clang-tidy --quiet $< -- $(STRICT)
	@mkdir -p $(@D) && touch $@
lint-page:
	@if $(TSC) --version >/dev/null 2>&1; then $(TSC) -p physsim_ros/sketchpad/page; \
	else echo 'Node or TypeScript is not there: the types of the page are not checked.'; fi

tables: $(BUILT)  ## write anew what docs/ and config/ repeat from the code
	$(BIN)/python -m tools.tables

# The core is compiled with AddressSanitizer and UndefinedBehaviorSanitizer. HISTORIES is 200 by default; ARGS chooses
# other tests.
sanitize: $(TOOLS)  ## run laws and random histories with memory checks in the core
	$(BIN)/python -m tools.sanitize $(ARGS)

# The tests are those of `make test`, unless ARGS names others.
coverage: $(TOOLS)  ## count the lines of Python and C that the tests run
	$(BIN)/python -m tools.coverage $(ARGS)

# SEED is 0 and COUNT is 40 by default. ONLY=10:20 tries a part of the mutations, and ARGS='engine/core/floor' those of
# files whose path begins so.
mutate: $(TOOLS)  ## change forty constants and operators at random; tell which of them no test notices
	$(BIN)/python -m tools.mutate $(ARGS)

bench: $(TOOLS)  ## measure what steps, frames, robots and pages cost
	$(BIN)/python -m tools.bench $(ARGS)

ablate: $(TOOLS)  ## show which tests fail without each stage of a step, and its cost
	$(BIN)/python -m tools.ablation $(ARGS)

evaluate: $(TOOLS)  ## count how many drawn strokes are read correctly
	$(BIN)/python -m tools.evaluation $(ARGS)

# The gallery needs a Vulkan driver (Debian: mesa-vulkan-drivers libvulkan1).
gallery: $(TOOLS)  ## draw the pictures of README and docs anew
	$(BIN)/python -m tools.gallery $(ARGS)

# Sphinx makes the site from docs/ and the docstrings. Any warning, such as a broken link, fails.
docs: $(VENV)/.with-docs  ## build the site of the documents, docs/_build/html
	@rm -rf docs/api  # pages of modules that are no more
	$(BIN)/python -m sphinx --quiet --fail-on-warning --keep-going -j auto docs docs/_build/html $(ARGS)
	@echo 'Open docs/_build/html/index.html'

# Sphinx's linkcheck runs only if this machine reaches other sites.
links: $(VENV)/.with-docs  ## ask whether the addresses in the documents still answer
	@if $(BIN)/python -c 'import socket; socket.create_connection(("www.ros.org", 443), 10)' 2>/dev/null; \
	then $(BIN)/python -m sphinx --quiet --builder linkcheck docs docs/_build/links $(ARGS); \
	else echo 'www.ros.org does not answer: links to other sites are not checked.'; fi

# BUMP=patch, minor or major raises the version in package.xml, setup.py and the changelog, commits and tags it, and
# pushes nothing. Without BUMP only dist/ changes; the workflow tries that for each change.
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

# MINUTES is 30 and SEED is 0 by default.
soak: $(TOOLS)  ## disturb a world at random for MINUTES=30, SEED=0, and fail if it suffers
	MINUTES=$(MINUTES) SEED=$(SEED) $(BIN)/python -m tools.adversary

clean:  ## remove .venv and all that was built
	rm -rf $(VENV) physsim_ros/engine/core/*.so physsim_ros/engine/core/_declarations.py build install log dist docs/_build docs/api *.egg-info .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# A filter of pip's output: it keeps the lines about progress and errors.
PROGRESS := sed -u -n -E '/^ *(Collecting|Downloading|Building|Installing|Successfully|ERROR)/ s/^ *(.{1,120}).*/  \1/p'

# pip does not compile modules, because most are never imported.
PIP = set -o pipefail; $(BIN)/python -m pip install --disable-pip-version-check --no-compile --use-pep517
# The core is compiled by the machine's compiler, or else by that of a wheel (ziglang, 101 MB).
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

# The package runs in the environment with a core that is compiled from the present sources. The time of the folder tells
# of sources that were renamed or deleted. If pip has just made the environment, it has compiled the core, too.
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
