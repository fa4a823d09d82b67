#include "mechanics/material/material.hpp"

#include <fmt/format.h>

#include <string>

#include "core/base/traps.hpp"
#include "core/tensor/invariants.hpp"
#include "core/tensor/kinematics.hpp"
#include "core/tensor/principal.hpp"
#include "mechanics/material/terms.hpp"
#include "mechanics/material/viscous_point.hpp"
#include "mechanics/mesh/directions.hpp"

namespace langer {

Vec6 fibre_tensor(const Fibre& fibre, const Vec3& a) {
  return fibre.kappa * identity6() + (1 - 3 * fibre.kappa) * structural_tensor(a);
}

std::vector<double> fibre_angles(const Material& material) {
  std::vector<double> alpha;
  for (const Fibre& fibre : material.fibres) alpha.push_back(fibre.alpha_deg);
  return alpha;
}

std::vector<std::vector<double>> fibre_angles(const std::vector<Material>& materials) {
  std::vector<std::vector<double>> alpha;
  for (const Material& material : materials) alpha.push_back(fibre_angles(material));
  return alpha;
}

std::vector<Vec3> fibre_directions(const Material& material, const Mat3& frame) {
  std::vector<Vec3> a;
  for (double alpha : fibre_angles(material)) a.push_back(fibre_direction(alpha, frame));
  return a;
}

double shear_modulus(const MatrixTerm& term) {
  return std::visit(
      []<class Law>(const Law& law) {
        if constexpr (Law::of == Invariant::I1_bar_and_I2_bar)
          return 2 * (law.of_I1(3.).dW + law.of_I2(3.).dW);
        else if constexpr (Law::of == Invariant::squared_stretches)
          return 2 * (law(1.).ddW + law(1.).dW);
        else
          return 2 * law(3.).dW;
      },
      term);
}

namespace {

// The largest sum of gamma. Above it the relaxed material would have almost no stress: probably a
// modulus or a percentage was typed.
constexpr double most_gamma = 1000;

void complain_of_strengths(const Material& material, std::vector<Complaint>& found) {
  constexpr const char* hint =
      "gamma is the stress at once after a step over what is left in the end, no modulus and no percentage";
  double sum = 0;
  std::string last;
  bool alone = false;
  for (std::size_t i = 0; material.viscous && i < material.viscous->size(); ++i) {
    const double gamma = (*material.viscous)[i].gamma;
    const std::string key = fmt::format("viscous[{}].gamma", i);
    if (gamma > most_gamma)
      found.push_back(
          {key, fmt::format("found {:g}", gamma), fmt::format("at most {:g}", most_gamma), hint});
    alone = alone || gamma > most_gamma;
    sum += gamma;
    last = key;
  }
  if (material.spectrum) {
    double of_spectrum = 0;
    for (const ViscousBranch& branch : branches_of(*material.spectrum)) of_spectrum += branch.gamma;
    sum += of_spectrum;
    last = "spectrum.c";
  }
  if (!alone && sum > most_gamma)
    found.push_back({last, fmt::format("found strengths that make {:g} in all", sum),
                     fmt::format("a sum of at most {:g}", most_gamma), hint});
}

}  // namespace

std::vector<Complaint> Material::complaints() const {
  std::vector<Complaint> found;
  if (viscous && viscous->empty())
    found.push_back({"viscous", "found an empty list", "at least {tau: 1, gamma: 0.5}",
                     "without the key the material is elastic"});
  complain_of_strengths(*this, found);
  if (!fibres.empty()) return found;
  for (std::size_t i = 0; viscous && i < viscous->size(); ++i)
    if ((*viscous)[i].of == BranchOf::fibres)
      found.push_back({"viscous[" + std::to_string(i) + "].of",
                       "fibres, which the material has none of", "all or matrix", ""});
  if (spectrum && spectrum->of == BranchOf::fibres)
    found.push_back({"spectrum.of", "fibres, which the material has none of", "all or matrix", ""});
  return found;
}

std::vector<ViscousBranch> branches_of(const Material& material) {
  std::vector<ViscousBranch> branches = material.viscous.value_or(std::vector<ViscousBranch>{});
  if (material.spectrum)
    for (const ViscousBranch& branch : branches_of(*material.spectrum)) branches.push_back(branch);
  return branches;
}

double shear_modulus(const Material& material) {
  const NoTraps parameters_may_be_any;
  double sum = 0;
  for (const MatrixTerm& term : material.matrix) sum += shear_modulus(term);
  return sum;
}

namespace {

// The contribution of a sum over the eigenvalues e_a of C_bar = I3^(-1/3) C, with G = dW/dC_bar and
// H = d2W/dC_bar2:
//   dW/dC = I3^(-1/3) (G - (G:C)/3 C^-1), as of a term with M = G;  d2W/dC2 = that term's + Q^T H Q,  Q = dC_bar/dC
struct StretchTerms {
  double W = 0;
  Vec6 G = Vec6::Zero();
  Mat6 QHQ = Mat6::Zero();
};

StretchTerms stretch_terms(const Ogden& law, const Invariants& v, bool with_tangent) {
  StretchTerms s;
  const Principal stretched = principal(tensor(v.m * v.C));
  const Vec3& e = stretched.values;
  const Mat3& n = stretched.directions;
  Mat6 H = Mat6::Zero();
  for (int a = 0; a < 3; ++a) {
    const Energy<double> g = law(e[a]);
    const Vec6 N = structural_tensor(n.col(a));
    s.W += g.W;
    s.G += g.dW * N;
    if (!with_tangent) continue;
    H += g.ddW * N * N.transpose();
    for (int b = 0; b < a; ++b) {
      const Mat3 mixed = 0.5 * (n.col(a) * n.col(b).transpose() + n.col(b) * n.col(a).transpose());
      const Vec6 N_ab = voigt(mixed);
      H += 2 * law.divided_difference(e[a], e[b]) * N_ab * N_ab.transpose();
    }
  }
  if (with_tangent) {
    // contraction over symmetric pairs counts shear twice
    Vec6 C = v.C;
    C.tail<3>() *= 2;
    const Mat6 Q = v.m * (Mat6::Identity() - (C / 3) * v.C_inverse.transpose());
    s.QHQ = Q.transpose() * H * Q;
  }
  return s;
}

// The invariants of one C in the form that for_each_term() needs, with M of each family in the
// reference state.
struct ReferenceState {
  const Invariants& v;
  std::span<const Vec3> a;
  struct Family {
    Vec6 M;
    double I;
  };
  double I1_bar() const { return v.m * v.I1; }
  double I2_bar() const { return langer::I2_bar(v); }
  double m() const { return v.m; }
  Family family(const Fibre& fibre, std::size_t k) const {
    const Vec6 M = fibre_tensor(fibre, a[k]);
    return {M, linear_bar(v, M)};
  }
};

// Factors of the stresses and energies of the terms: of an elastic material, of the stress of a
// viscous increment, and of the potential of such an increment.
struct AsTheyAre {
  static constexpr double matrix = 1, fibres = 1, W_matrix = 1, W_fibres = 1;
};
struct OfStress {
  double matrix, fibres;
  static constexpr double W_matrix = 1, W_fibres = 1;
};
struct OfPotential {
  double matrix, fibres, W_matrix, W_fibres;
};

// W, S and D of all terms at one C. Terms that are linear in C are summed as one tensor M, so that
// the derivatives of the invariants are formed only once.
template <class Factors>
Response isochoric(const Material& material, const Invariants& v, std::span<const Vec3> a,
                   const Mat6* C_inverse_product, const Factors& factors) {
  Response r;
  Vec6 M = Vec6::Zero();  // sum W' M, M = I or the fibres' tensor
  double dW_I2 = 0;
  const auto square = [&](double ddW, const Vec6& dI_dC) {
    if (C_inverse_product && ddW != 0) r.D.noalias() += (4 * ddW * dI_dC) * dI_dC.transpose();
  };
  for_each_term<double>(
      material, ReferenceState{v, a},
      Overloaded{[&](OfI1, const Energy<double>& e) {
                   r.W += factors.W_matrix * e.W;
                   M.head<3>().array() += factors.matrix * e.dW;
                   square(factors.matrix * e.ddW, dlinear_bar_dC(v, identity6()));
                 },
                 [&](OfI2, const Energy<double>& e) {
                   r.W += factors.W_matrix * e.W;
                   dW_I2 += factors.matrix * e.dW;
                   square(factors.matrix * e.ddW, dI2_bar_dC(v));
                 },
                 [&](const ReferenceState::Family& family, const Energy<double>& e) {
                   r.W += factors.W_fibres * e.W;
                   M += factors.fibres * e.dW * family.M;
                   square(factors.fibres * e.ddW, dlinear_bar_dC(v, family.M));
                 },
                 [&](const Ogden& law) {
                   const StretchTerms s = stretch_terms(law, v, C_inverse_product);
                   r.W += factors.W_matrix * s.W;
                   M += factors.matrix * s.G;
                   if (C_inverse_product) r.D += (4 * factors.matrix) * s.QHQ;
                 }});

  r.S = 2 * dlinear_bar_dC(v, M);
  if (C_inverse_product) r.D += 4 * d2linear_bar_dC2(v, M, *C_inverse_product);
  if (dW_I2 != 0) {
    r.S += 2 * dW_I2 * dI2_bar_dC(v);
    if (C_inverse_product) r.D += 4 * dW_I2 * d2I2_bar_dC2(v, *C_inverse_product);
  }
  return r;
}

}  // namespace

Response isochoric(const Material& material, const Mat3& C, std::span<const Vec3> a,
                   bool with_tangent) {
  const Invariants v = invariants(C);
  if (!with_tangent) return isochoric(material, v, a, nullptr, AsTheyAre{});
  const Mat6 P = inverse_product(v);
  return isochoric(material, v, a, &P, AsTheyAre{});
}

Response isochoric(const Material& material, const Mat3& C, std::span<const Vec3> a,
                   const Amplified& amplified, bool with_tangent) {
  const Invariants v = invariants(C);
  const OfStress factors{amplified.matrix, amplified.fibres};
  if (!with_tangent) return isochoric(material, v, a, nullptr, factors);
  const Mat6 P = inverse_product(v);
  return isochoric(material, v, a, &P, factors);
}

Response incremental(const Material& material, const Mat3& C, std::span<const Vec3> a,
                     const PointMemory& memory, bool with_tangent) {
  const Invariants v = invariants(C);
  const auto& [matrix, fibres] = memory.amplified;
  const OfPotential factors{matrix, fibres, matrix, fibres};
  const Mat6 P = with_tangent ? inverse_product(v) : Mat6(Mat6::Zero());
  Response r = isochoric(material, v, a, with_tangent ? &P : nullptr, factors);
  r.W += 0.5 * memory.H.dot(voigt_strain(C - Mat3::Identity()));
  r.S += memory.H;
  return r;
}

Response response(const Material& material, const Mat3& C, double J_minus_1,
                  std::span<const Vec3> a) {
  const Invariants v = invariants(C);
  const Mat6 P = inverse_product(v);
  Response r = isochoric(material, v, a, &P, AsTheyAre{});
  const double J = 1 + J_minus_1;
  const Energy<double> U = volume_energy(material.volume, J_minus_1);
  const Vec6 g = dJ_dC(v, J);
  r.W += U.W;
  r.S += 2 * U.dW * g;
  r.D += 4 * (U.ddW * g * g.transpose() + U.dW * d2J_dC2(v, J, P));
  return r;
}

Response response(const Material& material, const Mat3& C, std::span<const Vec3> a) {
  //   J - 1 = (I3 - 1)/(J + 1)
  const double I3_minus_1 = determinant_minus_1(C - Mat3::Identity());
  return response(material, C, I3_minus_1 / (std::sqrt(1 + I3_minus_1) + 1), a);
}

}  // namespace langer
