// Branch stresses at the Gauss points of a body's cells, from increment to increment
// (material/viscous.hpp). They follow from the displacements of the accepted increments: replaying
// these gives them again to the last digit.
//   begin(seconds)   begins an increment: H and amplified() then enter its equilibrium
//   end(...)         computes S_i at the displacements found, cell by cell
//   accept(...)      makes them and Q_i the start of the next increment; not called if the increment
//                    is repeated
// An elastic body has none of this.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mechanics/element/geometry.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

// The terms of the branches in one cell's increment:  S_iso = matrix S_matrix + fibres S_fibres + H
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
  // The same with other steps than those of a duration. keep = 1: the stresses of the branches stay
  // at the accepted state, and `follow` of each answers movements away from it.
  void begin(const std::function<BranchStep(const ViscousBranch&)>& step,
             const std::function<double(const ViscousBranch&)>& error);
  bool has(int e) const { return !law_of(e).branches.empty(); }
  const Amplified& amplified(int e) const { return law_of(e).amplified; }
  Vec6 H(int e, int g) const;
  CellMemory memory(int e) const;

  void end(int e, const Material& material, const ElementGeometry& geometry,
           std::span<const Vec3> a, const ElementNodes& u);
  // error of the branch stresses by the length of the increment: the root mean square over the
  // body, relative to the largest such mean of S_iso so far
  double error() const;
  // u0, u: displacements where the increment began and where it ends
  void accept(int e, const ElementGeometry& geometry, const ElementNodes& u0,
              const ElementNodes& u);
  void accepted();  // after accept() of every cell

  Vec6 stress(int e, int g) const;  // sum Q_i, accepted [MPa]
  std::vector<Vec6> stresses(int e) const;
  // integral of sum Q_i : E' at a Gauss point since rest [MPa]: dissipated, or stored in the
  // branches until they relax. This is the whole work of a cycle that ends with a hold; if it is
  // negative, the material produces energy.
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
