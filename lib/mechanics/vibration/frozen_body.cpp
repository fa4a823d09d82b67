#include "mechanics/vibration/frozen_body.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/tensor/dense.hpp"
#include "mechanics/assembly/mass.hpp"

namespace langer {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

// The constraints without those that hold what is driven along its direction.
Dofs released(Dofs dofs, const Mesh& mesh, const std::optional<Driver>& driver) {
  if (!driver || driver->nodes.empty()) return dofs;
  std::vector<char> moved(static_cast<std::size_t>(dofs.n), 0);
  for (int node : driver->nodes) {
    for (int i = 0; i < 3; ++i) {
      if (driver->along[i] != 0) moved[static_cast<std::size_t>(3 * node + i)] = 1;
    }
  }
  std::vector<Prescribed> held = std::move(dofs.prescribed);
  std::erase_if(held, [&](const Prescribed& p) { return moved[static_cast<std::size_t>(p.dof)]; });
  return number_dofs(mesh.n_nodes(), std::move(held), std::move(dofs.tie), mesh.hanging).dofs;
}

// A closed contact at one node: directions of it that are held, and the turning of its reaction.
struct Touch {
  int node = -1;
  int contact = -1;
  std::vector<Vec3> held;
  Mat3 turning = Mat3::Zero();
};

// Whether a node sticks follows from its reaction alone, so that a run that is continued at the end
// of its path gives the same digits.
std::vector<Touch> touches(const Increment& increment, const std::vector<Vec3>& X) {
  constexpr double inside_the_cone = 1 - 1e-6;
  std::vector<Touch> out;
  const BodyState& state = increment.accepted();
  for (std::size_t k = 0; k < increment.contacts().size(); ++k) {
    const RigidContact& contact = increment.contacts()[k];
    const Vec3 c = indenter_displacement(contact, state.t, state.travel);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const Vec3& r = state.r[k][i];
      if (r.isZero(0)) continue;
      const int node = contact.nodes[i];
      const ShapePoint shape = shape_at(contact.shape, X[node] + state.u.segment<3>(3 * node) - c);
      const double normal = std::max(0.0, r.dot(shape.normal));
      const double tangential = (r - r.dot(shape.normal) * shape.normal).norm();
      const Mat3 frame = contact_frame(shape.normal);
      Touch touch{node, static_cast<int>(k), {frame.col(0)}};
      if (contact.mu > 0 && tangential < inside_the_cone * contact.mu * normal) {
        touch.held.push_back(frame.col(1));
        touch.held.push_back(frame.col(2));
      } else {
        const Mat3 along = Mat3::Identity() - shape.normal * shape.normal.transpose();
        touch.turning = normal * along * shape.curvature * along;
      }
      out.push_back(std::move(touch));
    }
  }
  return out;
}

// Orthonormal columns: the movements that are left of a node.
MatX movements_left(const std::vector<Vec3>& held, const bool* is_free) {
  MatX columns = MatX::Zero(3, 3 + static_cast<Eigen::Index>(held.size()));
  Eigen::Index n = 0;
  for (int j = 0; j < 3; ++j) {
    if (!is_free[j]) columns.col(n++) = Vec3::Unit(j);
  }
  for (const Vec3& h : held) columns.col(n++) = h;
  const Svd of = svd(columns);
  return of.U.rightCols((of.values.array() <= 1e-9).count());
}

SparseX full(const Pattern& pattern, const std::vector<double>& values) {
  Triplets entries;
  entries.reserve(2 * values.size());
  for (int c = 0; c < pattern.n; ++c) {
    for (int k = pattern.column_start[c]; k < pattern.column_start[c + 1]; ++k) {
      entries.emplace_back(pattern.row[k], c, values[k]);
      if (pattern.row[k] != c) entries.emplace_back(c, pattern.row[k], values[k]);
    }
  }
  SparseX A(pattern.n, pattern.n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

// The rows of free dofs of the mass of the body.
SparseX free_mass(const Assembler& body, const Dofs& dofs, const std::vector<double>& density) {
  std::vector<double> share;
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const double whole = element_geometry(element_nodes(body.mesh(), e)).V;
    share.push_back(body.geometry(e).V / whole);
  }
  const BodyModel model(body.mesh(), body.materials(), body.directions(), body.formulation(), dofs,
                        share, std::nullopt);
  const Mass mass = make_mass(model, density, MassKind::consistent);
  Triplets entries;
  for (int column = 0; column < dofs.n_free(); ++column) {
    for (SparseX::InnerIterator entry(mass.M, dofs.free[column]); entry; ++entry) {
      const int row = dofs.equation[static_cast<int>(entry.row())];
      if (row >= 0) entries.emplace_back(row, column, entry.value());
    }
  }
  SparseX M(dofs.n_free(), dofs.n_free());
  M.setFromTriplets(entries.begin(), entries.end());
  return M;
}

// The columns of P, and of R, which is P without what moves with an indenter.
class Columns {
 public:
  Columns(const Dofs& dofs, const std::vector<Touch>& touches) : dofs_(dofs) {
    std::vector<int> touch_of(static_cast<std::size_t>(dofs.n / 3), -1);
    for (std::size_t i = 0; i < touches.size(); ++i) {
      int& known = touch_of[static_cast<std::size_t>(touches[i].node)];
      if (known >= 0) throw std::invalid_argument("a node that touches two indenters");
      known = static_cast<int>(i);
    }
    // Unknowns without a closed contact stay as they are.
    for (int node = 0; node < dofs.n / 3; ++node) {
      int row[3];
      bool is_free[3];
      for (int j = 0; j < 3; ++j) {
        row[j] = dofs.equation[3 * node + j];
        is_free[j] = row[j] >= 0;
      }
      const int touch = touch_of[static_cast<std::size_t>(node)];
      MatX basis = Mat3::Identity();
      if (touch >= 0)
        basis = movements_left(touches[static_cast<std::size_t>(touch)].held, is_free);
      for (Eigen::Index c = 0; c < basis.cols(); ++c) {
        if (touch < 0 && !is_free[c]) continue;
        for (int j = 0; j < 3; ++j) {
          if (!is_free[j] || basis(j, c) == 0) continue;
          P_.emplace_back(row[j], n_, basis(j, c));
          R_.emplace_back(row[j], n_, basis(j, c));
        }
        ++n_;
      }
    }
  }

  // Moves what touches the indenter with it. False, and nothing is added, where a support or
  // symmetry holds such a node: then the indenter cannot move.
  bool add_indenter(const std::vector<Touch>& touches, int contact, const Vec3& along) {
    for (const Touch& touch : touches) {
      if (touch.contact == contact && !moves_along(touch.node, along)) return false;
    }
    for (const Touch& touch : touches) {
      if (touch.contact == contact) add_node(touch.node, along);
    }
    ++n_;
    return true;
  }

  // Moves nodes of the body as a whole, instead of their own movements in that direction.
  bool add_nodes(const std::vector<int>& nodes, const Vec3& along) {
    std::vector<char> driven(static_cast<std::size_t>(dofs_.n_free()), 0);
    for (int node : nodes) {
      if (!moves_along(node, along)) return false;
      for (int j = 0; j < 3; ++j) {
        const int row = dofs_.equation[3 * node + j];
        if (along[j] != 0 && row >= 0) driven[static_cast<std::size_t>(row)] = 1;
      }
    }
    for (Triplets* columns : {&P_, &R_}) {
      std::erase_if(*columns, [&](const auto& entry) {
        return driven[static_cast<std::size_t>(entry.row())];
      });
    }
    for (int node : nodes) add_node(node, along);
    ++n_;
    return true;
  }

  SparseX P() const { return matrix(P_); }
  SparseX R() const { return matrix(R_); }

 private:
  bool moves_along(int node, const Vec3& along) const {
    for (int j = 0; j < 3; ++j) {
      if (along[j] != 0 && dofs_.equation[3 * node + j] < 0) return false;
    }
    return true;
  }

  void add_node(int node, const Vec3& along) {
    for (int j = 0; j < 3; ++j) {
      if (along[j] != 0) P_.emplace_back(dofs_.equation[3 * node + j], n_, along[j]);
    }
  }

  // Columns that erase_if() emptied are left out.
  SparseX matrix(const Triplets& entries) const {
    std::vector<int> place(static_cast<std::size_t>(n_), -1);
    for (const auto& entry : P_) place[static_cast<std::size_t>(entry.col())] = 0;
    int columns = 0;
    for (int& p : place) {
      if (p == 0) p = columns++;
    }
    Triplets kept;
    for (const auto& entry : entries)
      kept.emplace_back(entry.row(), place[static_cast<std::size_t>(entry.col())], entry.value());
    SparseX A(dofs_.n_free(), columns);
    A.setFromTriplets(kept.begin(), kept.end());
    return A;
  }

  const Dofs& dofs_;
  Triplets P_, R_;
  int n_ = 0;
};

}  // namespace

FrozenBody::FrozenBody(Assembler& body, const Increment& increment,
                       const std::vector<double>& density, Dofs dofs, bool symmetric,
                       const std::optional<Driver>& driver)
    : body_(body),
      u_(increment.accepted().u),
      tangent_(body.tangent_under(released(std::move(dofs), body.mesh(), driver))) {
  const std::vector<Touch> closed = touches(increment, body.mesh().X);
  Columns columns(tangent_.dofs, closed);

  for (std::size_t k = 0; k < increment.contacts().size(); ++k) {
    const RigidContact& contact = increment.contacts()[k];
    const int index = static_cast<int>(k);
    if (!symmetric || !contact.control || (driver && driver->contact == index)) continue;
    columns.add_indenter(closed, index, contact.control->along);
  }
  if (driver) {
    const char* held = "supports or symmetry hold a node along that direction";
    bool moves = true;
    if (driver->contact >= 0) {
      const auto touches_it = [&](const Touch& t) {
        return t.contact == driver->contact;
      };
      if (std::ranges::none_of(closed, touches_it))
        throw std::invalid_argument("an indenter that does not touch the body");
      moves = columns.add_indenter(closed, driver->contact, driver->along);
    } else {
      for (const Touch& touch : closed) {
        if (std::ranges::find(driver->nodes, touch.node) != driver->nodes.end())
          throw std::invalid_argument("a face that touches an indenter");
      }
      moves = columns.add_nodes(driver->nodes, driver->along);
    }
    if (!moves) throw std::invalid_argument(held);
    driven_ = true;
  }
  P_ = columns.P();

  Triplets turning;
  for (const Touch& touch : closed) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const int row = tangent_.dofs.equation[3 * touch.node + i];
        const int column = tangent_.dofs.equation[3 * touch.node + j];
        if (row < 0 || column < 0 || touch.turning(i, j) == 0) continue;
        turning.emplace_back(row, column, touch.turning(i, j));
      }
    }
  }
  SparseX B(tangent_.pattern.n, tangent_.pattern.n);
  B.setFromTriplets(turning.begin(), turning.end());
  const SparseX R = columns.R();
  turning_ = R.transpose() * (B * R).eval();
  const SparseX M = free_mass(body, tangent_.dofs, density);
  M_ = P_.transpose() * (M * P_).eval();
}

SparseX FrozenBody::stiffness() {
  body_.pressures_from(u_);
  std::vector<OtherTangent> one;
  one.push_back(std::move(tangent_));
  body_.assemble_under(u_, one);
  tangent_ = std::move(one.front());
  const SparseX K = full(tangent_.pattern, tangent_.K);
  SparseX A = P_.transpose() * (K * P_).eval();
  A -= turning_;
  return A;
}

// The columns of P are orthonormal.
VecX FrozenBody::coordinates(const VecX& u) const {
  VecX rows(tangent_.dofs.n_free());
  for (int row = 0; row < tangent_.dofs.n_free(); ++row) rows[row] = u[tangent_.dofs.free[row]];
  return P_.transpose() * rows;
}

VecX FrozenBody::displacements(const VecX& q) const {
  const VecX rows = P_ * q;
  VecX u = VecX::Zero(tangent_.dofs.n);
  for (int row = 0; row < tangent_.dofs.n_free(); ++row) u[tangent_.dofs.free[row]] = rows[row];
  return u;
}

}  // namespace langer
