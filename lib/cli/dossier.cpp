#include "cli/dossier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "cli/run_state.hpp"
#include "core/base/counted.hpp"
#include "core/base/error.hpp"
#include "core/base/input_file.hpp"
#include "core/base/text.hpp"
#include "core/base/xml.hpp"
#include "core/config/tree.hpp"
#include "core/hdf5/h5.hpp"
#include "pipeline/plan/run_files.hpp"
#include "report/answer.hpp"
#include "results/store/material_file.hpp"
#include "results/store/provenance.hpp"
#include "results/store/solution_file.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

using Row = std::vector<std::string>;

// A document that is written as Markdown or HTML from the same calls.
class Document {
 public:
  explicit Document(DossierFormat format) : html_(format == DossierFormat::html) {}

  void title(const std::string& text) {
    title_ = text;
    heading(1, text);
  }
  void section(const std::string& text) { heading(2, text); }
  void part(const std::string& text) { heading(3, text); }

  void paragraph(const std::string& text) {
    if (html_) {
      body_ += "<p>" + inline_html(text) + "</p>\n";
    } else {
      body_ += text + "\n\n";
    }
  }

  // What the run does not show, and how to make it.
  void missing(const std::string& what, const std::string& command) {
    ++n_missing_;
    if (html_) {
      body_ += "<p class=\"missing\"><b>Missing:</b> " + inline_html(what) + ". <code>" +
               xml_text(command) + "</code></p>\n";
    } else {
      body_ += "**Missing:** " + what + ". `" + command + "`\n\n";
    }
  }

  void table(const Row& head, const std::vector<Row>& rows) {
    if (html_) {
      body_ += "<table><thead>" + html_row(head, "th") + "</thead><tbody>";
      for (const Row& row : rows) body_ += html_row(row, "td");
      body_ += "</tbody></table>\n";
      return;
    }
    body_ += markdown_row(head);
    body_ += markdown_row(Row(head.size(), "---"));
    for (const Row& row : rows) body_ += markdown_row(row);
    body_ += "\n";
  }

  int n_missing() const { return n_missing_; }

  std::string text() const {
    if (!html_) return body_;
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
           "<meta name=\"color-scheme\" content=\"light dark\"><title>" +
           xml_text(title_) +
           "</title><style>"
           "body{font:15px/1.5 \"Liberation Sans\",Arial,sans-serif;max-width:1000px;"
           "margin:0 auto;padding:20px}"
           "table{border-collapse:collapse;font-size:13.5px;display:block;overflow-x:auto}"
           "th,td{text-align:left;vertical-align:top;padding:3px 10px;border-bottom:1px solid #8886}"
           ".missing{border-left:5px solid #d55e00;padding-left:10px}"
           "code{overflow-wrap:anywhere}"
           "</style></head><body>\n" +
           body_ + "</body></html>\n";
  }

 private:
  void heading(int level, const std::string& text) {
    if (html_) {
      body_ += fmt::format("<h{0}>{1}</h{0}>\n", level, xml_text(text));
    } else {
      body_ += std::string(static_cast<std::size_t>(level), '#') + " " + text + "\n\n";
    }
  }

  // Words between backquotes are code.
  static std::string inline_html(const std::string& text) {
    std::string out;
    bool code = false;
    std::string part;
    for (const char c : text + "`") {
      if (c != '`') {
        part += c;
        continue;
      }
      if (code) {
        out += "<code>" + xml_text(part) + "</code>";
      } else {
        out += xml_text(part);
      }
      part.clear();
      code = !code;
    }
    return out;
  }

  static std::string html_row(const Row& row, const std::string& cell) {
    std::string text = "<tr>";
    for (const std::string& one : row)
      text += "<" + cell + ">" + inline_html(one) + "</" + cell + ">";
    return text + "</tr>";
  }

  // A bar would end the cell, a line break the row.
  static std::string markdown_row(const Row& row) {
    std::string text = "|";
    for (const std::string& one : row) {
      text += " ";
      for (const char c : one) {
        if (c == '|') text += '\\';
        text += c == '\n' ? ' ' : c;
      }
      text += " |";
    }
    return text + "\n";
  }

  bool html_;
  int n_missing_ = 0;
  std::string title_, body_;
};

// The results of a run that are there, by the stage that made them.
struct RunResults {
  std::string folder;
  std::map<std::string, std::vector<std::string>> by_stage;  // targets, below the folder
  std::vector<std::string> not_made;

  std::string path(const std::string& target) const { return (fs::path(folder) / target).string(); }
  const std::vector<std::string>& of(const std::string& stage) const {
    static const std::vector<std::string> nothing;
    const auto found = by_stage.find(stage);
    if (found == by_stage.end()) return nothing;
    return found->second;
  }
};

// The rules of the Makefile say which files belong to the run. Other files in its folder are not
// evidence: nothing says how they were made.
RunResults results_of(const std::string& folder) {
  RunResults results{folder, {}, {}};
  for (const MadeBy& rule : rules_of(folder)) {
    if (!fs::exists(results.path(rule.target)))
      results.not_made.push_back(rule.target);
    else if (fs::path(rule.target).extension() == ".h5")
      results.by_stage[rule.stage].push_back(rule.target);
  }
  return results;
}

// A number of a summary; none if the file does not have it. A missing number is never taken as 0.
std::optional<double> number_of(const std::vector<Summary>& summary, const std::string& name) {
  const auto found = std::ranges::find(summary, name, &Summary::name);
  if (found == summary.end()) return std::nullopt;
  return found->value;
}

// The version and revision of the program that wrote a file; empty in files of old versions.
std::string code_version_of(const std::string& path) {
  const h5::File file = h5::File::open(path);
  if (!file.root().has("provenance")) return "";
  const h5::Group provenance = file.root().group("provenance");
  if (!provenance.has("code_version")) return "";
  return provenance.read_text("code_version");
}

// The tests of a log of ctest, by the folder in their names.
struct TestLog {
  struct Folder {
    int passed = 0, failed = 0;
    std::vector<std::string> with_tolerance;  // claims that name a number
  };
  std::map<std::string, Folder> folders;
  std::string started;
  int n = 0, n_failed = 0;
};

// Names of tests are claims, "solve: the force is that of Hertz to 1e-3": those with a power of ten
// or a percentage say how closely something was verified.
bool names_tolerance(const std::string& claim) {
  for (std::size_t i = 1; i + 1 < claim.size(); ++i) {
    if (!std::isdigit(static_cast<unsigned char>(claim[i - 1]))) continue;
    if (claim[i] == 'e' && claim[i + 1] == '-') return true;
    if (claim[i] == '%' || (claim[i] == ' ' && claim[i + 1] == '%')) return true;
  }
  return false;
}

// A log of ctest has for each test a line "3/12 Test: <name>", its output, and "Test Passed." or
// "Test Failed." after it. Tests of programs have no folder in their names.
TestLog read_test_log(const std::string& path) {
  require_file(path);
  std::ifstream in(path);
  TestLog log;
  std::string test;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("Start testing: ")) log.started = line.substr(15);
    const auto at = line.find(" Test: ");
    const bool is_name = at != std::string::npos && line.find('/') < at &&
                         std::isdigit(static_cast<unsigned char>(line[0]));
    if (is_name) test = line.substr(at + 7);
    const bool passed = line == "Test Passed.";
    const bool failed = line == "Test Failed.";
    if (test.empty() || (!passed && !failed)) continue;
    const auto colon = test.find(':');
    const std::string folder = colon == std::string::npos ? "programs" : test.substr(0, colon);
    TestLog::Folder& counts = log.folders[folder];
    ++log.n;
    if (failed) {
      ++counts.failed;
      ++log.n_failed;
    } else {
      ++counts.passed;
      if (names_tolerance(test)) counts.with_tolerance.push_back(test.substr(colon + 1));
    }
    test.clear();
  }
  if (log.n == 0)
    throw Failure(Exit::input, Error{{path},
                                     "",
                                     "no test in it",
                                     "a log of ctest",
                                     "build/Testing/Temporary/LastTest.log, after make test"});
  return log;
}

// Question, context and risk: the words of the user.
void write_context(Document& document, const DossierWords& words) {
  document.section("1 Context of use");
  const auto say = [&](const char* name, const std::string& text, const char* option) {
    if (text.empty()) {
      document.missing(std::string(name) + " is not stated",
                       "langer dossier RUN " + std::string(option) + " \"...\"");
    } else {
      document.paragraph(std::string(name) + ": " + text);
    }
  };
  say("Question of interest", words.question, "--question");
  say("Context of use", words.use, "--use");
  say("Model risk (influence of the model, consequence of a wrong decision)", words.risk, "--risk");
}

// What was computed, as the first lines of the report say it.
void write_model(Document& document, const RunResults& results) {
  document.section("2 Computational model");
  if (results.of("solve").empty())
    document.missing("the run has no solution", "make -C " + results.folder);
  for (const std::string& target : results.of("solve")) {
    const SolutionReader solution(results.path(target));
    const report::Answer answer = report::answer_of(solution, "");
    document.part(target);
    document.paragraph(answer.sentence + ".");
    std::vector<Row> rows;
    for (const report::Answer::Fact& fact : answer.facts) rows.push_back({fact.name, fact.text});
    document.table({"part", "value"}, rows);
  }
}

// Which programs made the files, and what was verified about them. The tests are those of a build,
// which a run does not hold, so their log is named by the user.
void write_code_verification(Document& document, const RunResults& results,
                             const DossierWords& words) {
  document.section("3 Code verification");
  document.part("Software quality assurance");
  std::map<std::string, std::vector<std::string>> versions;
  for (const auto& [stage, targets] : results.by_stage)
    for (const std::string& target : targets)
      versions[text_or(code_version_of(results.path(target)), "not recorded")].push_back(target);
  std::vector<Row> rows;
  for (const auto& [version, targets] : versions)
    rows.push_back({version, fmt::format("{}", fmt::join(targets, ", "))});
  document.table({"version that made it", "files"}, rows);
  if (versions.size() > 1)
    document.missing("files of one version only: the run mixes several",
                     "make STRICT=1 -C " + results.folder);
  document.part("Numerical code verification");
  if (words.tests.empty()) {
    document.missing("the log of the tests of this version",
                     "make test && langer dossier " + results.folder +
                         " --tests build/Testing/Temporary/LastTest.log");
    return;
  }
  const TestLog log = read_test_log(words.tests);
  document.paragraph(fmt::format(
      "{} tests ran on {}, {} failed (`{}`). Tests compare with closed forms, finite differences, "
      "manufactured solutions, symmetries and other programs; docs/tested.md says which.",
      log.n, log.started, log.n_failed, words.tests));
  std::vector<Row> counts;
  for (const auto& [folder, tests] : log.folders)
    counts.push_back({folder, std::to_string(tests.passed), std::to_string(tests.failed),
                      std::to_string(tests.with_tolerance.size())});
  document.table({"folder", "passed", "failed", "with a tolerance in their name"}, counts);
  std::vector<Row> claims;
  for (const auto& [folder, tests] : log.folders)
    for (const std::string& claim : tests.with_tolerance) claims.push_back({folder, claim});
  document.table({"folder", "verified claim with its tolerance"}, claims);
}

// Errors of mesh, increments and solver, from the summary and the steps of a solution.
void write_calculation(Document& document, const RunResults& results) {
  document.section("4 Calculation verification");
  document.part("Discretisation error");
  std::vector<Row> errors;
  std::vector<Row> solver;
  std::vector<std::string> without;
  for (const std::string& target : results.of("solve")) {
    const SolutionReader solution(results.path(target));
    const std::vector<Summary> summary = solution.summary();
    bool any = false;
    for (const Summary& s : summary) {
      if (!s.name.ends_with("_error")) continue;
      const std::string name = s.name.substr(0, s.name.size() - 6);
      const auto part = [&](const char* what) {
        const auto found = number_of(summary, name + "_error_" + what);
        if (!found) return std::string("not estimated");
        return fmt::format("{:.3g}", *found);
      };
      std::string limit = "none";
      if (const auto found = number_of(summary, name + "_limit"))
        limit = fmt::format("{:.6g}", *found);
      // Of an estimate without a limit the summary does not have the number itself.
      std::string value = "in the steps";
      std::string percent = "-";
      const report::KnownError known =
          report::known_error(summary, name, std::numeric_limits<double>::quiet_NaN());
      if (std::isfinite(known.value)) {
        value = report::rounded(known.value, known.percent);
        percent = fmt::format("{:.2g}", known.percent);
      }
      errors.push_back({target, name, s.unit, value, fmt::format("{:.3g}", s.value), percent,
                        part("cells"), part("increments"), part("scatter"), limit});
      any = true;
    }
    if (!any) without.push_back(target);
    double residual = 0;
    double penetration = 0;
    for (int i = 0; i < solution.n_steps(); ++i) {
      const StepRecord step = solution.step(i);
      residual = std::max(residual, step.residual);
      penetration = std::max(penetration, value_or(step.scalars, "penetration", 0.0));
    }
    solver.push_back({target, std::to_string(solution.n_steps()), fmt::format("{:.2g}", residual),
                      fmt::format("{:.2g}", penetration)});
  }
  if (!errors.empty())
    document.table({"solution", "quantity", "unit", "value", "error bar", "%", "mesh", "increments",
                    "scatter", "extrapolated limit"},
                   errors);
  for (const std::string& target : without)
    document.missing("an error estimate of " + target,
                     "accuracy: 2% (or estimate: recovery) in the solve config, then make");
  document.part("Numerical solver error");
  if (!solver.empty())
    document.table({"solution", "steps", "largest relative residual", "largest penetration, mm"},
                   solver);
  // Use error is what a person may do wrong: results of another config than the one that is shown,
  // or of other data. make and the content ids in the files find both.
  document.part("Use error");
  const std::vector<StepReasons> steps = explain(results.folder);
  std::vector<Row> stale;
  for (const StepReasons& step : steps)
    for (const std::string& reason : step.reasons) stale.push_back({step.target, reason});
  if (stale.empty()) {
    document.paragraph(
        fmt::format("All {} steps are up to date with their configs and inputs (`langer explain "
                    "{}`). Each file holds its whole config and the content ids of its inputs.",
                    steps.size(), results.folder));
  } else {
    document.table({"file", "would be made again, since"}, stale);
    document.missing("results of the present configs", "make -C " + results.folder);
  }
}

// Parameters with their intervals; what they rest on.
void write_inputs(Document& document, const RunResults& results) {
  document.part("Model inputs: parameters and their uncertainty");
  std::vector<Row> rows;
  for (const std::string& target : results.of("fit")) {
    const MaterialFile file = read_material(results.path(target));
    if (!file.fit) continue;
    for (const FittedParameter& p : file.fit->parameters) {
      const auto [low, high] = interval_95(p);
      std::string interval = "not determined by the data";
      if (std::isfinite(low) && std::isfinite(high))
        interval = fmt::format("{:.6g} to {:.6g}", low, high);
      rows.push_back({target, p.name, p.unit, fmt::format("{:.5g}", p.value), interval});
    }
  }
  if (rows.empty()) {
    document.missing("a fitted material with a covariance",
                     "a node {stage: fit} in the pipeline; langer new fit");
  } else {
    document.table({"material", "parameter", "unit", "value", "95 % interval"}, rows);
  }
  // All measures are listed with their own names: Morris, Sobol and one-at-a-time studies have
  // different ones, and none of them is better for every question.
  document.part("Sensitivity of the result to its inputs");
  std::vector<Row> sensitivity;
  for (const std::string& target : results.of("sensitivity"))
    for (const Summary& s : read_summary(results.path(target)))
      sensitivity.push_back({target, s.name, fmt::format("{:.4g}", s.value), s.unit});
  if (sensitivity.empty()) {
    document.missing("a sensitivity analysis",
                     "a node {stage: sensitivity} in the pipeline; langer describe sensitivity");
  } else {
    document.table({"file", "measure", "value", "unit"}, sensitivity);
  }
  // What the covariance of the parameters does to the forces. Parts without one parameter, such as
  // force_deviation_without_a1, stay in the file.
  document.part("Uncertainty of the result");
  std::vector<Row> deviations;
  for (const std::string& target : results.of("solve"))
    for (const Summary& s : read_summary(results.path(target)))
      if (s.name.ends_with("_deviation"))
        deviations.push_back({target, s.name, fmt::format("{:.4g}", s.value), s.unit});
  if (deviations.empty()) {
    document.missing("the uncertainty that the parameters give the result",
                     "uncertainty: linear in the solve config, behind a fitted material");
  } else {
    document.table({"solution", "standard deviation of", "value", "unit"}, deviations);
  }
}

// How well the law follows what it was fitted to, and what else was measured.
void write_comparison(Document& document, const RunResults& results) {
  document.part("Comparison with experiments: calibration");
  std::vector<Row> rows;
  for (const std::string& target : results.of("fit")) {
    const MaterialFile file = read_material(results.path(target));
    if (!file.fit) continue;
    for (const FittedTest& test : file.fit->tests)
      rows.push_back({target, test.name, test.kind, std::to_string(test.first.size()),
                      fmt::format("{:.4f}", test.r2),
                      fmt::format("{:.2g}", test.mean_error_percent),
                      fmt::format("{:.2g}", test.max_error_percent)});
    for (const FittedCurve& curve : file.fit->curves)
      rows.push_back({target, curve.name, curve.quantity, std::to_string(curve.x.size()),
                      fmt::format("{:.4f}", curve.r2),
                      fmt::format("{:.2g}", curve.mean_error_percent),
                      fmt::format("{:.2g}", curve.max_error_percent)});
  }
  if (rows.empty()) {
    document.missing("measured curves", "a node {stage: fit} in the pipeline");
  } else {
    document.table({"material", "test", "kind", "points", "R2", "mean error, %", "largest, %"},
                   rows);
    document.paragraph(
        "These tests calibrate the parameters. Agreement with them is no validation.");
  }
  // Validation needs data that the fit has not seen. A figure of the post config that draws
  // measured points over a curve is such a comparison; what it shows is for the reader to judge.
  document.part("Comparison with experiments: validation");
  std::vector<Row> measured;
  for (const std::string& target : results.of("post")) {
    const Tree config = parse_yaml(read_origin(results.path(target)).identity.config, target);
    const Tree* figures = config.find("figures");
    if (!figures) continue;
    for (const auto& [name, figure] : figures->map) {
      const Tree* points = figure.find("points");
      const Tree* file = points ? points->find("file") : nullptr;
      if (file)
        measured.push_back({target, name, file->scalar,
                            (fs::path(target).parent_path() / (name + ".svg")).string()});
    }
  }
  if (measured.empty()) {
    document.missing("data that the fit did not use, compared with the prediction",
                     "figures: {<name>: {points: {file: measured.csv, ...}}} in the post config");
  } else {
    document.table({"curves", "figure", "measured in", "picture"}, measured);
  }
}

// Whether the scene stays within what the tests cover, and is stable.
void write_applicability(Document& document, const RunResults& results) {
  document.section("6 Applicability");
  std::vector<Row> rows;
  for (const std::string& target : results.of("solve")) {
    const SolutionReader solution(results.path(target));
    double outside = -1;
    double volume = 0;
    double negative = 0;
    bool checked = false;
    for (int i = 0; i < solution.n_steps(); ++i) {
      const auto scalars = solution.step(i).scalars;
      outside = std::max(outside, value_or(scalars, "outside_fit", -1.0));
      volume = std::max(volume, value_or(scalars, "volume_change", 0.0));
      checked = checked || scalars.contains("negative_eigenvalues");
      negative = std::max(negative, std::abs(value_or(scalars, "negative_eigenvalues", 0.0)));
    }
    std::string beyond = "not known: the material was not fitted";
    if (outside >= 0) beyond = fmt::format("{:.3g} %", 100 * outside);
    std::string stable = "not checked (stability: each_step)";
    if (checked) stable = negative == 0 ? "yes" : "no";
    rows.push_back({target, beyond, fmt::format("{:.3g} %", 100 * volume), stable});
  }
  if (!rows.empty())
    document.table({"solution", "volume strained beyond the fitted tests",
                    "largest change of an element's volume", "every equilibrium stable"},
                   rows);
  document.paragraph(
      "Whether these quantities answer the question of section 1, and whether the tests resemble "
      "its conditions, is for the reader to judge.");
}

// The credibility factors of the standard and where this document has evidence for them.
void write_factors(Document& document) {
  document.section("7 Credibility factors");
  document.paragraph(
      "The thirteen factors of ASME V&V 40-2018. Grades and goals follow from the model risk; this "
      "document gives the evidence.");
  document.table(
      {"activity", "factor", "evidence"},
      {{"verification", "software quality assurance", "section 3"},
       {"verification", "numerical code verification", "section 3"},
       {"verification", "discretisation error", "section 4"},
       {"verification", "numerical solver error", "section 4"},
       {"verification", "use error", "section 4"},
       {"validation: model", "model form", "section 5, comparison: calibration"},
       {"validation: model", "model inputs", "section 5"},
       {"validation: comparator", "test samples", "section 5; the paper of the data"},
       {"validation: comparator", "test conditions", "section 5; the paper of the data"},
       {"validation: assessment", "equivalency of input parameters", "section 5"},
       {"validation: assessment", "output comparison", "section 5"},
       {"applicability", "relevance of the quantities of interest", "section 6"},
       {"applicability", "relevance of the validation to the context of use", "section 6"}});
}

}  // namespace

std::string dossier_text(const std::string& folder, const DossierWords& words,
                         DossierFormat format) {
  const RunResults results = results_of(folder);
  Document document(format);
  document.title("Verification and validation of " + fs::path(folder).lexically_normal().string());
  document.paragraph(
      "After ASME V&V 40-2018, written by `langer dossier`. All numbers are read from the files of "
      "the run; `langer show FILE` prints each of them.");
  for (const std::string& target : results.not_made)
    document.missing(target + " is not made", "make -C " + folder);
  write_context(document, words);
  write_model(document, results);
  write_code_verification(document, results, words);
  write_calculation(document, results);
  document.section("5 Validation");
  write_inputs(document, results);
  write_comparison(document, results);
  write_applicability(document, results);
  write_factors(document);
  document.section("8 What is missing");
  document.paragraph(
      fmt::format("{} above.", counted(static_cast<std::size_t>(document.n_missing()), "gap")));
  return document.text();
}

}  // namespace langer
