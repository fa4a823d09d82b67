#include "results/store/study_record.hpp"

#include <fmt/format.h>

#include "core/base/text.hpp"
#include "results/store/matrices.hpp"

namespace langer {

namespace {

// Standard errors, correlations, profiles, bootstrap and advice; parts that the study lacks are
// left out.
void write_identifiability(const h5::Group& group, const IdentifiabilityRecord& r) {
  group.attribute("order", fmt::format("{}", fmt::join(r.names, " ")));
  group.attribute("words", r.words);
  group.write_scalar("noise", r.noise, "MPa");
  group.write_scalar("residual_correlation", r.rho, "-");
  group.write_scalar("effective_values", r.effective, "-");
  write_vector(group, "error", r.error, "");
  write_vector(group, "size", r.size, "");
  write_vector(group, "singular", r.singular, "-");
  write_matrix(group, "correlation", r.correlation, "-");
  write_matrix(group, "combination", r.combination, "-");
  if (!r.profiles.empty()) {
    const h5::Group profiles = group.make_group("profiles");
    for (std::size_t i = 0; i < r.profiles.size(); ++i) {
      const ProfileRecord& p = r.profiles[i];
      const h5::Group one = profiles.make_group(r.names[i]);
      write_vector(one, "value", p.value, "");
      write_vector(one, "rise", p.rise, "-");
      write_vector(one, "interval", std::vector{p.low, p.high}, "");
      one.attribute("low_open", std::int64_t{p.low_open});
      one.attribute("high_open", std::int64_t{p.high_open});
    }
  }
  if (r.bootstrap.rows() > 0) {
    const h5::Group bootstrap = group.make_group("bootstrap");
    write_matrix(bootstrap, "samples", r.bootstrap, "");
    MatX interval(r.bootstrap_low.size(), 2);
    interval << r.bootstrap_low, r.bootstrap_high;
    write_matrix(bootstrap, "interval", interval, "");
  }
  if (!r.advice.empty()) {
    const h5::Group advice = group.make_group("advice");
    std::vector<std::string> tests;
    std::vector<double> worst, gain;
    MatX relative(static_cast<Eigen::Index>(r.advice.size()),
                  static_cast<Eigen::Index>(r.names.size()));
    for (const AdviceRecord& a : r.advice) {
      for (std::size_t j = 0; j < a.relative.size(); ++j)
        relative(static_cast<Eigen::Index>(tests.size()), static_cast<Eigen::Index>(j)) =
            a.relative[j];
      tests.push_back(a.test);
      worst.push_back(a.worst);
      gain.push_back(a.gain);
    }
    advice.attribute("tests", fmt::format("{}", fmt::join(tests, "; ")));
    write_vector(advice, "worst", worst, "-");
    write_vector(advice, "gain", gain, "-");
    write_matrix(advice, "relative", relative, "-");
  }
}

// The stability map: for each path and angle the amounts at which stiffness or ellipticity is
// lost.
void write_stability(const h5::Group& group, const StabilityRecord& r) {
  const StabilityMap& map = r.map;
  group.attribute("verdict", r.verdict);
  std::string order;
  for (Path path : all_paths)
    append(order, " ", std::string(names(path)[static_cast<std::size_t>(path)]));
  group.attribute("paths", order);
  write_vector(group, "amount", map.amount, "-");
  write_vector(group, "angle", map.angle, "deg");
  write_vector(group, "stretch", map.stretch, "-");
  write_matrix(group, "plane", map.plane, "MPa");
  group.write_scalar("safe_hencky", map.safe_hencky, "-");
  group.write_scalar("hencky_end", map.hencky_end, "-");
  const std::size_t paths = all_paths.size();
  const std::size_t angles = map.angle.size();
  const std::size_t amounts = map.amount.size();
  std::vector<double> slope_loss, ellipticity_loss, end, nominal, slope, ellipticity;
  for (const PathStability& p : map.paths) {
    slope_loss.push_back(p.slope_loss);
    ellipticity_loss.push_back(p.ellipticity_loss);
    end.push_back(p.end);
    nominal.insert(nominal.end(), p.nominal.begin(), p.nominal.end());
    slope.insert(slope.end(), p.slope.begin(), p.slope.end());
    ellipticity.insert(ellipticity.end(), p.ellipticity.begin(), p.ellipticity.end());
  }
  group.write<double>("slope_loss", {paths, angles}, slope_loss, "-");
  group.write<double>("ellipticity_loss", {paths, angles}, ellipticity_loss, "-");
  group.write<double>("end", {paths, angles}, end, "-");
  group.write<double>("nominal", {paths, angles, amounts}, nominal, "MPa");
  group.write<double>("slope", {paths, angles, amounts}, slope, "MPa");
  group.write<double>("ellipticity", {paths, angles, amounts}, ellipticity, "MPa");
}

}  // namespace

void write_study(const h5::Group& root, const StudyRecord& study) {
  if (study.identifiability)
    write_identifiability(root.make_group("identifiability"), *study.identifiability);
  if (study.stability) write_stability(root.make_group("stability"), *study.stability);
  if (study.range) {
    const h5::Group range = root.make_group("fitted_range");
    range.write_scalar("I1_bar", study.range->I1_bar, "-");
    write_vector(range, "I4_bar", study.range->I4_bar, "-");
  }
}

StudyRecord read_study(const h5::Group& root) {
  StudyRecord study;
  if (root.has("fitted_range")) {
    const h5::Group range = root.group("fitted_range");
    study.range = FittedRange{range.read_scalar("I1_bar"), range.read_finite("I4_bar", {h5::any})};
  }
  if (root.has("stability")) {
    const h5::Group group = root.group("stability");
    study.stability.emplace();
    study.stability->map.safe_hencky = group.read_scalar("safe_hencky");
    study.stability->verdict = group.text_attribute("verdict");
  }
  return study;
}

}  // namespace langer
