// Branch stresses at the Gauss points of a body's cells, from increment to increment.
// material/viscous.hpp They follow from the displacements of the increments that were accepted: who
// replays those has them to the last digit.
//   begin(seconds)   an increment; then H and amplified() stand in its equilibrium, whatever is tried
//   end(...)         S_i at the displacements found, cell by cell
//   accept(...)      they and Q_i become those that the next increment begins with; not called: the increment was not
// Where the body is elastic there is none of this.
#pragma once

#include <span>
#include <vector>

#include "mechanics/element/geometry.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

// What stands in the equilibrium of one cell's increment:  S_iso = matrix S_matrix + fibres
// S_fibres + H
struct CellMemory {
  Amplified amplified;
  std::vector<Vec6> H;  // by Gauss point [MPa]
};

class ViscousPoints {
 public:
  static bool needed(const std::vector<Material>& materials);
  // body: of each cell, an index of materials; empty: all cells have the first
  ViscousPoints(const std::vector<Material>& materials, const std::vector<int>& body, int n_cells,
                int n_gauss);

  void begin(double seconds);
  bool has(int e) const { return !law_of(e).branches.empty(); }
  const Amplified& amplified(int e) const { return law_of(e).amplified; }
  Vec6 H(int e, int g) const;
  CellMemory memory(int e) const;

  void end(int e, const Material& material, const ElementGeometry& geometry,
           std::span<const Vec3> a, const ElementNodes& u);
  // root of the mean square over the body of what the increment's length leaves uncertain in the
  // branch stresses, over the greatest such mean of S_iso so far
  double error() const;
  // u0, u: displacements where the increment began and where it ends
  void accept(int e, const ElementGeometry& geometry, const ElementNodes& u0,
              const ElementNodes& u);
  void accepted();  // after accept() of every cell

  Vec6 stress(int e, int g) const;  // sum Q_i, accepted [MPa]
  std::vector<Vec6> stresses(int e) const;
  // integral of sum Q_i : E' at a Gauss point since rest [MPa]: dissipated, or in the branches
  // until they relax. A cycle that is closed by holding costs this and nothing else: where it is
  // negative the law gives work for nothing.
  double work(int e, int g) const {
    if (work_.empty()) return 0;
    return work_[point(e, g)];
  }
  double bytes() const {
    return 8.0 *
           static_cast<double>(stress_.size() + trial_.size() + branch_.size() + work_.size());
  }

 private:
  struct Law {
    std::vector<ViscousBranch> branches;
    std::vector<BranchOf> groups;  // different `of` among them
    std::vector<std::size_t> group_of;
    std::vector<BranchStep> steps;
    std::vector<double> step_error;
    Amplified amplified;
  };
  const Law& law_of(int e) const {
    return laws_[body_.empty() ? 0 : static_cast<std::size_t>(body_[static_cast<std::size_t>(e)])];
  }
  std::size_t point(int e, int g) const {
    return first_[static_cast<std::size_t>(e)].point + static_cast<std::size_t>(g);
  }
  Eigen::Map<Vec6> at(std::vector<double>& values, std::size_t i) const {
    return Eigen::Map<Vec6>(&values[6 * i]);
  }
  Eigen::Map<const Vec6> at(const std::vector<double>& values, std::size_t i) const {
    return Eigen::Map<const Vec6>(&values[6 * i]);
  }

  std::vector<Law> laws_;  // of each material
  std::vector<int> body_;
  int n_gauss_;
  struct First {
    std::size_t point = 0, stress = 0, branch = 0;  // of each cell in the arrays
  };
  std::vector<First> first_;
  std::vector<double> stress_,
      trial_;  // S_i of each group, where the increment began and where it ends: point by point
  std::vector<double> branch_;  // Q_i
  std::vector<double> work_;
  std::vector<double> error_, size_;  // by cell: of the increment
  double largest_ = 0;                // of the sum of size_ so far
};

}  // namespace langer
