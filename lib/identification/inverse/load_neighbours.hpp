// What a number of a load changes where a body stands still: imposed displacements, forces on its
// surface and the force on an indenter, by central differences of two scenes around the one that is
// solved. They are exact where the load is linear in the number, as all are but rotations.
#pragma once

#include <memory>
#include <vector>

#include "mechanics/solve/state_tangent.hpp"
#include "scene/model/scene_parameters.hpp"
#include "scene/run/run.hpp"

namespace langer {

class LoadNeighbours {
 public:
  // Of the load numbers among the parameters. Refers to the run. Throws Failure(config) at
  // sensitivity[i] if a neighbour is not reduced as the run is.
  LoadNeighbours(const Run& run, const SceneParameters& parameters, const SolveConfig& config,
                 const Run::Where& where);

  // Adds what number i changes at t and at the displacements u (3 n); nothing for other numbers.
  void add_change(std::size_t i, double t, const VecX& u, ParameterChange& change);

 private:
  struct Neighbour {
    std::shared_ptr<const Scene> scene;
    Reduction reduction;
    Assembler body;

    Neighbour(const Run& run, std::shared_ptr<const Scene> other, const SolveConfig& config,
              const Run::Where& where);
    ParameterChange at(double t, const VecX& u);  // all of it instead of a change
  };
  struct Pair {
    std::unique_ptr<Neighbour> less, more;  // none: number i is none of a load
    double width = 1;
  };
  std::vector<Pair> pairs_;
};

}  // namespace langer
