#include "identification/statistics/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/tensor/kinematics.hpp"
#include "identification/fit/advice.hpp"
#include "identification/fit/identifiability.hpp"
#include "identification/statistics/candidate_test.hpp"
#include "identification/statistics/within_bounds.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/material_file.hpp"

namespace langer {

namespace {

template <class E>
std::string word(E e) {
  return names(e)[static_cast<std::size_t>(e)];
}

// Noise that is believed in, at least: `least` is the deviation of a weighted value. Where noise is
// not white all of it grows alike.
ResidualNoise noise_at_least(const FitResult& fit, double least) {
  if (fit.noise_model.is_white()) return with_least(fit.noise, least);
  const auto freedom = static_cast<double>(fit.residual.size() - fit.best.p.size());
  const double shown = fit.residual.norm() / std::sqrt(std::max(freedom, 1.));
  if (!(shown > 0)) return with_least(fit.noise, least);
  return with_least(fit.noise, fit.noise.total() * std::max(1., least / shown));
}

// Ranks the candidates for the next test. Correlated residuals carry less information than as many
// independent ones: old and new tests count with the white noise under which the least known
// parameter has the error that it has.
std::vector<AdviceRecord> advice_of(const FitProblem& problem, const FitResult& fit,
                                    const StudyConfig& config, const Identifiability& s,
                                    const std::vector<Candidate>& scenes) {
  // A parameter on a bound is not known to be there: it counts as free.
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < fit.best.p.size(); ++i)
    if (!fit.symmetric[static_cast<std::size_t>(i)]) free.push_back(i);
  if (free.empty()) return {};
  const MatX J = fit.best.J(Eigen::all, free);
  const VecX size = s.size(free);
  const VecX relative_error = s.error(free).cwiseQuotient(size);
  const MatX white =
      covariance(J, std::vector<bool>(free.size(), false), white_noise(s.noise, J.rows()));
  double noise = s.noise;
  Eigen::Index worst = 0;
  if (relative_error.allFinite() && relative_error.maxCoeff(&worst) > 0)
    noise *= relative_error[worst] * size[worst] / std::sqrt(white(worst, worst));
  const MatX known = information(J, size, noise);
  std::vector<Candidate> candidates;
  for (const Candidate& scene : scenes)
    candidates.push_back({scene.name, scene.J(Eigen::all, free), scene.noise * noise / s.noise});
  for (const CandidateChoice& choice : config.candidates) {
    if (choice.kind == DataKind::scene || problem.tests.empty())
      continue;  // without tests it is not known how far one would go
    const auto candidate = candidate_test(choice, fit.material, problem.tests, problem.dilatation);
    if (!candidate) continue;
    FitProblem more = problem;
    more.further.reset();
    more.tests = {*candidate};
    FitResult same_noise = fit;
    same_noise.residual = VecX::Zero(static_cast<Eigen::Index>(more.tests[0].values()));
    MatX J_all;
    if (!jacobian(likelihood_problem(more, same_noise), fit.best.p, J_all)) continue;
    // residuals of a likelihood have a size of their own in each set of tests
    const double units = standardizer(more, fit.noise_model).normalisation(same_noise.residual) /
                         standardizer(problem, fit.noise_model).normalisation(fit.residual);
    candidates.push_back({candidate->name, J_all(Eigen::all, free), noise * units});
  }
  std::vector<AdviceRecord> records;
  for (const Advice& a : advise(known, size, candidates)) {
    AdviceRecord record{
        a.name, a.worst, a.gain,
        std::vector<double>(static_cast<std::size_t>(fit.best.p.size()), std::nan(""))};
    for (std::size_t j = 0; j < free.size(); ++j)
      record.relative[static_cast<std::size_t>(free[j])] = a.relative[j];
    records.push_back(record);
  }
  return records;
}

// the problem with the model that its derivatives make at the optimum: fits to it cost nothing
LeastSquares linearised(const LeastSquares& q, const LeastSquaresResult& best) {
  LeastSquares line = q;
  const VecX r0 = best.r;
  const VecX p0 = best.p;
  const MatX J0 = best.J;
  line.residual = [r0, J0, p0](const VecX& p, VecX& r) {
    r = r0 + J0 * (p - p0);
    return true;
  };
  line.slope = [J0](const VecX&, MatX& J) {
    J = J0;
    return true;
  };
  line.start = best.p;
  return line;
}

// Errors, correlations, profiles, bootstrap and advice of a fit, as a record.
IdentifiabilityRecord identify(const FitProblem& problem, const FitResult& fit,
                               const StudyConfig& config, const ProgressOf& progress,
                               const std::vector<Candidate>& scenes) {
  const LeastSquares q = likelihood_problem(problem, fit);
  const auto say = [&](const char* what) {
    std::function<void(double)> report;
    if (progress) report = progress(what);
    return report;
  };
  const VecX& p = fit.best.p;
  const auto n = p.size();
  double largest = 0;
  for (const Test& t : problem.tests) largest = std::max(largest, t.weight * largest_stress(t));
  ResidualNoise noise = fit.noise;
  if (!problem.further) noise = noise_at_least(fit, config.noise * largest);
  const Identifiability s = identifiability(fit.best.J, p, sizes_of(q, p), fit.left_out, noise);
  const VecX factors = interval_factors(fit.columns, fit.left_out, noise);
  IdentifiabilityRecord record;
  record.names = parameter_names(problem);
  record.symmetric = fit.symmetric;
  record.value.assign(p.data(), p.data() + n);
  record.size.assign(s.size.data(), s.size.data() + n);
  record.noise = s.noise;
  record.rho = noise.rho;
  record.effective = noise.effective;
  record.error = s.error;
  record.singular = s.singular;
  record.correlation = s.correlation;
  record.combination = s.combination;
  if (const auto bounded = within_bounds(problem, fit);
      bounded && bounded->moments.array().isFinite().any()) {
    record.correlation = correlation(bounded->moments);
    for (Eigen::Index i = 0; i < n; ++i)
      if (!std::isnan(record.error[i])) record.error[i] = std::sqrt(bounded->moments(i, i));
  }
  if (s.singular.size() > 0) record.words = sloppy_words(s, record.names, s.singular.size() - 1);
  if (config.profiles.value_or(!problem.further)) {
    ProfileOptions options;
    options.factor = factors;
    options.threads = config.threads;
    options.progress = say("profiles");
    for (const Profile& one :
         profiles([&] { return likelihood_problem(problem, fit); }, p, s.error, s.noise, options))
      record.profiles.push_back(
          {one.value, one.rise, one.low, one.high, one.low_open, one.high_open});
  }
  if (config.bootstrap > 0) {
    BootstrapOptions options;
    options.samples = config.bootstrap;
    options.seed = static_cast<std::uint64_t>(config.seed);
    const VecX growth = growth_of_intervals(fit.columns, fit.left_out, noise);
    options.growth = growth.mean();
    options.threads = config.threads;
    options.progress = say("bootstrap");
    if (noise.rho > 0) options.spread = growth / options.growth;
    const auto maker = [&] {
      if (problem.further) return linearised(q, fit.best);
      return likelihood_problem(problem, fit);
    };
    const Bootstrap b = bootstrap(maker, p, noise, options);
    record.linearised = problem.further != nullptr;
    record.bootstrap = b.samples;
    record.bootstrap_low = b.low;
    record.bootstrap_high = b.high;
  }
  record.advice = advice_of(problem, fit, config, s, scenes);
  return record;
}

// In words: the amount up to which a path is stable.
std::string up_to(const PathStability& p, double end) {
  const double loss = std::min(p.slope_loss, p.ellipticity_loss);
  const bool shear = p.path == Path::simple_shear;
  const auto text = [&](double x) {
    if (shear) return fmt::format("shear {:.3f}", x);
    return fmt::format("stretch {:.3f}", 1 + x);
  };
  if (std::isinf(loss) && std::isfinite(p.end))
    return "stable up to " + text(std::floor(1000 * p.end) / 1000) +
           ", beyond which the material has no stress";
  if (std::isinf(loss)) return "stable up to " + text(end) + ", as far as looked";
  // rounded down: stable as far as said
  std::string s = "stable up to " + text(std::floor(1000 * std::max(0., loss)) / 1000);
  if (loss <= 0) s = "unstable from rest on";
  if (p.slope_loss < p.ellipticity_loss) {
    s += ", where the nominal stress starts to fall";
    if (std::isfinite(p.ellipticity_loss))
      s += "; strong ellipticity is lost at " + text(p.ellipticity_loss);
  } else
    s += ", where strong ellipticity is lost";
  return s;
}

// The loading path of a kind of test; biaxial tests are followed on the equibiaxial path.
Path path_of(TestKind kind) {
  if (kind == TestKind::simple_shear) return Path::simple_shear;
  if (kind == TestKind::pure_shear) return Path::pure_shear;
  if (kind == TestKind::uniaxial) return Path::uniaxial;
  return Path::equibiaxial;
}

// The map of strong ellipticity, and how far the first test itself is stable.
StabilityRecord stability_of(const Material& material, const FitProblem& problem,
                             const StudyConfig& config, const ProgressOf& progress) {
  StabilityRecord record;
  StabilityOptions options;
  options.to = config.stability_to;
  options.points = 51;
  options.stretches = 41;
  options.threads = config.threads;
  if (progress) options.progress = progress("stability map");
  record.map = stability_map(material, options);
  Test first;
  if (!problem.tests.empty()) first = problem.tests.front();
  double own = 0;
  if (!material.fibres.empty()) own = material.fibres[0].alpha_deg;
  const Path path = path_of(first.kind);
  std::vector<double> fine;
  for (int i = 0; i <= 200; ++i) fine.push_back(config.stability_to * i / 200);
  const PathStability along = path_stability(turned(material, first.fibre_angle_deg), path, fine);
  std::string reach;
  if (!first.first.empty()) {
    reach = fmt::format("; data reach {:.2f}",
                        *std::max_element(first.first.begin(), first.first.end()));
  }
  const double angle = own + first.fibre_angle_deg;
  std::string where;
  if (material.fibres.empty()) {
    where = "";
  } else if (angle == 0) {
    where = " along the fibre";
  } else {
    where = fmt::format(" with the fibre at {:g} degrees", angle);
  }
  record.verdict =
      fmt::format("{}{}: {}{}", word(path), where, up_to(along, config.stability_to), reach);
  return record;
}

}  // namespace

// Short names of the free parameters.
std::vector<std::string> parameter_names(const FitProblem& problem) {
  Material law = problem.law;
  std::vector<std::string> result;
  for (const FreeParameter& f : problem.free) {
    if (!f.is_material_number()) result.push_back(f.name);
    for (const MaterialParameter& p : parameters(law))
      if (p.key == f.key) result.push_back(p.name);
  }
  return result;
}

// The range of invariants that the tests cover.
FittedRange fitted_range(const Material& material, const std::vector<Test>& tests) {
  FittedRange range{3, std::vector<double>(material.fibres.size(), 1)};
  for (const Test& t : tests) {
    const std::vector<Vec3> a = specimen_fibres(material, t.fibre_angle_deg);
    for (std::size_t i = 0; i < t.points(); ++i) {
      const PlaneState s = plane_state(material, a, t.kind, t.first[i], t.second_at(i), t.shear);
      if (!s.converged) continue;
      range.I1_bar = std::max(range.I1_bar, s.F.squaredNorm());
      for (std::size_t k = 0; k < a.size(); ++k)
        range.I4_bar[k] = std::max(range.I4_bar[k], (s.F * a[k]).squaredNorm());
    }
  }
  return range;
}

StudyRecord study(const FitProblem& problem, const FitResult& fit, const StudyConfig& config,
                  const ProgressOf& progress, const std::vector<Candidate>& scenes) {
  StudyRecord record;
  record.identifiability = identify(problem, fit, config, progress, scenes);
  if (config.stability) record.stability = stability_of(fit.material, problem, config, progress);
  if (!problem.further) record.range = fitted_range(fit.material, problem.tests);
  return record;
}

// The study in words, for the terminal.
std::vector<std::string> study_lines(const StudyRecord& study) {
  std::vector<std::string> lines;
  if (study.identifiability) {
    const IdentifiabilityRecord& r = *study.identifiability;
    const char* of = r.linearised ? " standard deviations" : " MPa";
    lines.push_back(
        r.rho > 0
            ? fmt::format(
                  "identifiability at a noise of {:.3g}{}, correlated by {:.3f} from value to value "
                  "({:.0f} effective values):",
                  r.noise, of, r.rho, r.effective)
            : fmt::format("identifiability at a noise of {:.3g}{}:", r.noise, of));
    const bool held = std::find(r.symmetric.begin(), r.symmetric.end(), true) != r.symmetric.end();
    for (std::size_t i = 0; i < r.names.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      std::string s;
      if (r.symmetric[i]) {
        s = fmt::format("{:>10}  at an angle of symmetry: no standard error", r.names[i]);
      } else if (std::isnan(r.error[k])) {
        s = fmt::format("{:>10}  not determined, or on its bound", r.names[i]);
      } else {
        s = fmt::format("{:>10}  standard error {:.2g} ({:.0f} %){}", r.names[i], r.error[k],
                        100 * r.error[k] / r.size[i], held ? " with the angle held" : "");
      }
      if (!r.profiles.empty()) {
        const ProfileRecord& p = r.profiles[i];
        // an interval that ends at a bound of the search is marked there
        s += ", ";
        if (held && !r.symmetric[i]) s += "as it turns: ";
        s += "profile ";
        if (p.low_open) s += "[bound] ";
        s += fmt::format("{:.4g} to {:.4g}", p.low, p.high);
        if (p.high_open) s += " [bound]";
      }
      if (r.bootstrap.rows() > 1)
        s += fmt::format(", {}bootstrap {:.4g} to {:.4g}", r.linearised ? "linearised " : "",
                         r.bootstrap_low[k], r.bootstrap_high[k]);
      lines.push_back(s);
    }
    if (!r.words.empty()) lines.push_back("least identifiable combination: " + r.words);
    for (std::size_t i = 0; i < r.advice.size(); ++i) {
      const AdviceRecord& a = r.advice[i];
      lines.push_back(fmt::format(
          "{} {}: worst standard error {:.3g} %, information {:+.2f} nats per parameter",
          i == 0 ? "advice: next" : "        else", a.test, 100 * a.worst, a.gain));
    }
  }
  if (study.stability) {
    const StabilityMap& map = study.stability->map;
    lines.push_back("stability: " + study.stability->verdict);
    for (const PathStability& p : map.paths)
      if (std::isfinite(p.slope_loss) || std::isfinite(p.ellipticity_loss))
        lines.push_back(fmt::format("stability: {}, fibre at {:g} degrees: {}", word(p.path),
                                    p.angle, up_to(p, map.amount.back())));
    const double end = std::min(map.hencky_end, 1.2);
    lines.push_back(
        std::isinf(map.safe_hencky)
            ? fmt::format(
                  "stability: no loss of strong ellipticity found up to a Hencky norm of {:.3g}{}",
                  end, end < 1.2 ? ", beyond which the material has no stress in some states" : "")
            : fmt::format(
                  "stability: strongly elliptic in every state up to a Hencky norm of {:.3g}",
                  map.safe_hencky));
  }
  return lines;
}

// The study as CSV files.
std::vector<TextFile> study_tables(const StudyRecord& study) {
  std::vector<TextFile> files;
  if (study.identifiability) {
    const IdentifiabilityRecord& r = *study.identifiability;
    std::string text =
        "parameter,value,standard_error,relative_percent,profile_low,profile_high,bootstrap_low,bootstrap_high\n";
    for (std::size_t i = 0; i < r.names.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      text += fmt::format("{},{},{},{},", csv_cell(r.names[i]), r.value[i], r.error[k],
                          100 * r.error[k] / r.size[i]);
      if (r.profiles.empty()) {
        text += ",";
      } else {
        text += fmt::format("{},{}", r.profiles[i].low, r.profiles[i].high);
      }
      if (r.bootstrap.rows() < 2) {
        text += ",,\n";
      } else {
        text += fmt::format(",{},{}\n", r.bootstrap_low[k], r.bootstrap_high[k]);
      }
    }
    files.push_back({"identifiability.csv", text});
    for (std::size_t i = 0; i < r.profiles.size(); ++i) {
      std::vector<double> relative, rise;
      for (std::size_t k = 0; k < r.profiles[i].value.size(); ++k) {
        if (!std::isfinite(r.profiles[i].rise[k]) || r.profiles[i].rise[k] > 6) continue;
        relative.push_back(100 * (r.profiles[i].value[k] - r.value[i]) / r.size[i]);
        rise.push_back(r.profiles[i].rise[k]);
      }
      files.push_back({"profile_" + r.names[i] + ".csv",
                       csv({{"change", "percent", relative}, {"rise", "-", rise}})});
    }
    std::string advice = "test,worst_percent,gain";
    for (const std::string& name : r.names) advice += "," + csv_cell(name + "_percent");
    advice += "\n";
    for (const AdviceRecord& a : r.advice) {
      advice += fmt::format("{},{},{}", csv_cell(a.test), 100 * a.worst, a.gain);
      for (double x : a.relative) advice += fmt::format(",{}", 100 * x);
      advice += "\n";
    }
    files.push_back({"advice.csv", advice});
  }
  if (study.stability) {
    const StabilityMap& map = study.stability->map;
    std::string text = "path,fibre_angle_deg,slope_loss,ellipticity_loss,end\n";
    for (const PathStability& p : map.paths)
      text += fmt::format("{},{},{},{},{}\n", word(p.path), p.angle, p.slope_loss,
                          p.ellipticity_loss, p.end);
    files.push_back({"stability.csv", text});
    std::vector<double> l1, l2, value;
    for (Eigen::Index row = 0; row < map.plane.rows(); ++row)
      for (Eigen::Index column = 0; column < map.plane.cols(); ++column) {
        l1.push_back(map.stretch[static_cast<std::size_t>(column)]),
            l2.push_back(map.stretch[static_cast<std::size_t>(row)]);
        value.push_back(map.plane(row, column));
      }
    files.push_back({"stability_plane.csv", csv({{"stretch_x", "-", l1},
                                                 {"stretch_z", "-", l2},
                                                 {"smallest_shear_stiffness", "MPa", value}})});
  }
  return files;
}

}  // namespace langer
