# Langer: from a bare Debian 12 to results.
#   make                      set up, build, run pipelines/indentation.yaml
#   make test                 set up, build, run every test
#   make help                 the other targets
PIPELINE ?= pipelines/indentation.yaml
ifneq ($(filter trade pipelines/trade.yaml,$(PIPELINE)),)
$(info $(PIPELINE) is called refinement_study now)
override PIPELINE := refinement_study
endif
# a bare name is one of pipelines/
ifneq ($(wildcard pipelines/$(PIPELINE).yaml),)
override PIPELINE := pipelines/$(PIPELINE).yaml
endif
JOBS     ?= $(shell nproc)
LAUNCH   ?=

# SANITIZE=1 and TRAPS=1 build in folders of their own
build   := build$(if $(SANITIZE),-sanitize)$(if $(TRAPS),-traps)
options := $(if $(SANITIZE),-DLANGER_SANITIZE=ON) $(if $(TRAPS),-DLANGER_TRAPS=ON) $(if $(WERROR),-DLANGER_WERROR=ON) \
  $(if $(CCACHE),-DCCACHE=$(CCACHE))
run      = runs/$(basename $(notdir $(PIPELINE)))
programs := $(patsubst langer-langer,langer,$(patsubst stages/%.cpp,langer-%,$(wildcard stages/*.cpp)))
packages := g++ cmake ninja-build git libeigen3-dev libfmt-dev libcli11-dev libyaml-cpp-dev libhdf5-dev libgmsh-dev \
  libsuitesparse-dev libsundials-dev libpetsc-real-dev libmetis-dev libopenblas-pthread-dev libnlopt-cxx-dev libboost-dev libmuparser-dev pkg-config doctest-dev nlohmann-json3-dev gnuplot-nox libjs-three libcpp-httplib-dev

.NOTPARALLEL:
.PHONY: all deps configure build planned plan work run explain times test test-fast slow-tests clang format tidy coverage soak relations fuzz mutants mutants-listed reliability bench bench-features bench-forecasts bench-wide bench-pipeline bench-candidates bench-peers extremes ladder work-precision trade accuracy accuracy-elsewhere accuracy-random contact-discretisations adaptive estimates paper gallery packaged install deb bundle wheel test-package test-bundle map schemas site clean help
all: run

# As root, or with a sudo that asks nothing, missing packages are installed; otherwise the line to type is printed.
# Without dpkg the packages go by other names: then CMake says what it misses.
deps:
	@command -v dpkg-query >/dev/null || exit 0; \
	installed=$$(dpkg-query -W -f '$${Package}=$${Status}\n' $(packages) 2>/dev/null); \
	missing=; \
	for p in $(packages); do \
	  echo "$$installed" | grep -qx "$$p=install ok installed" || missing="$$missing $$p"; \
	done; \
	[ -z "$$missing" ] && exit 0; \
	install="apt-get install -y --no-install-recommends$$missing"; \
	if [ "$$(id -u)" = 0 ]; then sudo=; \
	elif sudo -n true 2>/dev/null; then sudo="sudo -n"; \
	else echo "missing packages; please run:"; echo "  sudo $$install"; exit 1; fi; \
	echo "installing:$$missing"; \
	$$sudo apt-get update -qq && $$sudo env DEBIAN_FRONTEND=noninteractive $$install

configure: deps
	@[ -f $(build)/CMakeCache.txt ] || cmake -S . -B $(build) -G Ninja -DCMAKE_BUILD_TYPE=Release $(options)

build: configure
	@cmake --build $(build) --parallel $(JOBS) --target $(programs) schemas

# what went wrong is said last, and by us: a recipe that fails would leave the last word to make
stopped = $(if $(shell cat $(build)/stopped 2>/dev/null),$(error $(1))):
planned: build
	@rm -f $(build)/stopped
	+@$(build)/bin/langer-plan $(PIPELINE) -o $(run) || echo planned > $(build)/stopped
plan: planned
	@$(call stopped,$(PIPELINE) is not right: see above; nothing was written)

work: planned
	@[ -e $(build)/stopped ] || $(MAKE) --no-print-directory -C $(run) $(if $(filter -j%,$(MAKEFLAGS)),,-j$(JOBS)) || \
	  { $(build)/bin/langer times --failed $(run) >&2; echo run > $(build)/stopped; }
run: work
	@$(call stopped,$(PIPELINE) stopped as said above; what is made stays and make goes on from there)
	@[ ! -f $(run)/report/report.html ] || \
	  echo "the report: $(run)/report/report.html (xdg-open $(run)/report/report.html shows it in a browser)"

# why a step would run again; what each took
explain: plan
	@$(build)/bin/langer explain $(run)
times:
	@$(build)/bin/langer times $(run)

test: configure
	@cmake --build $(build) --parallel $(JOBS)
	@ASAN_OPTIONS=allocator_may_return_null=1 LSAN_OPTIONS=suppressions=$(CURDIR)/tests/support/leaks.txt:print_suppressions=0 \
	  ctest --test-dir $(build) --output-on-failure -j2

# those that take less than 0.8 s each, a minute of CPU in all; the tests' programs have to be built all the same
test-fast: configure
	@cmake --build $(build) --parallel $(JOBS)
	@ctest --test-dir $(build) --output-on-failure -j$(JOBS) -L fast

# after `make test` on a quiet machine: which tests are not fast, from what they took
slow-tests:
	@{ head -1 tests/slow.txt; awk '/^---/ { exit } $$NF >= 0.8 { sub(/ [0-9]+ [0-9.e+-]+$$/, ""); print }' \
	  $(build)/Testing/Temporary/CTestCostData.txt | LC_ALL=C sort; } > $(build)/slow.txt && cp $(build)/slow.txt tests/slow.txt

# everything by clang (Debian 12 has 14), in build-clang, warnings as errors
clang:
	@$(MAKE) --no-print-directory deps packages="$(packages) clang libomp-dev"
	@[ -f build-clang/CMakeCache.txt ] || cmake --preset clang -DLANGER_WERROR=ON > /dev/null
	@cmake --build build-clang --parallel $(JOBS)

# kill -9 at random times in every program; KILLS and SEED may be given
KILLS ?= 200
SEED  ?= 1
soak: configure
	@cmake --build $(build) --parallel $(JOBS) --target $(programs) langer-soak
	@$(build)/bin/langer-soak . $(build)/bin $(build)/soak --kills $(KILLS) --seed $(SEED) --pages all --table $(build)/soak.md

# random scenes and their twins (tests/relations): SCENES of them from number FROM on, drawn by SEED
relations: SCENES ?= 500
relations: FROM ?= 0
relations: configure
	@cmake --build $(build) --parallel $(JOBS) --target langer-solve langer-relations
	@$(build)/tests/langer-relations $(build)/bin/langer-solve $(build)/relations --scenes $(SCENES) --from $(FROM) --seed $(SEED)

# every reader under libFuzzer, ASan and UBSan, for FUZZ_SECONDS each; needs clang and libclang-rt-dev
FUZZ_SECONDS ?= 60
FUZZ_TARGETS ?= yaml csv mesh hdf5 pipeline inp msh gmsh_answer stl scene layers edit served
fuzz:
	@command -v clang++ >/dev/null || { echo "make fuzz needs clang and libclang-rt-dev"; exit 1; }
	@[ -f build-fuzz/CMakeCache.txt ] || cmake -S tests/fuzz -B build-fuzz -G Ninja -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++
	@cmake --build build-fuzz --parallel $(JOBS)
	@tests/fuzz/run build-fuzz $(FUZZ_SECONDS) $(FUZZ_TARGETS)

# mutation tests. One operator, number or statement of the mechanics is changed at a time, by an environment variable in one build of a
# copy of the tree, build-mutants/tree; the table is build-mutants/operators.md. LIMIT=500: so many of all; FILES='mechanics/contact/*.cpp':
# of these sources; ONLY='*adhesion.cpp:*': at these places; AGAIN=1 PROGRAMS=fit,laws LONGEST=20: those without a test by other tests
mutants: configure
	@tests/mutants/operators.py --jobs $(JOBS) $(if $(FILES),--files '$(FILES)') $(if $(ONLY),--only '$(ONLY)') $(if $(LIMIT),--limit $(LIMIT)) $(if $(AGAIN),--again) $(if $(PROGRAMS),--programs '$(PROGRAMS)') $(if $(LONGEST),--longest $(LONGEST))
# the changes of tests/mutants/list.txt, each with what it means; each is compiled. KEEP=1 continues what an earlier run left; CHECK=1 asks
# only whether they fit the sources
mutants-listed: deps
	@tests/mutants/run.py --jobs $(JOBS) $(if $(ONLY),--only '$(ONLY)') $(if $(KEEP),--keep) $(if $(CHECK),--check)

# the style of .clang-format; what clang-tidy finds (.clang-tidy); lines that the tests reach
sources = $(shell git ls-files '*.cpp' '*.hpp')
format:
	@$(MAKE) --no-print-directory deps packages=clang-format
	@clang-format -i $(sources)
tidy: configure
	@$(MAKE) --no-print-directory deps packages="clang-tidy libomp-dev"
	@printf '%s\n' $(filter lib/%.cpp stages/%.cpp,$(sources)) | xargs -P $(JOBS) -n 4 clang-tidy -p $(build) --quiet
coverage:
	@$(MAKE) --no-print-directory deps packages="$(packages) gcovr"
	@cmake --preset coverage > /dev/null && cmake --build build-coverage --parallel $(JOBS)
	@ctest --test-dir build-coverage -j$(JOBS) --output-on-failure; gcovr --root . --filter lib/ --filter stages/ --html-details build-coverage/coverage.html --print-summary build-coverage

bench: configure
	@cmake --build $(build) --parallel $(JOBS) --target langer-bench
	@$(build)/bin/langer-bench
	@if command -v valgrind > /dev/null; then $(MAKE) --no-print-directory bench-features; \
	else echo "not counted: what each feature costs; make bench-features installs valgrind for that"; fi

# CPU seconds of each stage of the pipeline; OTHER=<folder>: programs of another build beside it
bench-pipeline: build
	@tests/bench/pipeline.py $(PIPELINE) $(OTHER) $(build)/bin

# what candidates cost that the indenter does not reach
bench-candidates: configure
	@cmake --build $(build) --parallel $(JOBS) --target langer-bench
	@$(build)/bin/langer-bench candidates

# programs, man pages, completion, configs; PREFIX and DESTDIR as usual. LANGER_NATIVE is off: the programs may go to another machine
PREFIX ?= /usr/local
package := build-package
version := $(shell awk '/^project/ { print $$3 }' CMakeLists.txt)
packaged: deps
	@$(MAKE) --no-print-directory deps packages=help2man || echo "without help2man there will be no man pages"
	@cmake -S . -B $(package) -G Ninja -DCMAKE_BUILD_TYPE=Release -DLANGER_NATIVE=OFF -DLANGER_TESTS=OFF > $(package).log || { cat $(package).log; exit 1; }
	@mv $(package).log $(package)/configured.log
	@cmake --build $(package) --parallel $(JOBS)
install: packaged
	@DESTDIR=$(DESTDIR) cmake --install $(package) --prefix $(PREFIX) > /dev/null
	@echo "installed in $(DESTDIR)$(PREFIX)"
# a Debian package; a tar with all its libraries for any Linux of its time (GMSH=1: with gmsh, too); both tried out
deb: packaged
	@$(MAKE) --no-print-directory deps packages=dpkg-dev
	@rm -rf $(package)/deb $(package)/*.deb && DESTDIR=$(CURDIR)/$(package)/deb cmake --install $(package) --prefix /usr > /dev/null
	@share/package/deb $(package)/deb $(version) $(package)
bundle: packaged
	@rm -rf $(package)/bundle && cmake --install $(package) --prefix $(CURDIR)/$(package)/bundle > /dev/null
	@GMSH=$(GMSH) share/package/bundle $(package)/bundle $(version) $(package)
# what pip installs: the same programs and libraries, and the Python package
wheel: bundle
	@SOURCE_DATE_EPOCH=$$(git log -1 --format=%ct) share/package/wheel $(package)/bundle $(version) $$(cat $(package)/glibc) $(package)
test-package: deb bundle
	@cmake -DROOT=$(CURDIR) -DPACKAGE=$(CURDIR)/$(package) -DWORK=$(CURDIR)/$(package)/test -P tests/stages/package.cmake
# the tar in a bare system of another release, which debootstrap makes: as root
SUITE ?= trixie
test-bundle: bundle
	@$(MAKE) --no-print-directory deps packages=debootstrap
	@tests/support/bare_system.sh $(SUITE) $(package)/langer-$(version)-linux-*.tar.gz

# docs/ and what the programs say of themselves as a site with a search: build-site/site/VERSION. Folders of earlier versions stay there,
# and the site has a menu of them
site: build
	@$(MAKE) --no-print-directory deps packages="mkdocs-material libjs-katex"
	@python3 share/site/prepare.py . build-site/pages $(build)/bin/langer
	@mkdocs build -q -f share/site/mkdocs.yml -d $(CURDIR)/build-site/site/$(version) && python3 share/site/versions.py build-site/site
	@echo "site: build-site/site; its search needs a server: python3 -m http.server -d build-site/site"

# the line in each config that names its schema, by which editors find it; `make build` writes the schemas to configs/schema
schemas: build
	@for kind in $$($(build)/bin/langer schema --list); do \
	  case $$kind in pipeline) files=pipelines/*.yaml; folder=../configs/schema;; *) files=configs/$$kind/*.yaml; folder=../schema;; esac; \
	  for file in $$files; do \
	    [ -e $$file ] || continue; \
	    grep -q '^# yaml-language-server: ' $$file || sed -i "1i # yaml-language-server: \$$schema=$$folder/$$kind.schema.json" $$file; \
	  done; \
	done

# measurements that write tables and pictures of docs/
include docs/measure.mk

clean:
	rm -rf $(build)

help:
	@echo "make                          set up, build, run $(PIPELINE)"
	@echo "make build                    set up and build the programs in $(build)/bin"
	@echo "make PIPELINE=twist           set up, build, run pipelines/twist.yaml"
	@echo "make plan PIPELINE=file       check a pipeline; write its configs and Makefile to $(run)"
	@echo "make run  PIPELINE=file       ... and run what is new or changed"
	@echo "         JOBS=4               steps at the same time"
	@echo "         LAUNCH=\"srun -n1\"    put before every command"
	@echo "         STRICT=1             rebuilt programs make their results again"
	@echo "         VERBOSE=1            show the commands, and everything that programs say (-v)"
	@echo "make explain PIPELINE=file    say why each step would run; make times: what each took, which failed"
	@echo "make test                     set up, build, run every test"
	@echo "         SANITIZE=1           ... with ASan and UBSan, in build-sanitize"
	@echo "         TRAPS=1              ... stopping at the first NaN or overflow, in build-traps"
	@echo "         WERROR=1             ... where warnings are errors (in a new build folder)"
	@echo "make test-fast                the tests labelled fast, a minute of CPU; make slow-tests: write tests/slow.txt again"
	@echo "make clang                    build everything with clang, in build-clang"
	@echo "make format                   the style of .clang-format in every source; make tidy: what clang-tidy finds"
	@echo "make coverage                 lines that the tests reach, build-coverage/coverage.html (installs gcovr)"
	@echo "make soak                     kill -9 at random times, KILLS=200; pages of unfinished files zero"
	@echo "make relations                random scenes against their turned, rescaled, unreduced, ... twins; SCENES=500 SEED=1 FROM=0"
	@echo "make fuzz                     every reader under libFuzzer, FUZZ_SECONDS=60 each"
	@echo "make mutants                  mutation tests: one operator of the mechanics changed at a time, which a test must notice; LIMIT=500 FILES= ONLY="
	@echo "make mutants-listed           the same for the changes of tests/mutants/list.txt; ONLY='contact.*' KEEP=1 CHECK=1"
	@echo "make bench                    time the solver"
	@echo "make bench-features           what each feature costs in instructions (installs valgrind), docs/feature_cost.md from it; part of make bench"
	@echo "make bench-forecasts          what --dry-run forecasts and the time taken, docs/solver_cost.md from it"
	@echo "make bench-pipeline           CPU seconds of each stage of the pipeline; OTHER=<folder of programs>: beside another build"
	@echo "make bench-candidates         the same indentation with sets of candidates of growing radius"
	@echo "make bench-wide               contact over 100 to 5 041 candidates, docs/solver_cost.md from it"
	@echo "make bench-peers              the same scene by CalculiX, GetFEM, FEniCSx (installs them): error against CPU seconds, docs/peers.md"
	@echo "make paper                    every figure and table of the paper, beside the published ones in docs/paper.md"
	@echo "make extremes                 run the extreme cases, write their table into docs/tested.md"
	@echo "make work-precision           error against cost of a refinement study, docs/work_precision.md from it"
	@echo "make estimates                estimated errors against true ones, in the scenes of make work-precision"
	@echo "make accuracy                 whether accuracy: 1% holds on random scenes"
	@echo "make accuracy-elsewhere       and on scenes unlike those of the refinement study"
	@echo "make accuracy-random          and on scenes of 26 kinds drawn at random; SEED=83 SCENES=120 ASKED=3 (percent)"
	@echo "make contact-discretisations  what error contact with friction has at nodes, in averages, at Gauss points"
	@echo "make adaptive                 cells cut where the error comes from against even and graded ones: error over CPU seconds"
	@echo "make install                  build for any machine of this kind and install; PREFIX=$(PREFIX) DESTDIR="
	@echo "make deb                      the same as a Debian package; make bundle: as a tar with its libraries, for any Linux; GMSH=1; make wheel: for pip"
	@echo "make test-package             both, and whether they hold what they should and run; make test-bundle SUITE=trixie: in a bare system"
	@echo "make measure                  list the command behind each table of measured numbers in docs/"
	@echo "make map                      draw the wings of lib and their includes, docs/map.svg (installs graphviz)"
	@echo "make site                     docs, gallery, columns and keys as pages with a search (installs mkdocs-material)"
	@echo "make gallery                  run the pipelines, write their pictures, costs and errors into docs/ for the site (installs python3-pil)"
	@echo "make schemas                  name its schema in the first line of each new config, for editors"
	@echo "make clean                    remove $(build); results in runs/ stay"
