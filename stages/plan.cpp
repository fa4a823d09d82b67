// langer-plan: checks everything that a pipeline names, then writes its Makefile and configs.
//   langer-plan pipelines/indentation.yaml -o runs/indentation
// It runs nothing itself; `make -C runs/indentation` does.
#include "pipeline/plan/plan.hpp"

#include "arguments.hpp"
#include "core/base/module_path.hpp"
#include "core/base/say.hpp"
#include "program.hpp"

int main(int argc, char** argv) {
  using namespace langer;
  // langer-plan has no config and no identity, so it does not use the frame of the stages.
  std::string file;
  std::string folder;
  pipeline::Overrides overrides;
  bool quiet = false;
  bool verbose = false;
  bool dry_run = false;
  PlanFor others;
  Arguments options("langer-plan");
  options.text("pipeline", file, true);
  options.text("-o,--output", folder);
  options.texts("--set", overrides.settings);
  options.texts("--sweep", overrides.sweeps);
  options.flag("--dry-run", dry_run);
  options.flag("--slurm", others.slurm);
  options.flag("--snakemake", others.snakemake);
  options.flag("--quiet", quiet);
  options.flag("-v,--verbose", verbose);
  options.version();
  return guarded("langer-plan", [&] {
    int code = 0;
    if (!options.read(plan_usage(), argc, argv, code)) return code;
    const std::string bin = program_folder().string();
    PlanReport report;
    if (dry_run) {
      report = check_pipeline(file, folder, overrides);
    } else {
      report = plan(file, folder, bin, command_line(argc, argv), others, overrides);
    }
    if (verbose) say_line("plan: {}, programs in {}", version_line("langer-plan"), bin);
    for (const std::string& doubt : report.doubts) say_line("plan: warning: {}", doubt);
    if (quiet) return 0;
    if (dry_run)
      say_line("plan: dry run, nothing is written: {} would have {} nodes, {} steps", report.folder,
               report.nodes, report.steps);
    else
      say_line("plan: {}: {} nodes, {} steps, {} configs new or changed", report.folder,
               report.nodes, report.steps, report.changed);
    if (others.snakemake && !dry_run)
      say_line("plan: to run it with Snakemake: snakemake -d {0} -s {0}/Snakefile --cores 4",
               report.folder);
    if (others.slurm && !dry_run)
      say_line("plan: to send it to Slurm: {}/slurm/submit [options of sbatch]", report.folder);
    return 0;
  });
}
