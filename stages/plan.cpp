// langer-plan pipelines/x.yaml [-o runs/x]: checks everything that a pipeline names, then writes its Makefile and configs.
#include "pipeline/plan.hpp"

#include "stage.hpp"

int main(int argc, char** argv) {
  using namespace langer;
  CLI::App app{"Turns a pipeline into a Makefile.", "langer-plan"};
  std::string file, folder;
  pipeline::Overrides overrides;
  bool quiet = false, verbose = false, dry_run = false;
  PlanFor others;
  app.add_option("pipeline", file)->required();
  app.add_option("-o,--output", folder);
  app.add_option("--set", overrides.settings)->allow_extra_args(false);
  app.add_option("--sweep", overrides.sweeps)->allow_extra_args(false);
  app.add_flag("--dry-run", dry_run);
  app.add_flag("--slurm", others.slurm);
  app.add_flag("--snakemake", others.snakemake);
  app.add_flag("--quiet", quiet);
  app.add_flag("-v,--verbose", verbose);
  app.set_help_flag("-h,--help");
  app.set_version_flag("--version", version_line("langer-plan"));
  return guarded("langer-plan", [&] {
    int code = 0;
    if (!parsed(app, plan_usage(), argc, argv, code)) return code;
    const std::string bin = std::filesystem::canonical("/proc/self/exe").parent_path().string();
    const PlanReport report =
        dry_run ? check_pipeline(file, folder, overrides) : plan(file, folder, bin, command_line(argc, argv), others, overrides);
    if (verbose) say_line("plan: {}, programs in {}", version_line("langer-plan"), bin);
    for (const std::string& doubt : report.doubts) say_line("plan: warning: {}", doubt);
    if (quiet) return 0;
    if (dry_run)
      say_line("plan: dry run, nothing is written: {} would hold {} nodes, {} steps", report.folder, report.nodes, report.steps);
    else
      say_line("plan: {}: {} nodes, {} steps, {} configs new or changed", report.folder, report.nodes, report.steps,
               report.changed);
    if (others.snakemake && !dry_run)
      say_line("plan: to run it by Snakemake: snakemake -d {0} -s {0}/Snakefile --cores 4", report.folder);
    if (others.slurm && !dry_run) say_line("plan: to send it to Slurm: {}/slurm/submit [options of sbatch]", report.folder);
    return 0;
  });
}
