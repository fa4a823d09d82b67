#include "mechanics/element/point_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/tensor/kinematics.hpp"
#include "mechanics/element/spatial_terms.hpp"
#include "mechanics/material/ellipticity.hpp"

namespace langer {

namespace {

using P = Packet;
using Row = Eigen::Array<double, P::lanes, 1>;

P root(const P& x) {
  P y;
  Eigen::Map<Row, Eigen::Aligned64>(reinterpret_cast<double*>(&y.v)) =
      Eigen::Map<const Row, Eigen::Aligned64>(reinterpret_cast<const double*>(&x.v)).sqrt();
  return y;
}

// Weights that contract a symmetric tensor (11 22 33 12 23 13) with n n, s n and t n.
struct Normal {
  double nn[6], sn[6], tn[6];
};

template <std::size_t n>
std::array<Normal, n> grid() {
  std::array<Normal, n> out;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 v = wave_normal(static_cast<int>(i), static_cast<int>(n));
    const Vec3 s = v.unitOrthogonal();
    const Vec3 t = v.cross(s);
    for (int p = 0; p < 6; ++p) {
      const int k = voigt_i[p];
      const int l = voigt_j[p];
      const auto weight = [&](const Vec3& x) {
        return p < 3 ? x[k] * v[k] : x[k] * v[l] + x[l] * v[k];
      };
      out[i].nn[p] = weight(v);
      out[i].sn[p] = weight(s);
      out[i].tn[p] = weight(t);
    }
  }
  return out;
}

P contract(const double* weight, const P* h) {
  P x = weight[0] * h[0];
  for (int p = 1; p < 6; ++p) x += weight[p] * h[p];
  return x;
}

struct Term {
  P h[6], four_ddW;
};

// the terms of a law in packet form; B gets sum 2 W' h
int terms(const Material& material, const P* F, const P& J, std::span<const Vec3> a, Term* out,
          P* B) {
  const SpatialState state(F, J, [&](std::size_t k, int i) { return a[k][i]; });
  P dW{}, ddW{};
  matrix_terms<P>(material, state, [&](OfI1, const Energy<P>& e) {
    dW += e.dW;
    ddW += e.ddW;
  });
  for (int p = 0; p < 6; ++p) {
    out[0].h[p] = state.b[p];
    B[p] = 2.0 * dW * state.b[p];
  }
  out[0].four_ddW = 4.0 * ddW;
  int n = 1;
  fibre_terms<P>(material, state, [&](const auto& family, const Energy<P>& e) {
    Term& term = out[n++];
    for (int p = 0; p < 6; ++p) {
      term.h[p] = family.h[p];
      B[p] += 2.0 * e.dW * family.h[p];
    }
    term.four_ddW = 4.0 * e.ddW;
  });
  return n;
}

// Whether all eight stiffnesses are above s by the bound from below; not where one has no number.
bool surely_above(const Term* law, int n, const P* B, const P& J, double s) {
  P M[6];  // 11 22 33 12 23 13
  P size{};
  for (int p = 0; p < 6; ++p) M[p] = B[p];
  for (int k = 0; k < n; ++k) {
    const P trace = law[k].h[0] + law[k].h[1] + law[k].h[2];
    const P softer = where_not_negative(law[k].four_ddW, P(0.0), law[k].four_ddW * trace);
    size += abs(law[k].four_ddW) * trace * trace;
    for (int p = 0; p < 6; ++p) M[p] += softer * law[k].h[p];
  }
  for (int p = 0; p < 3; ++p) size += abs(B[p]);
  const P diagonal = s * J + 1e-9 * size;  // far more than rounding
  for (int p = 0; p < 3; ++p) M[p] -= diagonal;
  const P minor = M[0] * M[1] - M[3] * M[3];
  const P determinant =
      M[2] * minor - M[0] * M[4] * M[4] - M[1] * M[5] * M[5] + 2.0 * M[3] * M[4] * M[5];
  const auto positive = [](const P& x) {
    bool all = true;
    for (int l = 0; l < P::lanes; ++l) all = all && std::isgreater(x[l], 0);
    return all;
  };
  return positive(M[0]) && positive(minor) && positive(determinant) &&
         within(size, std::numeric_limits<double>::infinity());
}

}  // namespace

void check_points(const Material& material, const ElementGeometry& geometry,
                  std::span<const Vec3> a, const ElementNodes& u, PointCheck& out, double enough) {
  const int n_gauss = geometry.n_gauss();
  out.F.resize(n_gauss);
  out.J.resize(n_gauss);
  out.stiffness.resize(n_gauss);
  for (int g = 0; g < n_gauss; ++g) {
    const Mat3 H = displacement_gradient(u, geometry.dN_dX[g]);
    out.F[g] = Mat3::Identity() + H;
    out.J[g] = 1 + volume_change(H);
  }
  if (!packet_form(material)) {
    for (int g = 0; g < n_gauss; ++g)
      out.stiffness[g] = sampled_shear_stiffness(material, out.F[g], a, 48);
    return;
  }
  static const auto normals = grid<96>();
  for (int first = 0; first < n_gauss; first += P::lanes) {
    P F[9], J;
    for (int l = 0; l < P::lanes; ++l) {
      const int g = std::min(first + l, n_gauss - 1);
      J.set(l, out.J[g]);
      for (int i = 0; i < 9; ++i) F[i].set(l, out.F[g](i / 3, i % 3));
    }
    Term law[5];
    P B[6], least = std::numeric_limits<double>::infinity(), largest{};
    const int n = terms(material, F, J, a, law, B);
    if (std::isless(enough, std::numeric_limits<double>::infinity()) &&
        surely_above(law, n, B, J, std::max(enough, 0.))) {
      for (int l = 0; l < P::lanes && first + l < n_gauss; ++l)
        out.stiffness[first + l] = std::numeric_limits<double>::max();
      continue;
    }
    for (const Normal& normal : normals) {
      P aa{}, ab{}, bb{};
      for (int k = 0; k < n; ++k) {
        const P s = contract(normal.sn, law[k].h);
        const P t = contract(normal.tn, law[k].h);
        aa += law[k].four_ddW * s * s;
        ab += law[k].four_ddW * s * t;
        bb += law[k].four_ddW * t * t;
      }
      const P half = 0.5 * (aa - bb);
      const P same = contract(normal.nn, B);
      const P value = same + 0.5 * (aa + bb) - root(half * half + ab * ab);
      const P size = root(same * same) + root((aa + bb) * (aa + bb));
      largest = P(size.v > largest.v ? size.v : largest.v);
      least = P(value.v < least.v || value.v != value.v ? value.v : least.v);
    }
    for (int l = 0; l < P::lanes && first + l < n_gauss; ++l)
      out.stiffness[first + l] = without_rounding(least[l], largest[l]) / J[l];
  }
}

}  // namespace langer
