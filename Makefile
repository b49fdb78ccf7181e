# The two commands of the README, and the ones that contributors use: `make help` lists them.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/pip --quiet --disable-pip-version-check
# What the installed package is made of: touching any of it makes `make demo` and `make test` build it again.
PACKAGE := $(shell find CMakeLists.txt pyproject.toml LICENSE README.md voxrt voxelize octree export rtl sim view board serve docs/make_man_page.py -type f -not -name '*.pyc' -not -path '*/.*' 2>/dev/null)
INSTALLED := $(VENV)/.installed $(VENV)/.dependencies
CXX_FILES = $(shell find voxelize octree sim web examples tests -name '*.cpp' -o -name '*.h')

.PHONY: help demo configurations test quick assets slow blender blender-test lint lint-scripts lint-workflows hardware boards docs site pages web bench soak sanitize fuzz clean
.DELETE_ON_ERROR:

help:
	@echo "make demo    set up $(VENV), build the example scene and ray-trace its preview"
	@echo "make configurations  build and install every configuration of the simulated ray tracer; make demo builds one"
	@echo "make test    set up $(VENV), run the tests on the installed wheel"
	@echo "make quick   lint Python, run the tests of the folders that changed since the last commit"
	@echo "make assets  list the public files that tests read and that are not here, with their origins"
	@echo "make slow    run the tests that take minutes: the board designs in simulation, every attack on the server"
	@echo "make blender  pack the extension of Blender into build/blender, for the Python $(BLENDER_PYTHON)"
	@echo "make blender-test  test it, and the reader of .blend files, in Blender's module bpy"
	@echo "make lint    ruff, mypy --strict, clang-format, verilator --lint-only -Wall; Biome and tsc; the workflows"
	@echo "make hardware  check the registers, run the cocotb benches and the formal proofs"
	@echo "make boards  build the designs of the boards anew, place and route them, simulate what was placed"
	@echo "make docs    build the manual into build/docs"
	@echo "make site    build the static page into build/site: WebAssembly, for any web server"
	@echo "make pages   the manual with the static page in its folder try, for a web host: build/pages"
	@echo "make web     build the static page, test it in Node and in a browser"
	@echo "make bench   run the benchmarks"
	@echo "make soak MINUTES=15  load and attack the frame server, write bench/results/soak.md"
	@echo "make sanitize  run the native voxelizer and octree under the address, undefined and thread sanitizers"
	@echo "make fuzz      fuzz both under the address and undefined sanitizers, RUNS=1000000 times each"
	@echo "make clean   remove what the others made"

# pip downloads packages while the compiler runs.
SET_UP := @$(MAKE) --jobs=2 --no-print-directory $(VENV)/.dependencies
# One configuration of the ray tracer is enough, where not all are installed already.
demo:
	$(SET_UP) $(if $(wildcard $(VENV)/.installed),$(VENV)/.installed,$(VENV)/.one)
	$(BIN)/voxrt-build examples/courtyard.glb -o demo --preview demo/preview.png

configurations: $(INSTALLED)

# pytest leaves the repository's root off the path, so that the wheel is what is tested; tests/conftest.py checks it.
# Tests of one xdist_group share what one process has compiled.
PYTEST := VOXRT_EXPECT_INSTALLED=1 $(BIN)/pytest --numprocesses=auto --dist=loadgroup
test:
	$(SET_UP) $(VENV)/.installed $(VENV)/.tools
	$(PYTEST)

# Each changed folder has its tests in the folder of the same name in tests/; those of voxrt/ itself are in api and cli.
CHANGED = $(shell { git diff --name-only HEAD; git ls-files --others --exclude-standard; } | sed -nE \
  -e 's#^voxrt/([a-z_]+)/.*#tests/\1 tests/api tests/cli#p; t' -e 's#^voxrt/.*#tests/api tests/cli#p; t' \
  -e 's#^(tests/)?([a-z]+)/.*#tests/\2#p')
quick: $(INSTALLED) $(VENV)/.tools
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(PYTEST) tests/test_*.py $(wildcard $(sort $(CHANGED)))

assets:
	@$(PYTHON) tests/list_assets.py

slow: $(INSTALLED) $(VENV)/.tools
	VOXRT_EXPECT_INSTALLED=1 $(BIN)/pytest -m slow

# In an environment of its own: bpy has wheels for one version of Python alone, and 430 MB.
BLENDER_PYTHON ?= python3.13
BLENDER_MAKE := $(MAKE) --no-print-directory VENV=.venv-blender PYTHON=$(BLENDER_PYTHON)
blender:
	$(BLENDER_MAKE) .venv-blender/.blender .venv-blender/.installed
	.venv-blender/bin/python -P blender/make_extension.py build/wheel/*.whl

blender-test:
	$(BLENDER_MAKE) .venv-blender/.blender $(if $(wildcard .venv-blender/.installed),.venv-blender/.installed,.venv-blender/.one)
	VOXRT_EXPECT_INSTALLED=1 .venv-blender/bin/pytest tests/blender

lint: $(INSTALLED) $(VENV)/.tools lint-workflows lint-scripts
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/mypy blender
	$(BIN)/clang-format --dry-run --Werror $(CXX_FILES)
	$(BIN)/python rtl/lint.py

# The JavaScript of both pages and of the npm package.
ifneq ($(shell command -v npm),)
lint-scripts: web/node_modules/.package-lock.json
	web/node_modules/.bin/biome ci --error-on-warnings --colors=off
	web/node_modules/.bin/tsc -p web
else
lint-scripts:
	@echo "the JavaScript is not checked: npm is not here"
endif

web/node_modules/.package-lock.json: web/package.json web/package-lock.json
	npm ci --prefix web --no-audit --no-fund
	@touch $@

# The workflows, forms and texts of .github. actionlint checks the shell scripts in them by shellcheck.
WORKFLOW_FILES := .github .pre-commit-config.yaml .yamllint
lint-workflows: $(VENV)/.tools $(VENV)/.actionlint
	$(BIN)/yamllint --strict $(WORKFLOW_FILES)
	$(BIN)/codespell $(WORKFLOW_FILES) SECURITY.md
	$(BIN)/shellcheck .ci/* .github/*.sh
	$(BIN)/check-jsonschema --quiet --builtin-schema vendor.github-workflows .github/workflows/*.yml
	$(BIN)/check-jsonschema --quiet --builtin-schema vendor.github-actions .github/*/action.yml
	$(BIN)/check-jsonschema --quiet --builtin-schema vendor.dependabot .github/dependabot.yml
	$(BIN)/check-jsonschema --quiet --builtin-schema vendor.github-issue-config .github/ISSUE_TEMPLATE/config.yml
	$(BIN)/check-jsonschema --quiet --builtin-schema vendor.github-issue-forms \
	  $(filter-out %/config.yml,$(wildcard .github/ISSUE_TEMPLATE/*.yml))
	@if test -x $(BIN)/actionlint; then echo $(BIN)/actionlint && PATH="$(abspath $(BIN)):$$PATH" actionlint; \
	  else echo "actionlint is left out: it is built by Go, which is not here"; fi

bench: $(INSTALLED)
	$(BIN)/python bench/demo.py

MINUTES ?= 15
soak: $(INSTALLED)
	$(BIN)/python bench/soak.py --minutes $(MINUTES) --write

# The registers as generated, the cocotb benches and what they cover, the formal proofs. BENCHES=--quick leaves out the
# forms of the core that repeat the benches of others.
BENCHES :=
hardware: $(VENV)/.hardware
	PATH="$(abspath $(BIN)):$$PATH" $(BIN)/python rtl/generate.py
	git diff --exit-code -- rtl/generated
	$(BIN)/python rtl/benches/coverage.py $(BENCHES)
	$(BIN)/python rtl/formal/prove.py

# Ten minutes and more per board. BOARDS chooses.
BOARDS := $(patsubst board/designs/%/board.json,%,$(wildcard board/designs/*/board.json))
boards: $(INSTALLED) $(VENV)/.tools $(VENV)/.estimate
	for board in $(BOARDS); do \
	  $(BIN)/python -m voxrt.board.designs.build $$board --netlist && \
	  $(BIN)/python bench/boards.py $$board --rebuilt --write || exit 1; done

docs: $(INSTALLED) $(VENV)/.docs
	$(BIN)/sphinx-build --quiet --fail-on-warning -b html docs build/docs

# It needs npm, which fetches the loaders of three.js and the compiler of TypeScript.
site: $(INSTALLED) $(VENV)/.web web/node_modules/.package-lock.json
	$(BIN)/python web/make_site.py

pages: docs site
	rm -rf build/pages
	cp -r build/docs build/pages
	cp -r build/site build/pages/try

web: site $(VENV)/.tools
	VOXRT_EXPECT_INSTALLED=1 $(BIN)/pytest tests/web

# Without Python, so that the sanitizers see our own code alone. build/sanitize/SANITIZERS/PROGRAM for each of both.
SANITIZERS := address-undefined thread
ROOMS := voxelize octree sim
voxelize_programs := voxelize colour
octree_programs := octree edit mesh_to_ray query_octree
sim_programs := fit bake
SANITIZED = $(foreach room,$(ROOMS),$($(room)_programs))
sanitize: $(foreach program,$(SANITIZED),$(SANITIZERS:%=build/sanitize/%/$(program)))
	for program in $^; do echo $$program && $$program || exit 1; done

comma := ,
# GCC leaves numbers that do not fit their integer out of "undefined".
UNDEFINED := undefined,float-cast-overflow
sanitized = $(CXX) -std=c++20 -O1 -g -Wall -Wextra -fno-sanitize-recover=all -fsanitize=$(subst undefined,$(UNDEFINED),$(subst -,$(comma),$*)) -I$(CURDIR)/build/sanitize/include
HEADERS := $(wildcard voxelize/src/*/*.h octree/src/*/*.h sim/src/*/*/*.h)
# Sources for certain instructions have their own flags, and stay away from other processors.
AVX2 := -Wno-psabi -mavx2 -mfma
AVX512 := -Wno-psabi -mavx512f -mavx512dq -mavx512vl
OTHERS := $(if $(filter x86_64,$(shell uname -m)),,%_avx2.cpp %_avx512.cpp)
# $(call sources,FOLDER): what a folder has besides its bindings for Python.
sources = $(filter-out %/module.cpp %_bindings.cpp $(OTHERS),$(wildcard $(1)/src/*/*.cpp))
# $(call compile,SOURCES,FLAGS)
compile = $(if $(1),cd $(@:.a=) && $(sanitized) $(2) -c $(abspath $(1)))
# $(call archive,SOURCES): their library.
define archive
@rm -rf $(@:.a=) && mkdir -p $(@:.a=)
$(call compile,$(filter-out %_avx2.cpp %_avx512.cpp,$(1)),-Wno-psabi)
$(call compile,$(filter %_avx2.cpp,$(1)),$(AVX2))
$(call compile,$(filter %_avx512.cpp,$(1)),$(AVX512))
$(AR) rcs $@ $(@:.a=)/*.o
endef

# Headers are included as <voxrt/FOLDER/...>, as from CMake.
build/sanitize/include/voxrt:
	@mkdir -p $@
	@ln -sfn $(CURDIR)/voxelize/src $@/voxelize
	@ln -sfn $(CURDIR)/octree/src $@/octree
	@ln -sfn $(CURDIR)/sim/src/model $@/sim
	@ln -sfn $(CURDIR)/sim/src/bake $@/bake

build/sanitize/%/libvoxelize.a: $(call sources,voxelize) $(HEADERS) | build/sanitize/include/voxrt
	$(call archive,$(call sources,voxelize))

build/sanitize/%/liboctree.a: $(call sources,octree) $(HEADERS) | build/sanitize/include/voxrt
	$(call archive,$(call sources,octree))

SIM := $(filter-out %/module.cpp %_bindings.cpp $(OTHERS),$(wildcard sim/src/model/*/*.cpp sim/src/bake/*/*.cpp))
build/sanitize/%/libsim.a: $(SIM) $(HEADERS) | build/sanitize/include/voxrt
	$(call archive,$(SIM))

# $(call program,NAME,SOURCE,LIBRARIES): a program of these libraries.
define program
build/sanitize/%/$(1): $(2) $(3:%=build/sanitize/\%/lib%.a)
	$$(sanitized) -o $$@ $$^ -pthread
endef
$(eval $(call program,fit,tests/sim/native/fit.cpp,sim octree voxelize))
$(eval $(call program,bake,tests/sim/native/bake.cpp,sim octree voxelize))
$(eval $(call program,voxelize,tests/voxelize/native/exercise.cpp,voxelize))
$(eval $(call program,colour,tests/voxelize/native/colour.cpp,voxelize))
$(eval $(call program,octree,tests/octree/native/exercise.cpp,octree voxelize))
$(eval $(call program,edit,tests/octree/native/edit.cpp,octree voxelize))
$(eval $(call program,mesh_to_ray,examples/cpp/mesh_to_ray.cpp,octree voxelize))
$(eval $(call program,query_octree,examples/cpp/query_octree.cpp,octree voxelize))

# The same libraries with calls at every branch, which tell the fuzzer where an input leads. What it finds and keeps is
# in build/fuzz/native/PROGRAM.
RUNS := 1000000
FUZZERS := voxelize octree edit
fuzz: $(FUZZERS:%=build/fuzz/native/%-fuzzer)
	for program in $(FUZZERS); do build/fuzz/native/$$program-fuzzer $(RUNS) build/fuzz/native/$$program || exit 1; done

covered = $(CXX) -std=c++20 -O2 -g -fno-sanitize-recover=all -fsanitize=address,$(UNDEFINED) -I$(CURDIR)/build/sanitize/include
COVERED := $(patsubst %.cpp,build/fuzz/native/objects/%.o,$(call sources,voxelize) $(call sources,octree))
build/fuzz/native/objects/%_portable.o: covered += -Wno-psabi
build/fuzz/native/objects/%_avx2.o: covered += $(AVX2)
build/fuzz/native/objects/%_avx512.o: covered += $(AVX512)
build/fuzz/native/objects/%.o: %.cpp $(HEADERS) | build/sanitize/include/voxrt
	@mkdir -p $(@D)
	$(covered) -fsanitize-coverage=trace-pc -c -o $@ $<

build/fuzz/native/%-fuzzer: tests/fuzz/native/%.cpp tests/fuzz/native/driver.cpp tests/fuzz/native/driver.h $(COVERED)
	$(covered) -Itests/fuzz/native -o $@ $(filter tests/%.cpp,$^) $(COVERED) -pthread

.SECONDARY: $(COVERED) $(foreach library,libvoxelize liboctree libsim,$(SANITIZERS:%=build/sanitize/%/$(library).a))

clean:
	rm -rf $(VENV) .venv-blender build demo web/node_modules

# Without pip's isolation, so that objects that are made stay valid; with ccache where it is, so that other folders of
# the same sources are built quickly too. One job server is enough: make's would give Ninja one core.
export CMAKE_CXX_COMPILER_LAUNCHER ?= $(shell command -v ccache)
$(VENV)/.one: CONFIGURATIONS := tiny
$(VENV)/.installed $(VENV)/.one: $(VENV)/.build $(PACKAGE)
	@echo "building voxrt, its native code and the verilated ray tracer: minutes the first time"
	@rm -rf build/wheel
	@env -u MAKEFLAGS PATH="$(abspath $(BIN)):$$PATH" $(PIP) wheel --no-build-isolation --no-deps --wheel-dir build/wheel \
	  --config-settings=cmake.define.VOXRT_RTL_CONFIGURATIONS=$(CONFIGURATIONS) .
	@$(PIP) install --force-reinstall --no-deps --no-compile build/wheel/*.whl
	@touch $@

$(VENV)/.dependencies: pyproject.toml | $(VENV)/.build
	@$(BIN)/python -c 'import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["dependencies"], sep="\n")' \
	  | $(PIP) install --requirement /dev/stdin
	@touch $@

$(VENV)/.tools: pyproject.toml | $(VENV)/.dependencies
	@$(PIP) install --group dev
	@touch $@

$(VENV)/.blender: pyproject.toml | $(VENV)/.dependencies
	@$(PIP) install --group blender
	@touch $@

# No Python package brings actionlint itself: Go's module proxy has it.
$(VENV)/.actionlint: $(VENV)/.ready Makefile
	@if command -v go >/dev/null; then echo "building actionlint"; \
	  GOBIN=$(abspath $(BIN)) GOFLAGS=-modcacherw go install github.com/rhysd/actionlint/cmd/actionlint@v1.7.12 || \
	  echo "actionlint cannot be built by the Go that is here"; fi
	@touch $@

$(VENV)/.build $(VENV)/.hardware $(VENV)/.estimate $(VENV)/.docs $(VENV)/.web: $(VENV)/.%: $(VENV)/.ready pyproject.toml
	@$(PIP) install --group $*
	@touch $@

$(VENV)/.ready:
	@command -v $(PYTHON) >/dev/null || { echo "voxrt needs Python 3.11 or newer: apt install python3 python3-venv python3-dev" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "voxrt needs Python 3.11 or newer, and $(PYTHON) is $$($(PYTHON) -V): install one and say make PYTHON=/path/to/it" >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { echo "voxrt needs Python's venv module: apt install python3-venv" >&2; exit 1; }
	@$(PYTHON) -c 'import os, sys, sysconfig; sys.exit(not os.path.exists(os.path.join(sysconfig.get_paths()["include"], "Python.h")))' || { echo "voxrt needs Python's headers: apt install python3-dev" >&2; exit 1; }
	@echo 'int main() { return [](auto x) requires true { return x; }(0); }' | $${CXX:-c++} -std=c++20 -x c++ -fsyntax-only - 2>/dev/null || { echo "voxrt needs a C++20 compiler (gcc 11, clang 14 or newer): apt install g++" >&2; exit 1; }
	@echo "setting up $(VENV)"
	@$(PYTHON) -m venv $(VENV)
	@$(PIP) install --upgrade 'pip>=25.1'
	@touch $@
