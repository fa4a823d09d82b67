#include "layers/line_chain.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/tensor/principal.hpp"

namespace langer {

namespace {

// Shape functions on a line of length h, nodes from below: N quadratic, L linear.
//   mass[a][b] h = int N_a N_b        slope[a][b] / h = int N_a' N_b'     mixed[a][b] = int N_a N_b'
//   linear[m][a] h = int L_m N_a      gradient[m][a] = int L_m N_a'       pressures[m][n] h = int L_m L_n
constexpr double mass[3][3] = {
    {4. / 30, 2. / 30, -1. / 30}, {2. / 30, 16. / 30, 2. / 30}, {-1. / 30, 2. / 30, 4. / 30}};
constexpr double slope[3][3] = {
    {7. / 3, -8. / 3, 1. / 3}, {-8. / 3, 16. / 3, -8. / 3}, {1. / 3, -8. / 3, 7. / 3}};
constexpr double mixed[3][3] = {
    {-3. / 6, 4. / 6, -1. / 6}, {-4. / 6, 0, 4. / 6}, {1. / 6, -4. / 6, 3. / 6}};
constexpr double linear[2][3] = {{1. / 6, 1. / 3, 0}, {0, 1. / 3, 1. / 6}};
constexpr double gradient[2][3] = {{-5. / 6, 4. / 6, 1. / 6}, {-1. / 6, -4. / 6, 5. / 6}};
constexpr double pressures[2][2] = {{1. / 3, 1. / 6}, {1. / 6, 1. / 3}};

// Places of the unknowns in a line: those that are eliminated first.
constexpr int eliminated = 7;
constexpr int place_of_node[3] = {4, 0, 7};  // lower, middle, upper
constexpr int place_of_pressure[2] = {3, 10};

template <class Number>
DirectedModuli<Number> in_direction(const Eigen::Matrix<Number, 9, 9>& A, double angle) {
  Mat3 e;
  e.col(0) = Vec3(std::cos(angle), 0, std::sin(angle));
  e.col(1) = Vec3(0, 1, 0);
  e.col(2) = Vec3(-std::sin(angle), 0, std::cos(angle));
  Eigen::Matrix<double, 9, 3> along;
  Eigen::Matrix<double, 9, 3> deep;
  for (int a = 0; a < 3; ++a)
    for (int i = 0; i < 3; ++i)
      for (int p = 0; p < 3; ++p) {
        along(3 * i + p, a) = e(i, a) * e(p, 0);
        deep(3 * i + p, a) = e(i, a) * e(p, 1);
      }
  DirectedModuli<Number> m;
  // products by coefficients: those by blocks take the compiler seconds
  const Eigen::Matrix<Number, 9, 3> A_along = A.lazyProduct(along);
  const Eigen::Matrix<Number, 9, 3> A_deep = A.lazyProduct(deep);
  m.Q = along.transpose().lazyProduct(A_along);
  m.T = deep.transpose().lazyProduct(A_deep);
  const Eigen::Matrix<Number, 3, 3> R = along.transpose().lazyProduct(A_deep);
  // u = (a, i b, c) turns i k R into a real matrix
  m.S.setZero();
  for (const int i : {0, 2}) {
    m.S(i, 1) = R(i, 1);
    m.S(1, i) = -R(1, i);
  }
  return m;
}

template <class Number>
void finish(const LayerState& state, DirectedModuli<Number>& m) {
  m.density = state.density;
  m.compressibility = state.bulk > 0 ? 1 / state.bulk : 0;
}

bool is_negative(double x) { return x < 0; }
bool is_negative(const std::complex<double>&) { return false; }

// A pivot that is exactly 0 would end the elimination; the number of modes is then that just above.
template <class Number>
Number pivot_or_tiny(const Number& pivot) {
  if (pivot != Number(0)) return pivot;
  return Number(-std::numeric_limits<double>::min());
}

int negative_eigenvalues(const Mat3& A) {
  const Vec3 values = principal_values(A);
  return static_cast<int>((values.array() < 0).count());
}
int negative_eigenvalues(const Eigen::Matrix3cd&) { return 0; }

}  // namespace

DirectedModuli<double> directed_moduli(const LayerState& state, double angle) {
  DirectedModuli<double> m = in_direction<double>(state.A, angle);
  finish(state, m);
  return m;
}

DirectedModuli<double> storage_moduli(const LayerState& state, double angle, double frequency) {
  Moduli A = state.A;
  for (const BranchModuli& branch : state.branches) {
    const double x = frequency * branch.tau;
    A += x * x / (1 + x * x) * branch.A;
  }
  DirectedModuli<double> m = in_direction<double>(A, angle);
  finish(state, m);
  return m;
}

DirectedModuli<std::complex<double>> complex_moduli(const LayerState& state, double angle,
                                                    double frequency) {
  Eigen::Matrix<std::complex<double>, 9, 9> A = state.A.cast<std::complex<double>>();
  for (const BranchModuli& branch : state.branches) {
    // exp(-i w t): the loss has a negative sign, and waves decay with Im k > 0
    const std::complex<double> x(0, -frequency * branch.tau);
    A += x / (1. + x) * branch.A.cast<std::complex<double>>();
  }
  DirectedModuli<std::complex<double>> m = in_direction<std::complex<double>>(A, angle);
  finish(state, m);
  return m;
}

template <class Number>
LineChain<Number>::LineChain(std::vector<DirectedModuli<Number>> layers, LineMesh mesh,
                             BottomFace bottom, double surface_tension)
    : layers_(std::move(layers)),
      mesh_(std::move(mesh)),
      held_(!mesh_.cut && bottom == BottomFace::fixed),
      tension_(surface_tension) {}

template <class Number>
void LineChain<Number>::add_stiffness(const DepthLine& line, Number k, double w2, Local& E) const {
  const DirectedModuli<Number>& m = layers_[static_cast<std::size_t>(line.layer)];
  const double h = line.length;
  const Mat volume = h * (k * k * m.Q - Mat(Mat::Identity() * Number(w2 * m.density)));
  const Mat deep = m.T / h;
  const Mat coupled = k * m.S;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      E.template block<3, 3>(place_of_node[a], place_of_node[b]) +=
          mass[a][b] * volume + slope[a][b] * deep + mixed[a][b] * coupled +
          mixed[b][a] * coupled.transpose();
    }
    for (int n = 0; n < 2; ++n) {
      const int p = place_of_pressure[n];
      const int u = place_of_node[a];
      const Number along = k * (linear[n][a] * h);
      E(p, u) += along;
      E(u, p) += along;
      E(p, u + 1) += gradient[n][a];
      E(u + 1, p) += gradient[n][a];
    }
  }
  for (int n = 0; n < 2; ++n)
    for (int l = 0; l < 2; ++l)
      E(place_of_pressure[n], place_of_pressure[l]) -= pressures[n][l] * h * m.compressibility;
}

// A chain of 2^20 lines like the last one, fixed below. Unknowns of a part: (u, p) of its lower
// node, then of its upper one.
template <class Number>
typename LineChain<Number>::HalfSpace LineChain<Number>::half_space(Number k, double w2) const {
  constexpr int doublings = 20;
  constexpr int most = 1 << 20;
  Local E = Local::Zero();
  add_stiffness(mesh_.lines.front(), k, w2, E);
  HalfSpace found;
  for (int c = 0; c < 3; ++c) {  // the middle node of the line
    const Number pivot = pivot_or_tiny(E(c, c));
    if (is_negative(pivot)) ++found.modes;
    for (int col = c + 1; col < 11; ++col) {
      const Number factor = E(c, col) / pivot;
      for (int row = c + 1; row < 11; ++row) E(row, col) -= E(row, c) * factor;
    }
  }
  // pressures first: their pivots are negative
  constexpr int order[8] = {3, 4, 5, 6, 10, 7, 8, 9};
  Eigen::Matrix<Number, 8, 8> part;
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b) part(a, b) = E(order[a], order[b]);
  for (int doubling = 0; doubling < doublings; ++doubling) {
    // unknowns: the node between both parts, the lower one, the upper one
    Eigen::Matrix<Number, 12, 12> both = Eigen::Matrix<Number, 12, 12>::Zero();
    const auto lower = part.template topLeftCorner<4, 4>();
    const auto upper = part.template bottomRightCorner<4, 4>();
    const auto coupling = part.template topRightCorner<4, 4>();
    both.template block<4, 4>(0, 0) = lower + upper;
    both.template block<4, 4>(4, 4) = lower;
    both.template block<4, 4>(8, 8) = upper;
    both.template block<4, 4>(4, 0) = coupling;
    both.template block<4, 4>(0, 4) = coupling.transpose();
    both.template block<4, 4>(0, 8) = coupling;
    both.template block<4, 4>(8, 0) = coupling.transpose();
    found.modes = std::min(2 * found.modes - 1, most);  // less the pressure between
    for (int c = 0; c < 4; ++c) {
      const Number pivot = pivot_or_tiny(both(c, c));
      if (is_negative(pivot)) ++found.modes;
      for (int col = c + 1; col < 12; ++col) {
        const Number factor = both(c, col) / pivot;
        for (int row = c + 1; row < 12; ++row) both(row, col) -= both(row, c) * factor;
      }
    }
    part = both.template bottomRightCorner<8, 8>();
    if (part.template topRightCorner<4, 4>().norm() < 1e-18 * part.norm()) break;
  }
  // the pressure at the fixed end
  const Number pivot = pivot_or_tiny(part(0, 0));
  if (is_negative(pivot)) ++found.modes;
  --found.modes;
  const Eigen::Matrix<Number, 4, 1> column = part.template block<4, 1>(4, 0);
  const Node top = part.template bottomRightCorner<4, 4>() - column * column.transpose() / pivot;
  constexpr int back[4] = {1, 2, 3, 0};  // to (u, p)
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) found.stiffness(a, b) = top(back[a], back[b]);
  return found;
}

template <class Number>
void LineChain<Number>::eliminate(Number k, double w2, bool keep) {
  k_ = k;
  w2_ = w2;
  if (keep) parts_.assign(mesh_.lines.size(), {});
  int negative = 0;
  int constraints = 0;
  Eigen::Matrix<Number, 4, 4> below = Eigen::Matrix<Number, 4, 4>::Zero();  // of (u, p)
  bool at_bottom = held_;
  int below_modes = 0;
  if (mesh_.cut) {
    const HalfSpace deep = half_space(k, w2);
    below = deep.stiffness;
    below_modes = deep.modes;
  }
  modes_of_half_space_ = below_modes;
  for (std::size_t i = 0; i < mesh_.lines.size(); ++i) {
    const DepthLine& line = mesh_.lines[i];
    const bool first_of_layer = i == 0 || mesh_.lines[i - 1].layer != line.layer;
    const bool last_of_layer =
        i + 1 == mesh_.lines.size() || mesh_.lines[i + 1].layer != line.layer;
    if (first_of_layer) ++constraints;
    ++constraints;
    Local E = Local::Zero();
    add_stiffness(line, k, w2, E);
    // the lower node: (u, p) stand at 4..6 and 3
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) E(4 + a, 4 + b) += below(a, b);
      E(4 + a, 3) += below(a, 3);
      E(3, 4 + a) += below(3, a);
    }
    E(3, 3) += below(3, 3);
    if (at_bottom) {
      E.template middleRows<3>(4).setZero();
      E.template middleCols<3>(4).setZero();
      for (int a = 4; a < 7; ++a) E(a, a) = 1;
    }
    at_bottom = false;
    for (int c = 0; c < eliminated; ++c) {
      const Number pivot = pivot_or_tiny(E(c, c));
      if (is_negative(pivot)) ++negative;
      for (int col = c + 1; col < 11; ++col) {
        const Number factor = E(c, col) / pivot;
        if (factor == Number(0)) continue;
        for (int row = c + 1; row < 11; ++row) E(row, col) -= E(row, c) * factor;
      }
    }
    if (keep) {
      // back substitution: rows of the upper triangle, for each unknown of the upper node
      Part& part = parts_[i];
      for (int r = 0; r < 4; ++r)
        for (int c = eliminated - 1; c >= 0; --c) {
          Number sum = -E(c, eliminated + r);
          for (int j = c + 1; j < eliminated; ++j) sum -= E(c, j) * part.eliminated(j, r);
          part.eliminated(c, r) = sum / pivot_or_tiny(E(c, c));
        }
    }
    below = E.template bottomRightCorner<4, 4>();
    if (last_of_layer) {  // the next layer has a pressure of its own
      const Number pivot = pivot_or_tiny(below(3, 3));
      if (is_negative(pivot)) ++negative;
      const Vec column = below.template block<3, 1>(0, 3);
      if (keep) {
        parts_[i].pressure = -column / pivot;
        parts_[i].top_of_layer = true;
      }
      const Mat u = below.template topLeftCorner<3, 3>() - column * column.transpose() / pivot;
      below.setZero();
      below.template topLeftCorner<3, 3>() = u;
    }
  }
  surface_ = below.template topLeftCorner<3, 3>();
  surface_ = (surface_ + Mat(surface_.transpose())) / Number(2);
  surface_(1, 1) += Number(tension_) * k * k;
  modes_below_ = below_modes + negative + negative_eigenvalues(surface_) - constraints;
}

template <class Number>
typename LineChain<Number>::Forms LineChain<Number>::forms(const Vec& v) const {
  Forms forms;
  forms.slope = Number(2 * tension_) * k_ * v[1] * v[1];
  Vec u = v;
  Number p = 0;
  for (std::size_t i = mesh_.lines.size(); i-- > 0;) {
    const DepthLine& line = mesh_.lines[i];
    const DirectedModuli<Number>& m = layers_[static_cast<std::size_t>(line.layer)];
    const Part& part = parts_[i];
    if (part.top_of_layer) p = part.pressure.transpose() * u;
    Eigen::Matrix<Number, 4, 1> upper;
    upper << u, p;
    const Eigen::Matrix<Number, 7, 1> inner = part.eliminated * upper;
    const double h = line.length;
    Vec node[3] = {inner.template segment<3>(4), inner.template head<3>(), u};
    if (i == 0 && held_) node[0].setZero();
    const Number q[2] = {inner[3], p};
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        const Number uu = (node[a].transpose() * node[b])(0);
        const Number uQu = (node[a].transpose() * m.Q * node[b])(0);
        const Number uSu = (node[a].transpose() * m.S * node[b])(0);
        forms.mass += m.density * h * mass[a][b] * uu;
        forms.slope += 2. * k_ * h * mass[a][b] * uQu + 2. * mixed[a][b] * uSu;
      }
      for (int n = 0; n < 2; ++n) forms.slope += 2. * h * linear[n][a] * q[n] * node[a][0];
    }
    u = node[0];
    p = q[0];
  }
  if (mesh_.cut) {
    // dS/dw^2 and dS/dk of the half-space by central differences
    constexpr double h = 1e-5;
    Eigen::Matrix<Number, 4, 1> x;
    x << u, p;
    const double dw2 = h * std::max(w2_, std::abs(k_ * k_) * 1e-6);
    const Number dk = h * k_;
    const Node of_w2 = half_space(k_, w2_ + dw2).stiffness - half_space(k_, w2_ - dw2).stiffness;
    const Node of_k = half_space(k_ + dk, w2_).stiffness - half_space(k_ - dk, w2_).stiffness;
    forms.mass -= (x.transpose() * of_w2 * x)(0) / (2 * dw2);
    forms.slope += (x.transpose() * of_k * x)(0) / (2. * dk);
  }
  return forms;
}

template class LineChain<double>;
template class LineChain<std::complex<double>>;

}  // namespace langer
