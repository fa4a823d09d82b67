// Multigrid over the rows of several ranks. PETSc wants those of a rank to follow each other: it numbers nodes by rank, and then as they are.
#include <optional>
#include <stdexcept>

#include "linear/petsc/calls.hpp"

namespace langer::petsc_module {

namespace {

// What comes from other ranks is added in their order, not in that of arrival: PETSc's own choice of P^T A P differs from run to run
// with three ranks and more. Matrices of one process do not know the word.
class InOrder {
 public:
  InOrder() {
    need(PetscOptionsSetValue(nullptr, "-matstash_reproduce", "true"));
    need(PetscOptionsSetValue(nullptr, "-matptap_via", "allatonce"));
  }
  ~InOrder() {
    for (const char* option : {"-matstash_reproduce", "-matptap_via"}) passed_over(PetscOptionsClearValue(nullptr, option));
  }
  InOrder(const InOrder&) = delete;
  InOrder& operator=(const InOrder&) = delete;
};

class DividedAggregation : public Multigrid {
 public:
  explicit DividedAggregation(const Ranks& ranks) : ranks_(ranks) {}
  ~DividedAggregation() override { clear(); }

  // A failure is one of all ranks, or the end of the program: the others would wait.
  bool setup(const Rows& A, const double* rigid, bool again, std::string&) override {
    const std::lock_guard alone(mutex);
    begin();
    const bool anew = !again || !A_;
    if (anew) clear(), number(A), make(A);
    const InOrder sums;
    need(MatSetValuesCOO(A_, A.value, INSERT_VALUES));
    if (anew) make_cycle(rigid, A.n);
    need(PCSetUp(cycle_));
    return true;
  }

  void apply(const double* r, double* z) override {
    of_whole(r, z, [this] { need(PCApply(cycle_, from_, to_)); });
  }
  void times(const double* x, double* y) override {
    of_whole(x, y, [this] { need(MatMult(A_, from_, to_)); });
  }

 private:
  void number(const Rows& A) {
    const int nodes = A.n / 3;
    std::vector<int> counts(static_cast<std::size_t>(ranks_.n()), 0);
    order_.clear(), place_.assign(static_cast<std::size_t>(A.n), 0);
    for (int k = 0; k < ranks_.n(); ++k)
      for (int i = 0; i < nodes; ++i)
        if (A.rank_of_node[i] == k) {
          counts[static_cast<std::size_t>(k)] += 3;
          for (int axis = 0; axis < 3; ++axis)
            place_[static_cast<std::size_t>(3 * i + axis)] = static_cast<int>(order_.size()), order_.push_back(3 * i + axis);
        }
    shares_.emplace(std::move(counts));
    whole_.resize(order_.size());
  }

  void make(const Rows& A) {
    std::vector<int> rows, columns;
    rows.reserve(static_cast<std::size_t>(A.start[A.n])), columns.reserve(rows.capacity());
    for (int row = 0; row < A.n; ++row)
      for (int at = A.start[row]; at < A.start[row + 1]; ++at)
        rows.push_back(place_[static_cast<std::size_t>(row)]), columns.push_back(place_[static_cast<std::size_t>(A.column[at])]);
    need(MatCreate(PETSC_COMM_WORLD, &A_));
    need(MatSetSizes(A_, shares_->own(), shares_->own(), A.n, A.n));
    need(MatSetType(A_, MATMPIAIJ));
    need(MatSetBlockSize(A_, 3));
    need(MatSetPreallocationCOO(A_, static_cast<PetscCount>(rows.size()), rows.data(), columns.data()));
    need(MatSetOption(A_, MAT_SPD, PETSC_TRUE));
    need(MatCreateVecs(A_, &from_, &to_));
  }

  void make_cycle(const double* rigid, int n) {
    std::vector<double> own(static_cast<std::size_t>(shares_->own()));
    const auto values = [&](int k) {
      for (int i = 0; i < shares_->own(); ++i)
        own[static_cast<std::size_t>(i)] = rigid[static_cast<std::size_t>(k) * n + first_of(i)];
      return own.data();
    };
    set_near_null_space(A_, values, 6);
    need(PCCreate(PETSC_COMM_WORLD, &cycle_));
    need(PCSetType(cycle_, PCGAMG));
    need(PCSetOperators(cycle_, A_, A_));
    need(PCSetOptionsPrefix(cycle_, "langer_ranks_"));
    need(PCGAMGSetReuseInterpolation(cycle_, PETSC_TRUE));
    need(PCSetFromOptions(cycle_));
  }

  int first_of(int i) const { return order_[static_cast<std::size_t>(shares_->before() + i)]; }  // row, of the i-th of this rank

  template <class Apply>
  void of_whole(const double* x, double* y, Apply apply) {
    const std::lock_guard alone(mutex);
    double* own = nullptr;
    need(VecGetArray(from_, &own));
    for (int i = 0; i < shares_->own(); ++i) own[i] = x[first_of(i)];
    need(VecRestoreArray(from_, &own));
    apply();
    const double* found = nullptr;
    need(VecGetArrayRead(to_, &found));
    shares_->gather(found, whole_.data());
    need(VecRestoreArrayRead(to_, &found));
    for (std::size_t i = 0; i < order_.size(); ++i) y[order_[i]] = whole_[i];
  }

  void clear() {
    passed_over(PCDestroy(&cycle_));
    passed_over(VecDestroy(&from_)), passed_over(VecDestroy(&to_));
    passed_over(MatDestroy(&A_));
  }

  const Ranks& ranks_;
  std::vector<int> order_, place_;  // row of each place, place of each row
  std::optional<Shares> shares_;
  std::vector<double> whole_;
  Mat A_ = nullptr;
  PC cycle_ = nullptr;
  Vec from_ = nullptr, to_ = nullptr;
};

}  // namespace

Multigrid* multigrid_of(const Ranks& ranks) { return new DividedAggregation(ranks); }

}  // namespace langer::petsc_module
