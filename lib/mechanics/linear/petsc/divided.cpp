// Multigrid over the rows of several ranks. PETSc wants those of a rank to follow each other: it
// numbers nodes by rank, and then as they are.
#include <algorithm>
#include <optional>

#include "mechanics/linear/petsc/calls.hpp"

namespace langer::petsc_module {

namespace {

// What comes from other ranks is added in their order, not in that of arrival. Of three ranks and
// more that takes another P^T A P than PETSc's own choice, which is faster; matrices of one process
// do not know the word.
class InOrder {
 public:
  explicit InOrder(int ranks) {
    if (ranks > 2) need(PetscOptionsSetValue(nullptr, "-matptap_via", "allatonce"));
  }
  ~InOrder() { passed_over(PetscOptionsClearValue(nullptr, "-matptap_via")); }
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
    const InOrder sums(ranks_.n());
    const bool anew =
        !again || !A_;  // A as well: one that has been used before has other last digits
    if (anew) {
      clear();
      number(A);
      make(A);
    }
    add(A);
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
    order_.clear();
    place_.assign(static_cast<std::size_t>(A.n), 0);
    for (int k = 0; k < ranks_.n(); ++k)
      for (int i = 0; i < nodes; ++i)
        if (A.rank_of_node[i] == k) {
          counts[static_cast<std::size_t>(k)] += 3;
          for (int axis = 0; axis < 3; ++axis)
            place_[static_cast<std::size_t>(3 * i + axis)] = static_cast<int>(order_.size()),
                                                    order_.push_back(3 * i + axis);
        }
    shares_.emplace(std::move(counts));
    whole_.resize(order_.size());
  }

  // Room for what each rank adds to a row: some more where nodes are of several.
  void make(const Rows& A) {
    std::vector<int> within(static_cast<std::size_t>(A.n), 0), beside = within;
    for (int row = 0; row < A.n; ++row)
      for (int at = A.start[row]; at < A.start[row + 1]; ++at)
        ++(A.rank_of_node[row / 3] == A.rank_of_node[A.column[at] / 3] ? within
                                                                       : beside)[place_of(row)];
    for (std::vector<int>* counts : {&within, &beside})
      MPI_Allreduce(MPI_IN_PLACE, counts->data(), A.n, MPI_INT, MPI_SUM, PETSC_COMM_WORLD);
    const int own = shares_->own();
    const int before = shares_->before();
    for (int& count : within) count = std::min(count, own);
    for (int& count : beside) count = std::min(count, A.n - own);
    need(MatCreate(PETSC_COMM_WORLD, &A_));
    need(MatSetSizes(A_, own, own, A.n, A.n));
    need(MatSetType(A_, MATMPIAIJ));
    need(MatSetBlockSize(A_, 3));
    need(MatMPIAIJSetPreallocation(A_, 0, within.data() + before, 0, beside.data() + before));
    need(MatSetOption(A_, MAT_SPD, PETSC_TRUE));
    need(MatCreateVecs(A_, &from_, &to_));
    meet(A);
  }

  // What is added to rows of others goes to them, who add it in the order of ranks: PETSc's own way
  // is that of arrival.
  void meet(const Rows& A) {
    const auto n = static_cast<std::size_t>(ranks_.n());
    std::vector<std::vector<int>> places(n);
    std::vector<std::vector<int>> from(n);
    for (int row = 0; row < A.n; ++row)
      if (const auto of = static_cast<std::size_t>(A.rank_of_node[row / 3]);
          static_cast<int>(of) != ranks_.rank())
        for (int at = A.start[row]; at < A.start[row + 1]; ++at) {
          from[of].push_back(at);
          places[of].push_back(place_of(row));
          places[of].push_back(place_of(A.column[at]));
        }
    out_.clear();
    in_.assign(n, 0);
    n_out_.clear();
    std::vector<int> sent;
    for (std::size_t k = 0; k < n; ++k) {
      n_out_.push_back(static_cast<int>(from[k].size()));
      out_.insert(out_.end(), from[k].begin(), from[k].end());
      sent.insert(sent.end(), places[k].begin(), places[k].end());
    }
    MPI_Alltoall(n_out_.data(), 1, MPI_INT, in_.data(), 1, MPI_INT, PETSC_COMM_WORLD);
    const std::vector<int> first_out = begins(n_out_);
    const std::vector<int> first_in = begins(in_);
    places_in_.resize(2 * static_cast<std::size_t>(first_in.back()));
    MPI_Datatype pair;
    MPI_Type_contiguous(2, MPI_INT, &pair);
    MPI_Type_commit(&pair);
    MPI_Alltoallv(sent.data(), n_out_.data(), first_out.data(), pair, places_in_.data(), in_.data(),
                  first_in.data(), pair, PETSC_COMM_WORLD);
    MPI_Type_free(&pair);
  }

  static std::vector<int> begins(const std::vector<int>& counts) {
    std::vector<int> out(1, 0);
    for (int count : counts) out.push_back(out.back() + count);
    return out;
  }

  void add_of_others(const Rows& A) {
    const std::vector<int> first_out = begins(n_out_);
    const std::vector<int> first_in = begins(in_);
    std::vector<double> out;
    std::vector<double> in(static_cast<std::size_t>(first_in.back()));
    for (int at : out_) out.push_back(A.value[at]);
    MPI_Alltoallv(out.data(), n_out_.data(), first_out.data(), MPI_DOUBLE, in.data(), in_.data(),
                  first_in.data(), MPI_DOUBLE, PETSC_COMM_WORLD);
    for (std::size_t i = 0; i < in.size(); ++i)
      need(MatSetValues(A_, 1, &places_in_[2 * i], 1, &places_in_[2 * i + 1], &in[i], ADD_VALUES));
  }

  void add(const Rows& A) {
    need(MatZeroEntries(A_));
    std::vector<int> columns;
    for (int row = 0; row < A.n; ++row) {
      if (A.rank_of_node[row / 3] != ranks_.rank()) continue;
      columns.clear();
      for (int at = A.start[row]; at < A.start[row + 1]; ++at)
        columns.push_back(place_of(A.column[at]));
      const int place = place_of(row);
      need(MatSetValues(A_, 1, &place, static_cast<int>(columns.size()), columns.data(),
                        A.value + A.start[row], ADD_VALUES));
    }
    add_of_others(A);
    need(MatAssemblyBegin(A_, MAT_FINAL_ASSEMBLY));
    need(MatAssemblyEnd(A_, MAT_FINAL_ASSEMBLY));
  }

  void make_cycle(const double* rigid, int n) {
    std::vector<double> own(static_cast<std::size_t>(shares_->own()));
    const auto values = [&](int k) {
      for (int i = 0; i < shares_->own(); ++i)
        own[static_cast<std::size_t>(i)] = rigid[static_cast<std::size_t>(k) * n + first_of(i)];
      return own.data();
    };
    set_near_null_space(A_, values, 6);
    make_aggregation(cycle_, A_, "langer_ranks_");
  }

  int place_of(int row) const { return place_[static_cast<std::size_t>(row)]; }
  int first_of(int i) const {
    return order_[static_cast<std::size_t>(shares_->before() + i)];
  }  // row, of the i-th of this rank

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
    passed_over(VecDestroy(&from_));
    passed_over(VecDestroy(&to_));
    passed_over(MatDestroy(&A_));
  }

  const Ranks& ranks_;
  std::vector<int> order_, place_;  // row of each place, place of each row
  std::vector<int> out_, n_out_, in_,
      places_in_;  // entries for rows of others: where they stand, how many, and those that come
  std::optional<Shares> shares_;
  std::vector<double> whole_;
  Mat A_ = nullptr;
  PC cycle_ = nullptr;
  Vec from_ = nullptr, to_ = nullptr;
};

}  // namespace

Multigrid* multigrid_of(const Ranks& ranks) { return new DividedAggregation(ranks); }

}  // namespace langer::petsc_module
