#include <algorithm>
#include <cstring>
#include <new>

#include "mechanics/linear/linear_state.hpp"

namespace langer {

LinearSolver::LinearSolver(const Pattern& pattern, std::vector<int> last, int threads)
    : state_(std::make_unique<State>()) {
  state_->begin(pattern, threads);
  state_->take_last(std::move(last));
  state_->analyse();
}

LinearSolver::LinearSolver(const Pattern& pattern, Order order, int threads)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  const NoNestedThreads guard;
  s.begin(pattern, threads);
  s.take_last({});
  s.fill_reducing = std::move(order.rows);
  s.order_last();
  if (!s.L) throw std::bad_alloc();
}

const std::vector<int>& LinearSolver::order() const { return state_->fill_reducing; }

void LinearSolver::State::begin(const Pattern& pattern, int threads) {
  blas::check_buffers();
  blas::set_threads(std::max(1, threads));
  cholmod_start(&common);
  common.print = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.final_ll = 1;
  common.nmethods = 1;
  A = cholmod_allocate_sparse(pattern.n, pattern.n, pattern.nnz(), 1, 1, -1, CHOLMOD_REAL, &common);
  if (!A) throw std::bad_alloc();
  std::copy(pattern.column_start.begin(), pattern.column_start.end(), static_cast<int*>(A->p));
  std::copy(pattern.row.begin(), pattern.row.end(), static_cast<int*>(A->i));
}

LinearSolver::~LinearSolver() = default;

void LinearSolver::State::take_last(std::vector<int> rows) {
  last = std::move(rows);
  place_of.assign(A->nrow, -1);
  for (std::size_t i = 0; i < last.size(); ++i) place_of[last[i]] = static_cast<int>(i);
}

void LinearSolver::eliminate_last(std::vector<int> last) {
  State& s = *state_;
  const NoNestedThreads guard;
  s.take_last(std::move(last));
  s.trailing_block.resize(0, 0);
  s.indefinite = false;
  s.springs.clear();
  s.order_last();
  if (!s.L) throw std::bad_alloc();
}

// CHOLMOD's nested dissection, with separators by METIS, orders the rows for small fill. Factors
// take 5 to 10 % less work than in METIS's own order. order_last() then moves the rows of `last` to
// the end.
void LinearSolver::State::analyse() {
  const NoNestedThreads guard;
  common.method[0].ordering = CHOLMOD_NESDIS;
  {
    const auto alone = one_ordering_at_a_time();
    L = cholmod_analyze(A, &common);
  }
  if (!L) throw std::bad_alloc();
  const int* order = static_cast<int*>(L->Perm);
  fill_reducing.assign(order, order + A->nrow);
  if (!last.empty()) order_last();
  if (!L) throw std::bad_alloc();
}

void LinearSolver::State::order_last() {
  const int n = static_cast<int>(A->nrow);
  const int m = static_cast<int>(last.size());
  std::vector<int> order;
  order.reserve(n);
  for (int i = 0; i < n; ++i)
    if (place_of[fill_reducing[i]] < 0) order.push_back(fill_reducing[i]);
  order.insert(order.end(), last.begin(), last.end());
  cholmod_free_factor(&L, &common);
  cholmod_free_sparse(&permuted, &common);
  common.method[0].ordering = CHOLMOD_GIVEN;
  L = cholmod_analyze_p(A, order.data(), nullptr, 0, &common);
  if (!L) return;
  // CHOLMOD's postordering may permute the last rows among themselves. If the matrix is that of
  // several unconnected bodies, it orders body by body. Then the last rows of all bodies are moved
  // to the end once more: rows keep their order otherwise, so that the supernodes stay as they are,
  // and another postordering is not needed.
  const int* permutation = static_cast<int*>(L->Perm);
  const auto is_last = [&](int row) {
    return place_of[row] >= 0;
  };
  if (!std::all_of(permutation + (n - m), permutation + n, is_last)) {
    order.assign(permutation, permutation + n);
    std::stable_partition(order.begin(), order.end(), [&](int row) { return !is_last(row); });
    cholmod_free_factor(&L, &common);
    const int postorder = common.postorder;
    common.postorder = 0;
    L = cholmod_analyze_p(A, order.data(), nullptr, 0, &common);
    common.postorder = postorder;
    if (!L) return;
    permutation = static_cast<int*>(L->Perm);
  }
  trailing = !last.empty();
  trailing_order.resize(m);
  for (int i = 0; i < m; ++i) {
    trailing_order[i] = place_of[permutation[n - m + i]];
    trailing = trailing && trailing_order[i] >= 0;
  }
}

bool LinearSolver::factorize(const std::vector<double>& values) {
  State& s = *state_;
  const NoNestedThreads guard;
  std::copy(values.begin(), values.end(), static_cast<double*>(s.A->x));
  s.indefinite = false;
  s.springs.clear();
  return s.cholesky();
}

// Each entry of the lower triangle of A moves into the lower triangle of P A P^T.
void LinearSolver::State::permute_pattern() {
  const int n = static_cast<int>(A->nrow);
  permuted = cholmod_allocate_sparse(n, n, A->nzmax, 0, 1, -1, CHOLMOD_REAL, &common);
  if (!permuted) throw std::bad_alloc();
  const int *order = static_cast<int*>(L->Perm), *start = static_cast<int*>(A->p),
            *row = static_cast<int*>(A->i);
  std::vector<int> place(n);
  for (int i = 0; i < n; ++i) place[order[i]] = i;
  int* to_start = static_cast<int*>(permuted->p);
  std::fill(to_start, to_start + n + 1, 0);
  for (int c = 0; c < n; ++c)
    for (int k = start[c]; k < start[c + 1]; ++k) ++to_start[std::min(place[row[k]], place[c]) + 1];
  for (int c = 0; c < n; ++c) to_start[c + 1] += to_start[c];
  std::vector<int> next(to_start, to_start + n);
  int* to_row = static_cast<int*>(permuted->i);
  permuted_from.resize(A->nzmax);
  // A is read by the columns of L, so that a column of the result reads few columns of A
  for (int i = 0; i < n; ++i) {
    const int c = order[i];
    for (int k = start[c]; k < start[c + 1]; ++k) {
      const int at = next[std::min(place[row[k]], i)]++;
      to_row[at] = std::max(place[row[k]], i);
      permuted_from[at] = k;
    }
  }
}

bool LinearSolver::State::cholesky() {
  common.status = CHOLMOD_OK;
  trailing_block.resize(0, 0);
  if (A->nrow == 0) {
    cholmod_factorize(A, L, &common);
  } else {
    if (!permuted) permute_pattern();
    const double* from = static_cast<double*>(A->x);
    double* to = static_cast<double*>(permuted->x);
    for (std::size_t k = 0; k < permuted_from.size(); ++k) to[k] = from[permuted_from[k]];
    double no_shift[2] = {0, 0};
    cholmod_super_numeric(permuted, nullptr, no_shift, L, &common);
  }
  if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  return common.status != CHOLMOD_NOT_POSDEF && L->minor >= L->n;
}

VecX LinearSolver::solve(const VecX& b) const {
  State& s = *state_;
  const NoNestedThreads guard;
  VecX x(b.size());
  if (s.indefinite) {
    double control[UMFPACK_CONTROL];
    umfpack_di_defaults(control);
    umfpack_di_solve(UMFPACK_A, s.full.start.data(), s.full.row.data(), s.full.value.data(),
                     x.data(), b.data(), s.full.numeric, control, nullptr);
    return x;
  }
  x = s.whole(b);
  if (s.springs.empty()) return x;
  VecX at(s.springs.size());
  for (std::size_t i = 0; i < s.springs.size(); ++i) at[i] = x[s.springs[i]];
  return x + s.spring_moves * s.spring_share.solve(at);
}

// With K = L L^T and the rows of `last` at the end of L, the first half ends with L^-1 P b. Its
// tail gives x on the rows of `last` by the small trailing factor alone.
LinearSolver::Half LinearSolver::start(const VecX& b) const {
  const State& s = *state_;
  const Eigen::Index n = b.size();
  const Eigen::Index m = static_cast<Eigen::Index>(s.last.size());
  Half half{VecX(m), VecX(n)};
  if (!s.halves()) {
    half.rest = solve(b);
    for (Eigen::Index i = 0; i < m; ++i) half.last[i] = half.rest[s.last[i]];
    return half;
  }
  const NoNestedThreads guard;
  const int* permutation = static_cast<int*>(s.L->Perm);
  VecX permuted(n);
  for (Eigen::Index i = 0; i < n; ++i) permuted[i] = b[permutation[i]];
  half.rest = s.through(CHOLMOD_L, permuted);
  const VecX x =
      s.trailing_factor().triangularView<Eigen::Lower>().transpose().solve(half.rest.tail(m));
  for (Eigen::Index i = 0; i < m; ++i) half.last[s.trailing_order[i]] = x[i];
  return half;
}

VecX LinearSolver::finish(const Half& half, const VecX& c) const {
  const State& s = *state_;
  const Eigen::Index n = half.rest.size();
  const Eigen::Index m = static_cast<Eigen::Index>(s.last.size());
  if (!s.halves()) {
    VecX b = VecX::Zero(n);
    for (Eigen::Index i = 0; i < m; ++i) b[s.last[i]] += c[i];
    return half.rest + solve(b);
  }
  const NoNestedThreads guard;
  VecX ordered(m), y = half.rest;
  for (Eigen::Index i = 0; i < m; ++i) ordered[i] = c[s.trailing_order[i]];
  y.tail(m) += s.trailing_factor().triangularView<Eigen::Lower>().solve(ordered);
  y = s.through(CHOLMOD_Lt, y);
  const int* permutation = static_cast<int*>(s.L->Perm);
  VecX x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[permutation[i]] = y[i];
  return x;
}

VecX LinearSolver::State::whole(const VecX& b) const { return through(CHOLMOD_A, b); }

VecX LinearSolver::State::through(int system, const VecX& b) const {
  VecX x(b.size());
  if (b.size() == 0) return x;  // all nodes are prescribed; CHOLMOD needs an address
  cholmod_dense rhs{};
  rhs.nrow = rhs.d = rhs.nzmax = b.size();
  rhs.ncol = 1;
  rhs.x = const_cast<double*>(b.data());
  rhs.xtype = CHOLMOD_REAL;
  rhs.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* y = cholmod_solve(system, L, &rhs, const_cast<cholmod_common*>(&common));
  if (!y) throw std::bad_alloc();
  std::memcpy(x.data(), y->x, sizeof(double) * b.size());
  cholmod_free_dense(&y, const_cast<cholmod_common*>(&common));
  return x;
}

// Lower-triangular trailing block of L, read from the supernodes.
const MatX& LinearSolver::State::trailing_factor() const {
  if (trailing_block.size() > 0) return trailing_block;
  const int n = static_cast<int>(L->n);
  const int m = static_cast<int>(last.size());
  const int first = n - m;
  const int *super = static_cast<int*>(L->super), *pi = static_cast<int*>(L->pi),
            *px = static_cast<int*>(L->px), *rows = static_cast<int*>(L->s);
  const double* x = static_cast<double*>(L->x);
  MatX& block = trailing_block = MatX::Zero(m, m);
  for (int k = static_cast<int>(L->nsuper) - 1; k >= 0 && super[k + 1] > first; --k) {
    const int n_rows = pi[k + 1] - pi[k];
    for (int c = std::max(super[k], first); c < super[k + 1]; ++c)
      for (int q = c - super[k]; q < n_rows; ++q)
        block(rows[pi[k] + q] - first, c - first) =
            x[px[k] + q + static_cast<std::size_t>(c - super[k]) * n_rows];
  }
  return block;
}

// The trailing block L_22 of the factor satisfies  S = L_22 L_22^T  for the Schur complement S of
// the rows of `last`, so that  B^T K^-1 B = Y^T Y  with Y = L_22^-1 B. Springs are removed by
// Woodbury's formula. Without such a block, each column costs a solve.
MatX LinearSolver::compliance(const MatX& B) const {
  const State& s = *state_;
  if (s.trailing && !s.indefinite) {
    MatX Y(B.rows(), B.cols());
    for (Eigen::Index i = 0; i < B.rows(); ++i) Y.row(i) = B.row(s.trailing_order[i]);
    s.trailing_factor().triangularView<Eigen::Lower>().solveInPlace(Y);
    MatX W = MatX::Zero(B.cols(), B.cols());
    W.selfadjointView<Eigen::Lower>().rankUpdate(Y.transpose());
    W = MatX(W.selfadjointView<Eigen::Lower>());
    if (s.springs.empty()) return W;
    MatX moves(B.cols(), s.springs.size());  // of the contacts by the springs
    for (std::size_t k = 0; k < s.springs.size(); ++k) {
      VecX picked(s.last.size());
      for (std::size_t i = 0; i < s.last.size(); ++i) picked[i] = s.spring_moves(s.last[i], k);
      moves.col(k) = B.transpose() * picked;
    }
    W += moves * s.spring_share.solve_columns(moves.transpose());
    return 0.5 * (W + W.transpose());
  }
  MatX W(B.cols(), B.cols());
  VecX rhs = VecX::Zero(s.L->n);
  for (Eigen::Index c = 0; c < B.cols(); ++c) {
    for (std::size_t i = 0; i < s.last.size(); ++i) rhs[s.last[i]] = B(i, c);
    const VecX x = solve(rhs);
    VecX picked(s.last.size());
    for (std::size_t i = 0; i < s.last.size(); ++i) picked[i] = x[s.last[i]];
    W.col(c) = B.transpose() * picked;
  }
  return W;
}

std::optional<MatX> LinearSolver::schur() const {
  const State& s = *state_;
  if (!s.trailing || s.indefinite || !s.springs.empty()) return std::nullopt;
  const MatX& L = s.trailing_factor();
  MatX ordered = MatX::Zero(L.rows(), L.rows());
  ordered.selfadjointView<Eigen::Lower>().rankUpdate(L);
  MatX S(L.rows(), L.rows());
  for (Eigen::Index i = 0; i < S.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      S(s.trailing_order[i], s.trailing_order[j]) = S(s.trailing_order[j], s.trailing_order[i]) =
          ordered(i, j);
  return S;
}

LinearSolver::Size LinearSolver::size() const {
  const State& s = *state_;
  const double nonzeros = static_cast<double>(s.A->nzmax);
  const double block = static_cast<double>(s.last.size());
  // supernodes and their workspace; K permuted, and where its entries come from; the trailing block
  // of the candidates and their compliance
  const double bytes = 8.0 * static_cast<double>(s.L->xsize + s.L->maxcsize) + 16.0 * nonzeros +
                       3 * 8.0 * block * block;
  return {nonzeros, s.common.lnz, bytes, s.common.fl};
}

}  // namespace langer
