// Ranks: the processes that mpirun or srun has started for one solution. All of them run the same
// program with the same numbers. Each assembles its own cells, and the contributions are summed.
// Only rank 0 (the root) writes messages and files.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

namespace langer {

// How many processes were started together and which of them this one is, by the environment; MPI
// need not be loaded for it.
struct Launched {
  int rank = 0, n = 1;
};
inline Launched launched() {
  constexpr const char* names[][2] = {
      {"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
      {"PMI_SIZE", "PMI_RANK"},
      // of a step: a batch script has SLURM_NTASKS for all of its job
      {"SLURM_STEP_NUM_TASKS", "SLURM_PROCID"}};
  for (const auto& [size, rank] : names) {
    const char *n = std::getenv(size), *own = std::getenv(rank);
    if (n && own && std::atoi(n) > 0) return {std::atoi(own), std::atoi(n)};
  }
  return {};
}

// Each function is called by all ranks, in the same order.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int n() const = 0;
  bool first() const { return rank() == 0; }

  // In place, with the same bits on all ranks, and the same again for as many ranks.
  virtual void sum(double* x, std::size_t n) const = 0;
  virtual double smallest(double x) const = 0;
  virtual double largest(double x) const = 0;
  virtual void broadcast_from_root(void* x, std::size_t bytes) const = 0;  // what rank 0 has
  // Into parts that share few facets, by METIS: the rank of each cell. nodes: (n_cells, per_cell)
  virtual std::vector<int> divide(const std::vector<int>& nodes, int per_cell,
                                  int n_nodes) const = 0;

  // The end of the program, in which all ranks meet; returns the exit code of rank 0. Where others
  // do not come, because only this one has failed, the program is ended on all of them. failed:
  // whether this one has; say: called on a rank that has failed where rank 0 has not.
  virtual int end(int code, bool failed, void (*say)(const char*), const std::string& why) = 0;
};

// This program's, where it was started as several ranks and knows how to share the work; nullptr
// otherwise.
inline Ranks*& ranks() {
  static Ranks* all = nullptr;
  return all;
}

// Thrown on the other ranks if rank 0 has failed; rank 0 gives the reason.
struct EndedByRoot {};

// Work that only rank 0 does and that may throw; all ranks return its answer. ranks: nullptr if
// there is only one process.
template <class Work>
bool on_root_rank(const Ranks* ranks, Work work) {
  if (!ranks) return work();
  enum { no, yes, failed };
  int verdict = failed;
  std::exception_ptr thrown;
  if (ranks->first()) try {
      verdict = work() ? yes : no;
    } catch (...) {
      thrown = std::current_exception();
    }
  ranks->broadcast_from_root(&verdict, sizeof verdict);
  if (thrown) std::rethrow_exception(thrown);
  if (verdict == failed) throw EndedByRoot();
  return verdict == yes;
}

}  // namespace langer
