// What every program does around its work: arguments, config, input files, identity, exit code.
//
//   std::vector<Summary> mesh(const Job<MeshConfig>& job);   // reads, computes, writes job.output; returns what --json prints
//   int main(int argc, char** argv) { return langer::run_stage<MeshConfig>(argc, argv, "mesh", mesh); }
//
// stdout is for data (--json, --describe); stderr for everything said to the person who waits.
#pragma once

#include <sys/resource.h>
#include <unistd.h>
#ifdef LANGER_SANITIZE
#include <sanitizer/lsan_interface.h>
#endif

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "base/interrupt.hpp"
#include "base/memory.hpp"
#include "base/stopwatch.hpp"
#include "base/traps.hpp"
#include "base/version.hpp"
#include "base/voice.hpp"
#include "hdf5/h5.hpp"
#include "pipeline/ports.hpp"
#include "pipeline/run_files.hpp"
#include "store/lock.hpp"
#include "tool/usage.hpp"

namespace langer {

template <class Config>
struct Job {
  Config config;
  Where where;  // place of a config key, for errors found later
  InputFiles inputs;
  std::string output;  // main output file; side files stand beside it
  Identity identity;
  bool quiet = false;
  bool verbose = false;
  bool json = false;
  bool dry_run = false;  // only with stages that forecast

  bool has(const std::string& port) const { return inputs.count(port) > 0; }
  const std::string& input(const std::string& port) const { return inputs.at(port).front(); }
  std::string beside(const std::string& name) const { return (std::filesystem::path(output).parent_path() / name).string(); }

  Voice voice() const { return {identity.stage, quiet, verbose}; }
  template <class... Parts>
  void say(fmt::format_string<Parts...> form, Parts&&... parts) const {
    voice().say(form, std::forward<Parts>(parts)...);
  }
  // with --quiet too
  template <class... Parts>
  void warn(fmt::format_string<Parts...> form, Parts&&... parts) const {
    voice().warn(fmt::format(form, std::forward<Parts>(parts)...));
  }
};

// Data on stdout, to its end; a reader who has seen enough (`| head`) is no error, a full disk is.
inline void put_out(const std::string& text) {
  errno = 0;
  if ((std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) && errno != EPIPE)
    throw Failure(Exit::input, Error{{"stdout"}, "", fmt::format("cannot be written ({})", std::strerror(errno)), "", ""});
}

inline std::string version_line(const std::string& program) { return fmt::format("{} {} ({})", program, version, revision); }

// of programs that were started here and have ended: gnuplot
inline double cpu_seconds_of_children() {
  rusage used{};
  if (getrusage(RUSAGE_CHILDREN, &used) != 0) return 0;
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

// What --log keeps: all that is said, and how it ended.
class RunLog {
 public:
  ~RunLog() {
    if (said::log) std::fclose(std::exchange(said::log, nullptr));
  }
  // `goes_on`: the run may continue one that was stopped
  void open(const std::string& path, const std::string& command, bool goes_on) {
    need_own_log(path);
    std::error_code failed;  // a folder that cannot be made has no file either
    if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty())
      std::filesystem::create_directories(folder, failed);
    said::log = std::fopen(path.c_str(), goes_on ? "a" : "w");
    if (!said::log)
      throw Failure(Exit::input, Error{{path},
                                       "",
                                       fmt::format("cannot be written ({})", std::strerror(errno)),
                                       "a file in a folder that may be written to",
                                       "another name for --log"});
    fmt::print(said::log, "# {}\n# {} on {}, {}\n", command, version_line("langer"), host_name(), utc_now());
    std::fflush(said::log);
  }
  // read by the table of a run's times (pipeline/run_state.hpp)
  static void end(int code) {
    if (said::log)
      fmt::print(said::log, "# end: exit {}, {:.2f} s, {:.2f} s of CPU, {:.0f} MB\n", code, wall_seconds(),
                 cpu_seconds() + cpu_seconds_of_children(), 1e-6 * peak_bytes());
  }
};

// The end of a program whose work is done. Where memory or disk have run out, libraries hang or crash in their own farewells
// (OpenBLAS joins a thread that waits for memory, HDF5 writes again what could not be written): they are not asked for any.
[[noreturn]] inline void leave(int code) {
  std::fflush(nullptr);
#ifdef LANGER_SANITIZE
  __lsan_do_leak_check();
#endif
  _exit(code);
}

// Runs the body and turns what it throws into a message and an exit code.
int exit_code_after(const std::string& program, auto&& body) {
  wall_seconds();
  const auto no_memory = [&](const char* what) {
    say_line("{}: out of memory{}\n  hint: fewer elements, fewer threads, or a higher limit (ulimit -v)", program, what);
    return static_cast<int>(Exit::input);
  };
  listen_to_signals();
  set_traps();
  try {
    return body();
  } catch (const Failure& failure) {
    say_error(failure.what());
    return static_cast<int>(failure.code());
  } catch (const std::bad_alloc&) {
    return no_memory("");
  } catch (const std::system_error& e) {
    if (e.code() == std::errc::resource_unavailable_try_again || e.code() == std::errc::not_enough_memory)
      return no_memory(": no further thread can be started");
    say_line("{}: {}", program, e.what());
    return static_cast<int>(Exit::input);
  } catch (const std::exception& e) {
    say_line("{} {} ({}): {}\n  this is a bug, please report it with the command and its files", program, version, revision,
             e.what());
  }
  return static_cast<int>(Exit::bug);
}

int guarded(const std::string& program, auto&& body) {
  const int code = exit_code_after(program, body);
  RunLog::end(code);
  leave(code);
}

// Reads the arguments; nothing if the program has said all it was asked for, then `code` is its exit code.
// --help and --version are answered whatever else is missing.
inline bool parsed(CLI::App& app, const Usage& usage, int argc, char** argv, int& code) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    known.push_back(name);
    if (name.rfind("-", 0) == 0 && !usage.find(name))
      throw std::logic_error("the option " + name + " is not in the table of usage");
  }
  for (int i = 1; i < argc; ++i)
    if (const std::string a = argv[i]; a == "--help" || a == "-h") {
      put_out(help_text(usage));
      return false;
    }
  try {
    app.parse(argc, argv);
    return true;
  } catch (const CLI::Success& asked) {
    std::ostringstream text;
    code = app.exit(asked, text, text);
    put_out(text.str());
  } catch (const CLI::ParseError& e) {
    // an unknown option says more than the required one that is missing because of it
    for (const std::string& extra : app.remaining())
      if (extra.rfind("-", 0) == 0) {
        const std::string near = nearest(extra, known);
        say_error(
            fmt::format("{}: unknown option {}{}", app.get_name(), extra, near.empty() ? "" : "; did you mean " + near + "?"));
      }
    say_error(fmt::format("{}: {}\n  hint: {} --help", app.get_name(), e.what(), app.get_name()));
    code = static_cast<int>(Exit::config);
  }
  return false;
}

// -v: what this run is made from
inline void say_inputs(const Identity& identity, const std::string& program) {
  say_line("{}: {}, config {}", identity.stage, version_line(program), identity.config_hash);
  for (const auto& [port, id] : identity.inputs) say_line("{}: {} {}", identity.stage, port, id);
}

inline std::string command_line(int argc, char** argv) {
  std::string line = std::filesystem::path(argv[0]).filename().string();
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

// inputs are files of ours of a kind that the port takes
inline void need_kinds(const StageSpec& spec, const InputFiles& inputs) {
  for (const auto& [port, files] : inputs)
    for (const std::string& file : files) {
      if (std::filesystem::path(file).extension() != ".h5") continue;
      const std::string stage = read_origin(file).identity.stage;
      const std::vector<std::string>& makers = spec.port(port)->made_by;
      if (std::find(makers.begin(), makers.end(), stage) == makers.end())
        throw Failure(Exit::input, Error{{file}, "", "made by langer-" + stage, "a file of langer-" + list_words(makers), ""});
    }
}

// --dry-run of the stages without a forecast
inline void say_dry_run(const StageSpec& spec, const std::vector<ConfigPart>& parts, const std::string& output,
                        const InputFiles& inputs) {
  say_line("{}: dry run, nothing is computed or written", spec.name);
  const auto line = [](const std::string& part, const std::string& says) { say_line("  {:<14}{}", part, says); };
  for (const auto& [port, files] : inputs) line(port, fmt::format("{}", fmt::join(files, ", ")));
  for (const ConfigPart& p : parts)
    line(p.key, p.active ? (p.count > 0 ? std::to_string(p.count) : "on") : "off, not in the config");
  line("makes", output.empty() ? std::string(spec.output) : output);
}

// What a stage's command line gives beside its job.
struct CommandLine {
  std::string config_file, log;
  std::vector<std::string> settings;
};

void add_options(CLI::App& app, const StageSpec& spec, auto& job, CommandLine& given) {
  app.add_option("config", given.config_file)->required();
  for (const Port& port : spec.inputs) {
    auto* option = app.add_option("--" + std::string(port.name), job.inputs[port.name]);
    option->allow_extra_args(false)->required(port.required);
    if (!port.several) option->expected(1);
  }
  app.add_option("-o,--output", job.output);
  app.add_flag("--dry-run", job.dry_run);
  app.add_option("--set", given.settings)->allow_extra_args(false);
  app.add_flag("--quiet", job.quiet);
  app.add_flag("-v,--verbose", job.verbose);
  app.add_flag("--json", job.json);
  app.add_option("--log", given.log);
  app.add_flag("--describe");
  app.set_help_flag("-h,--help");
  app.set_version_flag("--version", version_line(app.get_name()));
}

// Config and inputs of a job whose options are read; nothing of it is written yet.
template <Listed Config>
void read_job(Job<Config>& job, const StageSpec& spec, const CommandLine& given, const std::string& command) {
  std::erase_if(job.inputs, [](const auto& port) { return port.second.empty(); });
  for (const auto& [port, files] : job.inputs)
    for (const std::string& file : files) need_file(file);
  Tree tree = load_yaml(given.config_file);
  for (const std::string& file : files_of(tree)) never_replace(file);
  for (const std::string& setting : given.settings) apply_setting(tree, setting);
  std::vector<std::string> ports;
  for (const auto& [port, files] : job.inputs) ports.push_back(port);
  need_one_source(spec, tree, ports);
  auto loaded = read_config<Config>(std::move(tree));
  job.config = std::move(loaded.config);
  job.where = std::move(loaded.where);
  if (!job.dry_run) need_output(job.output, given.config_file, job.inputs);
  job.identity = identity_of(std::string(spec.name), job.config, job.where, job.inputs, command);
  for (const std::string& notice : loaded.notices) job.warn("{}", notice);
  if (!job.dry_run) need_replaceable(job.output);  // by now it is known what the config names
  begin_beside(job.output);
}

template <Listed Config>
int run_stage(int argc, char** argv, const std::string& name, auto&& body) {
  const StageSpec& spec = *find_stage(name);
  const std::string program = "langer-" + name;
  CLI::App app{spec.sentence, program};
  Job<Config> job;
  CommandLine given;
  add_options(app, spec, job, given);

  RunLog kept;
  return guarded(program, [&] {
    // --describe needs none of the required arguments
    if (std::any_of(argv + 1, argv + argc, [](const char* a) { return std::string(a) == "--describe"; })) {
      put_out(describe<Config>());
      return static_cast<int>(Exit::ok);
    }
    int code = 0;
    if (!parsed(app, usage_of(spec, top_keys<Config>(), ""), argc, argv, code)) return code;
    if (job.output.empty() && !job.dry_run) {
      say_error(fmt::format("{}: --output is required\n  hint: {} --help", program, program));
      return static_cast<int>(Exit::config);
    }
    const std::string command = command_line(argc, argv);
    never_replace(given.config_file);
    for (const auto& [port, files] : job.inputs) std::for_each(files.begin(), files.end(), never_replace);
    if (!given.log.empty() && std::filesystem::weakly_canonical(given.log) == std::filesystem::weakly_canonical(job.output))
      throw Failure(Exit::input, Error{{given.log}, "", "is the output too", "another name for --log", ""});
    if (!given.log.empty()) kept.open(given.log, command, std::filesystem::exists(job.output + ".part"));
    read_job(job, spec, given, command);
    if (job.verbose) say_inputs(job.identity, program);
    if (job.dry_run && !spec.forecasts) {
      need_kinds(spec, job.inputs);
      if (!job.quiet) say_dry_run(spec, parts_of(job.config), job.output, job.inputs);
      if (job.json) put_out(json_text(job.identity, {}));
      return static_cast<int>(Exit::ok);
    }
    std::optional<OutputLock> lock;
    if (!job.dry_run) lock.emplace(job.output, job.identity.command);
    const std::vector<Summary> results = body(std::as_const(job));
    if (job.verbose)
      say_line("{}: {:.2f} s, {:.2f} s of CPU, {:.0f} MB at most", name, wall_seconds(), cpu_seconds(), 1e-6 * peak_bytes());
    if (job.json) put_out(json_text(job.identity, results));
    return static_cast<int>(Exit::ok);
  });
}

}  // namespace langer
