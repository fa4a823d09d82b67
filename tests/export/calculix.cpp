// Cards of CalculiX run by CalculiX: one element pulled and pushed gives the stress of Langer's own
// law.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "export/cards.hpp"
#include "mechanics/material/uniaxial.hpp"
#include "support/near.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

Fibre family(double alpha) { return {HgoFibre{0.2, 0.8}, alpha}; }

constexpr double d = 1e-4;  // stiff against change of volume, soft enough for one element

// Cauchy stress along x that ccx finds in a cube stretched along x, its sides free; NaN if it found
// none
double stress_by_ccx(const std::string& card, double stretch, const std::string& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::ofstream(folder + "/cube.inp")
      << "*NODE, NSET=ALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
         "*NSET, NSET=X0\n1,4,5,8\n*NSET, NSET=X1\n2,3,6,7\n*NSET, NSET=Y0\n1,2,5,6\n*NSET, NSET=Z0\n1,2,3,4\n"
         "*ELEMENT, TYPE=C3D8, ELSET=CUBE\n1,1,2,3,4,5,6,7,8\n"
      << card << "*SOLID SECTION, ELSET=CUBE, MATERIAL="
      << (card.find("ELASTIC_FIBER") == std::string::npos
              ? "LANGER"
              : "ELASTIC_FIBER_LANGER, ORIENTATION=FIBRES")
      << "\n*BOUNDARY\nX0,1,1\nY0,2,2\nZ0,3,3\n"
         "*STEP, NLGEOM, INC=1000\n*STATIC\n0.02,1.,1e-6,0.05\n*BOUNDARY\nX1,1,1,"
      << stretch - 1 << "\n*EL PRINT, ELSET=CUBE, FREQUENCY=1000, GLOBAL=YES\nS\n*END STEP\n";
  if (std::system(fmt::format("cd '{}' && ccx -i cube > log 2>&1", folder).c_str()) != 0)
    return std::nan("");
  std::ifstream in(folder + "/cube.dat");
  double found = std::nan("");
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    int element = 0, point = 0;
    double xx = 0;
    if (cells >> element >> point >> xx && element == 1) found = xx;
  }
  return found;
}

}  // namespace

TEST_CASE("CalculiX makes of its cards the stress of Langer's laws") {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) {
    MESSAGE("skipped: CalculiX (ccx) is not installed");
    return;
  }
  const Volume volume{QuadraticVolume{d}};
  const std::pair<const char*, Material> laws[] = {
      {"neo_hooke", {{NeoHooke{0.3}}, {}, volume}},
      {"mooney_rivlin", {{MooneyRivlin{0.2, 0.1}}, {}, volume}},
      {"yeoh", {{Yeoh{0.3, 0.05, 0.02}}, {}, volume}},
      {"signorini", {{Signorini{0.2, 0.1, 0.05}}, {}, volume}},
      {"ogden_1", {{Ogden{0.4, 3}}, {}, volume}},
      {"ogden_2", {{Ogden{0.4, 1.6, 0.02, 6}}, {}, volume}},
      {"ogden_3", {{Ogden{0.4, 1.3, 0.01, 5, -0.1, -2}}, {}, volume}},
      {"cubic", {{Yeoh{0.2, 0.1, 0.02}, YeohI2{0.1, 0.05, 0.01}}, {}, volume}},
      {"arruda_boyce", {{ArrudaBoyce{0.4, 2}}, {}, volume}},
      {"fibre", {{NeoHooke{0.3}}, {family(0)}, volume}},
      {"families", {{NeoHooke{0.3}}, {family(30), family(-30)}, volume}},
      {"idle", {{Yeoh{0.3, 0.05, 0.02}}, {{HgoFibre{0, 1}}}, volume}}};
  for (const auto& [name, m] : laws)
    for (double stretch : {1.5, 0.75}) {
      const auto named = name;
      CAPTURE(named);
      CAPTURE(stretch);
      const Card card = cards(m).back();
      REQUIRE(card.program == "CalculiX");
      REQUIRE(card.exists);
      const double own = uniaxial(m, stretch).sigma;
      const double theirs = stress_by_ccx(card.text, stretch,
                                          fmt::format(BINARY_DIR "/calculix/{}_{}", name, stretch));
      // six digits in its table; other volume terms (Arruda-Boyce) and its own expansion of them:
      // of the order of sigma d
      CHECK(theirs == near(own, 3e-4));
    }
}
