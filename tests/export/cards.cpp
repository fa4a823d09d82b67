// Fitted laws as input of other programs.
#include "export/cards.hpp"

#include <doctest/doctest.h>

#include "material/catalogue.hpp"

using namespace langer;

namespace {

const Volume volume{QuadraticVolume{1e-3}};

Card card(const Material& m, const std::string& program) {
  for (const Card& c : cards(m))
    if (c.program == program) return c;
  FAIL("no card for " << program);
  return {};
}

void holds(const Card& c, const std::string& part) {
  CAPTURE(c.text);
  CHECK(c.exists);
  CHECK(c.text.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("isotropic laws stand in Abaqus and CalculiX with the same keywords") {
  for (const char* program : {"Abaqus", "CalculiX"}) {
    holds(card({{NeoHooke{0.3}}, {}, volume}, program), "*HYPERELASTIC, NEO HOOKE\n0.3, 0.001\n");
    holds(card({{Yeoh{0.3, 0.2, 0.1}}, {}, volume}, program),
          "*HYPERELASTIC, YEOH\n0.3, 0.2, 0.1, 0.001, 0, 0\n");
    holds(card({{MooneyRivlin{0.3, 0.2}}, {}, volume}, program),
          "*HYPERELASTIC, MOONEY-RIVLIN\n0.3, 0.2, 0.001\n");
    // the same law written as a sum
    holds(card({{NeoHooke{0.3}, YeohI2{0.2, 0, 0}}, {}, volume}, program),
          "MOONEY-RIVLIN\n0.3, 0.2, 0.001\n");
    holds(card({{Signorini{0.3, 0.2, 0.1}}, {}, volume}, program),
          "POLYNOMIAL, N=2\n0.3, 0.2, 0.1, 0, 0, 0.001, 0\n");
    // mu alpha/2 = 0.3 * 4/2
    holds(card({{Ogden{0.3, 4}}, {}, volume}, program), "OGDEN, N=1\n0.6, 4, 0.001\n");
    holds(card({{ArrudaBoyce{0.3, 4}}, {}, volume}, program), "ARRUDA-BOYCE\n0.3, 4, 0.001\n");
    const Card gent = card({{Gent{0.3, 4}}, {}, volume}, program);
    CHECK(!gent.exists);
    CHECK(gent.text.find(std::string(program) + " lacks gent; nearest: ") != std::string::npos);
  }
}

TEST_CASE("FEBio has a Yeoh of its own, and an Arruda-Boyce that is refused") {
  // its stress lacks the factor i: 1 x 0.4, 2 x 0.2, 3 x 0.1
  const Card yeoh = card({{NeoHooke{0.1}, Yeoh{0.3, 0.2, 0.1}}, {}, volume}, "FEBio");
  holds(
      yeoh,
      "type=\"Yeoh\">\n  <k>2000</k><pressure_model>2</pressure_model>\n  <c1>0.4</c1><c2>0.4</c2><c3>0.3");
  holds(yeoh, "lacks the factor i");
  const Card chains = card({{ArrudaBoyce{0.3, 1.2}}, {}, volume}, "FEBio");
  CHECK(!chains.exists);
  CHECK(chains.text.find("nearest: gent, or near rest yeoh: {a1: ") != std::string::npos);
}

TEST_CASE("HGO and GOH stand in Abaqus and FEBio, HGO-Yeoh in FEBio and ANSYS") {
  const Material goh{{NeoHooke{0.3}}, {hgo_fibre(0.2, 0.5, 90, FibreSwitch::I4_bar, 0.1)}, volume};
  holds(card(goh, "Abaqus"),
        "*ANISOTROPIC HYPERELASTIC, HOLZAPFEL, LOCAL DIRECTIONS=1\n0.3, 0.001, 0.2, 0.5, 0.1\n");
  holds(card(goh, "Abaqus"),
        "**  1., 0., 0., 0., 1., 0.\n**  3, 0.\n");  // axes, rotation, then the directions
  const Card febio = card(goh, "FEBio");
  holds(febio, "type=\"Holzapfel-Gasser-Ogden\"");
  holds(febio, "<c>0.6</c><k1>0.1</k1>");  // two coincident families there
  const Material hgo_yeoh = positive_hgo_yeoh(30);
  for (const char* program : {"FEBio", "ANSYS"}) CHECK(card(hgo_yeoh, program).exists);
  for (const char* program : {"Abaqus", "CalculiX"}) CHECK(!card(hgo_yeoh, program).exists);
}

TEST_CASE("a modulus that FEBio refuses makes no card, and the note says which") {
  const Card table1 = card(table1_hgo_yeoh(), "FEBio");
  CHECK(!table1.exists);
  CHECK(table1.text.find(
            "fibres with c1 = -0.317 (it refuses ksi, k1 < 0); nearest: c1 of 0 or more") !=
        std::string::npos);
}

TEST_CASE("the law (44) of two families stands in ANSYS with its ten constants") {
  const Material m{
      {Yeoh{1, 2, 3}, YeohI2{4, 5, 6}}, {hgo_fibre(7, 8, 0), hgo_fibre(9, 10, 90)}, volume};
  const Card c = card(m, "ANSYS");
  holds(c, "TB,AHYPER,1,1,10,EXPO\nTBDATA,1,1,2,3\nTBDATA,4,4,5,6\nTBDATA,7,7,8\nTBDATA,9,9,10\n");
  holds(c, "AVEC\nTBDATA,1,1,0,0\n");
  holds(c, "TB,AHYPER,1,1,1,PVOL\nTBDATA,1,0.001\n");
  holds(card({{Gent{0.3, 4}}, {}, volume}, "ANSYS"), "GENT\nTBDATA,1,0.3,4,0.001\n");
  holds(card({{Yeoh{0.3, 0.2, 0.1}}, {}, volume}, "ANSYS"),
        "TB,HYPER,1,1,3,YEOH\nTBDATA,1,0.3,0.2,0.1,0.001,0,0\n");
  Material dispersed = m;
  dispersed.fibres[0].kappa = 0.1;
  CHECK(!card(dispersed, "ANSYS").exists);
}

TEST_CASE(
    "viscous branches are shares of the instantaneous modulus, or a note where a program was not tried") {
  Material m{{NeoHooke{0.3}}, {}, QuadraticVolume{1e-3}};
  m.viscous = {{0.5, 0.3, BranchOf::all}, {20, 0.2, BranchOf::matrix}};
  const std::vector<Card> all = cards(m);
  CHECK(all[0].exists);
  CHECK(all[0].text.find("*HYPERELASTIC, MODULI=LONG TERM, NEO HOOKE\n0.3, 0.001\n") !=
        std::string::npos);
  CHECK(all[0].text.find("*VISCOELASTIC, TIME=PRONY\n0.2, 0, 0.5\n0.1333333333, 0, 20\n") !=
        std::string::npos);
  CHECK(all[1].exists);
  CHECK(all[1].text.find("TBDATA,1,0.9,0.001\n") != std::string::npos);  // 2 a1 (1 + 0.5)
  CHECK(all[1].text.find("TB,PRONY,1,1,2,SHEAR\nTBDATA,1,0.2,0.5\nTBDATA,3,0.1333333333,20\n") !=
        std::string::npos);
  CHECK(!all[2].exists);
  CHECK(!all[3].exists);
  m.fibres = {Fibre{HgoFibre{0.1, 0.3}, 30}};
  for (const Card& card : cards(m)) {
    CAPTURE(card.program);
    CHECK(!card.exists);
    CHECK(card.text.find("viscous") != std::string::npos);
  }
}
