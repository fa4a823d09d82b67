#include "scene/range_watch.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <filesystem>

#include "material/ellipticity.hpp"
#include "store/material_file.hpp"

namespace langer {

namespace {

constexpr double slack = 1 + 1e-6;  // a run to the end of the test is inside

// visit(cell, w, F without change of volume)
template <class Visit>
void each_point(const Equilibrium& body, const VecX& u, Visit visit) {
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const auto states =
        gauss_states(body.formulation(), body.material(e), body.geometry(e), body.fibres(e), body.element_displacements(u, e));
    for (std::size_t g = 0; g < states.size(); ++g)
      visit(e, body.geometry(e).w[g], Mat3(states[g].F / std::cbrt(states[g].F.determinant())));
  }
}

// of the invariants over their range: above 1 outside
double excess(const FittedRange& range, const Mat3& F, std::span<const Vec3> a) {
  double most = (F.squaredNorm() - 3) / std::max(range.I1_bar - 3, 1e-12);
  for (std::size_t k = 0; k < a.size() && k < range.I4_bar.size(); ++k)
    if (const double I4 = (F * a[k]).squaredNorm(); I4 > 1)
      most = std::max(most, (I4 - 1) / std::max(range.I4_bar[k] - 1, 1e-12));
  return most;
}

double hencky(const Mat3& F) {
  const Eigen::SelfAdjointEigenSolver<Mat3> C(Mat3(F.transpose() * F), Eigen::EigenvaluesOnly);
  return (0.5 * C.eigenvalues().array().log()).matrix().norm();
}

struct Part {
  double volume = 0, worst = 0;
  int cell = -1;
  void add(int e, double w, double how_far) {
    volume += w;
    if (cell < 0 || how_far > worst) worst = how_far, cell = e;
  }
};

std::string place(const Mesh& mesh, int cell) {
  Vec3 x = Vec3::Zero();
  for (int node : mesh.cell(cell)) x += mesh.X[static_cast<std::size_t>(node)] / 8;
  return fmt::format("({:.3g}, {:.3g}, {:.3g}) mm", x[0], x[1], x[2]);
}

}  // namespace

StudyRecord study_from(const std::string& material_file) {
  const std::string extension = std::filesystem::path(material_file).extension();
  if (extension == ".yaml" || extension == ".yml") return {};
  const auto fit = read_material(material_file).fit;
  return fit ? fit->study : StudyRecord{};
}

void RangeWatch::look(const Equilibrium& body, const BodyState& state) {
  if (!study_.range || left_at_ >= 0) return;
  each_point(body, state.u, [&](int e, double, const Mat3& F) {
    if (excess(*study_.range, F, body.fibres(e)) > slack) left_at_ = state.t;
  });
}

std::vector<std::string> RangeWatch::warnings(const Equilibrium& body, const BodyState& state) const {
  std::vector<std::string> lines;
  double volume = 0, largest = 0;
  Part outside, unstable;
  each_point(body, state.u, [&](int e, double w, const Mat3& F) {
    volume += w, largest = std::max(largest, hencky(F));
    if (!study_.range) return;
    if (const double far = excess(*study_.range, F, body.fibres(e)); far > slack) outside.add(e, w, far);
  });
  if (volume <= 0) return lines;
  if (outside.cell >= 0)
    lines.push_back(
        fmt::format("{:.3g} % of the volume is deformed beyond the tests that the material was fitted to, most {:.3g} times as "
                    "far near {}{}",
                    100 * outside.volume / volume, outside.worst, place(body.mesh(), outside.cell),
                    left_at_ >= 0 && left_at_ < state.t ? fmt::format("; first at t = {:.4g}", left_at_) : ""));
  if (body.mesh().n_cells() == 0 || largest == 0) return lines;
  const double safe =
      study_.stability ? study_.stability->map.safe_hencky : safe_hencky(body.material(0), std::min(1.05 * largest, 1.2));
  if (largest <= safe) return lines;
  // the radius is sampled: a little inside of it is looked at too; of very many points every n-th stands for its neighbours
  const auto beyond = [&](const Mat3& F) { return hencky(F) > 0.98 * safe; };
  long points = 0, n = 0;
  each_point(body, state.u, [&](int, double, const Mat3& F) { points += beyond(F); });
  const long stride = 1 + points / 10000;
  each_point(body, state.u, [&](int e, double w, const Mat3& F) {
    if (!beyond(F) || n++ % stride != 0) return;
    w *= static_cast<double>(stride);
    const double stiffness = smallest_shear_stiffness(body.material(e), F, body.fibres(e)).value;
    if (!(stiffness >= 0)) unstable.add(e, w, -stiffness);
  });
  if (unstable.cell >= 0)
    lines.push_back(
        fmt::format("{:.3g} % of the volume has lost strong ellipticity (smallest shear stiffness {:.3g} MPa near {}): the "
                    "solution depends on "
                    "the mesh there",
                    100 * unstable.volume / volume, -unstable.worst, place(body.mesh(), unstable.cell)));
  return lines;
}

}  // namespace langer
