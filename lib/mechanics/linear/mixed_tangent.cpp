#include "mechanics/linear/mixed_tangent.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mechanics/linear/petsc/petsc_load.hpp"

namespace langer {

namespace {

constexpr int n_dofs = MixedSolver::per_cell;
// bulk modulus that A keeps, in shear moduli: 1 to 3 take 8 to 12 products on even and flat cells,
// 10 take 100 on flat ones
constexpr double kept = 2;

}  // namespace

std::unique_ptr<MixedTangent> MixedTangent::of(const Assembler& body, int threads,
                                               std::string& why) {
  const petsc_module::Functions* module = petsc(why);
  if (!module) return nullptr;
  auto out = std::make_unique<MixedTangent>();
  const Dofs& dofs = body.dofs();
  out->cell_dofs_ = body.element_dofs();
  for (int dof : out->cell_dofs_) out->cell_rows_.push_back(dofs.equation[dof]);
  out->solver_ = std::make_unique<MixedSolver>(body.pattern(), dofs.free, out->cell_rows_, *module,
                                               threads, body.division());
  Vec3 middle = Vec3::Zero();
  for (const Vec3& X : body.mesh().X) middle += X / static_cast<double>(body.mesh().X.size());
  out->rigid_ = MatX::Zero(dofs.n_free(), 6);
  for (int row = 0; row < dofs.n_free(); ++row) {
    const int axis = dofs.free[row] % 3;
    const Vec3 X = body.mesh().X[dofs.free[row] / 3] - middle;
    out->rigid_(row, axis) = 1;
    for (int k = 0; k < 3; ++k) out->rigid_(row, 3 + k) = Vec3(Vec3::Unit(k).cross(X))[axis];
  }
  return out;
}

void MixedTangent::linearise(const Assembler& body, const VecX& du_prescribed) {
  Assembler::VolumetricPart part = body.volumetric_part();
  const Eigen::Index n = part.V.size();
  b_ = std::move(part.b);
  V_ = part.V;
  scale_.resize(n);
  D_.resize(n);
  softened_.resize(n);
  of_prescribed_ = VecX::Zero(n);
  for (Eigen::Index e = 0; e < n; ++e) {
    const double mu = std::max(std::abs(shear_modulus(body.material(static_cast<int>(e)))),
                               1e-9 * part.kappa[e]);  // a matrix may have none
    const double soft = std::min(kept * mu, 0.5 * part.kappa[e]);
    const double stiff = part.kappa[e] - soft;
    scale_[e] = 1 / std::sqrt(1 / (V_[e] * stiff) + 1 / (V_[e] * (soft + mu)));
    D_[e] = V_[e] * stiff / (scale_[e] * scale_[e]);
    softened_[e] = soft / scale_[e];
    for (int k = 0; k < n_dofs; ++k) {
      double& entry = b_[n_dofs * e + k];
      entry *= scale_[e];
      of_prescribed_[e] += entry * du_prescribed[cell_dofs_[n_dofs * e + k]];
      if (cell_rows_[n_dofs * e + k] < 0) entry = 0;
    }
  }
  missing_ = part.missing.cwiseProduct(V_).cwiseQuotient(scale_);
}

std::vector<double> MixedTangent::rest_of(const Assembler& body) const {
  std::vector<double> A = body.K();
  const Pattern& pattern = body.pattern();
  for (int e : body.own_cells()) {
    const int* rows = &cell_rows_[n_dofs * e];
    const double* b = &b_[n_dofs * e];
    for (int j = 0; j < n_dofs; ++j) {
      if (rows[j] < 0) continue;
      const int* begin = pattern.row.data() + pattern.column_start[rows[j]];
      const int* end = pattern.row.data() + pattern.column_start[rows[j] + 1];
      for (int a = 0; a < n_dofs; a += 3) {  // the rows of a node stand together
        const int* at = nullptr;
        for (int i = a; i < a + 3; ++i) {
          if (rows[i] < rows[j]) continue;
          if (at) {
            at = at + 1;
          } else {
            at = std::lower_bound(begin, end, rows[i]);
          }
          A[at - pattern.row.data()] -= D_[e] * b[i] * b[j];
        }
      }
    }
  }
  return A;
}

VecX MixedTangent::pressures(const VecX& Bd, const VecX& q) const {
  // V (p' - p) = q + (what A keeps of the volume) b d
  return q.cwiseProduct(scale_).cwiseQuotient(V_) + (Bd + of_prescribed_).cwiseProduct(softened_);
}

}  // namespace langer
