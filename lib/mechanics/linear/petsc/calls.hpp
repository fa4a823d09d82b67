// What the sources of the module share: how it calls PETSc.
#pragma once

#include <petscksp.h>

#include <mutex>
#include <vector>

#include "mechanics/linear/petsc/petsc_interface.hpp"

namespace langer::petsc_module {

// PETSc has one state for the whole process
extern std::recursive_mutex mutex;

void passed_over(PetscErrorCode code);  // where nobody can be told
void need(PetscErrorCode code);  // throws std::runtime_error with PETSc's words, or std::bad_alloc
void begin(bool of_all_ranks = false);  // once

// Movements that A hardly resists, orthonormal; values(k): (rows of this rank) of the k-th.
void set_near_null_space(Mat A, const std::function<const double*(int)>& values, int n_modes);

// Multigrid by aggregation for A, with the options that begin with this; to be set up by PCSetUp.
void make_aggregation(PC& cycle, Mat A, const char* options);

Ranks* world(std::string& why);
Multigrid* multigrid_of(const Ranks& ranks);

// Numbers of which each rank has some, one rank after the other.
class Shares {
 public:
  explicit Shares(std::vector<int> counts);  // by rank
  int own() const { return counts_[static_cast<std::size_t>(rank_)]; }
  int before() const { return first_[static_cast<std::size_t>(rank_)]; }
  int all() const { return all_; }
  void gather(const double* own, double* all) const;

 private:
  std::vector<int> counts_, first_;
  int rank_ = 0, all_ = 0;
};

}  // namespace langer::petsc_module
