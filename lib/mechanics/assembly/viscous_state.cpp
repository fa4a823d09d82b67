#include "mechanics/assembly/viscous_state.hpp"

namespace langer {

ViscousState::ViscousState(const BodyModel& body) : body_(body) {
  const Mesh& mesh = body.mesh();
  if (ViscousPoints::needed(body.materials())) {
    points_.emplace(body.materials(), mesh.body, mesh.n_cells(), mesh.cell().n_gauss);
  }
}

void ViscousState::begin(double seconds) {
  if (points_) points_->begin(seconds);
}

void ViscousState::begin_small_movements(
    const std::function<double(const ViscousBranch&)>& follow) {
  if (!points_) return;
  const auto step = [&](const ViscousBranch& branch) {
    return BranchStep{1, follow(branch)};
  };
  points_->begin(step, [](const ViscousBranch&) { return 0.0; });
}

double ViscousState::end(const VecX& u) {
  if (!points_) return 0;
  for (int e = 0; e < body_.mesh().n_cells(); ++e) {
    points_->end(e, body_.material(e), body_.geometry(e), body_.fibres(e),
                 body_.displacements(u, e));
  }
  return points_->error();
}

void ViscousState::accept(const VecX& u0, const VecX& u) {
  if (!points_) return;
  for (int e = 0; e < body_.mesh().n_cells(); ++e) {
    points_->accept(e, body_.geometry(e), body_.displacements(u0, e), body_.displacements(u, e));
  }
  points_->accepted();
}

double ViscousState::work() const {
  if (!points_) return 0;
  double sum = 0;
  for (int e = 0; e < body_.mesh().n_cells(); ++e) {
    if (!points_->has(e)) continue;
    for (int g = 0; g < body_.geometry(e).n_gauss(); ++g) {
      sum += body_.geometry(e).w[g] * points_->work(e, g);
    }
  }
  return sum;
}

}  // namespace langer
