#include "scene/run/cell_stress.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "scene/model/solve_config.hpp"

namespace langer {

CellStressRecorder::CellStressRecorder(const Mesh& mesh, const Scene& scene,
                                       const std::optional<CellStress>& wanted)
    : directions_(wanted == CellStress::principal) {
  if (!wanted) return;
  body_.emplace(mesh, scene.materials, scene.directions, scene.formulation);
  if (body_->viscous()) branches_.emplace(*body_);
}

void CellStressRecorder::kept(const StepRecord& step) {
  if (branches_) branches_->add(*body_, step.scalars.at("time"), step.u);
}

void CellStressRecorder::add(StepRecord& whole) {
  if (!body_) return;
  kept(whole);
  if (branches_) branches_->update(*body_);
  std::vector<double> stress, values[3], directions[3];
  for (int e = 0; e < body_->mesh().n_cells(); ++e) {
    const VecX row = gauss_values(*body_, whole.u, e).colwise().mean().transpose();
    const Mat3 sigma = sigma_of(row);  // symmetric: by rows or by columns
    stress.insert(stress.end(), sigma.data(), sigma.data() + 9);
    if (!directions_) continue;
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(sigma);  // ascending
    for (int k = 0; k < 3; ++k) {
      values[k].push_back(eigen.eigenvalues()[2 - k]);
      const Vec3 along = eigen.eigenvectors().col(2 - k);
      directions[k].insert(directions[k].end(), along.data(), along.data() + 3);
    }
  }
  whole.cell_fields["stress"] = std::move(stress);
  for (int k = 0; directions_ && k < 3; ++k) {
    whole.cell_fields[fmt::format("principal_stress_{}", k + 1)] = std::move(values[k]);
    whole.cell_fields[fmt::format("principal_direction_{}", k + 1)] = std::move(directions[k]);
  }
}

}  // namespace langer
