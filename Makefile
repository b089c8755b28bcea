# RAPLAS: the front door. `make` lists what there is.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help

BUILD ?= build
JOBS ?= $(shell nproc)
SCENE ?= scenes/cornell_teapot.json
PROFILE ?= raplas
SIZE ?= 128
UNIT ?=
# the README's figures are those of the default picture
RENDER_JSON = $(BUILD)/$(if $(filter scenes/cornell_teapot.json-raplas-128,$(SCENE)-$(PROFILE)-$(SIZE)),figures,render)/render.json
PRIM ?= generic
SIM ?= verilator

.PHONY: help setup configure build render model sim test lint netlist prove mutation skip figures trace waves scenes soak exact stress bench clean

help: ## this list
	@echo "RAPLAS: ray tracing by planes and bounding spheres, in VHDL, a golden model, and a host"
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12
	@echo "settings: SCENE=$(SCENE) PROFILE=$(PROFILE) SIZE=$(SIZE) UNIT=fp_add.. PRIM=generic|xc4v SIM=verilator|ghdl"

setup: ## installs the Debian packages that are missing
	@scripts/setup.sh --check 2>/dev/null || scripts/setup.sh

configure: setup
	@[ -f $(BUILD)/build.ninja ] || cmake -S . -B $(BUILD) -G Ninja > /dev/null

build: configure ## the host with the devices reference, model and rtl
	@ninja -C $(BUILD) -j $(JOBS) raplas

render: build ## renders SCENE on all devices and compares them: pictures in build/render
	@mkdir -p $(dir $(RENDER_JSON))
	$(BUILD)/host/raplas compare "$(SCENE)" --profile $(PROFILE) --width $(SIZE) --height $(SIZE) \
	  -o $(BUILD)/render --json $(RENDER_JSON)
	@echo "pictures: $(BUILD)/render/rtl.png model.png reference.png"

model: setup ## builds and tests the golden model and the host without the RTL, with sanitizers
	@cmake -S . -B $(BUILD)/model -G Ninja -DRAPLAS_WITH_RTL=OFF -DRAPLAS_SANITIZE=ON > /dev/null
	@ninja -C $(BUILD)/model -j $(JOBS)
	ctest --test-dir $(BUILD)/model -j $(JOBS) --output-on-failure --no-tests=error -E ConservativeRadius

sim: lint ## the whole regression: lint, model, host, every unit on Verilator and GHDL
	@ninja -C $(BUILD) -j $(JOBS)
	ctest --test-dir "$(BUILD)" -j $(JOBS) --output-on-failure --no-tests=error

test: configure ## only the tests of UNIT
	@[ -n "$(UNIT)" ] || { echo "make test UNIT=fp_add"; exit 2; }
	@ninja -C "$(BUILD)" -j $(JOBS) $(UNIT)
	ctest --test-dir "$(BUILD)" -j $(JOBS) --output-on-failure --no-tests=error -R '^$(UNIT)\.'

lint: build ## formatters, linters and generated files
	@scripts/lint.sh $(BUILD)

netlist: setup ## LUT, FF and DSP48 counts of the units from Yosys (estimates)
	@scripts/netlist.py --check --build $(BUILD)

prove: configure ## the proofs over all inputs, then the largest errors that long campaigns find
	formal/prove.py --build $(BUILD) --jobs $(JOBS)
	@ninja -C $(BUILD) -j $(JOBS) raplas_bounds_test raplas_float_definition_test raplas_host_test
	RAPLAS_CASES=100000000 RAPLAS_FIGURES=$(BUILD)/figures/bounds.json $(BUILD)/cmodel/test/raplas_bounds_test
	RAPLAS_CASES=1000000000 RAPLAS_FIGURES=$(BUILD)/figures/model.json \
	  $(BUILD)/cmodel/test/raplas_float_definition_test
	RAPLAS_CASES=200000000 RAPLAS_FIGURES=$(BUILD)/figures/radius.json $(BUILD)/host/test/raplas_host_test \
	  --gtest_filter='ConservativeRadius.*'

mutation: configure ## mutants of the synthesized netlists that the benches notice: of UNIT, or of all
	formal/mutation.py --check --build $(BUILD) --jobs $(JOBS) $(addprefix --unit ,$(UNIT))

SKIP = $(BUILD)/host/raplas skip
# the bundled and fetched meshes, each on a floor
SKIP_MESHES = scenes/cornell_box.obj scenes/teapot.bpt $(addprefix $(BUILD)/scenes/, bunny_3k.ply bunny_69k.obj \
  dragon_11k.ply dragon_47k.ply dragon_202k.ply dragon_871k.ply)
skip: build scenes ## what profile raplas skips in all scenes, every result compared; tables and heat maps
	@mkdir -p $(BUILD)/figures
	$(SKIP) scenes/cornell.json --name cornell -o $(BUILD)/skip/cornell --json $(BUILD)/figures/skip.cornell.json
	$(SKIP) scenes/cornell_teapot.json --name teapot -o $(BUILD)/skip/teapot --json $(BUILD)/figures/skip.teapot.json
	$(SKIP) $(BUILD)/scenes/bunny_69k.obj --name bunny_floor --rtl 240 -o $(BUILD)/skip/bunny_floor \
	  --json $(BUILD)/figures/skip.bunny_floor.json
	$(SKIP) $(BUILD)/scenes/dragon_871k.ply --name dragon_floor -o $(BUILD)/skip/dragon_floor \
	  --json $(BUILD)/figures/skip.dragon_floor.json
	@for mesh in $(SKIP_MESHES); do name=$$(basename $${mesh%.*} | sed 's/^teapot$$/teapot_1k/'); \
	  $(SKIP) $$mesh --name $$name --width 512 --height 512 -o $(BUILD)/skip/$$name \
	    --json $(BUILD)/figures/skip.$$name.json; done

BENCH_SCENES = scenes/cornell.json scenes/cornell_teapot.json $(BUILD)/scenes/bunny_69k.obj \
  $(BUILD)/scenes/dragon_871k.ply
exact: configure scenes ## the hits of exact devices against double precision, on four scenes
	@ninja -C $(BUILD) -j $(JOBS) exact_hits
	@mkdir -p $(BUILD)/figures
	$(BUILD)/bench/exact_hits --tile 20 $(BENCH_SCENES) --json $(BUILD)/figures/exact.json

bench: configure scenes ## run time against error: formats, plane tests, configurations; build/bench/report.html
	@ninja -C $(BUILD) -j $(JOBS) format_error plane_error configurations
	@mkdir -p $(BUILD)/bench $(BUILD)/figures
	$(BUILD)/bench/format_error $(BENCH_SCENES) --csv $(BUILD)/bench/format_error.csv \
	  --json $(BUILD)/figures/format_error.json
	$(BUILD)/bench/plane_error $(BENCH_SCENES) --json $(BUILD)/figures/plane_error.json
	$(BUILD)/bench/configurations $(BENCH_SCENES) --pictures $(BUILD)/bench/pictures \
	  --json $(BUILD)/figures/configurations.json
	bench/picture_similarity.py --build $(BUILD)
	bench/report.py --build $(BUILD) --require-better-than paper

stress: configure ## a catalogue of numerical traps on reference and model: build/bench/stress.csv; fails if a promise does
	@ninja -C $(BUILD) -j $(JOBS) stress
	@mkdir -p $(BUILD)/bench $(BUILD)/figures
	$(BUILD)/bench/stress --csv $(BUILD)/bench/stress.csv --json $(BUILD)/figures/stress.json

figures: ## makes what is missing and collects build/figures.json and the tables of README and numerics
	@[ -f $(BUILD)/figures/render.json ] || $(MAKE) render
	@[ -f $(BUILD)/figures/netlist.json ] || $(MAKE) netlist
	@[ -f $(BUILD)/figures/stages.fp_add.json ] || $(MAKE) sim
	@[ -f $(BUILD)/figures/proof.json ] && [ -f $(BUILD)/figures/radius.json ] || $(MAKE) prove
	@[ -f $(BUILD)/figures/mutation.json ] || $(MAKE) mutation
	@[ -f $(BUILD)/figures/skip.dragon_871k.json ] || $(MAKE) skip
	@[ -f $(BUILD)/figures/exact.json ] || $(MAKE) exact
	@[ -f $(BUILD)/figures/stress.json ] || $(MAKE) stress
	@scripts/figures.py --build $(BUILD)

trace: configure ## traces of UNIT's bench and of its model, compared: build/traces
	@[ -n "$(UNIT)" ] || { echo "make trace UNIT=fp_add [PRIM=xc4v] [SIM=ghdl]"; exit 2; }
	@ninja -C $(BUILD) -j $(JOBS) $(UNIT).$(PRIM).$(SIM) raplas_trace_compare
	@mkdir -p $(BUILD)/traces
	@$(BUILD)/tb/$(UNIT).$(PRIM).$(SIM) --trace $(BUILD)/traces/$(UNIT).rtl.trace \
	  --trace-expected $(BUILD)/traces/$(UNIT).model.trace > $(BUILD)/traces/$(UNIT).log || \
	  echo "the bench failed: $(BUILD)/traces/$(UNIT).log"
	$(BUILD)/tb/raplas_trace_compare $(BUILD)/traces/$(UNIT).model.trace $(BUILD)/traces/$(UNIT).rtl.trace
	@tail -n 1 $(BUILD)/traces/$(UNIT).log | grep -q checked
	@! grep -q FAILED $(BUILD)/traces/$(UNIT).log

waves: configure ## all signals of UNIT's bench for GTKWave: build/waves/UNIT.ghw
	@[ -n "$(UNIT)" ] || { echo "make waves UNIT=selector [PRIM=xc4v]"; exit 2; }
	@ninja -C $(BUILD) -j $(JOBS) $(UNIT).$(PRIM).ghdl
	@mkdir -p $(BUILD)/waves
	@$(BUILD)/tb/$(UNIT).$(PRIM).ghdl --waves $(BUILD)/waves/$(UNIT).ghw > $(BUILD)/waves/$(UNIT).log || true
	@echo "gtkwave $(BUILD)/waves/$(UNIT).ghw"

scenes: setup ## fetches the Stanford bunny and dragon and a small bunny: build/scenes
	@scripts/fetch_scenes.sh $(BUILD)/scenes

soak: build scenes ## 10^8 single decisions, 100000 random pencils, all broken designs, real meshes on all devices
	@ninja -C $(BUILD) -j $(JOBS) decisions
	@mkdir -p $(BUILD)/figures
	$(BUILD)/bench/decisions --json $(BUILD)/figures/soak.json
	@ninja -C $(BUILD) -j $(JOBS) raplas_unit.generic.verilator
	RAPLAS_CASES=100000 RAPLAS_FIGURES=$(BUILD)/figures/unit_random.json $(BUILD)/tb/raplas_unit.generic.verilator \
	  --gtest_filter='*.FindsTheHitsOfTheDefinition'
	tb/broken/run.py --work $(BUILD)/broken
	@for mesh in bunny_3k bunny_69k dragon_47k; do \
	  $(MAKE) --no-print-directory render SCENE=$$(echo $(BUILD)/scenes/$$mesh.*) PROFILE=raplas SIZE=64; done

clean: ## removes build
	rm -rf $(BUILD)
