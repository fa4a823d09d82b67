// Inverse identification: parameters of a material from measured curves of a whole experiment, such
// as an indentation, that only a finite element run can predict.
//
// A scene is a solve config together with a measured file. At a set of parameters each scene is
// solved once (runs are cached and made in parallel), and the curve that the instrument would have
// recorded is read off the run:
//   values    F(s) + force_offset,  s = s_read - touch_offset - compliance (F_read - force_offset)
//   Jacobian  by material numbers and friction: the run differentiates itself (sensitivity.hpp);
//             by offsets and compliance: the chain rule with the slope dF/ds of the computed curve
// Weighted residuals go to the least squares of the fit (fit/fit.hpp) next to those of homogeneous
// tests. A trial set of parameters without equilibrium has no model there: the search shortens its
// step.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/voice.hpp"
#include "identification/fit/fit.hpp"
#include "identification/inverse/run_cache.hpp"
#include "identification/inverse/scene_test.hpp"
#include "identification/setup/fit_config.hpp"
#include "results/store/material_file.hpp"

namespace langer {

// A number of a scene or of its instrument that a fit holds fixed, and how what was measured would
// follow it.
struct HeldNumber {
  std::string name, unit;
  double value = 0;
  VecX slope;  // of all values of the scenes, per unit
};

struct SceneFitOptions {
  int jobs = 1;
  bool quotients = false;  // derivatives by differences of whole runs, to compare with
  std::function<void(const std::string&)> say = {};
};

// Start values and boxes that the config of a fit leaves to its scenes (NaN): those of the scene,
// half and twice its value, or six standard deviations of a prior. Throws Failure(config) for a
// number that no scene has.
void complete_scene_numbers(const FitConfig& config,
                            const std::function<Place(const std::string&)>& where,
                            FitProblem& problem);

class SceneTests : public FurtherTests {
 public:
  using Where = std::function<Place(const std::string&)>;
  static constexpr double beyond_path =
      0.1;  // part of a path by which trial offsets may lead beyond its end
  const VecX& measured() const override { return observed_.measured; }
  const VecX& weight() const override { return observed_.weight; }
  const std::vector<Eigen::Index>& curves() const override { return observed_.curves; }
  bool model(const VecX& p, VecX& values) override;
  bool slope(const VecX& p, MatX& J) override;

  // Makes the runs of many sets of parameters, which model() and slope() find later.
  void run_ahead(const std::vector<VecX>& p);

  // Reads solve configs and files; `files` are those of the items that name none. problem: its law,
  // free numbers and ties. Throws Failure(config, input) at the key or the line that does not fit.
  SceneTests(const FitConfig& config, const Where& where, const FitProblem& problem,
             const std::vector<std::string>& files, std::shared_ptr<RunCache> cache,
             SceneFitOptions options, double longer = 1);
  // the same on cells longer by a factor, where they follow from numbers of a config; nullptr where
  // none do
  std::shared_ptr<SceneTests> on_longer_cells(double factor) const;

  int runs() const { return effort_.runs; }               // made so far
  double run_seconds() const { return effort_.seconds; }  // of CPU, in them
  // why the scene of a trial set has no end
  const std::string& last_failure() const { return effort_.failure; }
  // Sentences about tests that were read beyond the end of a path at the offsets of p.
  std::vector<std::string> extrapolations(const VecX& p) const;
  std::vector<FittedCurve> fitted(const VecX& values) const;  // at the values that were found
  // Friction, radii, thicknesses, offsets and compliances that are no parameters. One run of each
  // scene more at p, and one more without friction.
  std::vector<HeldNumber> held_numbers(const VecX& p);
  const std::vector<SceneTest>& tests() const { return tests_; }
  std::size_t scenes() const { return scenes_.size(); }

 private:
  struct Number {         // a free parameter as a scene sees it
    std::string contact;  // friction
    std::optional<SceneNumber>
        measured;           // touch_offset, force_offset, compliance; none of all: of the law
    std::string path;       // of a number of the config
    bool quotient = false;  // its column comes from differences of whole runs
  };
  using Path = std::shared_ptr<const ForwardPath>;
  struct Wanted {
    std::size_t scene;
    ForwardInput input;
  };
  ForwardInput input_at(const VecX& p, std::size_t scene) const;
  std::vector<Path> solved(const std::vector<Wanted>& wanted);
  bool paths_at(const VecX& p, std::vector<Path>& paths);
  double measured_by(const SceneTest& test, SceneNumber::Of of, const VecX& p) const;
  // What to read of a test: values of `of`, which has a column for each observation, or their rate
  // over s.
  enum class Read { values, rate };
  bool read(const SceneTest& test, const ForwardPath& path, const MatX& of, const VecX& p,
            Read what, VecX& out) const;
  // all: of each number; else of those whose column nothing else gives
  bool add_difference_quotients(const VecX& p, const std::vector<Path>& paths, bool all, MatX& J);
  bool add_path_sensitivities(const VecX& p, const std::vector<Path>& paths, MatX& J) const;
  void add_instrument_columns(const VecX& p, const std::vector<Path>& paths, MatX& J) const;
  bool instrument_column(const SceneTest& test, SceneNumber::Of of, const VecX& p,
                         const ForwardPath& path, VecX& column) const;
  void add_held_of_instruments(const VecX& p, const std::vector<Path>& paths,
                               std::vector<HeldNumber>& held) const;
  void add_run(std::size_t item, double longer, std::map<std::string, std::size_t>& known);
  void add_numbers();
  void add_tests();
  bool offset_free(std::size_t item) const;  // touch offset, force offset or compliance
  // scene: of the one whose runs it concerns; all of them without
  void add_slope(const std::string& key, std::size_t number, double factor,
                 std::optional<std::size_t> scene = {});
  void add_config_number(const std::string& path, std::size_t number,
                         const std::function<void(std::string, std::string)>& refuse);
  bool free_angle(std::size_t item) const;  // whether data[item].fibre_angle is a parameter

  FitConfig config_;
  Where where_;
  std::vector<std::string> files_;
  FitProblem law_;  // without further tests
  std::vector<Number> numbers_;
  struct Scene {
    std::shared_ptr<ForwardRun> run;
    std::string observed;              // what its runs are asked, for their key in the cache
    double top = 0;                    // of its mesh [mm]
    bool solvable = false;             // a run of it has had an end
    std::optional<std::size_t> angle;  // number that is its fibre_angle
  };
  std::vector<Scene> scenes_;
  std::vector<std::size_t> run_of_;  // scene by item of data
  bool any_longer_ = false, with_friction_ = false;
  struct SlopeOf {
    std::size_t number;
    double factor;
    std::optional<std::size_t> scene;
  };
  struct Slope {  // a number by which runs are differentiated, and what each parameter makes of it
    std::string key;
    std::vector<SlopeOf> of;
  };
  std::vector<Slope> slopes_;
  std::vector<SceneTest> tests_;
  struct Observed {
    VecX measured, weight;            // of all tests
    std::vector<Eigen::Index> first;  // of the values of each test
    std::vector<Eigen::Index> curves;
  };
  Observed observed_;
  std::shared_ptr<RunCache> cache_;
  SceneFitOptions options_;
  struct Effort {
    int runs = 0;
    double seconds = 0;   // of CPU
    std::string failure;  // why the last run without an end has none
  };
  Effort effort_;
};

}  // namespace langer
