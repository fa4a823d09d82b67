# Measurements whose tables and pictures stand in docs/; included by the Makefile, which sets $(build), $(programs), $(packages).

# the command behind each table of measured numbers in docs/; a test asks for it, too
.PHONY: measure
measure:
	@python3 tests/style/tables_are_measured.py .

# both, and their tables into the page
reliability: soak fuzz
	@tests/soak/page docs/tested.md kills $(build)/soak.md
	@tests/soak/page docs/tested.md inputs build-fuzz/fuzz.md

# what each feature costs in instructions, under valgrind, which is installed for it, and the tables of docs/feature_cost.md. A build of
# its own: valgrind knows no AVX-512, and lines (-g1) tell whose code it is. Two minutes beside that
counted := build-features
bench-features:
	@$(MAKE) --no-print-directory deps packages="$(packages) valgrind"
	@[ -f $(counted)/CMakeCache.txt ] || cmake -S . -B $(counted) -G Ninja -DCMAKE_BUILD_TYPE=Release -DLANGER_NATIVE=OFF -DLANGER_TESTS=OFF -DCMAKE_CXX_FLAGS=-g1
	@cmake --build $(counted) --parallel $(JOBS) --target langer-solve
	@tests/bench/features/count $(counted)/bin/langer-solve runs/features
	@tests/soak/page docs/feature_cost.md features runs/features/scenes.md
	@tests/soak/page docs/feature_cost.md unused runs/features/unused.md

# CPU seconds that --dry-run forecasts beside those that it takes, and the table of docs/solver_cost.md; alone on the machine, two minutes
bench-forecasts: build
	@mkdir -p runs/forecasts
	@tests/bench/forecasts $(build)/bin | tee runs/forecasts/table.md
	@tests/soak/page docs/solver_cost.md forecasts runs/forecasts/table.md
	@tests/bench/forecast_pipelines.py $(build)/bin runs/forecasts/pipelines.csv | tee runs/forecasts/pipelines.md
	@tests/soak/page docs/solver_cost.md forecast_pipelines runs/forecasts/pipelines.md

# what contact costs over its candidates, condensed, in the tangent and iteratively, and its table and picture in docs/solver_cost.md; two minutes of CPU
bench-wide: build
	@cmake --build $(build) --parallel $(JOBS) --target langer-bench
	@mkdir -p runs/wide && tests/bench/wide run $(build)/bin runs/wide
	@tests/bench/wide table runs/wide > runs/wide/table.md && tests/soak/page docs/solver_cost.md wide runs/wide/table.md
	@tests/bench/wide picture runs/wide | gnuplot > docs/wide_contact.svg

# the same indentation by CalculiX, GetFEM and FEniCSx, which are installed for it, and by FEBio where febio4 is there; docs/peers.md from it.
# An hour or two. KEEP=1 goes on with what runs/peers/peers.csv has; PEERS_LIMIT: CPU seconds for a run
peer_packages := calculix-ccx python3-getfem python3-dolfinx-real python3-numpy
bench-peers: build
	@$(MAKE) --no-print-directory deps packages="$(peer_packages)"
	@[ -n "$(KEEP)" ] || rm -rf runs/peers
	@/usr/bin/python3 tests/peers/run.py $(build)/bin runs/peers
	@for scene in isotropic positive strip suction hold; do for what in levels runs; do \
	  /usr/bin/python3 tests/peers/table.py $$what runs/peers/peers.csv $$scene > runs/peers/table.md && \
	  tests/soak/page docs/peers.md $${scene}_$$what runs/peers/table.md || exit 1; done; done
	@/usr/bin/python3 tests/peers/table.py picture runs/peers/peers.csv isotropic | gnuplot > docs/peers.svg
	@cat runs/peers/peers.csv

# every figure and table of the paper, and docs/paper.md, which shows them beside the published ones
paper:
	@$(MAKE) --no-print-directory run PIPELINE=pipelines/paper.yaml
	@mkdir -p docs/paper && awk -F'|' '$$1 == "F" { print $$3, "docs/paper/figure_" $$2 ".png" }' docs/paper.csv | \
	  while read -r from to; do cp runs/paper/$$from $$to || exit 1; done
	@! command -v mogrify > /dev/null || mogrify -strip -define png:exclude-chunks=date,time -resize '1200x>' -define png:compression-level=9 -colors 250 docs/paper/*.png  # imagemagick
	@awk -v run=runs/paper -f docs/paper.awk docs/paper.csv > runs/paper/paper.md && cp runs/paper/paper.md docs/paper.md

# the section "Extreme cases" of docs/tested.md from a run of pipelines/extremes.yaml; `ladder` is its former name
extremes ladder:
	@$(MAKE) --no-print-directory run PIPELINE=pipelines/extremes.yaml
	@awk -v run=runs/extremes -f docs/extremes.awk docs/extremes.csv > runs/extremes/cases.md; passed=$$?; \
	awk 'FNR == NR { table = table $$0 "\n"; next } /<!-- extremes:/ { print; printf "\n%s\n", table; skip = 1 } \
	  /<!-- end of extremes/ { skip = 0 } !skip' runs/extremes/cases.md docs/tested.md > runs/extremes/tested.md && \
	cp runs/extremes/tested.md docs/tested.md; exit $$passed

# work-precision diagrams of three indentations, alone on the machine, and docs/work_precision.md from them; about 20 minutes.
# `trade` is its former name
work-precision trade:
	@$(MAKE) --no-print-directory run PIPELINE=pipelines/refinement_study.yaml JOBS=1
	@for scene in isotropic table1 positive; do \
	  awk -v what=front -f docs/work_precision.awk runs/refinement_study/$$scene/levels.csv > runs/refinement_study/front.md && \
	  tests/soak/page docs/work_precision.md $$scene runs/refinement_study/front.md && cp runs/refinement_study/$$scene/error_force.svg docs/work_precision_$$scene.svg || exit 1; done
	@awk -v what=levels -f docs/work_precision.awk $(foreach s,isotropic table1 positive,runs/refinement_study/$(s)/levels.csv) > runs/refinement_study/levels.md
	@tests/soak/page docs/work_precision.md levels runs/refinement_study/levels.md

# does `accuracy: 1%` keep its word on 24 random scenes; are errors as large as their estimates say, on the levels of `make work-precision`
accuracy estimates:
	@$(MAKE) --no-print-directory run PIPELINE=pipelines/$@.yaml
	@awk -v what=$@ -f docs/work_precision.awk $(foreach s,isotropic table1 positive,runs/$@/$(s)_table/table.csv) > runs/$@/table.md
	@tests/soak/page docs/study_estimates.md $@ runs/$@/table.md; tail -2 runs/$@/table.md

# the same in scenes of other kinds than the study's; two minutes
accuracy-elsewhere:
	@$(MAKE) --no-print-directory run PIPELINE=pipelines/accuracy_elsewhere.yaml
	@awk -v what=accuracy -f docs/work_precision.awk runs/accuracy_elsewhere/elsewhere_table/table.csv > runs/accuracy_elsewhere/table.md
	@tests/soak/page docs/study_estimates.md elsewhere runs/accuracy_elsewhere/table.md; tail -2 runs/accuracy_elsewhere/table.md

# cells cut where the error comes from against even and graded ones, in six scenes without friction; six minutes of CPU. ONLY="punch far": those
# again, beside what runs/adaptive has of the others
adaptive: build
	@tests/bench/adaptive.py run $(build)/bin runs/adaptive
	@for what in at runs; do tests/bench/adaptive.py $$what runs/adaptive/adaptive.csv > runs/adaptive/$$what.md && \
	  tests/soak/page docs/study_adaptive.md adaptive_$$what runs/adaptive/$$what.md || exit 1; done
	@tests/bench/adaptive.py picture runs/adaptive/adaptive.csv | gnuplot > docs/work_precision_adaptive.svg

# the wings of lib with their rooms, and the includes between wings: docs/map.svg
map:
	@$(MAKE) --no-print-directory deps packages=graphviz
	@mkdir -p runs && grep -rc '' lib stages --include=*.?pp > runs/map_lines && grep -rHo '^#include "[a-z_0-9/]*/' lib stages > runs/map_includes
	@awk -f docs/map.awk tests/layout.cmake runs/map_lines runs/map_includes | tred | dot -Tsvg > docs/map.svg

# which discretisation of contact with friction is nearest, and what its error is
contact-discretisations:
	@$(MAKE) --no-print-directory deps packages=python3-scipy
	@mkdir -p runs && tests/bench/contact_discretisations.py | tee runs/contact_discretisations.md
	@tests/soak/page docs/study_friction.md contact_discretisations runs/contact_discretisations.md

# accuracy in scenes of 26 kinds, drawn at random: whether what ends with success is within what was asked for, and whether bars hold.
# Another SEED draws others; each scene is left as a config in runs/random. A solve of more than LONGEST seconds of CPU is left. Their counts
# are in docs/study_estimates.md. BARS=default judges the bars that the scenes get without an estimate, against
# the limits of what is asked for
SEED ?= 83
SCENES ?= 120
ASKED ?= 3
LONGEST ?= 12
accuracy-random: configure
	@cmake --build $(build) --parallel $(JOBS) --target langer-random-scenes
	@mkdir -p runs/random
	@$(build)/tests/langer-random-scenes runs/random seed=$(SEED) scenes=$(SCENES) asked=$(ASKED) seconds=$(LONGEST) $(BARS) | tee runs/random/table.md
	@awk '!/^\| [0-9]/ || /fails|utside|OUTSIDE|ended|left/' runs/random/table.md > runs/random/misses.md
	@echo "runs/random/misses.md: what missed something or has no result, and the counts"

# the gallery of the site: every pipeline (those of a study by name, GALLERY=dual) with an estimate of errors where its scene takes one; what it
# took, its errors and a picture go to docs/
GALLERY ?= $(filter-out accuracy accuracy_elsewhere dual estimates extremes paper refinement_study,$(basename $(notdir $(wildcard pipelines/*.yaml))))
gallery: build
	@$(MAKE) --no-print-directory deps packages=python3-pil
	@for one in $(GALLERY); do \
	  for by in dual recovery ""; do \
	    $(build)/bin/langer-plan pipelines/$$one.yaml -o $(build)/gallery/$$one --quiet $${by:+--set solve.estimate=$$by} 2>/dev/null && \
	      $(MAKE) --no-print-directory -C $(build)/gallery/$$one > $(build)/gallery/$$one/said 2>&1 && \
	      { [ -z "$$by" ] || find $(build)/gallery/$$one -name solution.h5 -exec $(build)/bin/langer show --json {} + | grep -q _error_; } && \
	      { echo "$$one $$by"; break; }; \
	  done; \
	done
	@/usr/bin/python3 share/site/gallery.py . $(build)/gallery $(build)/bin/langer
