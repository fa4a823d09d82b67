#include "mechanics/solve/bodies_in_tangent.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/stopwatch.hpp"
#include "mechanics/contact/alart_curnier.hpp"
#include "mechanics/linear/krylov.hpp"

namespace langer {

namespace {

// candidates that do something else than in the factor, and are left to GMRES
constexpr int most_that_differ = 3;
constexpr double accurate = 1e-6;  // of a step and of the law in it, relative

// By surface, of the order of what the softer side opposes to a movement of one node [N/mm].
std::vector<double> stiffnesses(const Assembler& body,
                                const std::vector<SurfaceContact>& surfaces) {
  const Mesh& mesh = body.mesh();
  std::vector<double> of_node(mesh.X.size(), 0);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const double mu = std::abs(shear_modulus(body.material(e)));
    for (int node : mesh.cell(e)) {
      double& most = of_node[static_cast<std::size_t>(node)];
      most = std::max(most, mu);
    }
  }
  std::vector<double> out;
  for (const SurfaceContact& surface : surfaces) {
    double softer = std::numeric_limits<double>::infinity();
    for (const auto* side : {&surface.own, &surface.other}) {
      double sum = 0;
      for (const QuadNodes& facet : *side) sum += of_node[static_cast<std::size_t>(facet[0])];
      softer = std::min(softer, sum / static_cast<double>(side->size()));
    }
    const double edge = surface.reach / 3;  // the longest
    out.push_back(softer > 0 ? 2.5 * softer * edge * surface.images : 1);
  }
  return out;
}

}  // namespace

bool BodiesInTangent::serves(const Assembler& body, const std::vector<RigidContact>& contacts,
                             const TouchingBodies& bodies) {
  if (bodies.empty() || !contacts.empty()) return false;
  if (ties_nodes(body.dofs()) || !body.mesh().hanging.empty()) return false;
  std::set<int> own, other;
  for (const SurfaceContact& surface : bodies.surfaces()) {
    if (surface.adhesion || surface.touches_itself()) return false;
    for (int node : surface.nodes)
      if (!own.insert(node).second) return false;
    for (const QuadNodes& facet : surface.other) other.insert(facet.begin(), facet.end());
  }
  return std::none_of(own.begin(), own.end(), [&](int node) { return other.count(node) > 0; });
}

BodiesInTangent::BodiesInTangent(const Assembler& body, TouchingBodies& bodies, int threads)
    : body_(body), threads_(threads), rho_(stiffnesses(body, bodies.surfaces())) {
  const std::vector<Vec3>& X = body.mesh().X;
  std::vector<std::set<int>> around(X.size());
  for (const SurfaceContact& surface : bodies.surfaces())
    for (const QuadNodes& facet : surface.other)
      for (int node : facet)
        around[static_cast<std::size_t>(node)].insert(facet.begin(), facet.end());
  for (const std::set<int>& nodes : around) around_.emplace_back(nodes.begin(), nodes.end());
  list_own_rows(bodies);
  // The cost of a factor, from the bodies at rest.
  const VecX at_rest = VecX::Zero(body.dofs().n);
  Reactions r;
  for (const SurfaceContact& surface : bodies.surfaces())
    r.emplace_back(surface.nodes.size(), Vec3::Zero());
  const std::vector<RigidContact> no_indenters;
  const std::vector<VecX> no_start;
  const std::vector<Vec3> none;
  const ContactState state{no_indenters, X, at_rest, no_start, none, none, r};
  linearise(state, bodies, at_rest, at_rest, true);
  make_pattern();
  size_ = linear_->size();
}

void BodiesInTangent::list_own_rows(const TouchingBodies& bodies) {
  const Dofs& dofs = body_.dofs();
  std::set<int> rows;
  for (const SurfaceContact& surface : bodies.surfaces())
    for (int node : surface.nodes)
      for (int dof = 3 * node; dof < 3 * node + 3; ++dof)
        if (dofs.equation[dof] >= 0) rows.insert(dofs.equation[dof]);
  own_rows_.assign(rows.begin(), rows.end());
  own_of_.assign(static_cast<std::size_t>(dofs.n_free()), -1);
  for (std::size_t i = 0; i < own_rows_.size(); ++i)
    own_of_[static_cast<std::size_t>(own_rows_[i])] = static_cast<int>(i);
  in_body_ = rows_in(body_.pattern());
}

// The own rows of a symmetric matrix with this pattern, on both sides of the diagonal.
BodiesInTangent::Rows BodiesInTangent::rows_in(const Pattern& pattern) const {
  Rows out(own_rows_.size());
  for (int column = 0; column < pattern.n; ++column)
    for (int at = pattern.column_start[column]; at < pattern.column_start[column + 1]; ++at) {
      const int row = pattern.row[static_cast<std::size_t>(at)];
      if (const int i = own_of_[static_cast<std::size_t>(row)]; i >= 0)
        out[static_cast<std::size_t>(i)].push_back({column, at});
      if (const int j = own_of_[static_cast<std::size_t>(column)]; j >= 0 && row != column)
        out[static_cast<std::size_t>(j)].push_back({row, at});
    }
  return out;
}

// with_axes: of a new factor. Else false where the rows are not those of the last one.
bool BodiesInTangent::linearise(const ContactState& state, TouchingBodies& bodies,
                                const VecX& u_begin, const VecX& prescribed, bool with_axes) {
  laws_ = surface_laws(state, bodies, u_begin, prescribed, SurfaceLaws::Of::near,
                       SurfaceLaws::Nodes::involved);
  if (with_axes) candidates_.clear();
  std::size_t row = 0;
  for (std::size_t s = 0; s < laws_.mortar.size(); ++s) {
    const MortarLaw& law = laws_.mortar[s];
    for (std::size_t p = 0; p < law.nodes.size(); ++p, ++row) {
      const auto candidate = static_cast<std::size_t>(law.nodes[p].candidate);
      if (!with_axes) {
        if (row >= candidates_.size() || candidates_[row].surface != s ||
            candidates_[row].candidate != candidate)
          return false;
        continue;
      }
      Candidate c{s, candidate, bodies.surfaces()[s].mu, rho_[s], {}, {}};
      const int node = bodies.surfaces()[s].nodes[candidate];
      for (int axis = 0; axis < 3; ++axis)
        if (const int free = body_.dofs().equation[3 * node + axis]; free >= 0) {
          if (c.axes.n == 0) c.axes.first = free;
          c.axes.axis[c.axes.n++] = axis;
        }
      c.axes.turn_to(law.frames[p]);
      candidates_.push_back(c);
    }
  }
  return row == candidates_.size();
}

// T. structure: with ones in place of values, and with the nodes that neighbour those of the other
// side, so that the pattern holds while surfaces slide by less than a facet.
BodiesInTangent::Sparse BodiesInTangent::transformation(bool structure) const {
  const Dofs& dofs = body_.dofs();
  SparseEntries entries;
  std::vector<char> turned(static_cast<std::size_t>(dofs.n_free()), 0);
  std::size_t row = 0;
  for (const MortarLaw& law : laws_.mortar)
    for (std::size_t p = 0; p < law.nodes.size(); ++p, ++row) {
      const JumpAxes& axes = candidates_[row].axes;
      if (!axes.moves) continue;
      for (int i = 0; i < axes.n; ++i) {
        turned[static_cast<std::size_t>(axes.first + i)] = 1;
        for (int j = 0; j < axes.n; ++j)
          entries.add(axes.first + i, axes.first + j, structure ? 1 : axes.Q(i, j));
      }
      const auto add = [&](int node, double weight) {
        for (int axis = 0; axis < 3; ++axis) {
          const int column = dofs.equation[3 * node + axis];
          if (column < 0) continue;
          const Vec3 d = axes.Q * axes.by_axes(weight * law.frames[p].row(axis).transpose());
          for (int i = 0; i < axes.n; ++i)
            entries.add(axes.first + i, column, structure ? 1 : d[i]);
        }
      };
      for (const Weight& w : law.nodes[p].other) {
        if (structure)
          for (int node : around_[static_cast<std::size_t>(w.node)]) add(node, 1);
        else
          add(w.node, -w.of);
      }
    }
  for (int i = 0; i < dofs.n_free(); ++i)
    if (!turned[static_cast<std::size_t>(i)]) entries.add(i, i, 1);
  return entries.matrix(dofs.n_free(), dofs.n_free());
}

void BodiesInTangent::transform(const std::vector<double>& K) {
  T_ = transformation(false);
  if (pattern_holds_ && add_turned(K)) return;
  make_pattern();
  pattern_holds_ = true;
  add_turned(K);
}

// values_ = T^T K T. T = 1 + N has other rows than those of 1 at candidates alone:
//   T^T K T = K + K N + (K N)^T + N^T K N
// False where an entry has no place in the pattern.
bool BodiesInTangent::add_turned(const std::vector<double>& K) {
  values_.assign(pattern_.row.size(), 0);
  for (std::size_t i = 0; i < K.size(); ++i) values_[static_cast<std::size_t>(place_[i])] = K[i];
  const auto own = static_cast<Eigen::Index>(own_rows_.size());
  SparseEntries select, of_columns;
  for (Eigen::Index i = 0; i < own; ++i) {
    const auto at = static_cast<std::size_t>(i);
    select.add(static_cast<int>(i), own_rows_[at], 1);
    for (const Entry& entry : in_body_[at])
      of_columns.add(entry.at, static_cast<int>(i), K[static_cast<std::size_t>(entry.position)]);
  }
  const Sparse rows = select.matrix(own, pattern_.n);
  const Sparse columns = of_columns.matrix(pattern_.n, own);  // of K
  const Sparse N = rows * T_ - rows;
  const Sparse KN = columns * N;
  const Sparse NKN = Sparse(N.transpose()) * Sparse(Sparse(rows * columns) * N);
  const auto add = [&](int row, int column, double value) {
    const auto begin = pattern_.row.begin() + pattern_.column_start[column];
    const auto end = pattern_.row.begin() + pattern_.column_start[column + 1];
    const auto found = std::lower_bound(begin, end, row);
    if (found == end || *found != row) return false;
    values_[static_cast<std::size_t>(found - pattern_.row.begin())] += value;
    return true;
  };
  for (int column = 0; column < pattern_.n; ++column) {
    for (Sparse::InnerIterator entry(KN, column); entry; ++entry) {
      const auto row = static_cast<int>(entry.row());
      if (row >= column && !add(row, column, entry.value())) return false;
      if (row <= column && !add(column, row, entry.value())) return false;
    }
    for (Sparse::InnerIterator entry(NKN, column); entry; ++entry)
      if (const auto row = static_cast<int>(entry.row());
          row >= column && !add(row, column, entry.value()))
        return false;
  }
  return true;
}

// The pattern of T^T K T with the weights of the present facets and of those around them.
void BodiesInTangent::make_pattern() {
  std::vector<int> made_of;
  std::size_t candidate = 0;
  for (const MortarLaw& law : laws_.mortar)
    for (const MortarNode& node : law.nodes) {
      const JumpAxes& axes = candidates_[candidate++].axes;
      if (!axes.moves) continue;
      made_of.push_back(-1 - axes.first);
      for (const Weight& w : node.other) made_of.push_back(w.node);
    }
  if (linear_ && made_of == made_of_) return;
  made_of_ = std::move(made_of);
  const Pattern& body = body_.pattern();
  const std::vector<double> ones(body.row.size(), 1);
  const Eigen::Map<const Sparse> half(body.n, body.n, body.nnz(), body.column_start.data(),
                                      body.row.data(), ones.data());
  const Sparse whole = half.selfadjointView<Eigen::Lower>();
  const Sparse T = transformation(true);
  Sparse lower = Sparse(Sparse(T.transpose()) * Sparse(whole * T)).triangularView<Eigen::Lower>();
  lower.makeCompressed();
  pattern_ = {};
  pattern_.n = body.n;
  pattern_.column_start.assign(lower.outerIndexPtr(), lower.outerIndexPtr() + body.n + 1);
  pattern_.row.assign(lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros());
  place_.clear();
  for (int column = 0; column < body.n; ++column) {
    int at = pattern_.column_start[column];
    for (int i = body.column_start[column]; i < body.column_start[column + 1]; ++i) {
      while (pattern_.row[static_cast<std::size_t>(at)] != body.row[static_cast<std::size_t>(i)])
        ++at;
      place_.push_back(at);
    }
  }
  in_turned_ = rows_in(pattern_);
  linear_ = std::make_unique<LinearSolver>(pattern_, std::vector<int>{}, threads_);
}

// The laws and their forces in terms of y.
void BodiesInTangent::map_laws(const VecX& prescribed, const VecX& rhs) {
  const Dofs& dofs = body_.dofs();
  const auto columns = static_cast<Eigen::Index>(laws_.dofs.size());
  SparseEntries entries;
  VecX imposed = VecX::Zero(columns);
  for (std::size_t c = 0; c < laws_.dofs.size(); ++c) {
    const int row = dofs.equation[laws_.dofs[c]];
    if (row >= 0)
      entries.add(static_cast<int>(c), row, 1);
    else if (prescribed.size() > 0)
      imposed[static_cast<Eigen::Index>(c)] = prescribed[laws_.dofs[c]];
  }
  const Sparse free = entries.matrix(columns, dofs.n_free());
  const Sparse by_y = free * T_;
  const Sparse back = by_y.transpose();
  L_ = laws_.L * by_y;
  G_ = back * laws_.G;
  C_ = back * Sparse(laws_.C * by_y);
  q_ = laws_.q + laws_.L * imposed;
  rhs_ = T_.transpose() * rhs + back * VecX(laws_.C * imposed);
}

// Symmetric matrix of y with the friction of slip; what is held leaves it.
bool BodiesInTangent::factorize() {
  std::vector<double> values = values_;
  std::vector<char> held(static_cast<std::size_t>(pattern_.n), 0);
  for (Candidate& c : candidates_) {
    c.factored = c.law.status;
    c.friction_factored.setZero();
    for (int j = 0; j < c.axes.n; ++j)
      held[static_cast<std::size_t>(c.axes.first + j)] = c.axes.hold(c.factored, j);
    if (!c.friction() || !c.axes.moves) continue;
    c.friction_factored =
        c.axes.along.transpose() * (c.law.k * across_direction(c.law.e)) * c.axes.along;
    for (int j = 1; j < c.axes.n; ++j)
      for (int i = j; i < c.axes.n; ++i)
        values[static_cast<std::size_t>(pattern_.column_start[c.axes.first + j] + i - j)] +=
            c.friction_factored(i - 1, j - 1);
  }
  for (int column = 0; column < pattern_.n; ++column)
    for (int at = pattern_.column_start[column]; at < pattern_.column_start[column + 1]; ++at) {
      const int row = pattern_.row[static_cast<std::size_t>(at)];
      double& value = values[static_cast<std::size_t>(at)];
      if (!held[static_cast<std::size_t>(column)] && !held[static_cast<std::size_t>(row)]) continue;
      value = row == column ? std::max(std::abs(value), 1e-12) : 0;
    }
  ++factorizations_;
  const Stopwatch watch(seconds_);
  return linear_->factorize(values);
}

// Of a reaction, with the multipliers of the axes that are held; constants 0: the part that is
// linear in these and in x.
Vec3 BodiesInTangent::change_of(const Candidate& c, const Vec3& multiplier, const Vec3& x,
                                double constants, const Vec3& present) const {
  if (c.law.status == ContactStatus::open) return -constants * present;
  Vec3 s(multiplier[0], 0, 0);
  if (c.law.status == ContactStatus::stick) {
    s.tail<2>() = c.axes.sticks * multiplier.tail<2>();
    return s;
  }
  s.tail<2>() = -constants * present.tail<2>();
  if (c.friction()) {
    const double pressed = constants * present[0] + multiplier[0];
    s.tail<2>() += c.mu * pressed * c.law.e - c.law.k * (across_direction(c.law.e) * x.tail<2>());
  }
  return s;
}

// Of a vector of unknowns, whose second part has three for each candidate [mm], over its rho [N].
Vec3 BodiesInTangent::multiplier(const VecX& v, std::size_t row) const {
  return candidates_[row].rho * v.segment<3>(pattern_.n + 3 * static_cast<Eigen::Index>(row));
}

VecX BodiesInTangent::right_side() const {
  VecX s(q_.size());
  VecX out = VecX::Zero(pattern_.n + q_.size());
  for (std::size_t p = 0; p < candidates_.size(); ++p) {
    const Candidate& c = candidates_[p];
    const auto at = 3 * static_cast<Eigen::Index>(p);
    const Vec3 q = q_.segment<3>(at);
    s.segment<3>(at) = change_of(c, Vec3::Zero(), q, 1, laws_.r.segment<3>(at));
    if (!c.axes.hold(c.law.status, 0)) continue;
    const Vec3 z = c.axes.by_axes(q);
    for (int j = 0; j < 3; ++j)
      if (c.axes.hold(c.law.status, j)) out[pattern_.n + at + j] = -z[j];
  }
  out.head(pattern_.n) = rhs_ + G_ * s;
  return out;
}

// The system, less what the factor is of, times v. It is not zero on the rows of contact nodes and
// of laws alone.
VecX BodiesInTangent::beyond_factor(const VecX& v) const {
  const VecX y = v.head(pattern_.n);
  const VecX x = L_ * y;
  VecX s(x.size());
  VecX out(v.size());
  VecX in_factor = VecX::Zero(pattern_.n);
  for (std::size_t p = 0; p < candidates_.size(); ++p) {
    const Candidate& c = candidates_[p];
    const auto at = 3 * static_cast<Eigen::Index>(p);
    s.segment<3>(at) = change_of(c, multiplier(v, p), x.segment<3>(at), 0, Vec3::Zero());
    Vec3 z = Vec3::Zero();
    if (c.axes.moves) z = c.axes.by_axes(x.segment<3>(at));
    Vec3 held = Vec3::Zero();
    for (int j = 0; j < 3; ++j) {
      const double free = v[pattern_.n + at + j];
      double law = free;
      if (c.axes.hold(c.law.status, j)) law = z[j];
      double law_in_factor = free;
      if (c.axes.hold(c.factored, j)) {
        law_in_factor = y[c.axes.first + j];
        held[j] = c.rho * free;
      }
      out[pattern_.n + at + j] = law - law_in_factor;
    }
    if (!c.axes.moves) continue;
    const Vec3 row = c.axes.row_of(held);
    for (int j = 0; j < c.axes.n; ++j) {
      double force = 0;
      if (c.axes.hold(c.factored, j)) force = row[j];
      for (int i = 1; i < c.axes.n && j > 0; ++i)
        force -= c.friction_factored(j - 1, i - 1) * y[c.axes.first + i];
      in_factor[c.axes.first + j] = force;
    }
  }
  out.head(pattern_.n) = in_factor - C_ * y - G_ * s;
  return out;
}

// The inverse of what the factor is of: the system as it would be if the law of a candidate had to
// do with the rows of its own node alone.
VecX BodiesInTangent::by_factor(const VecX& v) const {
  VecX out = v;
  VecX forces = v.head(pattern_.n);
  std::vector<std::pair<int, double>> held;  // row, movement
  for (std::size_t p = 0; p < candidates_.size(); ++p) {
    const Candidate& c = candidates_[p];
    for (int j = 0; j < c.axes.n; ++j)
      if (c.axes.hold(c.factored, j))
        held.emplace_back(c.axes.first + j, v[pattern_.n + 3 * static_cast<Eigen::Index>(p) + j]);
  }
  for (const auto& [row, moved] : held)
    for (const Entry& entry :
         in_turned_[static_cast<std::size_t>(own_of_[static_cast<std::size_t>(row)])])
      forces[entry.at] -= values_[static_cast<std::size_t>(entry.position)] * moved;
  for (const auto& [row, moved] : held) forces[row] = 0;
  VecX y = linear_->solve(forces);
  for (const auto& [row, moved] : held) y[row] = moved;
  out.head(pattern_.n) = y;
  for (std::size_t p = 0; p < candidates_.size(); ++p) {
    const Candidate& c = candidates_[p];
    Vec3 lacks = Vec3::Zero();
    for (int j = 0; j < c.axes.n; ++j) {
      if (!c.axes.hold(c.factored, j)) continue;
      const int row = c.axes.first + j;
      double sum = -v[row];
      for (const Entry& entry :
           in_turned_[static_cast<std::size_t>(own_of_[static_cast<std::size_t>(row)])])
        sum += values_[static_cast<std::size_t>(entry.position)] * y[entry.at];
      lacks[j] = sum;
    }
    if (!c.axes.hold(c.factored, 0)) continue;
    const Vec3 of_row = c.axes.multiplier_of(lacks) / c.rho;
    for (int j = 0; j < c.axes.n; ++j)
      if (c.axes.hold(c.factored, j))
        out[pattern_.n + 3 * static_cast<Eigen::Index>(p) + j] = of_row[j];
  }
  return out;
}

std::optional<VecX> BodiesInTangent::solution(int& solutions) const {
  constexpr double enough = 1e-4;
  const auto counted = [&](const VecX& v) {
    ++solutions;
    return by_factor(v);
  };
  const auto product = [&](const VecX& v) {
    return VecX(v + counted(beyond_factor(v)));
  };
  double left = 0;
  const VecX v = solve_near_identity(product, counted(right_side()), accurate, 60, &left);
  if (!v.allFinite() || !(left <= enough)) return std::nullopt;
  return v;
}

BodiesInTangent::Step BodiesInTangent::Step::towards(const Step& other, double share) const {
  return {y + share * (other.y - y), x + share * (other.x - x), r + share * (other.r - r)};
}

BodiesInTangent::Step BodiesInTangent::step_of(const VecX& v) const {
  Step out{v.head(pattern_.n), {}, VecX(q_.size())};
  out.x = q_ + L_ * out.y;
  for (std::size_t p = 0; p < candidates_.size(); ++p) {
    const auto at = 3 * static_cast<Eigen::Index>(p);
    const Vec3 present = laws_.r.segment<3>(at);
    out.r.segment<3>(at) =
        present + change_of(candidates_[p], multiplier(v, p), out.x.segment<3>(at), 1, present);
  }
  return out;
}

// How far reactions are from the law, as a norm [N].
double BodiesInTangent::defect(const Step& step) const {
  double sum = 0;
  for (std::size_t p = 0; p < candidates_.size(); ++p) {
    const auto at = 3 * static_cast<Eigen::Index>(p);
    sum += AlartCurnier(step.r.segment<3>(at), step.x.segment<3>(at), candidates_[p].rho,
                        candidates_[p].mu)
               .F.squaredNorm();
  }
  return std::sqrt(sum);
}

// Judges all candidates anew; how many of them do something else now.
int BodiesInTangent::judge(const VecX& r, const VecX& x) {
  int some = 0;
  for (std::size_t p = 0; p < candidates_.size(); ++p) {
    Candidate& c = candidates_[p];
    const auto at = 3 * static_cast<Eigen::Index>(p);
    const ContactStatus before = c.law.status;
    c.law = law_status(r.segment<3>(at), x.segment<3>(at), c.mu, c.rho);
    some += c.law.status != before;
  }
  return some;
}

BodiesInTangent::Answer BodiesInTangent::answer_of(const Step& step,
                                                   const ContactState& state) const {
  Answer out{T_ * step.y, state.r};
  for (auto& of_contact : out.r)
    std::fill(of_contact.begin(), of_contact.end(), Vec3(Vec3::Zero()));
  VecX local = VecX::Zero(q_.size());
  for (std::size_t p = 0; p < candidates_.size(); ++p) {
    const Candidate& c = candidates_[p];
    const auto at = 3 * static_cast<Eigen::Index>(p);
    Vec3 r = step.r.segment<3>(at);
    if (c.law.status == ContactStatus::open || !(r[0] > 0)) continue;
    put_on_cone(r, c.mu, c.friction());
    local.segment<3>(at) = r;
  }
  laws_.give_reactions(local, out.r);
  return out;
}

std::optional<BodiesInTangent::Answer> BodiesInTangent::solve(
    const ContactState& state, TouchingBodies& bodies, const VecX& u_begin, const VecX& prescribed,
    const std::vector<double>& K, const VecX& rhs) {
  linearise(state, bodies, u_begin, prescribed, true);
  transform(K);
  map_laws(prescribed, rhs);
  judge(laws_.r, laws_.q);
  std::optional<Step> at;
  int solutions = 0;
  bool factored = false;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const auto stuck = [](const Candidate& c) {
      return !c.axes.moves && c.law.status != ContactStatus::open;
    };
    if (std::any_of(candidates_.begin(), candidates_.end(), stuck)) return std::nullopt;
    const auto differ =
        std::count_if(candidates_.begin(), candidates_.end(),
                      [](const Candidate& c) { return c.law.status != c.factored; });
    const bool anew = !factored || differ > most_that_differ;
    if (anew && !factorize()) return std::nullopt;
    factored = true;
    const std::optional<VecX> v = solution(solutions);
    if (!v && anew) return std::nullopt;
    if (!v) {
      factored = false;  // another factor
      continue;
    }
    const Step next = step_of(*v);
    double share = 1;
    if (at) {  // both balance, and so does whatever is between them
      const double before = defect(*at);
      while (share > 0.01 && !(defect(at->towards(next, share)) <= (1 - 0.1 * share) * before))
        share *= 0.5;
    }
    at = at ? at->towards(next, share) : next;
    const int changed = judge(at->r, at->x);
    if (changed == 0 && share == 1 && defect(*at) <= accurate * at->r.norm()) break;
  }
  if (!at) return std::nullopt;
  Answer answer = answer_of(*at, state);
  answer.solutions = solutions;
  return answer;
}

std::optional<BodiesInTangent::Answer> BodiesInTangent::solve_again(const ContactState& state,
                                                                    TouchingBodies& bodies,
                                                                    const VecX& u_begin,
                                                                    const VecX& rhs) {
  const VecX at_rest = VecX::Zero(state.u.size());
  if (!linearise(state, bodies, u_begin, at_rest, false)) return std::nullopt;
  map_laws({}, rhs);
  judge(laws_.r, laws_.q);
  if (std::any_of(candidates_.begin(), candidates_.end(),
                  [](const Candidate& c) { return c.law.status != c.factored; }))
    return std::nullopt;
  int solutions = 0;
  const std::optional<VecX> v = solution(solutions);
  if (!v) return std::nullopt;
  const Step step = step_of(*v);
  Answer answer = answer_of(step, state);
  if (judge(step.r, step.x) > 0) return std::nullopt;
  answer.solutions = solutions;
  return answer;
}

}  // namespace langer
