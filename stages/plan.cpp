// langer-plan pipelines/x.yaml [-o runs/x]: checks everything that a pipeline names, then writes its Makefile and configs.
#include "pipeline/plan.hpp"

#include "stage.hpp"

int main(int argc, char** argv) {
  using namespace langer;
  CLI::App app{"Turns a pipeline into a Makefile.", "langer-plan"};
  std::string pipeline, folder;
  bool quiet = false;
  app.add_option("pipeline", pipeline, "YAML file with nodes")->required()->type_name("FILE");
  app.add_option("-o,--output", folder, "folder of the run; runs/<name of the pipeline> by default")->type_name("FOLDER");
  app.add_flag("--quiet", quiet, "say errors only");
  app.set_version_flag("--version", version_line("langer-plan"));
  return guarded("langer-plan", [&] {
    int code = 0;
    if (!parsed(app, argc, argv, code)) return code;
    const std::string bin = std::filesystem::canonical("/proc/self/exe").parent_path().string();
    const PlanReport report = plan(pipeline, folder, bin, command_line(argc, argv));
    if (!quiet)
      say_line("plan: {}: {} nodes, {} steps, {} configs new or changed", report.folder, report.nodes, report.steps, report.changed);
    return static_cast<int>(Exit::ok);
  });
}
