// The uncertainty of a force from the uncertainty of fitted parameters: `uncertainty: linear`.
//   variance of a force   g^T C g     g: its derivatives by the parameters (sensitivity.hpp),
//                                     C: their covariance in material.h5
//   without p_j           what would be left if p_j were known exactly: C conditioned on p_j
// Of a population of specimens C is the scatter between them and the error of its median: the
// deviation is that of a specimen that was not tested. Moduli scatter by a factor, so forces are
// skewed: their 95 % are those of specimens that are drawn, with forces linear in the numbers,
//   F_k = F + g^T (p_k - p)
// First order: valid while a force is linear over the uncertainty of the parameters; langer-sample
// checks it by runs. Tied numbers follow their parameter. Angles of symmetry, parameters on a bound
// and undetermined ones have no variance in C: they are left out, and the run says so.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/estimate/error_estimate.hpp"
#include "core/base/voice.hpp"
#include "identification/inverse/sensitivity.hpp"
#include "results/store/material_file.hpp"

namespace langer {

struct ParameterKnowledge {
  std::vector<std::string>
      keys;  // of `sensitivity`: the parameters with a variance, and the numbers that follow them
  std::vector<std::string> names;     // of those parameters
  MatX follow;                        // (keys, names): d number / d parameter
  MatX covariance;                    // (names, names)
  std::vector<std::string> left_out;  // names
  // Of a population, one row for each specimen that is drawn: its numbers less those of the median
  // (specimens, names). Empty: of the error of a fit.
  MatX specimens;
};
ParameterKnowledge knowledge_of(const MaterialFile& file);
// Where config asks for `uncertainty`: of the material's file (empty: there is none). The
// parameters are those of config.sensitivity then, beside those named there. Throws Failure(config)
// where the file has no covariance.
ParameterKnowledge prepare_uncertainty(SolveConfig& config, const std::string& material_file,
                                       const Run::Where& where);

// One force at the end of the path.
struct ForceUncertainty {
  std::string name;                 // force, force_<contact>, reaction_<set>
  double value = 0, deviation = 0;  // [N]; deviation: one standard deviation
  struct Part {
    std::string name;    // of a parameter
    double without = 0;  // the deviation that would be left if it were known [N]
  };
  std::vector<Part> parts;  // the one that would help most first
  // of a population: 95 % of specimens have a force between these two [N]
  std::optional<std::array<double, 2>> specimens;
};
// g: by key. of names, as ForceUncertainty::parts
ForceUncertainty uncertainty_of(const ParameterKnowledge& known, double value, const VecX& g);

class Uncertainty {
 public:
  // Refers to what it is given; sensitivity: of known.keys, others beside them may be there.
  Uncertainty(ParameterKnowledge known, const Run& run, const Sensitivity& sensitivity)
      : known_(std::move(known)), run_(run), sensitivity_(sensitivity) {}
  // whole: with the derivatives that Sensitivity writes
  std::vector<ForceUncertainty> of(const StepRecord& whole) const;
  Observer beside(
      Observer sensitivity) const;  // who writes them, behind it; nobody without parameters
  void write(StepRecord& whole)
      const;  // scalars force_deviation, force_<contact>_deviation, reaction_<set>_deviation

 private:
  ParameterKnowledge known_;
  const Run& run_;
  const Sensitivity& sensitivity_;
};

std::vector<Summary> summary_of(const std::vector<ForceUncertainty>& forces);
void report_forces(const Voice& voice, const ParameterKnowledge& known,
                   const std::vector<ForceUncertainty>& forces,
                   const std::vector<ErrorEstimate>& errors);
// "force 9.44 N +- 0.9 % (cells) +- 24 % (parameters; 5.1 % if c1 were known, 8 % if a1 were
// known)"; of a population "+- 24 % (between specimens; ...), 95 % of specimens between 5.9 and
// 15 N"; cells: [N]
std::string in_words(const ForceUncertainty& force, std::optional<double> cells);

}  // namespace langer
