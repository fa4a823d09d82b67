// langer-gather table.yaml --curves a/curves.h5 --curves b/curves.h5 -o sweep.h5: one row per file, also as table.csv.
#include "post/gather.hpp"
#include "scene/gather_config.hpp"
#include "scene/sweep_file.hpp"
#include "stage.hpp"

namespace langer {

std::vector<Summary> gather_sweep(const Job<GatherConfig>& job) {
  const std::vector<std::string>& files = job.inputs.at("curves");
  const GatherConfig& config = job.config;
  if (!config.members.empty() && config.members.size() != files.size())
    throw Failure(Exit::config, Error{job.where("members"), "members", fmt::format("found {} members", config.members.size()),
                                      fmt::format("one for each of the {} files given", files.size()), ""});
  std::vector<SweepAxis> axes;
  for (const GatherAxis& a : config.axes) axes.push_back({a.name, a.unit, {}});
  std::vector<GatherInput> members;
  for (std::size_t i = 0; i < files.size(); ++i) {
    GatherInput member{files[i], {}, read_summary(files[i])};
    if (member.summary.empty())
      throw Failure(Exit::input, Error{{files[i], 0, 0},
                                       "/summary",
                                       "nothing to gather",
                                       "a file with a summary",
                                       "curves.h5, material.h5, mesh.h5 and sensitivity.h5 have one"});
    if (!config.members.empty()) member.path = config.members[i].path, member.at = config.members[i].at;
    members.push_back(std::move(member));
  }
  const Sweep sweep = gather(config.columns, axes, members, job.where("columns"));
  write_sweep(job.output, job.beside("table.csv"), sweep, job.identity);
  job.say("{} rows, {} columns", sweep.members.size(), sweep.axes.size() + sweep.columns.size());
  return {};
}

}  // namespace langer

int main(int argc, char** argv) { return langer::run_stage<langer::GatherConfig>(argc, argv, "gather", langer::gather_sweep); }
