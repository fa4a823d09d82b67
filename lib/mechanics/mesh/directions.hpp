// Directions of the fibres, by cell and family: a property of the cells, not of the material. They
// are computed once, here, for assembly, results, stability and files. [A23] eq. 1
//   angle   of a family in a body [deg]: a = cos(alpha) e_x + sin(alpha) e_z in the cell's frame
//   field   the direction of the first family, cell by cell; further families keep their angle to it
// Angles of fibres are converted to radians only here.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

class Directions {
 public:
  explicit Directions(bool from_field = false) : from_field_(from_field) {}  // of no cell yet

  void append(std::vector<Vec3> a);  // of the next cell: a unit vector for each family
  // In the order of the families, those that do nothing included; empty: a cell without fibres, or
  // one that was not appended.
  std::span<const Vec3> of(int cell) const;
  Directions of_cells(std::span<const int> cells) const;  // of a part of the body, in this order

  int n_families() const;  // the most that any cell has
  bool from_field() const {
    return from_field_;
  }  // then angles and frames do not determine them, and files store them
  int n_stored() const {
    return static_cast<int>(stored_.size());
  }  // lists in memory: cells in a row with the same share one

 private:
  bool from_field_;
  int n_cells_ = 0;
  std::vector<int> first_;  // cell of each list, ascending
  std::vector<std::vector<Vec3>> stored_;
};

// of the first family in the cells of one body, in their order: no field, angles [deg], unit
// vectors
using FirstFamily = std::variant<std::monostate, std::vector<double>, std::vector<Vec3>>;

Vec3 fibre_direction(double alpha_deg, const Mat3& frame = Mat3::Identity());

// angles: by body and family [deg], or one list for all bodies; fields: by body, empty where there
// is none
Directions make_directions(const Mesh& mesh, const std::vector<std::vector<double>>& angles,
                           const std::vector<FirstFamily>& fields = {});

}  // namespace langer
