#include "mechanics/assembly/zero_energy_modes.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/tensor/dense.hpp"
#include "core/tensor/principal.hpp"

namespace langer {

RigidMotions rigid_motions(const Mesh& mesh, const Dofs& dofs) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& X : mesh.X) centre += X / mesh.n_nodes();
  double size = 0;
  for (const Vec3& X : mesh.X) size = std::max(size, (X - centre).norm());
  // what each rigid motion (translation, turn about the centre times the body's size) asks of the
  // prescribed dofs
  using Mat66 = Eigen::Matrix<double, 6, 6>;
  Mat66 M = Mat66::Zero();
  for (const Prescribed& p : dofs.prescribed) {
    const int k = p.dof % 3;
    const Vec3 x = (mesh.X[static_cast<std::size_t>(p.dof / 3)] - centre) / size;
    Eigen::Matrix<double, 6, 1> row = Eigen::Matrix<double, 6, 1>::Zero();
    row[k] = 1;
    for (int j = 0; j < 3; ++j) row[3 + j] = Vec3::Unit(j).cross(x)[k];
    M += row * row.transpose();
  }
  // and what ties ask: u(node) = T u(of)
  for (std::size_t i = 0; i < dofs.tie.size(); ++i) {
    const Image& image = dofs.tie[i];
    if (image.of == static_cast<int>(i) && image.T.isIdentity(0)) continue;
    const auto motions = [&](int node) {
      Eigen::Matrix<double, 3, 6> u;
      u << Mat3::Identity(), Mat3::Zero();
      for (int j = 0; j < 3; ++j)
        u.col(3 + j) =
            Vec3::Unit(j).cross((mesh.X[static_cast<std::size_t>(node)] - centre) / size);
      return u;
    };
    const Eigen::Matrix<double, 3, 6> rows =
        motions(static_cast<int>(i)) - image.T * motions(image.of);
    M += rows.transpose() * rows;
  }
  const auto count = [](const auto& e) {
    return static_cast<int>((e.array() < 1e-12 * std::max(1.0, e.maxCoeff())).count());
  };
  const SymmetricEigen all = symmetric_eigen(M);
  const int free = count(all.values);
  if (free == 0) return {};
  const Mat3 translations = M.topLeftCorner<3, 3>();
  const int moves = count(principal_values(translations));
  RigidMotions found{moves, free - moves, ""};
  if (free > 1) {
    found.words =
        fmt::format("the supports leave the body {} rigid motions ({} along, {} about an axis)",
                    free, moves, free - moves);
    return found;
  }
  const Vec3 t = all.vectors.col(0).head<3>();
  const Vec3 w = all.vectors.col(0).tail<3>() / size;
  const auto text = [](Vec3 x) {
    for (double& c : x) c = std::abs(c) < 1e-9 ? 0 : c;
    return fmt::format("({:.3g}, {:.3g}, {:.3g})", x[0], x[1], x[2]);
  };
  const auto upright = [](Vec3 x) {
    return Vec3(x.normalized() * (x.sum() < 0 ? -1 : 1));
  };
  if (moves == 1) {
    found.words =
        fmt::format("the supports leave the body free to move along {}", text(upright(t)));
  } else {
    found.words =
        fmt::format("the supports leave the body free to turn about the axis {} through {} mm",
                    text(upright(w)), text(centre + w.cross(t) / w.squaredNorm()));
  }
  return found;
}

std::string zero_energy_modes(const Mesh& mesh, const Dofs& dofs) {
  return rigid_motions(mesh, dofs).words;
}

}  // namespace langer
