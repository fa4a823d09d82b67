// What is measured of a state of a scene, one number each.
//   force         that resists an indenter, as the column `force` of post/quantity.cpp, of one of several force_<contact> [N]
//   travel        of an indenter that is pushed [mm]
//   reaction      sum over the nodes of a set, along an axis [N]
//   displacement  weighted sum over nodes, along an axis: of a set their mean, of a place on the surface by its shape functions [mm]
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "results/store/solution_file.hpp"

namespace langer {

struct Observation {
  enum class Of { force, reaction, displacement, travel } of = Of::force;
  int axis = 0;
  std::string contact =
      "";  // of a force on one of several indenters, empty: on all of them; of a travel
  std::vector<int> nodes = {};
  std::vector<double> weights = {};

  // contacts: of the scene
  double value(const StepRecord& whole, const std::vector<RigidContact>& contacts) const;
  // derivative: what inverse/sensitivity.hpp gives
  double slope(const StepRecord& whole, const StepRecord& derivative,
               const std::vector<RigidContact>& contacts) const;
  double sum(const StepRecord& whole) const;  // over the nodes
};

// Nodes and weights of a place on the surface: on the top where y is not given (NaN), else on the
// facet that it lies in. false where there is none.
bool find_place(const Mesh& mesh, const Vec3& place, Observation& found);

}  // namespace langer
