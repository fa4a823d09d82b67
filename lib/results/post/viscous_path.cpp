#include "results/post/viscous_path.hpp"

namespace langer {

ViscousPath::ViscousPath(const Body& body)
    : points_(body.materials(), body.mesh().body, body.mesh().n_cells(),
              body.mesh().cell().n_gauss),
      u_(body.mesh().X.size(), Vec3::Zero()) {}

// The branches of a step follow from the displacements at its two ends and its duration.
void ViscousPath::add(const Body& body, double time, const std::vector<Vec3>& u) {
  points_.begin(time - time_);
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const ElementNodes q = element_displacements(body.mesh(), u, e);
    points_.end(e, body.material(e), body.geometry(e), body.fibres(e), q);
    points_.accept(e, body.geometry(e), element_displacements(body.mesh(), u_, e), q);
  }
  points_.accepted();
  time_ = time;
  u_ = u;
}

void ViscousPath::update(Body& body) const {
  std::vector<std::vector<Vec6>> branches;
  for (int e = 0; e < body.mesh().n_cells(); ++e) branches.push_back(points_.stresses(e));
  body.set_branches(std::move(branches));
}

}  // namespace langer
