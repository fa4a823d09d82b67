#include "scene/run/homogeneous.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "mechanics/mesh/bounding_box.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/solve/body_scale.hpp"
#include "scene/run/run.hpp"

namespace langer {

namespace {

constexpr double same = 1e-9;

// The faces of the body, if it is a box.
struct Hull : BoundingBox {
  double bound(int axis, int side) const { return side > 0 ? high[axis] : low[axis]; }
  bool on(const Vec3& X, int axis, int side) const {
    return std::abs(X[axis] - bound(axis, side)) <= same * (high - low).norm();
  }
};

// Whether all elements have the same directions; a family without direction is the same everywhere.
bool same_fibres(const Mesh& mesh, const Scene& scene) {
  const std::vector<Fibre>& families = scene.materials.front().fibres;
  if (scene.families() == 0) return true;
  const auto first = scene.directions.of(0);
  for (int e = 1; e < mesh.n_cells(); ++e) {
    const auto here = scene.directions.of(e);
    for (std::size_t k = 0; k < first.size(); ++k)
      if ((k == 0 || has_direction(families[k])) &&
          std::min((here[k] - first[k]).norm(), (here[k] + first[k]).norm()) > 1e-12)
        return false;
  }
  return true;
}

// Displacements that are prescribed on whole faces, as values of the corners of the box. Nothing
// where a node has a prescribed displacement that the rest of its face has not.
std::optional<std::vector<Prescribed>> displacements_of_faces(const Mesh& mesh, const Dofs& dofs,
                                                              const Hull& hull) {
  std::map<int, History> imposed, explained;
  for (const Prescribed& p : dofs.prescribed) {
    if (p.turn) return std::nullopt;
    imposed[p.dof] = {p.value, p.factor};
  }
  std::vector<Prescribed> corners;
  for (int axis = 0; axis < 3; ++axis)
    for (int side : {-1, 1}) {
      std::vector<int> nodes;
      for (int n = 0; n < mesh.n_nodes(); ++n)
        if (hull.on(mesh.X[n], axis, side)) nodes.push_back(n);
      for (int k = 0; k < 3; ++k) {
        const auto value = imposed.find(3 * nodes.front() + k);
        const auto alike = [&](int n) {
          const auto found = imposed.find(3 * n + k);
          return found != imposed.end() && found->second == value->second;
        };
        if (value == imposed.end() || !std::all_of(nodes.begin(), nodes.end(), alike)) continue;
        for (int n : nodes) explained[3 * n + k] = value->second;
        for (int a = 0; a < 8; ++a)
          if (Hex8::corner[a][axis] == side)
            corners.push_back({3 * a + k, value->second.value, value->second.factor});
      }
    }
  if (imposed != explained) return std::nullopt;
  return corners;
}

// Forces on whole faces, on those of the hexahedron; nothing where one acts on a part of a face.
std::optional<std::vector<SurfaceLoad>> loads_of_faces(const Mesh& mesh,
                                                       const std::vector<SurfaceLoad>& loads,
                                                       const Hull& hull) {
  std::vector<SurfaceLoad> found;
  for (const SurfaceLoad& load : loads) {
    std::array<double, 6> area{};
    for (const Facet& facet : load.facets) {
      const std::vector<int> nodes = facet_nodes(mesh, facet);
      for (int face = 0; face < 6; ++face)
        if (std::all_of(nodes.begin(), nodes.end(),
                        [&](int n) { return hull.on(mesh.X[n], face / 2, face % 2 ? 1 : -1); }))
          area[face] += nodal_areas(mesh, {facet}).sum();
    }
    const Vec3 size = hull.size();
    SurfaceLoad one = load;
    one.facets.clear();
    for (int face = 0; face < 6; ++face) {
      if (area[face] == 0) continue;
      const double whole = size.prod() / size[face / 2];
      if (std::abs(area[face] - whole) > same * whole) return std::nullopt;
      one.facets.push_back({0, face});
    }
    if (one.facets.empty()) return std::nullopt;
    found.push_back(std::move(one));
  }
  return found;
}

}  // namespace

// A box of one material that is loaded on whole faces deforms alike everywhere: one element has the
// deformation of all. It is solved more accurately than asked, since its error appears in each
// element of the mesh.
HomogeneousScene::HomogeneousScene(const Mesh& mesh, const Scene& scene, const SolveConfig& config)
    : asked_(config.solver), solver_(config.solver) {
  if (auto* newton = std::get_if<NewtonOptions>(&solver_))
    newton->relative = std::min(newton->relative, 1e-11);
  corner_node_.fill(-1);
  if (!recognise(mesh, scene)) return;
  seconds_ = config.path.seconds.value_or(0);
  whole_ = std::make_unique<Assembler>(mesh, scene.materials, scene.directions, scene.formulation,
                                       scene.dofs, config.threads);
  if (!scene.loads.empty()) whole_->set_loads({mesh, scene.loads});
}

std::unique_ptr<HomogeneousScene> HomogeneousScene::find(const Mesh& mesh, const Scene& scene,
                                                         const SolveConfig& config) {
  std::unique_ptr<HomogeneousScene> found(new HomogeneousScene(mesh, scene, config));
  if (!found->whole_ || !found->first_increment_balances(config.path)) return nullptr;
  if (!found->whole_->viscous()) return found;
  // Its viscous branches followed the increment of that trial, so a new one is made.
  std::unique_ptr<HomogeneousScene> afresh(new HomogeneousScene(mesh, scene, config));
  return afresh;
}

// The mesh must fill its bounding box, and a node must stand at each corner. The shape functions of
// the box then give the displacements of all nodes.
bool HomogeneousScene::recognise(const Mesh& mesh, const Scene& scene) {
  if (mesh.section || !scene.contacts.empty() || scene.materials.size() != 1 ||
      !same_fibres(mesh, scene))
    return false;
  const Hull hull{bounding_box(mesh.X)};
  const double volume = hull.size().prod();
  if (std::abs(quality(mesh).volume - volume) > same * volume) return false;
  const auto corners = displacements_of_faces(mesh, scene.dofs, hull);
  const auto loads = loads_of_faces(mesh, scene.loads, hull);
  if (!corners || !loads) return false;
  scene_.loads = *loads;

  for (int a = 0; a < 8; ++a) {
    Vec3 X;
    for (int i = 0; i < 3; ++i) X[i] = hull.bound(i, Hex8::corner[a][i]);
    mesh_.X.push_back(X);
    mesh_.connectivity.push_back(a);
    for (int n = 0; n < mesh.n_nodes() && corner_node_[a] < 0; ++n)
      if ((mesh.X[n] - X).norm() <= same * (hull.high - hull.low).norm()) corner_node_[a] = n;
    if (corner_node_[a] < 0) return false;
  }
  mesh_.body = {0};
  mesh_.bodies = {"all"};
  mesh_.frames = {Mat3::Identity()};
  for (const Vec3& X : mesh.X) {
    std::array<double, 8>& N = N_.emplace_back();
    for (int a = 0; a < 8; ++a) {
      N[a] = 1;
      for (int i = 0; i < 3; ++i) {
        const double s = (X[i] - hull.low[i]) / (hull.high[i] - hull.low[i]);
        if (Hex8::corner[a][i] > 0) {
          N[a] *= s;
        } else {
          N[a] *= 1 - s;
        }
      }
    }
  }
  const Vec3 size = hull.size();
  const Material& law =
      scene.materials.front();  // an error of strain of 1e-9 at most: else the mesh may be nearer
  rounding_of_J_ = std::min(std::numeric_limits<double>::epsilon() * bulk_modulus(law),
                            1e-9 * shear_modulus(law)) *
                   size.prod() / size.minCoeff();
  scene_.formulation = usual_formulation(CellType::hex8);
  scene_.materials = scene.materials;
  scene_.stops = scene.stops;
  scene_.directions = scene.directions.of_cells(std::array{0});
  scene_.dofs = number_dofs(8, *corners).dofs;
  return scene_.dofs.n_free() > 0;  // nothing is left to solve where every corner is prescribed
}

Assembler HomogeneousScene::assembler() const {
  return Assembler(mesh_, scene_.materials, scene_.directions, scene_.formulation, scene_.dofs);
}

// The last word is with the mesh itself: the first increment of the box must be in equilibrium
// there.
bool HomogeneousScene::first_increment_balances(const LoadPathOptions& path) {
  bool balances = false;
  RunListener listener;
  listener.of_part = [&](StepRecord& one) {
    balances = whole(one).has_value();
    return false;
  };
  Run(mesh_, scene_, std::nullopt, path, solver_).follow(listener);
  return balances;
}

// Computes the forces of the mesh at displacements u. Viscous branches follow to the time t, unless
// they are there already.
bool HomogeneousScene::balance(const VecX& u, double t) const {
  const bool anew = whole_->viscous() && t != t_;
  if (anew) whole_->begin_increment((t - t_) * seconds_);
  whole_->load_to(t);
  whole_->pressures_from(u);
  if (!whole_->assemble(u, false)) return false;
  if (!anew) return true;
  if (u_.size() == 0) u_ = VecX::Zero(u.size());
  whole_->end_increment(u);
  whole_->accept_increment(u_, u);
  t_ = t;
  u_ = u;
  return true;
}

void HomogeneousScene::replay(const StepRecord& whole) const {
  VecX u(3 * static_cast<Eigen::Index>(whole.u.size()));
  for (std::size_t i = 0; i < whole.u.size(); ++i)
    u.segment<3>(3 * static_cast<Eigen::Index>(i)) = whole.u[i];
  balance(u, whole.t);
}

std::optional<StepRecord> HomogeneousScene::whole(const StepRecord& one) const {
  StepRecord record = one;
  const int n = whole_->mesh().n_nodes();
  record.u.assign(static_cast<std::size_t>(n), Vec3::Zero());
  VecX u(3 * static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < record.u.size(); ++i) {
    for (std::size_t a = 0; a < 8; ++a) record.u[i] += N_[i][a] * one.u[a];
    u.segment<3>(3 * static_cast<Eigen::Index>(i)) = record.u[i];
  }
  if (!balance(u, one.t)) return std::nullopt;
  const bool loaded = !whole_->loads().empty();
  const VecX f = loaded ? VecX(whole_->f_int() - whole_->f_ext()) : whole_->f_int();
  double left = 0;
  double reactions = 0;
  if (loaded) reactions = whole_->f_ext().squaredNorm();
  for (int dof : whole_->dofs().free) left += f[dof] * f[dof];
  record.reaction.assign(record.u.size(), Vec3::Zero());
  for (const Prescribed& p : whole_->dofs().prescribed) {
    reactions += f[p.dof] * f[p.dof];
    record.reaction[static_cast<std::size_t>(p.dof / 3)][p.dof % 3] = f[p.dof];
  }
  left = std::sqrt(left);
  reactions = std::sqrt(reactions);
  const double small = 1e-9 * reactions + rounding_of_J_;
  if (!(left <= small + 10 * whole_->rounding_floor()))
    return std::nullopt;  // it deforms otherwise
  if (!(left <= std::max(small, on_mesh(left, reactions, {}).tolerance)))
    return std::nullopt;  // a solution of the mesh is nearer
  if (reactions > 0) {
    record.residual = left / reactions;
  } else {
    record.residual = left;
  }
  for (auto& [name, values] : record.cell_fields)
    values.assign(static_cast<std::size_t>(whole_->mesh().n_cells()), one.cell_fields.at(name)[0]);
  record.scalars["J_min"] = whole_->J_min(), record.scalars["energy"] = whole_->W();
  if (whole_->viscous()) record.scalars["viscous_work"] = whole_->viscous_work();
  return record;
}

SolveReport HomogeneousScene::on_mesh(double residual, double reactions, SolveReport report) const {
  Assessment found;
  // as Increment assesses a state (solve/balance.hpp)
  found.residual = residual;
  found.reference = reactions;
  found.floor = 3 * whole_->rounding_floor();
  const double least_force = scale_of(*whole_).least_force;
  std::visit(
      [&](const auto& asked) {
        compare(found, asked.absolute.value_or(least_force), asked.relative, report);
      },
      asked_);
  return report;
}

SolveReport HomogeneousScene::report(const SolveReport& of_point, const StepRecord& whole) const {
  double reactions = 0;
  for (const Vec3& r : whole.reaction) reactions += r.squaredNorm();
  if (!whole_->loads().empty()) reactions += whole_->f_ext().squaredNorm();
  reactions = std::sqrt(reactions);
  return on_mesh(std::max(of_point.residual, whole.residual * reactions), reactions, of_point);
}

BodyState HomogeneousScene::reduced(const StepRecord& whole) const {
  BodyState state;
  state.t = whole.t;
  state.u.resize(24);
  for (int a = 0; a < 8; ++a)
    state.u.segment<3>(3 * a) = whole.u[static_cast<std::size_t>(corner_node_[a])];
  return state;
}

}  // namespace langer
