# The two commands of the README; `make help` lists the rest.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: help demo test lint clean

help:
	@echo "make demo   set up .venv, build the example scene, ray-trace its preview"
	@echo "make test   set up .venv, run the tests on the installed wheel"
	@echo "make lint   ruff, mypy, clang-format, verilator --lint-only"
