# make run | test | lint | bench | ablate | evaluate | gallery | soak | clean; ARGS='...' is handed on to the program that a target runs.
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
  EXTRAS := test
  VENV_OPTIONS := --system-site-packages
  STAMP := $(VENV)/.made-for-sourced-jazzy
else
  # The first that is recent enough and can make environments (Debian splits ensurepip off into python3-venv).
  PYTHON ?= $(shell for name in python3.13 python3.12 python3.11 python3; do \
	    $$name -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
	      && echo $$name && break; \
	  done)
  EXTRAS := jazzy,test
  STAMP := $(VENV)/.made-of-wheels
  # The wheels put their libraries onto LD_LIBRARY_PATH in random order, so those of another ROS could win, and the
  # mark that they have done so is inherited from other environments. They have Fast DDS and no other middleware.
  unexport LD_LIBRARY_PATH PYTHONPATH AMENT_PREFIX_PATH COLCON_PREFIX_PATH RMW_IMPLEMENTATION
  unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE
endif

# TypeScript's checker, for the types in the comments of the page.
TSC := npx --yes --package=typescript -- tsc

.PHONY: run test lint bench ablate evaluate gallery soak clean

run: $(STAMP)
	@echo 'Where to look:'
	@echo '  the page  draw with pen and mouse, at the address printed below'
	@echo '  Rerun     opens by itself where there is a display, else at the address printed below'
	@echo '  RViz      fixed frame `world`, add MarkerArray /physsim/markers'
	@echo '  ros2      topics and services under /physsim'
	@echo 'Ctrl-C ends it.'
	@exec $(BIN)/physsim --ros-args -p world_file:=demo -p sketchpad:=serve $(ARGS)

test: $(STAMP)
	$(BIN)/python -m pytest --numprocesses=auto --maxprocesses=8 --dist=worksteal $(ARGS)

lint: $(STAMP)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy physsim_ros
	$(BIN)/lint-imports
	$(BIN)/python -m pytest -q test/style
	@if $(TSC) --version >/dev/null 2>&1; then $(TSC) -p physsim_ros/sketchpad/page; \
	else echo 'The types of the page are not checked: there is no node, or no registry.'; fi

bench: $(STAMP)
	$(BIN)/python -m test.bench $(ARGS)

ablate: $(STAMP)
	$(BIN)/python -m test.ablation $(ARGS)

evaluate: $(STAMP)
	$(BIN)/python -m test.evaluation $(ARGS)

# Draws the pictures of README and docs anew; needs a Vulkan driver (Debian: mesa-vulkan-drivers libvulkan1).
gallery: $(STAMP)
	$(BIN)/python -m test.gallery $(ARGS)

# MINUTES=30 and SEED=0 unless they are given.
soak: $(STAMP)
	MINUTES=$(MINUTES) SEED=$(SEED) $(BIN)/python -m test.adversary $(ARGS)

clean:
	rm -rf $(VENV) build install log dist *.egg-info .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# The stamp is written last, so an interrupted installation starts over; a new setup.py is installed on top.
$(STAMP): setup.py
	@[ -n '$(PYTHON)' ] || { echo 'No Python of 3.11 or later with venv; name one: make PYTHON=/path/to/python' >&2; exit 1; }
	[ -e $@ ] || $(PYTHON) -m venv --clear $(VENV_OPTIONS) $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[$(EXTRAS)]'
	@touch $@
