#include "accuracy/checks/free_surface.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/principal.hpp"
#include "core/tensor/push_forward.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/select.hpp"

namespace langer {

namespace {

// Components of voigt.hpp in the frame of unit columns: A_ijkl with the letters of the frame.
double in_frame(const Mat6& c, const Mat3& frame, int i, int j, int k, int l) {
  const auto component = [&](int a, int b) {
    const Vec3 p = frame.col(a);
    const Vec3 q = frame.col(b);
    Vec6 v;
    for (int m = 0; m < 6; ++m) {
      const int s = voigt_i[m];
      const int t = voigt_j[m];
      v[m] = s == t ? p[s] * q[s] : p[s] * q[t] + p[t] * q[s];
    }
    return v;
  };
  return component(i, j).dot(c * component(k, l));
}

// Whether a face is held or moved along its normal: each of its nodes is, where the dofs of a tied
// node are those of its image.
bool is_held(const Dofs& dofs, const std::vector<int>& nodes, const Vec3& normal) {
  int along = 0;
  normal.cwiseAbs().maxCoeff(&along);
  for (const int node : nodes)
    if (dofs.equation[static_cast<std::size_t>(3 * dofs.node(node) + along)] >= 0) return false;
  return true;
}

}  // namespace

double surface_margin(const Material& material, const Mat3& F, const Vec3& n) {
  const double J = F.determinant();
  if (!(J > 0)) return std::numeric_limits<double>::infinity();
  const Response r = isochoric(material, right_cauchy_green(F), {});
  const Mat3 sigma = cauchy(F, r.S, J);
  const Mat6 c = push_forward(F, r.D, J);
  // The deformed normal, and the principal directions of the deformation within the surface.
  const Vec3 normal = (F.inverse().transpose() * n).normalized();
  const Vec3 u = normal.unitOrthogonal();
  const Vec3 v = normal.cross(u);
  const Mat3 b = F * F.transpose();
  Mat2 in_plane;
  in_plane << u.dot(b * u), u.dot(b * v), u.dot(b * v), v.dot(b * v);
  const PlanePrincipal axes = principal(in_plane);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 2; ++k) {
    const Vec2 direction = axes.directions.col(k);
    Mat3 frame;
    frame.col(0) = direction[0] * u + direction[1] * v;
    frame.col(1) = normal;
    frame.col(2) = frame.col(0).cross(normal);
    // Along a direction that is longer than the normal a surface gives way by necks, not by
    // creases.
    if (!(frame.col(0).dot(b * frame.col(0)) < normal.dot(b * normal))) continue;
    const double along = frame.col(0).dot(sigma * frame.col(0));
    const double across = normal.dot(sigma * normal);
    const double shear = in_frame(c, frame, 0, 1, 0, 1);
    const double a = shear + along;
    const double g = shear + across;
    const double two_b = in_frame(c, frame, 0, 0, 0, 0) + in_frame(c, frame, 1, 1, 1, 1) -
                         2 * in_frame(c, frame, 0, 0, 1, 1) - 2 * shear + along + across;
    if (!std::isfinite(a + g + two_b)) continue;
    // Where a or g is negative strong ellipticity itself is lost.
    double margin = -1;
    if (a > 0 && g > 0) margin = a / g + std::sqrt(a / g) * (two_b + 2 * g) / g - 1;
    least = std::min(least, margin);
  }
  return least;
}

FreeSurface::FreeSurface(const Assembler& body, const std::vector<SurfaceLoad>& loads) {
  const Mesh& mesh = body.mesh();
  if (!mesh.hanging.empty()) return;  // facets of larger cells beside smaller ones are no surface
  std::set<std::pair<int, int>> loaded;
  for (const SurfaceLoad& load : loads)
    for (const langer::Facet& facet : load.facets) loaded.insert({facet.cell, facet.local});
  const ReferenceCell& cell = mesh.cell();
  for (const langer::Facet& facet : boundary(mesh)) {
    if (loaded.contains({facet.cell, facet.local})) continue;
    if (!body.fibres(facet.cell).empty()) continue;
    Facet out;
    out.cell = facet.cell;
    out.nodes = facet_nodes(mesh, facet);
    const auto X = [&](std::size_t i) {
      return mesh.X[static_cast<std::size_t>(out.nodes[i])];
    };
    const std::size_t last = static_cast<std::size_t>(cell.facet_corners) - 1;
    out.normal = (X(1) - X(0)).cross(X(last) - X(0));
    if (!(out.normal.norm() > 0)) continue;  // on the axis of a section
    out.normal.normalize();
    if (is_held(body.dofs(), out.nodes, out.normal)) continue;
    Vec3 xi = Vec3::Zero();
    const std::vector<int>& local = cell.facet[static_cast<std::size_t>(facet.local)];
    for (std::size_t i = 0; i <= last; ++i) {
      xi += cell.node[static_cast<std::size_t>(local[i])] / double(last + 1);
      out.place += X(i) / double(last + 1);
    }
    for (int g = 1; g < cell.n_gauss; ++g) {
      const auto distance = [&](int point) {
        return (cell.gauss[static_cast<std::size_t>(point)] - xi).norm();
      };
      if (distance(g) < distance(out.point)) out.point = g;
    }
    facets_.push_back(std::move(out));
  }
}

std::optional<FreeSurface::Weakest> FreeSurface::weakest(
    const Assembler& body, const BodyState& state,
    const std::vector<RigidContact>& contacts) const {
  // Moduli are computed where a direction of the surface is shortened by more than this only.
  constexpr double shortened = 0.8;
  std::set<int> touched;
  for (std::size_t k = 0; k < contacts.size(); ++k)
    for (std::size_t i = 0; i < contacts[k].nodes.size(); ++i)
      if (!state.r[k][i].isZero(0)) touched.insert(contacts[k].nodes[i]);
  std::optional<Weakest> weakest;
  for (const Facet& facet : facets_) {
    const ElementNodes u = body.element_displacements(state.u, facet.cell);
    const Mat3 F = Mat3::Identity() +
                   displacement_gradient(
                       u, body.geometry(facet.cell).dN_dX[static_cast<std::size_t>(facet.point)]);
    if (std::sqrt(principal_values(right_cauchy_green(F))[0]) >
        shortened * std::cbrt(F.determinant()))
      continue;
    bool is_touched = false;
    for (const int node : facet.nodes) is_touched = is_touched || touched.contains(node);
    if (is_touched) continue;
    const double margin = surface_margin(body.material(facet.cell), F, facet.normal);
    if (!weakest || margin < weakest->margin) weakest = Weakest{margin, facet.place};
  }
  return weakest;
}

}  // namespace langer
