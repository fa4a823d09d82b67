#include "pipeline/plan/snakefile.hpp"

#include <fmt/format.h>

#include <set>

#include "core/base/quoted.hpp"
#include "core/base/text.hpp"
#include "core/base/version.hpp"

namespace langer::pipeline {

namespace {

// The name of a rule, which must be a name of Python: alpha_000_solve_ for
// alpha_000/solve/solution.h5. The final underscore keeps it apart from the words of Python and
// Snakemake.
std::string rule_name(const std::string& target, std::set<std::string>& taken) {
  std::string name = target.substr(0, target.rfind('/'));
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  if (std::isdigit(static_cast<unsigned char>(name[0]))) name = "_" + name;
  name += "_";
  while (!taken.insert(name).second) name += "_";
  return name;
}

// Paths as a list of Python. They have safe characters only (is_safe_path).
std::string quoted_list(const std::vector<std::string>& paths) {
  std::string s;
  for (const std::string& path : paths) append(s, ", ", "\"" + path + "\"");
  return s;
}

}  // namespace

// One rule for each step, as in the Makefile.
std::string snakefile_text(const std::string& pipeline_file, const std::string& bin,
                           const std::vector<Rule>& rules, const std::vector<std::string>& finals) {
  std::string text = fmt::format("{}{} from {}: do not edit\n", planned_by, version, pipeline_file);
  text += fmt::format(
      "#   snakemake --cores 4 [-k] [--config launch=\"srun -n1\"]\n"
      "import os\n"
      "os.environ.setdefault(\"OPENBLAS_NUM_THREADS\", \"1\")  "
      "# its threads come when `blas_threads` asks for them\n"
      "BIN = config.get(\"bin\", {})\n"
      "LAUNCH = config.get(\"launch\", \"\")\n\n"
      "rule all:\n"
      "    input: {}\n",
      quoted(bin), quoted_list(finals));
  std::set<std::string> taken{"all"};
  for (const Rule& rule : rules) {
    const std::string log = rule.target.substr(0, rule.target.rfind('.')) + ".log";
    text += fmt::format(
        "\nrule {}:\n"
        "    input: {}\n"
        "    output: \"{}\"\n"
        "    threads: {}\n"
        "    shell: \"{{LAUNCH}} {{BIN}}/{} {} --log {} -o {{output}}\"\n",
        rule_name(rule.target, taken), quoted_list(rule.prerequisites), rule.target, rule.threads,
        rule.program, rule.arguments, log);
  }
  return text;
}

}  // namespace langer::pipeline
