#include "mechanics/solve/parameter_change.hpp"

namespace langer {

ShapePoint shape_change(const ParameterChange& change, std::size_t contact, const Vec3& x) {
  ShapePoint none{0, Vec3::Zero(), Mat3::Zero()};
  if (change.shapes.empty() || !change.shapes[contact]) return none;
  const ShapeChange& shape = *change.shapes[contact];
  const ShapePoint less = shape_at(shape.less, x);
  const ShapePoint more = shape_at(shape.more, x);
  return {(more.gap - less.gap) / shape.width, (more.normal - less.normal) / shape.width,
          (more.curvature - less.curvature) / shape.width};
}

}  // namespace langer
