// The numbers of a material by their paths.
#include "mechanics/material/parameters.hpp"

#include <doctest/doctest.h>

#include "material/catalogue.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {
std::vector<std::string> keys(Material m) {
  std::vector<std::string> k;
  for (const MaterialParameter& p : parameters(m)) k.push_back(p.key);
  return k;
}
}  // namespace

TEST_CASE("every number of a law has its YAML path, its name and its unit") {
  Material m = table1_hgo_yeoh(30);
  CHECK(keys(m) == std::vector<std::string>{"matrix.yeoh.a1", "matrix.yeoh.a2", "matrix.yeoh.a3",
                                            "fibres[0].hgo.c1", "fibres[0].hgo.c2",
                                            "fibres[0].alpha", "fibres[0].kappa",
                                            "volume.quadratic.d"});
  const auto all = parameters(m);
  CHECK(all[3].name == "c1");
  CHECK(all[3].unit == "MPa");
  CHECK(all[4].range.low == 0);
  *all[3].value = 7;
  CHECK(std::get<HgoFibre>(m.fibres[0].law).c1 == 7);
}

TEST_CASE("terms that stand twice are told apart by index, and names by a number") {
  Material m{{Yeoh{1, 2, 3}, Yeoh{4, 5, 6}},
             {hgo_fibre(0.1, 1, 10), hgo_fibre(0.2, 1, 20)},
             {QuadraticVolume{1}}};
  const auto k = keys(m);
  CHECK(k[0] == "matrix[0].yeoh.a1");
  CHECK(k[3] == "matrix[1].yeoh.a1");
  CHECK(k[10] == "fibres[1].hgo.c1");
  const auto all = parameters(m);
  CHECK(all[0].name == "a1");
  CHECK(all[3].name == "a1_2");
  CHECK(all[10].name == "c1_2");
}

TEST_CASE("a number of a fibre law with the word of its family's angle takes the name of the law") {
  Material m{{NeoHooke{0.1}},
             {{ExpPowFibre{0.3, 0.8, 2.5}, 20}, {PowLinearFibre{3, 1.1, 3}, 40}},
             LogarithmicVolume{1e3}};
  std::vector<std::string> names;
  for (const MaterialParameter& p : parameters(m)) names.push_back(p.name);
  CHECK(keys(m)[2] == "fibres[0].exp_pow.alpha");
  CHECK(keys(m).back() == "volume.logarithmic.bulk_modulus");
  CHECK(names == std::vector<std::string>{"a1", "ksi", "exp_pow_alpha", "beta", "alpha", "kappa",
                                          "E", "lam0", "beta_2", "alpha_2", "kappa_2",
                                          "bulk_modulus"});
}

TEST_CASE("energy and stress of a state are linear in what is called a modulus, in every law") {
  Mat3 F;
  F << 1.3, 0.2, -0.1, 0.05, 0.9, 0.15, 0.1, -0.2, 1.1;
  const Mat3 C = F.transpose() * F;
  for (NamedMaterial& law : catalogue()) {
    const std::vector<Vec3> a = fibre_directions(law.material);
    const Response here = isochoric(law.material, C, a);
    int moduli = 0;
    for (const MaterialParameter& p : parameters(law.material)) {
      if (!p.modulus()) continue;
      CAPTURE(law.name);
      CAPTURE(p.key);
      ++moduli;
      const double value = *p.value;
      *p.value = value + 1;
      const Response close = isochoric(law.material, C, a);
      *p.value = value + 3;
      const Response far = isochoric(law.material, C, a);
      *p.value = value;
      CHECK((far.S - here.S - 3 * (close.S - here.S)).norm() < 1e-12 * (1 + far.S.norm()));
      CHECK(far.W - here.W == near(3 * (close.W - here.W), 1e-12));
    }
    CHECK(moduli > 0);
  }
}
