#include "identification/laws/law_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/base/student.hpp"
#include "identification/fit/left_out.hpp"
#include "identification/setup/law_catalogue.hpp"
#include "identification/statistics/candidate_test.hpp"
#include "mechanics/material/ellipticity.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double aicc_alike = 4;

// of the points of at least a tenth of the largest strain [MPa]
double secant_modulus(const std::vector<Test>& tests) {
  double greatest = 0;
  for (const Test& test : tests) {
    double most = 0;
    for (const double x : test.first) most = std::max(most, std::abs(strain_of(test.kind, x)));
    for (std::size_t i = 0; i < test.points(); ++i) {
      const double strain = std::abs(strain_of(test.kind, test.first[i]));
      if (strain > 0 && strain >= 0.1 * most)
        greatest = std::max(greatest, std::abs(test.stress_x[i]) / strain);
    }
  }
  return greatest;
}

// Start values in MPa are those of a tissue with another modulus.
void scale_starts(FitProblem& problem, double factor) {
  for (FreeParameter& p : problem.free) {
    for (const MaterialParameter& number : parameters(problem.law)) {
      if (number.key != p.key || !number.modulus()) continue;
      p.start = std::clamp(p.start * factor, p.lower, p.upper);
    }
  }
}

FitConfig config_of(const FitConfig& config, const CatalogueLaw& law) {
  FitConfig one = config;
  one.laws.clear();
  one.discover.reset();
  one.law = law.law;
  one.parameters = law.parameters;
  one.ties = law.ties;
  if (one.bounds == Bounds::custom) one.bounds = Bounds::admissible;
  return one;
}

// Whether waves of shear have a real speed in every state of the tests.
void set_ellipticity(LawOutcome& law) {
  constexpr std::size_t most = 60;
  law.elliptic = true;
  const Material& material = law.fit.material;
  for (const Test& test : law.problem.tests) {
    const std::vector<Vec3> a = specimen_fibres(material, test.fibre_angle_deg);
    const std::size_t step = std::max<std::size_t>(1, (test.points() + most - 1) / most);
    for (std::size_t k = 0; k < test.points(); k += step) {
      // the last point is among those that are looked at
      const std::size_t i = test.points() - 1 - k;
      const PlaneState state =
          plane_state(material, a, test.kind, test.first[i], test.second_at(i), test.shear);
      double value = unknown;
      if (state.converged) value = smallest_shear_stiffness(material, state.F, a).value;
      if (std::isgreaterequal(value, 0)) continue;
      law.elliptic = false;
      law.lost =
          fmt::format("in {} at strain {:.3g}", test.name, strain_of(test.kind, test.first[i]));
    }
  }
}

// The law fitted to the tests; `failed` says why where there is no fit.
LawOutcome fitted(const FitConfig& config, const CatalogueLaw& law) {
  LawOutcome one;
  one.name = law.name;
  one.config = config_of(config, law);
  one.problem = fit_problem(one.config);
  scale_starts(one.problem, secant_modulus(one.problem.tests) / catalogue_modulus);
  try {
    one.fit = fit(one.problem, {one.config.searches(), static_cast<unsigned>(config.seed), {}});
    if (!one.fit.best.converged) one.failed = one.fit.best.why;
  } catch (const Failure& failure) {
    // more parameters than values: another law may still be fitted
    if (failure.code() != Exit::input) throw;
    one.failed = failure.errors().front().found;
  }
  return one;
}

LawOutcome outcome_of(const FitConfig& config, const CatalogueLaw& law) {
  LawOutcome one = fitted(config, law);
  if (!one.failed.empty() || !one.fit.best.converged) return one;
  for (std::size_t i = 0; i < one.config.parameters.size(); ++i)
    one.config.parameters[i].start = one.fit.best.p[static_cast<Eigen::Index>(i)];
  const std::size_t n = one.problem.tests.size();
  one.left_out.assign(n, unknown);
  one.left_out_error = unknown;
  if (n >= 2) {
    one.left_out = left_out_errors(one.problem, one.fit);
    double sum = 0;
    for (const double error : one.left_out) sum += error * error;
    one.left_out_error = std::sqrt(sum / static_cast<double>(n));
  }
  set_ellipticity(one);
  return one;
}

// Student's paired test of the errors over the tests, 5 %, two-sided.
bool same_errors(const LawOutcome& a, const LawOutcome& b) {
  const std::size_t n = a.left_out.size();
  if (n < 2) return false;
  double mean = 0;
  for (std::size_t i = 0; i < n; ++i)
    mean += (b.left_out[i] - a.left_out[i]) / static_cast<double>(n);
  double square = 0;
  double size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double d = b.left_out[i] - a.left_out[i] - mean;
    square += d * d;
    size = std::max(size, a.left_out[i]);
  }
  const auto freedom = static_cast<double>(n - 1);
  const double error = std::sqrt(square / freedom / static_cast<double>(n));
  // errors that agree to a hundredth are the same whatever their scatter
  return std::abs(mean) <= std::max(0.01 * size, student_95(freedom) * error);
}

bool same_likelihood(const LawOutcome& a, const LawOutcome& b) {
  return std::abs(a.fit.quality.aicc - b.fit.quality.aicc) < aicc_alike;
}

// chi-square of the law in its own units after a fit from where it is
double chi_square(FitProblem problem, const VecX& start, double noise) {
  problem.noise = NoiseKind::white;
  const LeastSquaresResult found = fit_from(problem, start);
  if (!std::isfinite(found.cost)) return unknown;
  return 2 * found.cost / (noise * noise);
}

// By how much `other` misses the candidate in which `truth` is right, in standard deviations.
double missed_by(const LawOutcome& truth, const LawOutcome& other, const CandidateChoice& choice,
                 std::string& name) {
  const auto test =
      candidate_test(choice, truth.fit.material, truth.problem.tests, truth.problem.dilatation);
  if (!test) return unknown;
  name = test->name;
  const VecX& r = truth.fit.residual;
  const auto freedom = std::max(1., static_cast<double>(r.size() - truth.fit.best.p.size()));
  const double noise = std::max(r.norm() / std::sqrt(freedom), 1e-300);
  FitProblem more = other.problem;
  more.tests.push_back(*test);
  const double before = chi_square(other.problem, other.fit.best.p, noise);
  const double after = chi_square(more, other.fit.best.p, noise);
  return std::sqrt(std::max(0., after - before));
}

std::vector<Separation> separations_of(const LawOutcome& a, const LawOutcome& b,
                                       const StudyConfig& study) {
  std::vector<Separation> all;
  if (is_viscous(a.problem.law) || a.problem.dilatation == Dilatation::compressible) return all;
  for (const CandidateChoice& choice : study.candidates) {
    if (choice.kind == DataKind::scene) continue;
    std::string name, other_name;
    const double one = missed_by(a, b, choice, name);
    const double two = missed_by(b, a, choice, other_name);
    if (std::isnan(one) || std::isnan(two)) continue;
    all.push_back({name, std::min(one, two)});
  }
  std::stable_sort(all.begin(), all.end(), [](const Separation& x, const Separation& y) {
    return x.deviations > y.deviations;
  });
  return all;
}

void refuse_if_none(const std::vector<LawOutcome>& laws, const std::string& key) {
  for (const LawOutcome& law : laws)
    if (law.failed.empty()) return;
  std::string why;
  for (const LawOutcome& law : laws)
    why += fmt::format("{}{}: {}", why.empty() ? "" : "; ", law.name, law.failed);
  throw Failure(Exit::not_converged,
                Error{{}, key, "no law has an optimum: " + why, "", "more starts, or other laws"});
}

// the best first; those without an optimum last
void rank(LawComparison& comparison) {
  comparison.by_prediction =
      std::all_of(comparison.laws.begin(), comparison.laws.end(), [](const LawOutcome& law) {
        return !law.failed.empty() || std::isfinite(law.left_out_error);
      });
  const auto value = [&](const LawOutcome& law) {
    if (!law.failed.empty()) return std::numeric_limits<double>::infinity();
    double x = law.fit.quality.aicc;
    if (comparison.by_prediction) x = law.left_out_error;
    if (std::isnan(x)) return std::numeric_limits<double>::max();
    return x;
  };
  std::stable_sort(comparison.laws.begin(), comparison.laws.end(),
                   [&](const LawOutcome& a, const LawOutcome& b) { return value(a) < value(b); });
  const LawOutcome& best = comparison.laws.front();
  for (std::size_t i = 1; i < comparison.laws.size(); ++i) {
    LawOutcome& law = comparison.laws[i];
    if (!law.failed.empty()) continue;
    law.same_prediction = !comparison.by_prediction || same_errors(best, law);
    law.indistinguishable = law.same_prediction && same_likelihood(best, law);
  }
}

void set_separations(LawComparison& comparison, const StudyConfig& study) {
  const auto& laws = comparison.laws;
  if (laws.size() < 2 || !laws[1].failed.empty()) return;
  comparison.separations = separations_of(laws[0], laws[1], study);
}

}  // namespace

LawComparison compare_laws(const FitConfig& config, const LawProgress& progress) {
  LawComparison comparison;
  for (const std::string& name : config.laws) {
    if (progress) progress(name);
    comparison.laws.push_back(outcome_of(config, *catalogue_law(name)));
  }
  refuse_if_none(comparison.laws, "laws");
  rank(comparison);
  set_separations(comparison, config.study.value_or(StudyConfig{}));
  return comparison;
}

// Forward selection with exchange: the best law of k terms begins with that of k - 1, and each of
// its terms may be replaced as long as this lowers the cost.
LawComparison discover_terms(const FitConfig& config, const LawProgress& progress) {
  std::vector<std::string> library = config.discover->terms;
  if (library.empty()) library = term_names();
  std::map<std::string, LawOutcome> known;
  const auto made = [&](const std::vector<std::string>& chosen) -> const LawOutcome& {
    const CatalogueLaw law = *law_of_terms(chosen);
    const auto found = known.find(law.name);
    if (found != known.end()) return found->second;
    FitConfig quick = config;
    // the first searches decide which terms stay; the laws of the front are searched in full
    quick.starts = std::min(config.searches(), 4);
    return known.emplace(law.name, fitted(quick, law)).first->second;
  };
  const auto score = [&](const std::vector<std::string>& chosen) {
    const LawOutcome& one = made(chosen);
    if (!one.failed.empty()) return std::numeric_limits<double>::infinity();
    return one.fit.quality.aicc;
  };
  LawComparison comparison;
  std::vector<std::string> chosen;
  const int most = std::min(config.discover->most, static_cast<int>(library.size()));
  for (int k = 1; k <= most; ++k) {
    std::vector<std::string> best;
    double lowest = std::numeric_limits<double>::infinity();
    const auto consider = [&](const std::vector<std::string>& set) {
      const double value = score(set);
      if (!(value < lowest)) return false;
      lowest = value;
      best = set;
      return true;
    };
    for (const std::string& term : library) {
      if (std::find(chosen.begin(), chosen.end(), term) != chosen.end()) continue;
      std::vector<std::string> set = chosen;
      set.push_back(term);
      consider(set);
    }
    if (best.empty()) break;
    for (bool again = k > 1; again;) {
      again = false;
      const std::vector<std::string> from = best;
      for (std::size_t i = 0; i < from.size(); ++i) {
        for (const std::string& term : library) {
          if (std::find(from.begin(), from.end(), term) != from.end()) continue;
          std::vector<std::string> set = from;
          set[i] = term;
          again = consider(set) || again;
        }
      }
    }
    chosen = best;
    const CatalogueLaw law = *law_of_terms(chosen);
    if (progress) progress(law.name);
    LawOutcome one = outcome_of(config, law);
    one.terms = k;
    comparison.laws.push_back(std::move(one));
  }
  if (comparison.laws.empty())
    throw Failure(Exit::not_converged,
                  Error{{}, "discover", "no law of one term has an optimum", "", "other terms"});
  refuse_if_none(comparison.laws, "discover");
  rank(comparison);
  set_separations(comparison, config.study.value_or(StudyConfig{}));
  return comparison;
}

RecordTable law_table(const LawComparison& comparison) {
  RecordTable table;
  table.name = "laws";
  table.row = "law";
  for (const char* name : {"parameters", "aicc", "left_out_error", "elliptic", "bic", "r2",
                           "mean_error", "indistinguishable", "converged"})
    table.column(name);
  for (const LawOutcome& law : comparison.laws) {
    const bool found = law.failed.empty();
    const FitQuality& q = law.fit.quality;
    const auto add = [&](const char* column, double value) {
      table.column(column).values.push_back(found ? value : unknown);
    };
    const bool first = &law == &comparison.laws.front();
    table.rows.push_back(law.name);
    table.column("parameters").values.push_back(static_cast<double>(law.problem.free.size()));
    add("aicc", q.aicc);
    add("left_out_error", law.left_out_error);
    add("elliptic", law.elliptic ? 1 : 0);
    add("bic", q.bic);
    add("r2", q.r2);
    add("mean_error", q.mean_error_percent / 100);
    add("indistinguishable", first || law.indistinguishable ? 1 : 0);
    table.column("converged").values.push_back(found ? 1 : 0);
  }
  return table;
}

RecordTable term_table(const LawComparison& comparison) {
  RecordTable table = law_table(comparison);
  table.name = "terms";
  // the front stands in the order of the number of terms
  std::vector<std::size_t> order(comparison.laws.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return comparison.laws[a].terms < comparison.laws[b].terms;
  });
  RecordTable front;
  front.name = "terms";
  front.row = "law";
  front.column("terms");
  for (const std::size_t i : order) {
    front.rows.push_back(table.rows[i]);
    front.column("terms").values.push_back(comparison.laws[i].terms);
    for (const RecordColumn& column : table.columns)
      front.column(column.name, column.unit).values.push_back(column.values[i]);
  }
  return front;
}

std::string separation_csv(const LawComparison& comparison) {
  std::string text = "test,deviations\n";
  for (const Separation& one : comparison.separations)
    text += fmt::format("{},{:.6g}\n", csv_cell(one.test), one.deviations);
  return text;
}

std::vector<std::string> law_lines(const LawComparison& comparison) {
  std::vector<std::string> lines;
  std::size_t width = 4;
  for (const LawOutcome& law : comparison.laws) width = std::max(width, law.name.size());
  lines.push_back(
      fmt::format("{:<{}}  numbers       AICc  left-out error  elliptic", "law", width));
  for (const LawOutcome& law : comparison.laws) {
    if (!law.failed.empty()) {
      lines.push_back(fmt::format("{:<{}}  no optimum: {}", law.name, width, law.failed));
      continue;
    }
    std::string left = "-";
    if (std::isfinite(law.left_out_error)) left = fmt::format("{:.2f} %", 100 * law.left_out_error);
    lines.push_back(fmt::format("{:<{}}  {:>7}  {:>9.1f}  {:>14}  {}", law.name, width,
                                law.problem.free.size(), law.fit.quality.aicc, left,
                                law.elliptic ? "yes" : "no: lost " + law.lost));
  }
  const LawOutcome& best = comparison.laws.front();
  if (!comparison.by_prediction)
    lines.push_back("ordered by AICc: a single test, or one without the others, predicts nothing");
  std::string alike, by_likelihood;
  for (std::size_t i = 1; i < comparison.laws.size(); ++i) {
    const LawOutcome& law = comparison.laws[i];
    std::string* list = nullptr;
    if (law.indistinguishable) list = &alike;
    if (!law.indistinguishable && law.same_prediction && comparison.by_prediction)
      list = &by_likelihood;
    if (!list) continue;
    if (!list->empty()) *list += ", ";
    *list += law.name;
  }
  if (!alike.empty())
    lines.push_back(fmt::format("these tests do not distinguish {} from {}", best.name, alike));
  if (!by_likelihood.empty())
    lines.push_back(
        fmt::format("{} predicts no worse than {} within chance; AICc distinguishes them",
                    by_likelihood, best.name));
  if (comparison.separations.empty()) return lines;
  const Separation& first = comparison.separations.front();
  if (first.deviations < 3) {
    lines.push_back(
        fmt::format("no homogeneous test of this range separates {} from {}: the best, {}, "
                    "by {:.1f} standard deviations of the noise",
                    best.name, comparison.laws[1].name, first.test, first.deviations));
    return lines;
  }
  lines.push_back(fmt::format(
      "{} and {} would be separated by {}: one of them would miss it by {:.1f} standard deviations "
      "of the noise in all",
      best.name, comparison.laws[1].name, first.test, first.deviations));
  return lines;
}

}  // namespace langer
