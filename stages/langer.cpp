// langer show | new | check | serve | describe | schema | explain | times | crate | dossier |
// doctor | completion: commands that read files and configs but compute nothing.
//
// Each command has a page in the table of cli/manual.cpp. Its positional arguments and options are
// taken from there, so a new command needs a line in that table and one in run_command().
#include <algorithm>
#include <filesystem>
#include <optional>

#include "arguments.hpp"
#include "cli/check.hpp"
#include "cli/crate.hpp"
#include "cli/doctor.hpp"
#include "cli/dossier.hpp"
#include "cli/run_state.hpp"
#include "cli/schemas.hpp"
#include "cli/show.hpp"
#include "cli/starter.hpp"
#include "core/base/say.hpp"
#include "core/base/text.hpp"
#include "core/hdf5/replace.hpp"
#include "core/hdf5/seal.hpp"
#include "pipeline/plan/effective.hpp"
#include "pipeline/plan/run_files.hpp"
#include "program.hpp"
#include "results/post/describe_columns.hpp"
#include "serve/scene_view.hpp"
#include "serve/serve.hpp"

namespace langer {
namespace {

// The arguments of a command.
struct Given {
  std::vector<std::string> places;  // positional arguments
  std::string as, same_as, port, into, output;
  CrateWords crate;
  DossierWords dossier;
  bool config = false;
  bool json = false;
  bool list = false;
  bool failed = false;
  bool scene = false;
};

// Prints data and returns the exit code of success.
int print(const std::string& text) {
  put_out(text);
  return static_cast<int>(Exit::ok);
}

// The text of `langer show`, by its options.
std::string file_text(const Given& given, const std::string& file) {
  if (given.config) return show_config(file);
  if (given.json) return show_summary(file);
  return show(file);
}

int show_files(const Given& given) {
  for (const std::string& file : given.places) {
    require_file(file);
    put_out(file_text(given, file));
  }
  return 0;
}

int new_project(const Given& given) {
  const std::string& scene = given.places[0];
  std::string folder = scene;
  if (given.places.size() > 1) folder = given.places[1];
  const std::vector<std::string> files = write_starter(scene, folder);
  say_line("langer: {} files in {}; to run them: make -C {}", files.size(), folder, folder);
  return 0;
}

// Checks all files, also after an error. The exit code is the largest of all.
int check_files(const Given& given) {
  int worst = 0;
  for (const std::string& file : given.places) {
    try {
      put_out(check_file(file, given.as) + "\n");
    } catch (const Failure& failure) {
      say_error(failure.what());
      worst = std::max(worst, static_cast<int>(failure.code()));
    }
  }
  return worst;
}

// `langer describe`: the reference of a kind of config, or the list of columns.
int describe_kind(const Given& given) {
  std::string name = given.places[0];
  if (name == "columns") return print(columns_text());
  if (const ConfigKind* kind = find_config_kind(name)) return print(kind->reference());
  // A pipeline has a schema but no reference. For an unknown kind schema_text() throws an error
  // that lists the known ones.
  if (name == "pipeline") name = "";
  return print(schema_text(name));
}

// `langer schema --into`: the schemas of all kinds, for an editor.
int write_all_schemas(const std::string& folder) {
  const std::size_t files = write_schemas(folder);
  say_line("langer: {} schemas in {}", files, folder);
  return 0;
}

// `langer crate`: writes a crate, or compares two folders with --same-as.
int crate(const Given& given) {
  const std::string& folder = given.places[0];
  if (!given.same_as.empty()) return print(same_results(folder, given.same_as) + "\n");
  const CrateReport report = write_crate(folder, given.crate);
  for (const std::string& file : report.copied) say_line("langer: copied {}/{}", folder, file);
  say_line(
      "langer: {}/ro-crate-metadata.json: {} files, {} steps, {} inputs copied; to make it again: "
      "sh {}/reproduce",
      folder, report.files, report.actions, report.copied.size(), folder);
  if (report.actions == 0)
    say_line("langer: no step was found: {}/Makefile has no rules as langer-plan writes them",
             folder);
  return 0;
}

// `langer serve`: the set-up page of a folder, or with --scene what the page draws of it.
int serve_folder(const Given& given) {
  std::string folder = ".";
  if (!given.places.empty()) folder = given.places[0];
  if (given.scene) return print(scene_view(folder + "/pipeline.yaml", folder + "/run") + "\n");
  int port = 0;
  if (!given.port.empty()) {
    const bool digits = given.port.find_first_not_of("0123456789") == std::string::npos;
    if (digits && given.port.size() < 6) port = std::stoi(given.port);
    if (port < 1 || port > 65535)
      throw Failure(Exit::config, Error{{"langer serve"},
                                        "--port",
                                        "found \"" + given.port + "\"",
                                        "a number from 1 to 65535",
                                        ""});
  }
  return serve(folder, port);
}

// `langer dossier`: on stdout, or as a file whose ending says the format.
int dossier(const Given& given) {
  const std::string& file = given.output;
  const std::string& run = given.places[0];
  if (file.empty()) return print(dossier_text(run, given.dossier, DossierFormat::markdown));
  const std::string end = std::filesystem::path(file).extension().string();
  if (end != ".md" && end != ".html")
    throw Failure(Exit::config, Error{{"langer dossier"},
                                      "--output",
                                      "found \"" + file + "\"",
                                      "the name of an .md or .html file",
                                      ""});
  require_own_text(file, "langer dossier");
  DossierFormat format = DossierFormat::markdown;
  if (end == ".html") format = DossierFormat::html;
  write_text_file(file, dossier_text(run, given.dossier, format));
  say_line("langer: {}", file);
  return static_cast<int>(Exit::ok);
}

// `langer doctor`: exit code 3 if a needed program is missing.
int doctor() {
  const std::vector<Finding> findings = examine();
  put_out(doctor_text(findings));
  if (std::ranges::any_of(findings, is_serious)) return static_cast<int>(Exit::input);
  return static_cast<int>(Exit::ok);
}

bool is_required_place(const UsageOption& o) { return is_place(o) && o.required; }

// Checks the number of positional arguments; `most`: of a command that does not take any number.
void check_places(const Usage& usage, const Given& given, std::size_t required,
                  std::optional<std::size_t> most) {
  if (given.places.size() < required) {
    std::string missing;
    for (const UsageOption& o : usage.options)
      if (is_required_place(o)) missing = o.flags;
    throw Failure(
        Exit::config,
        Error{{usage.program}, "", missing + " is required", "", usage.program + " --help"});
  }
  if (!most || given.places.size() <= *most) return;
  throw Failure(Exit::config, Error{{usage.program},
                                    "",
                                    fmt::format("found {} words", given.places.size()),
                                    fmt::format("{} at most", *most),
                                    usage.program + " --help"});
}

// Reads the arguments of one command and runs it.
int run_command(const Usage& usage, const std::string& name, int argc, char** argv) {
  Given given;
  const bool places = std::ranges::any_of(usage.options, is_place);
  const auto required =
      static_cast<std::size_t>(std::ranges::count_if(usage.options, is_required_place));
  Arguments options(usage.program);
  if (places) options.texts("places", given.places);
  if (usage.find("--output")) options.text("-o,--output", given.output);
  for (const auto& [name, text] : {std::pair{"--as", &given.as},
                                   {"--same-as", &given.same_as},
                                   {"--title", &given.crate.title},
                                   {"--author", &given.crate.author},
                                   {"--license", &given.crate.license},
                                   {"--port", &given.port},
                                   {"--into", &given.into},
                                   {"--use", &given.dossier.use},
                                   {"--question", &given.dossier.question},
                                   {"--risk", &given.dossier.risk},
                                   {"--tests", &given.dossier.tests},
                                   {"--root", &given.crate.root}})
    if (usage.find(name)) options.text(name, *text);
  for (const auto& [name, flag] : {std::pair{"--config", &given.config},
                                   {"--failed", &given.failed},
                                   {"--list", &given.list},
                                   {"--scene", &given.scene},
                                   {"--json", &given.json}})
    if (usage.find(name)) options.flag(name, *flag);
  int code = 0;
  if (!options.read(usage, argc, argv, code)) return code;
  if (given.list) return print(fmt::format("{}\n", fmt::join(schema_kinds(), "\n")));
  if (!given.into.empty()) return write_all_schemas(given.into);
  std::optional<std::size_t> most = required;
  if (name == "new") most = 2;
  if (name == "serve") most = 1;
  if (name == "show" || name == "check") most.reset();
  check_places(usage, given, required, most);
  if (name == "show") return show_files(given);
  if (name == "new") return new_project(given);
  if (name == "check") return check_files(given);
  if (name == "serve") return serve_folder(given);
  if (name == "describe") return describe_kind(given);
  if (name == "schema") return print(schema_text(given.places[0]));
  if (name == "explain") return print(explain_text(explain(given.places[0])));
  if (name == "times") return print(times_text(times_of(given.places[0]), given.failed));
  if (name == "crate") return crate(given);
  if (name == "dossier") return dossier(given);
  if (name == "doctor") return doctor();
  return print(completion_text());
}

int langer_program(int argc, char** argv) {
  std::string word = "--help";
  if (argc > 1) word = argv[1];
  if (word == "--help" || word == "-h" || word == "help") return print(help_text(langer_usage()));
  if (word == "--version") return print(version_line("langer") + "\n");
  std::vector<std::string> names;
  for (const Usage& usage : langer_commands()) {
    names.push_back(usage.program.substr(7));
    if (word == names.back()) return run_command(usage, word, argc - 1, argv + 1);
  }
  throw Failure(Exit::config, Error{{"langer"},
                                    "",
                                    fmt::format("there is no command \"{}\"", word),
                                    "one of " + list_words(names),
                                    text_or(did_you_mean(nearest(word, names)), "langer --help")});
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::guarded("langer", [&] { return langer::langer_program(argc, argv); });
}
