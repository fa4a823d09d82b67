// What a viscous body remembers, differentiated by numbers of the scene.
//
// The branch stresses at the end of an increment follow from those at its beginning and from both
// displacements (element/viscous_points.hpp), so they depend on a number p by the whole path. For
// each number two neighbours of the body are led along: one where p is less by h and one where it
// is more, displaced by u - h u' and by u + h u'. Their difference over 2 h is the derivative, with
// an error of order h^2. At displacements u that stand still, the difference of their internal
// forces is what p changes of the balance of an increment, directly and by the past.
#pragma once

#include <memory>
#include <vector>

#include "mechanics/assembly/assembler.hpp"
#include "scene/model/scene_parameters.hpp"
#include "scene/run/reduction.hpp"

namespace langer {

class ViscousNeighbours {
 public:
  ViscousNeighbours(const Reduction& reduction, const SceneParameters& parameters);

  void begin(double seconds);  // an increment
  // Of internal forces [N] and stored energy [N mm] per unit of number i, where u (3 n) stands
  // still.
  Assembler::Forces change(std::size_t i, const VecX& u);
  // The increment from u0 to u is accepted; d0 and d: the derivatives of both by number i.
  // Derivative of the stored energy at its end.
  double accept(std::size_t i, const VecX& u0, const VecX& d0, const VecX& u, const VecX& d);

 private:
  struct Pair {
    std::unique_ptr<Assembler> less, more;
    double h = 0;
  };
  std::vector<Pair> pairs_;  // of each number
};

}  // namespace langer
