// Ranks by MPI, and cells among them by METIS.
#include <metis.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

#include "mechanics/linear/petsc/calls.hpp"

namespace langer::petsc_module {

namespace {

class World : public Ranks {
 public:
  World() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &n_);
    MPI_Comm_dup(MPI_COMM_WORLD, &end_);
  }
  int rank() const override { return rank_; }
  int n() const override { return n_; }

  // By rank 0 for all: MPI promises no more of an MPI_Allreduce than that its results are alike.
  void sum(double* x, std::size_t n) const override {
    constexpr std::size_t most = 1u << 28;  // counts are int
    for (std::size_t at = 0; at < n; at += most) {
      const int part = static_cast<int>(std::min(most, n - at));
      MPI_Reduce(rank_ == 0 ? MPI_IN_PLACE : x + at, x + at, part, MPI_DOUBLE, MPI_SUM, 0,
                 MPI_COMM_WORLD);
      MPI_Bcast(x + at, part, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    }
  }
  double smallest(double x) const override { return of_all(x, MPI_MIN); }
  double largest(double x) const override { return of_all(x, MPI_MAX); }
  void broadcast_from_root(void* x, std::size_t bytes) const override {
    constexpr std::size_t most = 1u << 30;
    for (std::size_t at = 0; at < bytes; at += most)
      MPI_Bcast(static_cast<char*>(x) + at, static_cast<int>(std::min(most, bytes - at)), MPI_BYTE,
                0, MPI_COMM_WORLD);
  }

  std::vector<int> divide(const std::vector<int>& nodes, int per_cell, int n_nodes) const override {
    idx_t n_cells = static_cast<idx_t>(nodes.size()) / per_cell;
    idx_t points = n_nodes;
    idx_t parts = n_;
    idx_t edges = 0;
    idx_t shared = per_cell == 8 ? 4 : 3;  // nodes of a facet
    std::vector<idx_t> begins;
    std::vector<idx_t> of(nodes.begin(), nodes.end());
    std::vector<idx_t> part(static_cast<std::size_t>(n_cells));
    std::vector<idx_t> of_node(static_cast<std::size_t>(n_nodes));
    for (idx_t e = 0; e <= n_cells; ++e) begins.push_back(e * per_cell);
    int code = METIS_OK;
    if (rank_ == 0)
      code =
          METIS_PartMeshDual(&n_cells, &points, begins.data(), of.data(), nullptr, nullptr, &shared,
                             &parts, nullptr, nullptr, &edges, part.data(), of_node.data());
    broadcast_from_root(&code, sizeof code);
    if (code != METIS_OK) throw std::runtime_error("METIS cannot divide the mesh");
    broadcast_from_root(part.data(), part.size() * sizeof(idx_t));
    return {part.begin(), part.end()};
  }

  int end(int code, bool failed, void (*say)(const char*), const std::string& why) override {
    constexpr double patience = 5;  // s, in which a failure that all have meets on all of them
    constexpr useconds_t between = 5000;  // others sleep while rank 0 goes on by itself
    MPI_Request met;
    MPI_Ibarrier(end_, &met);
    int all_here = 0;
    const double begin = MPI_Wtime();
    for (MPI_Test(&met, &all_here, MPI_STATUS_IGNORE); !all_here;
         MPI_Test(&met, &all_here, MPI_STATUS_IGNORE)) {
      if (failed && MPI_Wtime() - begin > patience) {
        if (rank_ > 0) say(why.c_str());
        MPI_Abort(MPI_COMM_WORLD, code);
        _exit(code);
      }
      usleep(between);
    }
    int of_first = code;
    MPI_Bcast(&of_first, 1, MPI_INT, 0, end_);
    return of_first;
  }

 private:
  double of_all(double x, MPI_Op op) const {
    double out = x;
    MPI_Reduce(&x, &out, 1, MPI_DOUBLE, op, 0, MPI_COMM_WORLD);
    MPI_Bcast(&out, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    return out;
  }
  int rank_ = 0, n_ = 1;
  MPI_Comm end_ = MPI_COMM_NULL;
};

}  // namespace

Ranks* world(std::string& why) {
  if (!std::getenv("PMIX_RANK") && !std::getenv("OMPI_COMM_WORLD_SIZE")) {  // MPI would end them
    why = "they were started without a connection; srun --mpi=pmix and Open MPI's mpirun make one";
    return nullptr;
  }
  try {
    begin(true);
  } catch (const std::runtime_error& words) {
    why = words.what();
    return nullptr;
  }
  int n = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &n);
  static World all;
  if (n == launched().n) return &all;
  why = "they are not connected, MPI finds " + std::to_string(n) +
        "; start them by srun --mpi=pmix or Open MPI's mpirun";
  return nullptr;
}

Shares::Shares(std::vector<int> counts) : counts_(std::move(counts)) {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  for (int count : counts_) {
    first_.push_back(all_);
    all_ += count;
  }
}

void Shares::gather(const double* own, double* all) const {
  MPI_Allgatherv(own, this->own(), MPI_DOUBLE, all, counts_.data(), first_.data(), MPI_DOUBLE,
                 MPI_COMM_WORLD);
}

}  // namespace langer::petsc_module
