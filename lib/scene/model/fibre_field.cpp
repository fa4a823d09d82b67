#include "scene/model/fibre_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "core/base/csv_table.hpp"
#include "core/config/formula.hpp"
#include "core/hdf5/h5.hpp"
#include "core/hdf5/unit_attribute.hpp"
#include "core/tensor/principal.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {
constexpr double degree = std::numbers::pi / 180;
}

Vec3 cell_centre(const Mesh& mesh, int e) {
  Vec3 centre = Vec3::Zero();
  for (int node : mesh.cell(e)) centre += mesh.X[node] / nodes_per_cell(mesh.type);
  return centre;
}

namespace {

using Six = std::array<double, 6>;  // place and direction

void add_point(MeasuredDirections& points, const Six& v, const Place& where,
               const std::string& key) {
  const Vec3 a(v[3], v[4], v[5]);
  if (!(a.stableNorm() > 1e-12))
    throw Failure(Exit::input, Error{where, key, "a direction of no length", "a vector", ""});
  points.x.emplace_back(v[0], v[1], v[2]);
  points.a.push_back(a.stableNormalized());
}

// Columns are found by the names in the config; rows are points.
MeasuredDirections from_csv(const PointField& field) {
  const CsvTable table = read_table(field.file.path);
  const auto refuse = [&](int line, int column, const std::string& key, const std::string& found,
                          const std::string& expected) {
    throw Failure(Exit::input, Error{{table.name, line, column}, key, found, expected, ""});
  };
  std::array<std::size_t, 6> at{};
  for (int i = 0; i < 6; ++i) {
    const auto& names = table.header.cells;
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const CsvCell& c) { return c.text == field.columns[i]; });
    if (found == names.end())
      refuse(table.header.line, 1, field.columns[i], "no such column",
             "columns as `columns` names them");
    at[i] = found - names.begin();
  }
  MeasuredDirections points;
  for (const CsvRow& row : table.rows) {
    Six value{};
    for (int i = 0; i < 6; ++i) {
      const CsvCell& cell = row.cells[at[i]];
      const auto number = csv_number(cell.text);
      if (!number || !std::isfinite(*number))
        refuse(row.line, cell.column, field.columns[i], "found \"" + cell.text + "\"",
               "a finite number");
      value[i] = *number;
    }
    add_point(points, value, {table.name, row.line, 1}, field.columns[3]);
  }
  return points;
}

// The same from an HDF5 file: one dataset of n numbers for each column.
MeasuredDirections from_hdf5(const PointField& field) {
  const h5::File file = h5::File::open(field.file.path);
  std::array<std::vector<double>, 6> column;
  for (int i = 0; i < 6; ++i) {
    column[i] = file.root().read_finite(field.columns[i], {h5::any});
    require_unit(file.root(), field.columns[i], i < 3 ? "mm" : "-");
    if (column[i].size() != column[0].size())
      throw Failure(Exit::input,
                    Error{{field.file.path, 0, 0},
                          field.columns[i],
                          fmt::format("found {} numbers", column[i].size()),
                          fmt::format("{}, as {} has", column[0].size(), field.columns[0]),
                          ""});
  }
  MeasuredDirections points;
  for (std::size_t k = 0; k < column[0].size(); ++k) {
    Six value{};
    for (int i = 0; i < 6; ++i) value[i] = column[i][k];
    add_point(points, value, {field.file.path, 0, 0}, fmt::format("{}[{}]", field.columns[3], k));
  }
  return points;
}

}  // namespace

MeasuredDirections read_directions(const PointField& field) {
  const std::string type = std::filesystem::path(field.file.path).extension().string();
  MeasuredDirections points;
  if (type == ".h5" || type == ".hdf5" || type == ".hdf") {
    points = from_hdf5(field);
  } else {
    points = from_csv(field);
  }
  if (points.x.empty())
    throw Failure(Exit::input,
                  Error{{field.file.path, 0, 0}, "", "found no points", "at least one row", ""});
  return points;
}

// The direction at x. A fibre has no sign, so directions are averaged as tensors:
//   A(x) = sum_i w_i a_i a_i^T,  w_i = 1 / |x - x_i|^power,
// and the direction is the eigenvector of the largest eigenvalue. Zero if it is not unique.
Vec3 direction_at(const MeasuredDirections& points, const Vec3& x, Between method, double power) {
  std::size_t near = 0;
  for (std::size_t i = 1; i < points.x.size(); ++i)
    if ((points.x[i] - x).squaredNorm() < (points.x[near] - x).squaredNorm()) near = i;
  const double least = (points.x[near] - x).norm();
  if (method == Between::nearest || least == 0) return points.a[near];
  Mat3 sum = Mat3::Zero();  // weights relative to the nearest point's, so that no power overflows
  for (std::size_t i = 0; i < points.x.size(); ++i)
    sum +=
        std::pow(least / (points.x[i] - x).norm(), power) * points.a[i] * points.a[i].transpose();
  const Principal axes = principal(sum);
  if (axes.values[2] - axes.values[1] <= 1e-9 * axes.values[2]) return Vec3::Zero();
  return axes.directions.col(2);
}

FirstFamily first_family(const FibreField& field, const Mesh& mesh, std::span<const int> cells,
                         const std::string& key,
                         const std::function<Place(const std::string&)>& where) {
  if (const auto* formula = std::get_if<FormulaField>(&field)) {
    std::vector<FormulaPoint> centres;
    for (int e : cells) {
      const Vec3 x = cell_centre(mesh, e);
      centres.push_back({x[0], x[1], x[2]});
    }
    const std::string at = key + ".formula.alpha";
    return evaluate(formula->alpha, centres, where(at), at);
  }
  const auto& given = std::get<PointField>(field);
  const MeasuredDirections points = read_directions(given);
  std::vector<Vec3> directions;
  for (int e : cells) {
    const Vec3 x = cell_centre(mesh, e);
    const Vec3 a = direction_at(points, x, given.method, given.power);
    if (a.isZero(0))
      throw Failure(Exit::config,
                    Error{where(key + ".points"), key + ".points",
                          fmt::format("the points agree on no direction at ({:g}, {:g}, {:g})",
                                      x[0], x[1], x[2]),
                          "directions with one main axis", "method: nearest always has one"});
    directions.push_back(a);
  }
  return directions;
}

// The largest angle between the fibres of two cells that share a facet: a measure of how well the
// mesh resolves a field of directions.
FibreJump largest_jump(const Mesh& mesh, const Directions& directions) {
  FibreJump jump;
  std::map<std::array<int, 4>, int> open;  // facets that one cell has shown so far
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int f = 0; f < mesh.cell().n_facets(); ++f) {
      const std::array<int, 4> nodes = facet_key(mesh, {e, f});
      const auto [entry, is_new] = open.try_emplace(nodes, e);
      if (is_new) continue;
      const auto here = directions.of(e);
      const auto there = directions.of(entry->second);
      for (std::size_t k = 0; k < std::min(here.size(), there.size()); ++k) {
        const double angle =
            std::atan2(here[k].cross(there[k]).norm(), std::abs(here[k].dot(there[k]))) / degree;
        if (angle <= jump.degrees) continue;
        jump = {angle, entry->second, e, static_cast<int>(k), Vec3::Zero()};
        for (int node : nodes) jump.place += mesh.X[node] / 4;
      }
      open.erase(entry);
    }
  return jump;
}

}  // namespace langer
