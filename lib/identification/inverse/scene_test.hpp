// A measured file and the scene that it was measured in: to which observation of which state each
// value belongs.
//
// Files have no path parameter t. They give values over an abscissa s, such as the travel of the
// indenter, which the config of the scene imposes as a function of t. Each row is therefore
// assigned a piece of the path on which s is monotonic, and its t follows by linear interpolation.
//   s  what the file gives it over (travel of the indenter, imposed displacement, pressure, time, t), by which the state is found:
//      on the stretch of the path that the order of the values tells; so histories that come back are followed
#pragma once

#include <string>
#include <vector>

#include "identification/inverse/forward_run.hpp"
#include "identification/inverse/scene_data.hpp"

namespace langer {

// s along the path: linear between ascending t
struct Abscissa {
  std::string key = "", unit = "-";
  std::vector<double> t, s;
  // Place of `s` at or behind the stretch `piece`, which is put where it lies; nothing where the
  // path does not lead there. A little more than its ends is taken, by `slack` of the whole.
  std::optional<double> find(double s, std::size_t& piece, double slack) const;
  // The stretch of each of the values of a file, in their order, along a path that comes back: that
  // in which they go least against its way and leave least of it out. A value that no stretch has
  // gets the number of stretches.
  std::vector<std::size_t> stretches(const std::vector<double>& values, double slack) const;
  double rate(std::size_t piece) const {
    return (t[piece + 1] - t[piece]) / (s[piece + 1] - s[piece]);
  }  // dt/ds
};

struct SceneCurve {
  std::string key;  // of the column: force, u_x, ...
  std::string unit;
  Eigen::Index first = 0;                // of its values among those of the test
  std::vector<std::size_t> observation;  // of each value, in ForwardRun::observations()
};

struct SceneTest {
  std::string name;
  std::size_t data = 0, run = 0;  // item of `data`; which of the forward runs
  Abscissa over;
  std::vector<double> s;             // of each row
  std::vector<std::size_t> stretch;  // of each row
  std::vector<Vec3> places;          // of each row, where there are any
  std::vector<SceneCurve> curves;
  VecX measured;           // of the curves one after the other
  Eigen::Index force = 0;  // where the force that moves the machine begins among them
  double deviation = 1;
  std::vector<double> kinks;  // of the path: values are interpolated between them
};

// of the scene of `run`; throws Failure(config) at keys of the fit's config, Failure(input) at
// lines of the file
Abscissa abscissa_of(const FitData& data, std::size_t item, const SolveConfig& scene,
                     const std::function<Place(const std::string&)>& where);
// adds what it observes to `observations`; slack: by which the file may lead beyond the path, as
// part of it, where offsets are to be found; where: of the fit's config
SceneTest scene_test(const FitData& data, std::size_t item, const SceneData& file,
                     const ForwardRun& run, double noise, double slack,
                     const std::function<Place(const std::string&)>& where,
                     std::vector<Observation>& observations);

// Weights of the states of a path, and of d/dt, that give any observation at t: cubic polynomials
// between kinks. Rest has no weight, for there all are 0.
struct PathPlace {
  std::vector<std::pair<Eigen::Index, double>> value, rate;
  bool exists = true;
};
PathPlace place_on(const std::vector<double>& t, const std::vector<double>& kinks, double at);

}  // namespace langer
