// Fibre directions that vary from cell to cell: from a formula, or from directions measured at
// points.
//   formula   angle at each cell's centre, in the cell's frame: a = cos(alpha) e_x + sin(alpha) e_z        [A23] eq. 1
//   points    direction of the fibre lines (a and -a are the same) at points:
//             nearest            that of the nearest point
//             inverse_distance   main axis of  sum_i |x - x_i|^-power a_i a_i^T
// The field is that of the first fibre family; further families keep the angle that they have to
// the first.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/fields.hpp"
#include "core/base/input_path.hpp"
#include "mechanics/mesh/directions.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct FormulaField {
  static constexpr const char* key = "formula";
  std::string alpha;
  static void fields(auto& v) {
    v(&FormulaField::alpha, "alpha", unit::deg,
      "formula of x, y, z, the cell's centre in mm; read by muParser", required);
  }
};

enum class Between { nearest, inverse_distance };
constexpr auto names(Between) { return std::array{"nearest", "inverse_distance"}; }

struct PointField {
  static constexpr const char* key = "points";
  InputPath file;
  std::array<std::string, 6> columns{"x", "y", "z", "a_x", "a_y", "a_z"};
  Between method = Between::nearest;
  double power = 2;
  static void fields(auto& v) {
    v(&PointField::file, "file", unit::none, "CSV or HDF5 file of points [mm] and directions",
      required);
    v(&PointField::columns, "columns", unit::none,
      "names of its columns (HDF5: datasets of n numbers): the three of the place, the three of the direction");
    v(&PointField::method, "method", unit::none, "what a cell between the points gets");
    v(&PointField::power, "power", unit::none, "of the distance, for inverse_distance", positive);
  }
};

using FibreField = std::variant<FormulaField, PointField>;

struct MeasuredDirections {
  std::vector<Vec3> x, a;  // places [mm], unit directions
};
MeasuredDirections read_directions(
    const PointField& field);  // throws Failure(input) with file, line and column, or dataset

// unit direction there, or zero where the points agree on none (two main axes of the same weight)
Vec3 direction_at(const MeasuredDirections& points, const Vec3& x, Between method, double power);

// What the field says of the first family in the cells named, angles [deg] or directions, from
// which mesh/directions.hpp lays all families; throws Failure(config) with the place of the key.
FirstFamily first_family(const FibreField& field, const Mesh& mesh, std::span<const int> cells,
                         const std::string& key,
                         const std::function<Place(const std::string&)>& where);

// The largest angle between fibre lines of one family in cells that share a facet.
struct FibreJump {
  double degrees = 0;
  int cell = -1, neighbour = -1, family = 0;
  Vec3 place = Vec3::Zero();  // centre of the facet [mm]
};
FibreJump largest_jump(const Mesh& mesh, const Directions& directions);

Vec3 cell_centre(const Mesh& mesh, int e);

}  // namespace langer
