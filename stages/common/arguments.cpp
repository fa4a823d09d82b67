#include "arguments.hpp"

#include <CLI/CLI.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/say.hpp"
#include "program.hpp"

namespace langer {

// Hides CLI11 from the header.
struct Arguments::Parser {
  explicit Parser(std::string program) : app("", std::move(program)) {
    app.set_help_flag("-h,--help");
  }
  CLI::App app;
};

bool Arguments::nowhere = false;

Arguments::Arguments(std::string program) : parser_(std::make_unique<Parser>(std::move(program))) {}

Arguments::~Arguments() = default;

void Arguments::flag(const std::string& name, bool& given) { parser_->app.add_flag(name, given); }

void Arguments::text(const std::string& name, std::string& given, bool required) {
  parser_->app.add_option(name, given)->required(required);
}

void Arguments::texts(const std::string& name, std::vector<std::string>& given, bool required) {
  auto* option = parser_->app.add_option(name, given)->required(required);
  if (name[0] == '-') option->allow_extra_args(false);
}

void Arguments::text(const std::string& name, std::vector<std::string>& given, bool required) {
  parser_->app.add_option(name, given)->allow_extra_args(false)->required(required)->expected(1);
}

void Arguments::version() {
  parser_->app.set_version_flag("--version", version_line(parser_->app.get_name()));
}

// CLI11 answers --help only if nothing else is wrong, so the options are searched for it first.
bool Arguments::read(const Usage& usage, int argc, char** argv, int& code) {
  CLI::App& app = parser_->app;
  // Every option must have a help text; see cli/usage.hpp.
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    known.push_back(name);
    if (name.rfind("-", 0) == 0 && !usage.find(name))
      throw std::logic_error("the option " + name + " is not in the table of usage");
  }
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument != "--help" && argument != "-h") continue;
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
    // A misspelt option is reported before the required option that is missing because of it.
    for (const std::string& extra : app.remaining()) {
      if (!extra.starts_with("-")) continue;
      std::string hint = nearest(extra, known);
      if (!hint.empty()) hint = "; did you mean " + hint + "?";
      say_error(fmt::format("{}: unknown option {}{}", app.get_name(), extra, hint));
    }
    say_error(fmt::format("{}: {}\n  hint: {} --help", app.get_name(), e.what(), app.get_name()));
    code = static_cast<int>(Exit::config);
  }
  return false;
}

}  // namespace langer
