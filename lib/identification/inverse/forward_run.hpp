// A solve config as a function of its material and friction.
//
// solve() runs the scene in this process, without files, and returns what is observed along the
// path and its derivatives. Checks and estimates of the config are switched off: a fit makes many
// runs and needs the path alone. Increments end at the measured values, so that little has to be
// interpolated.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "identification/inverse/observation.hpp"
#include "scene/run/run.hpp"

namespace langer {

struct ForwardPath {
  bool complete = false;
  std::string why;           // where it is not
  std::vector<double> t;     // of accepted increments, ascending; 0 is not among them
  MatX values;               // (t, observations)
  std::vector<MatX> slopes;  // by parameter, where they were asked for: (t, observations)
};

// What a run is made with: the law of all bodies that the config gives none, friction by contact
// (others as in the config).
struct ForwardInput {
  Material law;
  std::map<std::string, double> friction = {};
  std::vector<std::string> slopes = {};  // keys of the config by which it is to be differentiated
  std::map<std::string, double> numbers = {};  // of the config, by path; of those that it has
  double fibre_angle = 0;                      // added to that of the run [deg]
};

class ForwardRun {
 public:
  using Where = std::function<Place(const std::string&)>;
  // config with its mesh; where: places of its keys. fibre_angle: added to those of the law [deg].
  // stops: increments end there. Throws Failure(config) for a mesh that cannot be made.
  ForwardRun(SolveConfig config, Where where, double fibre_angle);

  const Mesh& mesh() const { return *mesh_; }
  const SolveConfig& config() const { return config_; }
  SolveConfig config_at(const ForwardInput& input) const;
  // Value of a number of the config; of a thickness that of the mesh. Nothing where it has none.
  std::optional<double> number(const std::string& path) const;
  // Why a number of the config cannot be found; empty: it can.
  std::string reason_fixed(const std::string& path) const;
  // Whether runs with a law differentiate themselves wherever they have an end. Those with bonds
  // that may let go in a jump do not, nor a viscous body in motion.
  bool differentiates_itself(const Material& law) const;
  // Whether a run differentiates itself with respect to a number of its config that is no friction.
  bool differentiates(const std::string& path, const Material& law) const;
  // What a fit may have to find beside the law: friction, radii and thicknesses of the scene.
  std::vector<std::string> uncertain_numbers() const;
  void observe(std::vector<Observation> observations, std::vector<double> stops);
  const std::vector<Observation>& observations() const { return observations_; }

  // From several threads at once. Throws Failure(config) where the scene cannot be made,
  // one with the signal's code where one has come.
  ForwardPath solve(const ForwardInput& input) const;

  // the same scene on cells longer by this factor; nothing where they follow from no numbers of the
  // config
  std::optional<SolveConfig> on_longer_cells(double factor) const;

 private:
  Mesh mesh_at(const ForwardInput& input, const SolveConfig& config) const;

  SolveConfig config_;
  Where where_;
  double fibre_angle_;
  std::shared_ptr<const Mesh> mesh_;
  std::vector<Observation> observations_;
  std::vector<double> stops_;
};

}  // namespace langer
