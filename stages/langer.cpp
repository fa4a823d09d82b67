// langer show | new | check | describe | schema | explain | times | crate | doctor | man |
// completion: what one wants to know beside the stages.
#include <algorithm>

#include "arguments.hpp"
#include "cli/check.hpp"
#include "cli/crate.hpp"
#include "cli/doctor.hpp"
#include "cli/run_state.hpp"
#include "cli/schemas.hpp"
#include "cli/show.hpp"
#include "cli/starter.hpp"
#include "core/base/say.hpp"
#include "pipeline/plan/effective.hpp"
#include "pipeline/plan/run_files.hpp"
#include "program.hpp"
#include "results/post/describe_columns.hpp"

namespace langer {
namespace {

struct Given {
  std::vector<std::string> places;  // what stands without an option
  std::string as, same_as;
  CrateWords crate;
  bool config = false, json = false, list = false, failed = false;
};

int show_files(const Given& given) {
  for (const std::string& file : given.places) {
    require_file(file);
    put_out(given.config ? show_config(file) : given.json ? show_summary(file) : show(file));
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

int check_files(const Given& given) {
  int worst = 0;
  for (const std::string& file : given.places) try {
      put_out(check_file(file, given.as) + "\n");
    } catch (const Failure& failure) {
      say_error(failure.what());
      worst = std::max(worst, static_cast<int>(failure.code()));
    }
  return worst;
}

int describe_kind(const Given& given) {
  if (given.places[0] == "columns") return put_out(columns_text()), 0;
  const ConfigKind* kind = find_config_kind(given.places[0]);
  if (!kind)
    schema_text(given.places[0] == "pipeline" ? "" : given.places[0]);  // says which there are
  put_out(kind->reference());
  return 0;
}

int manual(const Given& given) {
  std::vector<std::string> known;
  for (const Usage& u : all_usages()) {
    if (u.program == given.places[0]) return put_out(man_text(u)), 0;
    known.push_back(u.program);
  }
  throw Failure(Exit::config, Error{{},
                                    "",
                                    fmt::format("there is no program \"{}\"", given.places[0]),
                                    "one of " + list_words(known),
                                    ""});
}

int crate(const Given& given) {
  const std::string& folder = given.places[0];
  if (!given.same_as.empty()) return put_out(same_results(folder, given.same_as) + "\n"), 0;
  const CrateReport report = write_crate(folder, given.crate);
  for (const std::string& file : report.copied) say_line("langer: copied {}/{}", folder, file);
  say_line(
      "langer: {}/ro-crate-metadata.json: {} files, {} steps, {} inputs copied; to make it again: sh {}/reproduce",
      folder, report.files, report.actions, report.copied.size(), folder);
  return 0;
}

int doctor() {
  const std::vector<Finding> findings = examine();
  put_out(doctor_text(findings));
  const bool runs = std::none_of(findings.begin(), findings.end(),
                                 [](const Finding& f) { return f.needed && !f.there; });
  return static_cast<int>(runs ? Exit::ok : Exit::input);
}

int command(const Usage& usage, const std::string& name, int argc, char** argv) {
  Given given;
  const bool places = std::any_of(usage.options.begin(), usage.options.end(), is_place);
  const std::size_t required = static_cast<std::size_t>(
      std::count_if(usage.options.begin(), usage.options.end(),
                    [](const UsageOption& o) { return is_place(o) && o.required; }));
  Arguments options(usage.program);
  if (places) options.texts("places", given.places);
  for (const auto& [name, text] : {std::pair{"--as", &given.as},
                                   {"--same-as", &given.same_as},
                                   {"--title", &given.crate.title},
                                   {"--author", &given.crate.author},
                                   {"--license", &given.crate.license},
                                   {"--root", &given.crate.root}})
    if (usage.find(name)) options.text(name, *text);
  for (const auto& [name, flag] : {std::pair{"--config", &given.config},
                                   {"--failed", &given.failed},
                                   {"--list", &given.list},
                                   {"--json", &given.json}})
    if (usage.find(name)) options.flag(name, *flag);
  int code = 0;
  if (!options.read(usage, argc, argv, code)) return code;
  if (given.list) return put_out(fmt::format("{}\n", fmt::join(schema_kinds(), "\n"))), 0;
  if (given.places.size() < required) {
    std::string missing;
    for (const UsageOption& o : usage.options)
      if (is_place(o) && o.required) missing = o.flags;
    throw Failure(
        Exit::config,
        Error{{usage.program}, "", missing + " is required", "", usage.program + " --help"});
  }
  const bool several = name == "show" || name == "check";
  if (const std::size_t most = name == "new" ? 2 : required; !several && given.places.size() > most)
    throw Failure(Exit::config, Error{{usage.program},
                                      "",
                                      fmt::format("found {} words", given.places.size()),
                                      fmt::format("{} at most", most),
                                      usage.program + " --help"});
  if (name == "show") return show_files(given);
  if (name == "new") return new_project(given);
  if (name == "check") return check_files(given);
  if (name == "describe") return describe_kind(given);
  if (name == "schema") return put_out(schema_text(given.places[0])), 0;
  if (name == "explain") return put_out(explain_text(explain(given.places[0]))), 0;
  if (name == "times") return put_out(times_text(times_of(given.places[0]), given.failed)), 0;
  if (name == "crate") return crate(given);
  if (name == "doctor") return doctor();
  if (name == "man") return manual(given);
  return put_out(completion_text()), 0;
}

int langer_program(int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "--help";
  if (word == "--help" || word == "-h" || word == "help")
    return put_out(help_text(langer_usage())), 0;
  if (word == "--version") return put_out(version_line("langer") + "\n"), 0;
  std::vector<std::string> names;
  for (const Usage& usage : langer_commands()) {
    names.push_back(usage.program.substr(7));
    if (word == names.back()) return command(usage, word, argc - 1, argv + 1);
  }
  const std::string near = nearest(word, names);
  throw Failure(Exit::config,
                Error{{"langer"},
                      "",
                      fmt::format("there is no command \"{}\"", word),
                      "one of " + list_words(names),
                      near.empty() ? "langer --help" : fmt::format("did you mean \"{}\"?", near)});
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::guarded("langer", [&] { return langer::langer_program(argc, argv); });
}
