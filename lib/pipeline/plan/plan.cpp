// Planning in four parts: the pipeline is read and expanded into steps; the config and the inputs
// of each step are checked; all errors are reported at once; only then are files written.
#include "pipeline/plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <vector>

#include "core/base/output_file.hpp"
#include "core/base/printable.hpp"
#include "core/config/reader.hpp"
#include "core/hdf5/replace.hpp"
#include "core/hdf5/seal.hpp"
#include "pipeline/plan/effective.hpp"
#include "pipeline/plan/expand.hpp"
#include "pipeline/plan/makefile.hpp"
#include "pipeline/plan/run_files.hpp"
#include "pipeline/plan/siblings.hpp"
#include "pipeline/plan/slurm.hpp"
#include "pipeline/plan/snakefile.hpp"
#include "results/store/lock.hpp"
#include "results/store/material_file.hpp"
#include "results/store/mesh_file.hpp"

namespace langer {

namespace fs = std::filesystem;
using namespace pipeline;

namespace {

struct TextFile {
  std::string path;  // relative to the run's folder
  std::string text;
};

// A comment that changes with the content of a data file. Empty where it cannot be read, which the
// stage reports, and for YAML, whose values are in files of the run.
std::string content_line(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".yaml" || extension == ".yml") return "";
  try {
    return fmt::format("# content of {}: {}\n", printable(fs::path(path).filename().string()),
                       content_of(path));
  } catch (const Failure&) {
    return "";
  }
}

// Collects the files and the rules of a run, step by step. Errors of all steps are collected, and
// thrown together by stop_if_wrong().
class Planning {
 public:
  explicit Planning(fs::path folder) : folder_(std::move(folder)) {}

  std::vector<TextFile> files;
  std::vector<Rule> rules;
  std::vector<std::string> finals;
  std::vector<std::string> doubts;

  // Reads the measured data of all fits. A plan alone does not need them, so only a check does.
  void check_data() {
    for (const auto& check : data_checks_) collect([&] { add_doubts(check()); });
  }

  // Adds the rule of a step and its effective config.
  void add(const Step& step) {
    const std::string here = (folder_ / step.folder).string();
    const std::string config = step.folder + "/" + step.stage->name + ".yaml";
    Rule rule{step.output(), {config}, std::string("langer-") + step.stage->name, config};
    std::string contents;
    for (const StepInput& input : step.inputs) {
      std::string path = input.path;
      if (!input.made) {
        path = given_file(step, input);
        contents += content_line(input.path);
      }
      rule.prerequisites.push_back(path);
      rule.arguments += fmt::format(" --{} {}", input.port, path);
    }
    collect([&] {
      std::vector<std::string> ports;
      for (const StepInput& input : step.inputs) ports.push_back(input.port);
      require_one_source(*step.stage, step.config, ports);
      const Effective effective = effective_config(*step.stage, step.config, here);
      add_doubts(effective.notices);
      for (const Effective::File& file : effective.files) {
        require_file(file.path, file.place, file.key);
        rule.prerequisites.push_back(from_run(file.path, file.place, file.key));
        contents += content_line(file.path);
      }
      if (effective.check_data) data_checks_.push_back(effective.check_data);
      SceneNames& names = names_[rule.target] = effective.names;
      for (const StepInput& input : step.inputs) add_names(step, input, names);
      if (const std::vector<Error> unknown = unknown_names(names); !unknown.empty())
        throw Failure(Exit::config, unknown);
      // The config contains the command and the contents of data files. So a step with another
      // input file has another config, and make repeats it, also where the file is an older one.
      files.push_back({config, fmt::format("# {} {}\n{}{}", rule.program, rule.arguments, contents,
                                           effective.text)});
    });
    // Snakemake reserves as many cores.
    rule.threads = threads_of(step.config);
    if (step.final) finals.push_back(rule.target);
    rules.push_back(std::move(rule));
  }

  void stop_if_wrong() {
    if (errors_.empty()) return;
    throw Failure(code_, errors_);
  }

 private:
  fs::path folder_;
  std::vector<std::function<std::vector<std::string>()>> data_checks_;
  std::map<std::string, SceneNames> names_;  // of steps by output and of files by path
  std::vector<Error> errors_;
  Exit code_ = Exit::input;

  // The largest number of threads that a config asks for. A wrong value counts as none; the check
  // of the config reports it.
  static int threads_of(const Tree& config) {
    int most = 1;
    for (const char* key : {"threads", "blas_threads", "jobs"}) {
      const Tree* value = config.find(key);
      if (!value || value->kind != Tree::Kind::scalar) continue;
      int n = 0;
      std::from_chars(value->scalar.data(), value->scalar.data() + value->scalar.size(), n);
      most = std::max(most, n);
    }
    return most;
  }

  void add_doubts(const std::vector<std::string>& more) {
    for (const std::string& doubt : more)
      if (std::ranges::find(doubts, doubt) == doubts.end()) doubts.push_back(doubt);
  }

  // Whether the names of this input matter to the step: mesh and material of a solve, the solution
  // of a post.
  static bool defines_names(const Step& step, const std::string& port) {
    const std::string stage = step.stage->name;
    if (stage == "solve") return port == "mesh" || port == "material";
    return stage == "post" && port == "solution";
  }

  // Adds the names that an input defines; it was made by an earlier step, or is given as a file.
  void add_names(const Step& step, const StepInput& input, SceneNames& names) {
    const std::string port = input.port;
    if (!defines_names(step, port)) return;
    if (!input.made) read_names(port, input.path);
    const SceneNames& defined = names_[input.made ? input.path : "file " + input.path];
    if (port != "material" && !names.mesh) names.mesh = defined.mesh;
    if (port != "mesh" && !names.families) names.families = defined.families;
    if (port == "solution") {
      names.more_families = defined.more_families;
      names.contacts = defined.contacts;
    }
  }

  // Reads the names that a file defines, once. An unreadable file defines none; its error is
  // reported by given_file().
  void read_names(const std::string& port, const std::string& path) {
    const auto [known, is_new] = names_.emplace("file " + path, SceneNames{});
    std::error_code ec;
    if (!is_new || !fs::is_regular_file(path, ec)) return;
    const Port material_port{.name = "material", .says = "", .made_by = {}};
    try {
      if (fs::path(path).extension() != ".h5" && port == "material")
        known->second = effective_port_file(material_port, load_yaml(path), "").names;
      else if (port == "mesh")
        known->second.mesh = names_of(read_mesh(path).mesh);
      else if (port == "material")
        known->second = names_in(read_material(path).material);
    } catch (const Failure&) {
    }
  }

  // Members of a sweep share most of their config: each error is kept once.
  void collect(auto&& work) {
    try {
      work();
    } catch (const Failure& failure) {
      // An error of the config is more important than a missing file.
      if (failure.code() != Exit::input) code_ = failure.code();
      for (const Error& e : failure.errors()) add_error(e);
    }
  }

  // Keeps an error once, by its text.
  void add_error(const Error& e) {
    for (const Error& known : errors_)
      if (text(known) == text(e)) return;
    errors_.push_back(e);
  }

  // A path as seen from the run's folder.
  std::string from_run(const std::string& path, const Place& place, const std::string& key) const {
    const std::string seen = relative_path(path, folder_.string());
    if (!is_safe_path(seen))
      throw Failure(Exit::config, Error{place, key, "found the path " + seen,
                                        "letters, digits, _ . + - and / only",
                                        "make gives other characters a meaning"});
    return seen;
  }

  // A file that the pipeline names at a port. HDF5 is used as it is; YAML is copied in canonical
  // form next to the step's config, so that comments repeat nothing.
  std::string given_file(const Step& step, const StepInput& input) {
    const std::string key = fmt::format("nodes.{}.{}", step.node, input.port);
    std::string path;
    collect([&] {
      require_file(input.path, input.place, key);
      const std::string extension = fs::path(input.path).extension().string();
      if (extension == ".h5") {
        path = from_run(input.path, input.place, key);
        return;
      }
      const Port& port = *step.stage->port(input.port);
      if (!port.takes_yaml || (extension != ".yaml" && extension != ".yml")) {
        std::string expected = "a .h5 file";
        if (port.takes_yaml) expected = "a .h5 or a .yaml file";
        throw Failure(Exit::config, Error{input.place, key, "found " + input.path, expected, ""});
      }
      path = fmt::format("{}/{}.yaml", step.folder, input.port);
      const Effective effective =
          effective_port_file(port, load_yaml(input.path), (folder_ / step.folder).string());
      add_doubts(effective.notices);
      files.push_back({path, effective.text});
    });
    return path;
  }
};

// Whether a file has exactly this text.
bool has_text(const fs::path& path, const std::string& text) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream found;
  found << file.rdbuf();
  return file.good() && found.str() == text;
}

// Writes <folder>/<file> unless it has this text already. `file` may name folders below the run's.
bool write_if_changed(const fs::path& folder, const std::string& file, const std::string& text) {
  const fs::path path = folder / file;
  make_folder_below(folder.string(), path.parent_path().string());
  require_replaceable(path.string());
  if (has_text(path, text)) return false;
  write_text_file_soon(path.string(), text);
  return true;
}

// The names are in comments of the Makefile, where a line break would begin a rule.
void refuse_control_characters(const std::string& name, const char* what) {
  if (!has_control(name)) return;
  throw Failure(Exit::input, Error{{name},
                                   "",
                                   fmt::format("the name of the {} has a control character", what),
                                   "a name without line breaks",
                                   "rename it: it becomes a line of the Makefile"});
}

// The folder of the programs as it is written in the Makefile. It may have any name, but a blank
// needs a backslash in make and in the shell, and some characters cannot be escaped in both.
std::string as_make_reads(const std::string& folder) {
  std::string seen;
  for (const char c : folder) {
    const auto byte = static_cast<unsigned char>(c);
    if (c != ' ' && byte < 0x80 && !std::isalnum(byte) &&
        std::string_view("/._-+,=@~").find(c) == std::string_view::npos)
      throw Failure(Exit::input,
                    Error{{folder},
                          "",
                          fmt::format("the programs are in a folder with {} in its name", c),
                          "letters, digits, blanks, / . _ - + , = @ ~",
                          "make gives it a meaning: move the programs to another folder"});
    if (c == ' ') seen += '\\';
    seen += c;
  }
  return seen;
}

// A checked plan with the steps that it was made from.
struct Planned {
  Planning planning;
  PlanReport report;
  std::string name;
  std::vector<Step> steps;
};

// Reads and checks a pipeline. siblings: a member may wait for another one whose mirror image it is
// (siblings.hpp); not with Slurm, where the jobs of a node start together.
Planned planned(const std::string& pipeline_file, std::string folder, const Overrides& overrides,
                bool siblings, bool with_data = false) {
  refuse_control_characters(pipeline_file, "pipeline's file");
  refuse_control_characters(folder, "run's folder");
  Tree tree = load_yaml(pipeline_file);
  apply(overrides, tree);
  set_base(tree, "");
  const Pipeline written = read_pipeline(tree);
  if (folder.empty()) folder = "runs/" + written.name;
  std::vector<Step> steps = expand(written, load_yaml);
  if (siblings) offer_siblings(steps);
  Planned p{
      Planning(folder), {folder, written.nodes.size(), steps.size(), 0, {}}, written.name, steps};
  for (const Step& step : p.steps) p.planning.add(step);
  if (with_data) p.planning.check_data();
  p.planning.stop_if_wrong();
  p.report.doubts = p.planning.doubts;
  return p;
}

}  // namespace

PlanReport check_pipeline(const std::string& pipeline_file, std::string folder,
                          const Overrides& overrides) {
  return planned(pipeline_file, std::move(folder), overrides, true, true).report;
}

// Writes the plan: configs, Makefile, and what `others` asks for. A lock keeps a second langer-plan
// away from the same folder.
PlanReport plan(const std::string& pipeline_file, std::string folder, const std::string& bin,
                const std::string& command, PlanFor others, const Overrides& overrides) {
  auto [planning, report, name, steps] =
      planned(pipeline_file, std::move(folder), overrides, !others.slurm);
  // Everything is right: from here on files are written. First of all it is checked that no
  // generated file would replace one of the user's.
  make_folder_below(report.folder, report.folder);
  const fs::path run = report.folder;
  const std::string makefile = (run / "Makefile").string();
  require_own_text(makefile, planned_by);
  if (others.snakemake) require_own_text((run / "Snakefile").string(), planned_by);
  begin_beside(makefile);
  const OutputLock lock(makefile, command);
  for (const TextFile& file : planning.files) {
    report.changed += write_if_changed(run, file.path, file.text);
  }
  // The Makefile is written after the configs: until it exists, make runs nothing.
  const std::string seen_bin = as_make_reads(relative_path(bin, report.folder));
  const std::string file_name = fs::path(pipeline_file).filename().string();
  write_if_changed(run, "Makefile",
                   makefile_text(file_name, seen_bin, planning.rules, planning.finals));
  if (others.snakemake) {
    write_if_changed(run, "Snakefile",
                     snakefile_text(file_name, seen_bin, planning.rules, planning.finals));
  }
  if (others.slurm) {
    for (const SlurmFile& file : slurm_files(name, steps)) {
      write_if_changed(run, file.name, file.text);
      if (file.program) {
        fs::permissions(run / file.name, fs::perms::owner_exec, fs::perm_options::add);
      }
    }
  }
  return report;
}

}  // namespace langer
