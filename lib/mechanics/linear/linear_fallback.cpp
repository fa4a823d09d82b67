// Tangents that are not positive definite: with springs, by UMFPACK, and how many directions give
// way.
#include <algorithm>
#include <new>

#include "mechanics/linear/linear_state.hpp"

namespace langer {

bool LinearSolver::factorize_with_springs(const std::vector<double>& values, int most) {
  State& s = *state_;
  const NoNestedThreads guard;
  const int* column_start = static_cast<int*>(s.A->p);
  double* x = static_cast<double*>(s.A->x);
  std::copy(values.begin(), values.end(), x);
  s.indefinite = false;
  s.springs.clear();
  double mean = 0;  // a column starts with its diagonal
  for (std::size_t row = 0; row < s.A->nrow; ++row)
    mean += std::abs(values[column_start[row]]) / static_cast<double>(s.A->nrow);
  std::vector<double> stiffness;
  for (int attempt = 0; !s.cholesky(); ++attempt) {
    const int row = static_cast<int*>(s.L->Perm)[s.L->minor];
    if (attempt == most) {
      s.springs.clear();
      return false;
    }
    // after an earlier pivot near zero a later one may be as low as any number: then its spring is
    // made stiffer
    const auto known = std::find(s.springs.begin(), s.springs.end(), row);
    double more = 100 * std::max(mean, std::abs(values[column_start[row]]));
    if (known == s.springs.end()) {
      s.springs.push_back(row);
      stiffness.push_back(more);
    } else {
      double& k = stiffness[static_cast<std::size_t>(known - s.springs.begin())];
      more = 9 * k;
      k += more;
    }
    x[column_start[row]] += more;
  }
  const int q = static_cast<int>(s.springs.size());
  if (q == 0) return true;
  // (K + E k E^T - E k E^T)^-1 = Z + Z E (1/k - E^T Z E)^-1 E^T Z
  MatX share = MatX::Zero(q, q);
  s.spring_moves.resize(s.A->nrow, q);
  for (int i = 0; i < q; ++i)
    s.spring_moves.col(i) = s.whole(VecX::Unit(static_cast<Eigen::Index>(s.A->nrow), s.springs[i]));
  for (int i = 0; i < q; ++i) {
    share(i, i) = 1 / stiffness[i];
    for (int j = 0; j < q; ++j) share(i, j) -= s.spring_moves(s.springs[i], j);
  }
  s.spring_share.compute(share);
  if (s.spring_share.rcond() > 1e-14) return true;
  s.springs.clear();
  return false;
}

bool LinearSolver::factorize_indefinite(const std::vector<double>& values) {
  const NoNestedThreads guard;
  std::copy(values.begin(), values.end(), static_cast<double*>(state_->A->x));
  state_->indefinite = true;
  return state_->factorize_indefinite();
}

bool LinearSolver::State::factorize_indefinite() {
  const int n = static_cast<int>(A->nrow);
  const int *p = static_cast<int*>(A->p), *row = static_cast<int*>(A->i);
  const double* x = static_cast<double*>(A->x);
  if (full.start.empty()) {  // both triangles, and from which entry of A each comes
    full.start.assign(n + 1, 0);
    for (int c = 0; c < n; ++c)
      for (int k = p[c]; k < p[c + 1]; ++k) {
        ++full.start[c + 1];
        if (row[k] != c) ++full.start[row[k] + 1];
      }
    for (int c = 0; c < n; ++c) full.start[c + 1] += full.start[c];
    full.row.resize(full.start[n]);
    full.from.resize(full.start[n]);
    full.value.resize(full.start[n]);
    std::vector<int> next(full.start.begin(), full.start.end() - 1);
    for (int c = 0; c < n;
         ++c)  // ascending c puts the upper entries of a column before its lower ones, in order
      for (int k = p[c]; k < p[c + 1]; ++k)
        if (row[k] != c) {
          full.row[next[row[k]]] = c;
          full.from[next[row[k]]++] = k;
        }
    for (int c = 0; c < n; ++c)
      for (int k = p[c]; k < p[c + 1]; ++k) {
        full.row[next[c]] = row[k];
        full.from[next[c]++] = k;
      }
  }
  for (std::size_t k = 0; k < full.from.size(); ++k) full.value[k] = x[full.from[k]];
  double control[UMFPACK_CONTROL];
  umfpack_di_defaults(control);
  control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  control[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
  const auto worked = [](int status) {
    if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
    return status == UMFPACK_OK;
  };
  if (!full.symbolic) {
    const auto alone = one_ordering_at_a_time();
    if (!worked(umfpack_di_symbolic(n, n, full.start.data(), full.row.data(), full.value.data(),
                                    &full.symbolic, control, nullptr)))
      return false;
  }
  if (full.numeric) umfpack_di_free_numeric(&full.numeric);
  return worked(umfpack_di_numeric(full.start.data(), full.row.data(), full.value.data(),
                                   full.symbolic, &full.numeric, control, nullptr));
}

int LinearSolver::negative_pivots(const std::vector<double>& values) {
  State& s = *state_;
  const NoNestedThreads guard;
  std::copy(values.begin(), values.end(), static_cast<double*>(s.A->x));
  const auto way = s.common.supernodal;
  const auto ordering = s.common.method[0].ordering;
  const auto final_ll = s.common.final_ll;
  s.common.supernodal = CHOLMOD_SIMPLICIAL;
  s.common.final_ll = 0;
  s.common.method[0].ordering = CHOLMOD_GIVEN;
  s.common.status = CHOLMOD_OK;
  cholmod_factor* D = cholmod_analyze_p(s.A, static_cast<int*>(s.L->Perm), nullptr, 0, &s.common);
  int negative = -1;
  if (D && cholmod_factorize(s.A, D, &s.common) && D->minor >= D->n && !D->is_ll) {
    negative = 0;
    for (std::size_t i = 0; i < D->n; ++i)
      negative += static_cast<double*>(D->x)[static_cast<int*>(D->p)[i]] < 0;
  }
  if (D) cholmod_free_factor(&D, &s.common);
  s.common.supernodal = way;
  s.common.final_ll = final_ll;
  s.common.method[0].ordering = ordering;
  if (s.common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  return negative;
}

}  // namespace langer
