// Stability of an accepted state, of the equilibrium and of the material, and the range of the
// tests that the material was fitted to.
//   tangent        signs of the eigenvalues of the constrained tangent (Signature in
//                  solve/increment.hpp): a negative one is an unstable equilibrium
//   material       smallest eigenvalue of the acoustic tensor over all Gauss points and directions
//                  (material/ellipticity.hpp), first on a grid of directions (point_check.hpp),
//                  then exactly where it is lowest; negative: strong ellipticity is lost
//   fitted range   I1_bar and each fibre's I4_bar against the largest values in the tests; only of
//                  materials that come from a fit
//   driving force  work of what is imposed per unit of t; where it falls, the same state under dead
//                  loads would be past a limit point
#pragma once

#include <array>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "mechanics/solve/increment.hpp"
#include "results/store/provenance.hpp"
#include "results/store/solution_file.hpp"
#include "results/store/study_record.hpp"

namespace langer {

StudyRecord study_from(const std::string& material_file);  // nothing in a YAML file

// The largest of a cell that its material resists.
struct VolumeChange {
  double value = 0;  // |V / V0 - 1|
  Vec3 place = Vec3::Zero();
};

struct StabilityReport {
  double t = 0;
  std::optional<Signature> signature;  // none: not looked at, as the tangent is solved iteratively
  // of movements that break the symmetry of a reduced body (solve/symmetry_breaking.hpp); none: not
  // looked at, or there are no such movements
  std::optional<Signature> breaking;
  double stiffness = 0;  // smallest, in the whole body [MPa]
  int cell = -1;         // where; reference position of the Gauss point [mm]
  Vec3 place = Vec3::Zero();
  VolumeChange volume_change;
  double lost = 0;  // share of the volume with a negative one
  double fibre_min = std::numeric_limits<double>::infinity(),
         fibre_max = 0;  // sqrt(I4_bar); no fibres: max < min
  double outside = 0,
         farthest = 0;  // of the fitted range: share of the volume, largest excess (1: at its end)
  Vec3 farthest_place = Vec3::Zero();
  double driving_force = 0;  // [N mm] per unit of t
  bool falling = false;      // ... less than one step before; looked at without contact only

  // of all movements that were looked at; -1: the tangent is singular and has no negative one
  int negative_eigenvalues() const;
  bool equilibrium_unstable() const { return negative_eigenvalues() != 0; }
  bool material_unstable() const { return !(stiffness >= 0); }
};
std::string in_words(const StabilityReport& report);  // what is unstable; empty where nothing is

class StabilityWatch {
 public:
  // Which movements the signs of the tangent are of.
  enum class Reach {
    whole_body,
    whole_of_reduced,         // all of them at each step, of a body that symmetry reduces
    symmetric_until_the_end,  // those that break the symmetry are looked at in the last step only
    section                   // within the plane of a section, or around its axis
  };
  explicit StabilityWatch(StudyRecord study, Reach reach = Reach::whole_body)
      : study_(std::move(study)), reach_(reach) {}
  void resume(const StepRecord& last);
  // the accepted state, right after accept(); within: TangentSigns::signature(); known: its
  // signature, where it follows without a factorization
  StabilityReport look(const Assembler& body, Increment& increment,
                       double within = TangentSigns::nearly_there);
  StabilityReport look(const Assembler& body, const BodyState& state, const VecX& reactions,
                       bool contacts, std::optional<Signature> signature);
  void add_to(StepRecord& record, const StabilityReport& report) const;
  void keep(const StabilityReport& report);  // for the warnings at the end

  // of the whole path: from when to when something was unstable, and how much of the body where at
  // the end
  std::vector<std::string> warnings() const;
  std::vector<std::string> notes() const;  // what the statement leaves out
  std::vector<Summary> summary() const;

 private:
  double stiffest_of_lowest(const Assembler& body, const BodyState& state) const;
  // values of t of accepted steps, in runs without a gap
  struct Spans {
    std::vector<std::array<double, 2>> of;
    bool open = false;
    void add(double t, bool here);
    std::string text() const;
  };
  StudyRecord study_;
  Reach reach_;
  std::optional<bool> says_which_signs_;  // as the steps do that a run continues
  double force_before_ = 0, t_before_ = -1;
  StabilityReport last_;
  std::set<int> lowest_cells_;  // of the last step
  VolumeChange volume_change_;
  int most_negative_ = 0, steps_unstable_ = 0;
  int most_breaking_ = 0;      // of them in movements that break the symmetry
  std::optional<bool> signs_;  // whether signatures are looked at: as at the first step, so that
                               // all steps have the same columns
  Spans equilibrium_, material_, outside_, falling_;
};

}  // namespace langer
