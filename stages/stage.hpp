// The frame of a stage's program: arguments, config, input files, identity of the run, and exit
// code. A stage itself is one function: it reads the inputs of its job, computes, writes
// job.output, and returns the numbers that --json prints.
//
//   std::vector<Summary> mesh(const Job<MeshConfig>& job);
//   int main(int argc, char** argv) {
//     return langer::run_stage<MeshConfig>(argc, argv, "mesh", mesh);
//   }
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/voice.hpp"
#include "pipeline/plan/run_files.hpp"
#include "pipeline/plan/stage_config.hpp"
#include "program.hpp"

namespace langer {

// A stage's task, whatever its config.
struct Task {
  Where where;  // the place of a config key, for messages
  InputFiles inputs;
  std::string output;       // main output file
  std::string side_folder;  // folder of tables and figures (results/store/side_files.hpp)
  Identity identity;
  bool quiet = false;
  bool verbose = false;
  bool json = false;
  bool dry_run = false;  // only for stages that estimate their time and memory

  bool has(const std::string& port) const { return inputs.count(port) > 0; }
  const std::string& input(const std::string& port) const { return inputs.at(port).front(); }
  std::string side_file(const std::string& name) const {
    return (std::filesystem::path(side_folder) / name).string();
  }

  Voice voice() const { return {identity.stage, quiet, verbose}; }
  template <class... Parts>
  void say(fmt::format_string<Parts...> form, Parts&&... parts) const {
    voice().say(form, std::forward<Parts>(parts)...);
  }
  template <class... Parts>
  void detail(fmt::format_string<Parts...> form, Parts&&... parts) const {
    voice().detail(form, std::forward<Parts>(parts)...);
  }
  // A warning is printed with --quiet, too.
  template <class... Parts>
  void warn(fmt::format_string<Parts...> form, Parts&&... parts) const {
    voice().warn(fmt::format(form, std::forward<Parts>(parts)...));
  }
};

template <class Config>
struct Job : Task {
  Config config;
};

// What --json prints.
struct StageResults {
  std::vector<Summary> numbers;
  std::vector<TextResult> texts;
  StageResults(std::vector<Summary> numbers_ = {}, std::vector<TextResult> texts_ = {})
      : numbers(std::move(numbers_)), texts(std::move(texts_)) {}
};

// A failure of a stage that has found something nevertheless: --json prints that, too.
struct FailedWork : Failure {
  StageResults results;
  FailedWork(const Failure& failure, StageResults results_)
      : Failure(failure), results(std::move(results_)) {}
};

// The parts of a program that depend on the type of its config.
struct StageWork {
  std::function<ReadConfig(Tree)> read;  // throws Failure(config)
  std::function<StageResults()> work;
  std::function<std::vector<std::string>()> side_files;  // names of the files the config asks for
};
int run_stage(int argc, char** argv, const std::string& name, Task& task, const StageWork& own);

// Results: StageResults, or the numbers alone.
template <class Config, class Results>
int run_stage(int argc, char** argv, const std::string& name, Results (*work)(const Job<Config>&),
              std::vector<std::string> (*side_files)(const Config&) = nullptr) {
  Job<Config> job;
  StageWork own;
  own.read = [&job](Tree tree) {
    return read_stage_config(std::move(tree), job.config);
  };
  own.work = [&job, work] {
    return StageResults(work(job));
  };
  own.side_files = [&job, side_files] {
    if (!side_files) return std::vector<std::string>();
    return side_files(job.config);
  };
  return run_stage(argc, argv, name, job, own);
}

}  // namespace langer
