#include "mechanics/element/viscous_points.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/voigt.hpp"

namespace langer {

bool ViscousPoints::needed(const std::vector<Material>& materials) {
  return std::any_of(materials.begin(), materials.end(),
                     [](const Material& m) { return is_viscous(m); });
}

ViscousPoints::ViscousPoints(const std::vector<Material>& materials, const std::vector<int>& body,
                             int n_cells, int n_gauss)
    : body_(materials.size() > 1 ? body : std::vector<int>{}), n_gauss_(n_gauss) {
  for (const Material& material : materials) {
    Law& law = laws_.emplace_back();
    law.branches = branches_of(material);
    for (const ViscousBranch& branch : law.branches) {
      const auto found = std::find(law.groups.begin(), law.groups.end(), branch.of);
      law.group_of.push_back(static_cast<std::size_t>(found - law.groups.begin()));
      if (found == law.groups.end()) law.groups.push_back(branch.of);
    }
  }
  First next;
  for (int e = 0; e < n_cells; ++e) {
    first_.push_back(next);
    if (!has(e)) continue;
    const auto n = static_cast<std::size_t>(n_gauss);
    next.point += n;
    next.stress += n * law_of(e).groups.size();
    next.branch += n * law_of(e).branches.size();
  }
  stress_.assign(6 * next.stress, 0);
  trial_ = stress_;
  branch_.assign(6 * next.branch, 0);
  work_.assign(next.point, 0);
  error_.assign(static_cast<std::size_t>(n_cells), 0), size_ = error_;
  begin(0);
}

void ViscousPoints::begin(double seconds) {
  const auto step = [seconds](const ViscousBranch& branch) {
    return branch_step(branch, seconds);
  };
  begin(step,
        [seconds](const ViscousBranch& branch) { return branch_step_error(branch, seconds); });
}

void ViscousPoints::begin(const std::function<BranchStep(const ViscousBranch&)>& step,
                          const std::function<double(const ViscousBranch&)>& error) {
  for (Law& law : laws_) {
    law.steps.clear();
    law.step_error.clear();
    law.amplified = {};
    for (const ViscousBranch& branch : law.branches) {
      law.steps.push_back(step(branch));
      law.step_error.push_back(error(branch));
      amplify(law.amplified, branch.of, law.steps.back().follow);
    }
  }
}

Vec6 ViscousPoints::H(int e, int g) const {
  const Law& law = law_of(e);
  const First& first = first_[static_cast<std::size_t>(e)];
  const std::size_t n = law.branches.size();
  const std::size_t m = law.groups.size();
  const std::size_t q = static_cast<std::size_t>(g);
  Vec6 H = Vec6::Zero();
  for (std::size_t i = 0; i < n; ++i)
    H += law.steps[i].keep * at(branch_, first.branch + q * n + i) -
         law.steps[i].follow * at(stress_, first.stress + q * m + law.group_of[i]);
  return H;
}

CellMemory ViscousPoints::memory(int e) const {
  CellMemory memory{amplified(e), {}};
  for (int g = 0; g < n_gauss_; ++g) memory.H.push_back(has(e) ? H(e, g) : Vec6(Vec6::Zero()));
  return memory;
}

void ViscousPoints::end(int e, const Material& material, const ElementGeometry& geometry,
                        std::span<const Vec3> a, const ElementNodes& u) {
  if (!has(e)) return;
  const Law& law = law_of(e);
  const std::size_t m = law.groups.size();
  const std::size_t first = first_[static_cast<std::size_t>(e)].stress;
  double error = 0, size = 0;
  for (int g = 0; g < n_gauss_; ++g) {
    const Mat3 C =
        right_cauchy_green(deformation_gradient(displacement_gradient(u, geometry.dN_dX[g])));
    const std::size_t here = first + static_cast<std::size_t>(g) * m;
    double here_error = 0, here_size = 0;
    for (std::size_t k = 0; k < m; ++k) {
      at(trial_, here + k) = isochoric(material, C, a, only(law.groups[k]), false).S;
      here_size += at(trial_, here + k).norm();
    }
    for (std::size_t i = 0; i < law.branches.size(); ++i)
      here_error +=
          law.step_error[i] *
          (at(trial_, here + law.group_of[i]) - at(stress_, here + law.group_of[i])).norm();
    error += geometry.w[g] * here_error * here_error;
    size += geometry.w[g] * here_size * here_size;
  }
  error_[static_cast<std::size_t>(e)] = error, size_[static_cast<std::size_t>(e)] = size;
}

double ViscousPoints::error() const {
  const double size = std::max(largest_, std::accumulate(size_.begin(), size_.end(), 0.));
  if (size > 0) {
    return std::sqrt(std::accumulate(error_.begin(), error_.end(), 0.) / size);
  }
  return 0;
}

void ViscousPoints::accept(int e, const ElementGeometry& geometry, const ElementNodes& u0,
                           const ElementNodes& u) {
  if (!has(e)) return;
  const Law& law = law_of(e);
  const First& first = first_[static_cast<std::size_t>(e)];
  const std::size_t n = law.branches.size();
  const std::size_t m = law.groups.size();
  for (int g = 0; g < n_gauss_; ++g) {
    const std::size_t q = static_cast<std::size_t>(g);
    const Mat3 grad0 = displacement_gradient(u0, geometry.dN_dX[g]);
    const Mat3 grad = displacement_gradient(u, geometry.dN_dX[g]);
    const Vec6 dE = voigt_strain(green_lagrange(grad) - green_lagrange(grad0));
    Vec6 twice_mean = Vec6::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      auto Q = at(branch_, first.branch + q * n + i);
      const std::size_t of = first.stress + q * m + law.group_of[i];
      twice_mean += Q;
      Q = law.steps[i].keep * Q + law.steps[i].follow * (at(trial_, of) - at(stress_, of));
      twice_mean += Q;
    }
    work_[first.point + q] += 0.5 * twice_mean.dot(dE);
  }
  const std::size_t from = 6 * first.stress;
  const std::size_t to = from + 6 * m * static_cast<std::size_t>(n_gauss_);
  std::copy(trial_.begin() + static_cast<std::ptrdiff_t>(from),
            trial_.begin() + static_cast<std::ptrdiff_t>(to),
            stress_.begin() + static_cast<std::ptrdiff_t>(from));
}

void ViscousPoints::accepted() {
  largest_ = std::max(largest_, std::accumulate(size_.begin(), size_.end(), 0.));
}

Vec6 ViscousPoints::stress(int e, int g) const {
  const std::size_t n = law_of(e).branches.size();
  Vec6 sum = Vec6::Zero();
  for (std::size_t i = 0; i < n; ++i)
    sum += at(branch_,
              first_[static_cast<std::size_t>(e)].branch + static_cast<std::size_t>(g) * n + i);
  return sum;
}

std::vector<Vec6> ViscousPoints::stresses(int e) const {
  std::vector<Vec6> all;
  for (int g = 0; g < n_gauss_ && has(e); ++g) all.push_back(stress(e, g));
  return all;
}

}  // namespace langer
