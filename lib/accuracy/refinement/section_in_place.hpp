// A block whose scene is axisymmetric except for its far sides, solved as an axisymmetric section.
//   conditions  an indented_block that is held, moved and touched at bottom and top only; indenters
//               of revolution about the vertical through its middle, which move along it; fibres
//               without a direction; sets and points that such a section has too
//   section     a disc of the block's area and thickness
//   sides       two more discs bracket the block: one inside of it (radius: half its shorter side),
//               one around it (half its diagonal). The larger change of the force, from the disc of
//               equal area, is the possible influence of the sides
// The section is taken with `reduce: auto`, if the sides change no force by more than the accuracy
// that is requested, 1 % without one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/refinement/accuracy.hpp"
#include "core/base/voice.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// Nothing where the scene is not the same around an axis. material: of the bodies that the config
// names none for
std::optional<SolveConfig> on_a_disc(const SolveConfig& config,
                                     const std::optional<Material>& material, double radius);

struct RadiiOfBlock {
  double inside = 0, alike = 0,
         around = 0;  // half the shorter side, of equal area, half the diagonal [mm]
};
RadiiOfBlock radii_of(const IndentedBlock& block);

class SectionInPlace {
 public:
  using Where = std::function<Place(const std::string&)>;
  // Says what is done and why; measures the sides where they are asked for, unless `dry`.
  // Throws Failure with the signal's code where one has come.
  SectionInPlace(const Voice& voice, const SolveConfig& config,
                 const std::optional<Material>& material, const Where& where, bool dry);

  bool taken() const { return section_.has_value(); }
  bool offered() const { return offered_; }  // the scene has one, and nobody has asked for it
  const SolveConfig& config() const {
    if (section_) return *section_;
    return asked_;
  }  // to be solved
  // With these errors of the section beside those of the sides: whether an accuracy that was asked
  // for is kept. Where it is not, config() is another one now: what finer_level says for the rest
  // that the sides leave, then the block.
  bool accurate(const std::vector<ErrorEstimate>& errors);
  std::vector<Summary> summary(const std::vector<ErrorEstimate>& errors) const;

 private:
  void decide(const std::optional<Material>& material, const Where& where, bool dry);
  void measure_sides(const SolveConfig& section, const std::optional<Material>& material,
                     const Where& where);
  struct Change {
    double of = 0, most = 0;  // size of the force, and its largest change [N]
  };
  Change largest_change(const std::string& force, const SolvedPath& alike,
                        const std::vector<const SolvedPath*>& others) const;
  double wanted() const { return accuracy_ ? accuracy_->wanted : 1; }  // [%]
  double percent(
      const std::vector<ErrorEstimate>& errors) const;  // largest of a force, sides included

  Voice voice_;
  SolveConfig asked_;
  std::optional<ChosenLevel> accuracy_;  // of the section, where one is asked for
  std::optional<SolveConfig> section_;
  RadiiOfBlock radii_;
  std::vector<Valued> sides_;  // by force: what the sides may change [N]
  double sides_percent_ = 0;
  bool offered_ = false;
};

}  // namespace langer
