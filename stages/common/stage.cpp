// The order of a stage's program:
//   options       --help, --describe and --version are answered at once
//   ranks         under mpirun: langer-solve uses all, other programs one
//   protection    config and inputs can no longer be replaced
//   config        read with includes and --set, checked; inputs must exist
//   identity      hash of config and inputs, which the output records
//   lock          a second run with the same output ends here
//   work          the stage itself; it writes its main output last
#include "stage.hpp"

#include <malloc.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

#include "arguments.hpp"
#include "core/base/lower_case.hpp"
#include "core/base/memory.hpp"
#include "core/base/ranks.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/text.hpp"
#include "mechanics/linear/blas/kernels.hpp"
#include "mechanics/linear/petsc/petsc_load.hpp"
#include "pipeline/plan/effective.hpp"
#include "pipeline/plan/ports.hpp"
#include "results/store/lock.hpp"
#include "results/store/side_files.hpp"

namespace langer {

namespace {

// Runs a function on rank 0 only. If it throws, all ranks end.
template <class Work>
void on_root_rank(Work work) {
  on_root_rank(ranks(), [&] {
    work();
    return true;
  });
}

// -v: version, config and content ids of the inputs.
void print_inputs(const Identity& identity, const std::string& program) {
  say_line("{}: {}, config {}", identity.stage, version_line(program), identity.config_hash);
  for (const auto& [port, id] : identity.inputs) say_line("{}: {} {}", identity.stage, port, id);
  if (const std::string kernels = blas::kernels_line(); !kernels.empty())
    say_line("{}: {}", identity.stage, kernels);
}

// Refuses an input that another stage made than those that the port takes.
void check_makers(const StageSpec& spec, const InputFiles& inputs) {
  for (const auto& [port, files] : inputs)
    for (const std::string& file : files) {
      if (std::filesystem::path(file).extension() != ".h5") continue;
      const std::string stage = read_origin(file).identity.stage;
      const std::vector<std::string>& makers = spec.port(port)->made_by;
      if (std::ranges::find(makers, stage) == makers.end())
        throw Failure(Exit::input, Error{{file},
                                         "",
                                         "made by langer-" + stage,
                                         "a file of langer-" + list_words(makers),
                                         ""});
    }
}

// A part of the config in words: on, off, or its number of items.
std::string part_words(const ConfigPart& part) {
  if (!part.active) return "off, not in the config";
  if (part.count > 0) return std::to_string(part.count);
  return "on";
}

// --dry-run of the stages that do not estimate their time and memory.
void print_dry_run(const StageSpec& spec, const std::vector<ConfigPart>& parts,
                   const std::string& output, const InputFiles& inputs) {
  say_line("{}: dry run, nothing is computed or written", spec.name);
  const auto line = [](const std::string& part, const std::string& says) {
    say_line("  {:<14}{}", part, says);
  };
  for (const auto& [port, files] : inputs) line(port, fmt::format("{}", fmt::join(files, ", ")));
  for (const ConfigPart& p : parts) line(p.key, part_words(p));
  line("makes", text_or(output, spec.output));
}

// Refuses an output whose name says that it is a table or a figure. A table of that name may be
// written next to it, and programs that choose by the name could not open it.
void require_name_of_kind(const std::string& output, const StageSpec& spec) {
  static const std::set<std::string> others{".csv", ".gp",   ".png",  ".svg", ".pdf",
                                            ".tex", ".xdmf", ".xmf",  ".vtu", ".yaml",
                                            ".yml", ".json", ".html", ".txt", ".h5"};
  const std::filesystem::path path(output);
  const std::string kind = std::filesystem::path(spec.output).extension().string();
  const std::string given = lower_case(path.extension().string());
  if (given == kind || others.count(given) == 0) return;
  std::string format = "HDF5";
  if (kind == ".html") format = "a page of HTML";
  std::filesystem::path named = path;
  named.replace_extension(kind);
  throw Failure(
      Exit::input,
      Error{{output},
            "",
            fmt::format("found {} for the main output, which is {}", given, format),
            "a name that ends in " + kind,
            fmt::format("-o {}; tables and figures are written next to it", named.string())});
}

// Options of a stage's command line that are not part of its task.
struct CommandLine {
  std::string config_file, log;
  std::vector<std::string> settings;
};

// The options of a stage: its ports, and those that all stages have.
void add_options(Arguments& options, const StageSpec& spec, Task& task, CommandLine& given) {
  options.text("config", given.config_file, true);
  for (const Port& port : spec.inputs) {
    std::vector<std::string>& files = task.inputs[port.name];
    const std::string name = "--" + std::string(port.name);
    if (port.several)
      options.texts(name, files, port.required);
    else
      options.text(name, files, port.required);
  }
  options.text("-o,--output", task.output);
  options.flag("--dry-run", task.dry_run);
  options.texts("--set", given.settings);
  options.flag("--quiet", task.quiet);
  options.flag("-v,--verbose", task.verbose);
  options.flag("--json", task.json);
  options.text("--log", given.log);
  options.flag("--describe");
  options.version();
}

// Reads the config and checks the inputs of a task. From here on the output may be replaced: first
// it is checked that this destroys neither an input nor a file that Langer did not make.
ReadConfig read_task(Task& task, const StageSpec& spec, const CommandLine& given,
                     const std::string& command, const StageWork& own) {
  std::erase_if(task.inputs, [](const auto& port) { return port.second.empty(); });
  for (const auto& [port, files] : task.inputs)
    for (const std::string& file : files) require_file(file);
  Tree tree = load_yaml(given.config_file);
  for (const std::string& file : files_of(tree)) never_replace(file);
  for (const std::string& setting : given.settings) apply_setting(tree, setting);
  std::vector<std::string> ports;
  for (const auto& [port, files] : task.inputs) ports.push_back(port);
  require_one_source(spec, tree, ports);
  ReadConfig config = own.read(std::move(tree));
  task.where = config.where;
  if (!task.dry_run)
    on_root_rank([&] { check_output(task.output, given.config_file, task.inputs); });
  require_name_of_kind(task.output, spec);
  task.identity =
      identity_of(std::string(spec.name), config.text, task.where, task.inputs, command);
  for (const std::string& notice : config.notices) task.warn("{}", notice);
  on_root_rank([&] {
    // Repeated here, because the files that the config names are known by now.
    if (!task.dry_run) require_replaceable(task.output);
    begin_beside(task.output);
  });
  return config;
}

// Protects the config and the inputs from being replaced by any file of this run.
void protect_inputs(const CommandLine& given, const Task& task) {
  never_replace(given.config_file);
  for (const auto& [port, files] : task.inputs)
    for (const std::string& file : files) never_replace(file);
  if (!given.log.empty() && std::filesystem::weakly_canonical(given.log) ==
                                std::filesystem::weakly_canonical(task.output))
    throw Failure(Exit::input,
                  Error{{given.log}, "", "is also the output", "another name for --log", ""});
}

// Starts the ranks of mpirun. Only langer-solve uses several; of other programs all ranks but one
// end at once. False on a rank that ends.
bool start_ranks(const std::string& program, bool quiet) {
  const Launched started = launched();
  if (started.n == 1) return true;
  std::string reason = program + " is the work of one process";
  if (program == shared_by_ranks && begin_ranks(reason)) return true;
  if (started.rank > 0) return false;
  if (!quiet) say_line("{}: {} of {} ranks idle: {}", program, started.n - 1, started.n, reason);
  return true;
}

// Chooses the folder of tables, cards and figures. Another run of this folder may own their plain
// names; then they go to a folder of their own.
void choose_side_folder(Task& task, const StageSpec& spec, const std::vector<std::string>& names) {
  const SideFolder folder = side_folder(task.output, spec.name, names);
  task.side_folder = folder.path;
  if (!folder.owner.empty()) {
    task.say("tables, cards and figures go to {}/: the plain names belong to {}", folder.path,
             folder.owner);
  }
}

// A run from its options to its output: checks, lock, work, summary.
int run(Task& task, const StageSpec& spec, const CommandLine& given, RunLog& log,
        const std::string& command, const StageWork& own) {
  protect_inputs(given, task);
  if (!given.log.empty())
    on_root_rank(
        [&] { log.open(given.log, command, std::filesystem::exists(task.output + ".part")); });
  const ReadConfig config = read_task(task, spec, given, command, own);
  if (task.verbose) print_inputs(task.identity, "langer-" + std::string(spec.name));
  if (task.dry_run && !spec.forecasts) {
    check_makers(spec, task.inputs);
    if (!task.quiet) print_dry_run(spec, config.parts, task.output, task.inputs);
    if (task.json) put_out(json_text(task.identity, {}));
    return static_cast<int>(Exit::ok);
  }
  // The lock is released when this function ends, also by an exception.
  std::optional<OutputLock> lock;
  task.side_folder = std::filesystem::path(task.output).parent_path().string();
  if (!task.dry_run) {
    on_root_rank([&] {
      lock.emplace(task.output, task.identity.command);
      choose_side_folder(task, spec, own.side_files());
    });
  }
  StageResults results;
  try {
    results = own.work();
  } catch (const FailedWork& failed) {
    if (task.json) put_out(json_text(task.identity, failed.results.numbers, failed.results.texts));
    throw;
  }
  if (task.verbose)
    say_line("{}: {:.2f} s, {:.2f} s of CPU, {:.0f} MB at most", spec.name, wall_seconds(),
             cpu_seconds(), 1e-6 * peak_bytes());
  if (task.json) put_out(json_text(task.identity, results.numbers, results.texts));
  return static_cast<int>(Exit::ok);
}

// A factorization frees its workspace, and the next one asks for it again. glibc returns large
// blocks to the system by default and gets each page anew, which took up to a third of the CPU time
// of a small scene. Blocks of up to 1 GB are kept instead, the last 512 MB of them at most.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 512 << 20);
#endif
}

}  // namespace

// Everything that may throw runs inside of guarded().
int run_stage(int argc, char** argv, const std::string& name, Task& task, const StageWork& own) {
  const StageSpec& spec = *find_stage(name);
  const ConfigKind& kind = *find_config_kind(name);
  const std::string program = "langer-" + name;
  // Only these two stages factorize large matrices.
  if (name == "solve" || name == "fit") {
    blas::restart_with_better_kernels(argv);
    keep_freed_memory();
  }
  Arguments options(program);
  CommandLine given;
  add_options(options, spec, task, given);
  RunLog log;
  const auto body = [&] {
    // --describe is answered without the required arguments.
    if (std::find(argv + 1, argv + argc, std::string_view("--describe")) != argv + argc) {
      put_out(kind.reference());
      return static_cast<int>(Exit::ok);
    }
    int code = 0;
    if (!options.read(usage_of(spec, kind.top_keys()), argc, argv, code)) return code;
    if (task.output.empty() && !task.dry_run) {
      say_error(fmt::format("{}: --output is required\n  hint: {} --help", program, program));
      return static_cast<int>(Exit::config);
    }
    if (!start_ranks(program, task.quiet)) return static_cast<int>(Exit::ok);
    return run(task, spec, given, log, command_line(argc, argv), own);
  };
  return guarded(program, body);
}

}  // namespace langer
