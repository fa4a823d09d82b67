// Eight elements at once give what one at a time gives.
#include "mechanics/element/packet_solid.hpp"

#include <doctest/doctest.h>

#include <random>

#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

TEST_CASE("packets reproduce the scalar element: force, tangent, dilatation, energy") {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> distance(-0.15, 0.15), small(-0.1, 0.1);
  const auto with = [](const MatrixTerm& term, double kappa = 0) {
    Material m = test::stable(40, 1e-3);
    m.matrix = {term};
    m.fibres[0].kappa = kappa;
    return m;
  };
  Material dispersed = with(Yeoh{0.05, 0.05, 0.02}, 0.1);
  dispersed.fibres[0].tension_switch = FibreSwitch::off;
  const auto with_laws = [](const FibreLaw& fibre, const Volume& volume) {
    Material m = test::stable(40, 1e-3);
    m.fibres[0].law = fibre, m.volume = volume;
    return m;
  };
  for (const Material& material :
       {with_laws(ExpPowFibre{0.3, 0.8, 2.5}, LogarithmicVolume{200}),
        with_laws(PowLinearFibre{0.4, 1.04, 3}, SimoTaylorVolume{2e3}), test::table1(30, 1e-2),
        test::table1(60, 1e-6), test::neo_hooke(0.4, 1e-3), test::stable(75, 1e-4),
        with(Gent{0.3, 4}), with(ArrudaBoyce{0.3, 2}), with(NeoHooke{0.1}, 0.2), dispersed}) {
    REQUIRE(packet_form(material));
    const auto a = fibre_directions(material);
    for (const auto& [n, formulation] : {std::pair{8, Formulation::mean_dilatation},
                                         {8, Formulation::displacement},
                                         {27, Formulation::linear_dilatation},
                                         {27, Formulation::mean_dilatation},
                                         {27, Formulation::displacement},
                                         {15, Formulation::linear_dilatation},
                                         {15, Formulation::displacement}}) {
      const double spread = n == 8 ? 1 : n == 27 ? 0.4 : 0.06;
      const int n_p = n_pressures(formulation, n);
      std::vector<ElementGeometry> geometry;
      std::vector<ElementNodes> u(8, ElementNodes(n, 3));
      for (int l = 0; l < 8; ++l) {
        ElementNodes X(n, 3);
        for (int i = 0; i < n; ++i)
          for (int k = 0; k < 3; ++k)
            X(i, k) = 0.5 * reference(n).node[i][k] + spread * distance(random),
                 u[l](i, k) = spread * small(random);
        geometry.push_back(element_geometry(X));
      }
      const ElementGeometry* pointers[8];
      std::vector<Packet> moved(3 * n);
      PacketFibre fibre[1];
      for (int l = 0; l < 8; ++l) {
        pointers[l] = &geometry[l];
        for (int i = 0; i < 3 * n; ++i) moved[i].set(l, u[l](i / 3, i % 3));
        for (int k = 0; k < 3 && !a.empty(); ++k) fibre[0].a[k].set(l, a[0][k]);
      }
      const PacketGeometry together = packed(pointers);
      for (bool given_pressure : {false, true}) {
        std::vector<Packet> p(n_p);
        MatX pressure(n_p, 8);
        for (int l = 0; l < 8; ++l)
          for (int k = 0; k < n_p; ++k)
            pressure(k, l) = distance(random), p[k].set(l, pressure(k, l));
        PacketElement out(n, n_p);
        const double local = test::local_modulus(formulation, material);
        packet_solid(formulation, material, local, together, fibre, moved.data(),
                     given_pressure ? p.data() : nullptr, true, out);
        for (int l = 0; l < 8; ++l) {
          SolidElement one;
          REQUIRE(solid(formulation, material, local, geometry[l], a, u[l],
                        given_pressure ? pressure.col(l).data() : nullptr, true, one));
          CHECK(out.W[l] == near(one.W, 1e-12));
          CHECK(out.J_min[l] == near(one.J_min, 1e-13));
          const double f = one.f.lpNorm<Eigen::Infinity>(), K = one.K.lpNorm<Eigen::Infinity>();
          double worst_f = 0, worst_K = 0, worst_dJ = 0;
          for (int i = 0; i < 3 * n; ++i) {
            worst_f = std::max(worst_f, std::abs(out.f[i][l] - one.f[i]));
            for (int j = 0; j <= i; ++j)
              worst_K = std::max(worst_K, std::abs(out.K[i * (i + 1) / 2 + j][l] - one.K(i, j)));
            for (int k = 0; k < n_p; ++k)
              worst_dJ = std::max(worst_dJ, std::abs(out.dJ_du(k)[i][l] - one.dJ_du[k][i]));
          }
          for (int k = 0; k < n_p; ++k)
            CHECK(std::abs(out.J_minus_1[k][l] - one.J_minus_1[k]) < 1e-14);
          CHECK(worst_f <= 1e-12 * f);
          CHECK(worst_K <= 1e-12 * K);
          CHECK(worst_dJ <= 1e-13);
        }
      }
    }
  }
}

TEST_CASE("laws that packets do not know are left to the scalar element") {
  for (const MatrixTerm& term : {MatrixTerm(YeohI2{0.1, 0, 0}), MatrixTerm(MooneyRivlin{0.1, 0.1}),
                                 MatrixTerm(Signorini{0.1, 0.1, 0.1}), MatrixTerm(Ogden{0.1, 3})}) {
    Material m = test::stable(40, 1e-3);
    m.matrix.push_back(term);
    CHECK(!packet_form(m));
  }
}
