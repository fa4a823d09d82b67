// Cards and decks mean what Langer's law says: read as the other program documents it, at random
// laws and random states.
#include <doctest/doctest.h>

#include <functional>
#include <map>
#include <random>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/stress.hpp"
#include "export/cards.hpp"
#include "export/export_scene.hpp"
#include "export/febio_material.hpp"
#include "support/foreign_laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace meaning_tests {

namespace {

class Dice {
 public:
  double operator()(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(engine_);
  }
  Mat3 state() {  // J between 0.98 and 1.02
    for (;;) {
      Mat3 F = Mat3::Identity();
      for (int i = 0; i < 9; ++i) F(i / 3, i % 3) += (*this)(-0.3, 0.3);
      if (const double J = F.determinant(); J > 0.3) return std::cbrt((*this)(0.98, 1.02) / J) * F;
    }
  }

 private:
  std::mt19937 engine_{7};
};
Dice dice;

Fibre family(double kappa = 0) {
  return {HgoFibre{dice(0.05, 1), dice(0.05, 2)}, dice(-90, 90), FibreSwitch::I4_bar, kappa};
}
Yeoh yeoh() { return {dice(0.1, 1), dice(0.1, 1), dice(0.1, 1)}; }
Ogden ogden() {
  return {dice(0.1, 1), dice(1, 4), dice(0.01, 0.1), dice(4, 8), -dice(0.01, 0.1), -dice(1, 4)};
}

struct Kind {
  std::string name;
  std::function<Material()> draw;
  std::string held_by;  // first letters of Abaqus, aNsys, Febio, Calculix
};
const std::vector<Kind> kinds = {
    {"neo_hooke",
     [] {
       return Material{{NeoHooke{dice(0.1, 1)}}, {}, {}};
     },
     "ANFC"},
    {"mooney_rivlin",
     [] {
       return Material{{MooneyRivlin{dice(0.1, 1), dice(0.1, 1)}}, {}, {}};
     },
     "ANFC"},
    {"yeoh",
     [] {
       return Material{{yeoh()}, {}, {}};
     },
     "ANFC"},
    {"yeoh of two terms and neo_hooke",
     [] {
       return Material{{Yeoh{dice(0.1, 1), dice(0.1, 1), 0}, NeoHooke{0.1}}, {}, {}};
     },
     "ANFC"},
    {"signorini",
     [] {
       return Material{{Signorini{dice(0.1, 1), dice(0.1, 1), dice(0.1, 1)}}, {}, {}};
     },
     "ANFC"},
    {"yeoh and yeoh_I2",
     [] {
       return Material{{yeoh(), YeohI2{dice(0.1, 1), dice(0.1, 1), dice(0.1, 1)}}, {}, {}};
     },
     "ANC"},
    {"yeoh and b1",
     [] {
       return Material{{yeoh(), YeohI2{dice(0.1, 1), 0, 0}}, {}, {}};
     },
     "ANFC"},
    {"ogden",
     [] {
       return Material{{ogden()}, {}, {}};
     },
     "ANFC"},
    {"ogden of one",
     [] {
       return Material{{Ogden{dice(0.1, 1), dice(1, 8)}}, {}, {}};
     },
     "ANFC"},
    {"ogden with a power of 0",
     [] {
       return Material{{Ogden{dice(0.1, 1), dice(1, 8), 0.5, 0}}, {}, {}};
     },
     "ANFC"},
    {"arruda_boyce",
     [] {
       return Material{{ArrudaBoyce{dice(0.1, 1), dice(1.5, 4)}}, {}, {}};
     },
     "ANC"},
    {"gent",
     [] {
       return Material{{Gent{dice(0.1, 1), dice(20, 90)}}, {}, {}};
     },
     "NF"},
    {"gent and yeoh",
     [] {
       return Material{{Gent{dice(0.1, 1), dice(20, 90)}, yeoh()}, {}, {}};
     },
     "F"},
    {"neo_hooke, a family",
     [] {
       return Material{{NeoHooke{dice(0.1, 1)}}, {family()}, {}};
     },
     "ANFC"},
    {"neo_hooke, two families",
     [] {
       return Material{{NeoHooke{dice(0.1, 1)}}, {family(), family()}, {}};
     },
     "NFC"},
    {"neo_hooke, two alike",
     [] {
       Fibre a = family(), b = a;
       b.alpha_deg = dice(-90, 90);
       return Material{{NeoHooke{dice(0.1, 1)}}, {a, b}, {}};
     },
     "ANFC"},
    {"a family that does nothing",
     [] {
       Fibre none = family();
       std::get<HgoFibre>(none.law).c1 = 0;
       return Material{{yeoh()}, {none}, {}};
     },
     "ANFC"},
    {"a family beside one that does nothing",
     [] {
       Fibre none = family();
       std::get<HgoFibre>(none.law).c1 = 0;
       return Material{{NeoHooke{dice(0.1, 1)}}, {none, family()}, {}};
     },
     "ANFC"},
    {"yeoh, a family",
     [] {
       return Material{{yeoh()}, {family()}, {}};
     },
     "NF"},
    {"yeoh, two families",
     [] {
       return Material{{yeoh()}, {family(), family()}, {}};
     },
     "NF"},
    {"signorini, three families",
     [] {
       return Material{{Signorini{0.1, 0.2, 0.3}}, {family(), family(), family()}, {}};
     },
     "F"},
    {"c2 = 0",
     [] {
       Fibre f = family();
       std::get<HgoFibre>(f.law).c2 = 0;
       return Material{{yeoh()}, {f}, {}};
     },
     "F"},
    {"GOH",
     [] {
       return Material{{NeoHooke{dice(0.1, 1)}}, {family(dice(0.01, 0.3))}, {}};
     },
     "AF"},
    {"GOH, two alike",
     [] {
       Fibre a = family(dice(0.01, 0.3)), b = a;
       b.alpha_deg = dice(-90, 90);
       return Material{{NeoHooke{dice(0.1, 1)}}, {a, b}, {}};
     },
     "AF"},
    {"GOH, two that fall together",
     [] {
       const Fibre a = family(dice(0.01, 0.3));
       return Material{{NeoHooke{dice(0.1, 1)}}, {a, a}, {}};
     },
     "AF"},
    {"dispersed in yeoh, two families",
     [] {
       return Material{{yeoh()}, {family(dice(0.01, 0.3)), family(0.2)}, {}};
     },
     "F"},
    {"c1 < 0",
     [] {
       Fibre f = family();
       std::get<HgoFibre>(f.law).c1 = -0.3;
       return Material{{NeoHooke{dice(0.3, 1)}}, {f}, {}};
     },
     "ANC"},
    {"exp_pow of the second power",
     [] {
       Fibre f = family();
       f.law = ExpPowFibre{dice(0.05, 1), dice(0.05, 2), 2};
       return Material{{NeoHooke{dice(0.3, 1)}}, {f}, {}};
     },
     "ANFC"},
    {"exp_pow",
     [] {
       Fibre f = family();
       f.law = ExpPowFibre{dice(0.05, 1), dice(0, 2), dice(2.1, 4)};
       return Material{{yeoh()}, {f, family()}, {}};
     },
     "F"},
    {"pow_linear",
     [] {
       Fibre f = family();
       f.law = PowLinearFibre{dice(0.05, 10), dice(1.02, 1.2), dice(2, 4)};
       return Material{{NeoHooke{dice(0.3, 1)}}, {f}, {}};
     },
     "F"},
    {"dispersed exp_pow of the second power",
     [] {
       Fibre f = family(0.1);
       f.law = ExpPowFibre{dice(0.05, 1), dice(0.05, 2), 2};
       return Material{{NeoHooke{dice(0.3, 1)}}, {f}, {}};
     },
     "AF"},
    {"dispersed exp_pow",
     [] {
       Fibre f = family(0.1);
       f.law = ExpPowFibre{dice(0.05, 1), dice(0.05, 2), 3};
       return Material{{NeoHooke{dice(0.3, 1)}}, {f}, {}};
     },
     ""},
    {"fibres that push",
     [] {
       Fibre f = family();
       f.tension_switch = FibreSwitch::off;
       return Material{{NeoHooke{dice(0.3, 1)}}, {f}, {}};
     },
     "N"},
};

constexpr double tolerance = 2e-8;  // ten digits in a card

void compare(const Card& card, const Material& m, const Mat3& F) {
  const Mat3 C = right_cauchy_green(F);
  const std::vector<Vec3> a = fibre_directions(m);
  const double J = F.determinant();
  if (card.program == "FEBio") {
    const Mat3 own = cauchy(F, response(m, C, J - 1, a).S, J),
               theirs = foreign::febio_stress(card.text, F);
    CHECK((own - theirs).norm() <= tolerance * own.norm());
    return;
  }
  // no switch in ANSYS: compared where all families are stretched, or act anyway
  for (std::size_t k = 0; card.program == "ANSYS" && k < a.size(); ++k)
    if (a[k].dot(C * a[k]) * std::pow(J, -2. / 3) < 1 && acts(m.fibres[k]) &&
        m.fibres[k].tension_switch != FibreSwitch::off)
      return;
  const foreign::Energies theirs = card.program == "ANSYS" ? foreign::by_ansys(card.text, F)
                                                           : foreign::by_keywords(card.text, F);
  const double own = isochoric(m, C, a).W;
  // twelve digits of two components leave the third, their length's rest, to 1e-6
  const bool user = card.text.find("USER MATERIAL") != std::string::npos;
  CHECK(theirs.isochoric == near(own, user ? 1e-5 : tolerance));
  const double square = volume_energy(m.volume, J - 1).W;
  if (card.text.find("volume term here") == std::string::npos)
    CHECK(theirs.volumetric == near(square, tolerance));
  else  // of another form, of the same bulk modulus
    CHECK(theirs.volumetric == near(square, 0.03));
}

}  // namespace

TEST_CASE("a card means Langer's law, or says what the program lacks and the nearest that it has") {
  // A killed fit knows its cards by their first lines, which are the same for all materials.
  std::map<std::string, std::string> first_line;
  for (const Kind& kind : kinds) {
    CAPTURE(kind.name);
    for (int draw = 0; draw < 10; ++draw) {
      Material m = kind.draw();
      m.volume = QuadraticVolume{std::pow(10, dice(-6, -2))};
      for (const Card& card : cards(m)) {
        CAPTURE(card.program);
        CAPTURE(card.text);
        const std::string line = card.text.substr(0, card.text.find('\n'));
        CHECK(first_line.try_emplace(card.program, line).first->second == line);
        const char letter = card.program == "ANSYS" ? 'N' : card.program[0];
        REQUIRE(card.exists == (kind.held_by.find(letter) != std::string::npos));
        if (!card.exists) CHECK(card.text.find("lacks") < card.text.find("; nearest: "));
        for (int state = 0; state < 10 && card.exists; ++state) compare(card, m, dice.state());
      }
    }
  }
}

TEST_CASE("the formulas tell FEBio's own Yeoh and Arruda-Boyce from the laws of that name") {
  const Mat3 F = Vec3(1.6, 1 / std::sqrt(1.6), 1 / std::sqrt(1.6)).asDiagonal();
  const auto ratio = [&](const std::string& text, const Material& m) {
    const Mat3 own = cauchy(F, isochoric(m, right_cauchy_green(F), {}).S, 1),
               theirs = foreign::febio_stress(text, F);
    return (theirs(0, 0) - theirs(1, 1)) / (own(0, 0) - own(1, 1));
  };
  const std::string head = "<material id=\"1\" name=\"x\" type=\"",
                    k = "\"><k>1</k><pressure_model>2</pressure_model>";
  const Material table1{{Yeoh{0.269, 0.376, 0.415}}, {}, {}},
      chains{{ArrudaBoyce{0.3, 1.2}}, {}, {}};
  // coefficients as they are: half the stress, and half as much again
  CHECK(ratio(head + "Yeoh" + k + "<c1>0.269</c1><c2>0.376</c2><c3>0.415</c3></material>",
              table1) == near(0.503, 0.02));
  CHECK(ratio(head + "Arruda-Boyce" + k + "<mu>0.3</mu><N>1.44</N></material>", chains) > 1.5);
}

TEST_CASE("a group of cells with directions of its own gets them in FEBio") {
  for (int draw = 0; draw < 40; ++draw) {
    const bool scattered = draw % 2 == 1;
    Material m{{yeoh()},
               {family(scattered ? 0.2 : 0), family(scattered ? 0.1 : 0)},
               {QuadraticVolume{1e-3}}};
    if (draw % 4 == 3) m.matrix = {NeoHooke{0.4}}, m.fibres[1] = m.fibres[0];
    std::vector<Vec3> a;
    for (int k = 0; k < 2; ++k)
      a.push_back(Vec3(dice(-1, 1), dice(-1, 1), dice(-1, 1)).normalized());
    const ForeignLaw law = febio_material(m, a, 1, "law");
    CAPTURE(law.text);
    for (int state = 0; state < 10; ++state) {
      const Mat3 F = dice.state();
      const Mat3 own =
          cauchy(F, response(m, right_cauchy_green(F), F.determinant() - 1, a).S, F.determinant());
      CHECK((own - foreign::febio_stress(law.text, F)).norm() <= 1e-11 * own.norm());
    }
  }
}

TEST_CASE(
    "another law of volume change goes where a program has it, and is refused by name with the nearest where not") {
  struct Case {
    Material m;
    Volume volume;
    std::string held_by, nearest;  // nearest: of Abaqus
  };
  const Fibre fibre{HgoFibre{0.3, 0.8}, 30};
  const std::string square = "volume: {quadratic: {d: 0.002}}",
                    other = "volume: {simo_taylor: {bulk_modulus: 1000}}";
  for (const auto& [m, volume, held_by, nearest] :
       {Case{{{NeoHooke{0.3}}, {}, {}}, LogarithmicVolume{1000}, "F", square},
        Case{{{NeoHooke{0.3}}, {}, {}}, SimoTaylorVolume{1000}, "F", square},
        Case{{{NeoHooke{0.3}}, {fibre}, {}}, LogarithmicVolume{1000}, "F", other},
        Case{{{NeoHooke{0.3}}, {fibre}, {}}, SimoTaylorVolume{1000}, "AF", ""},
        Case{{{ArrudaBoyce{0.3, 2}}, {}, {}}, SimoTaylorVolume{1000}, "ANC", ""},
        Case{{{Gent{0.3, 30}}, {}, {}}, SimoTaylorVolume{1000}, "NF", ""}}) {
    Material law = m;
    law.volume = volume;
    for (const Card& card : cards(law)) {
      CAPTURE(card.program);
      CAPTURE(card.text);
      const char letter = card.program == "ANSYS" ? 'N' : card.program[0];
      REQUIRE(card.exists == (held_by.find(letter) != std::string::npos));
      if (card.exists) {
        CHECK(card.text.find("volume term here") == std::string::npos);
        for (int state = 0; state < 10; ++state) compare(card, law, dice.state());
      } else if (card.program == "Abaqus" && !nearest.empty()) {
        CHECK(card.text.find("lacks volume: ") != std::string::npos);
        CHECK(card.text.find("nearest: " + nearest) != std::string::npos);
      }
    }
  }
}

}  // namespace meaning_tests
