// CalculiX: hyperelastic cards for isotropic laws; fibres as its user material ELASTIC_FIBER, which knows a neo-Hookean matrix
// only. hex27 become C3D20R: it has no 27-node cells. Numbers are cut after 20 letters there, so none is longer. The sphere is
// a layer of hexahedra all of whose nodes are led along the path.
#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"
#include "mesh/facets.hpp"
#include "export/cards.hpp"
#include "export/export_scene.hpp"

namespace langer {

namespace {

constexpr int side_of_facet[6] = {6, 4, 3, 5, 1, 2};  // S1 ... S6 by our local facet
constexpr double usual_stiffness = 1000;              // of contact, in units of the softest law's 2 a1 per mm

[[noreturn]] void refuse(const std::string& found, const std::string& expected) {
  throw Failure(Exit::config, Error{{"CalculiX"}, "material", found, expected, ""});
}

std::string name_of(const std::string& name) {
  if (name.size() > 60 || name.find_first_of("\", \n\r*=") != std::string::npos)
    throw Failure(Exit::config, Error{{"CalculiX"},
                                      "",
                                      "the name \"" + name + "\" cannot stand in its deck",
                                      "at most 60 letters without , \" * = and spaces",
                                      ""});
  return name;
}

std::string list(const std::vector<int>& numbers) {
  std::string s;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    s += fmt::format("{},{}", numbers[i], i % 16 == 15 || i + 1 == numbers.size() ? "\n" : " ");
  return s;
}

// a1 where the matrix is neo-Hookean
double neo_hookean(const Material& m) {
  double a1 = 0;
  for (const MatrixTerm& term : m.matrix) {
    const auto* neo = std::get_if<NeoHooke>(&term);
    const auto* yeoh = std::get_if<Yeoh>(&term);
    if (!neo && !(yeoh && yeoh->a2 == 0 && yeoh->a3 == 0))
      refuse("fibres in a matrix other than neo-Hookean",
             "a neo-Hookean matrix, or no fibres: CalculiX' ELASTIC_FIBER knows no other");
    a1 += neo ? neo->a1 : yeoh->a1;
  }
  return a1;
}

std::string fibre_card(const Material& m, const FibreFrame& frame, const std::string& name) {
  std::vector<double> constants{neo_hookean(m), m.volume.quadratic.d};
  for (std::size_t k = 0; k < m.fibres.size(); ++k) {
    const Fibre& f = m.fibres[k];
    if (f.kappa != 0) refuse("dispersed fibres", "kappa: 0");
    if (f.tension_switch != FibreSwitch::I4_bar) refuse("fibres with another switch", "switch: I4_bar, which is CalculiX' own");
    if (f.hgo.c2 == 0) refuse("c2 = 0", "c2 above 0: it divides by it");
    Vec3 a = frame.in_frame[k];
    if (a[2] < 0) a = -a;  // it takes the third component as positive, and refuses what rounding makes longer than 1
    a *= 1 - 2e-12;
    for (double c : {a[0], a[1], f.hgo.c1, f.hgo.c2}) constants.push_back(c);
  }
  std::string s = fmt::format("*MATERIAL, NAME={}\n*USER MATERIAL, CONSTANTS={}\n", name, constants.size());
  for (std::size_t i = 0; i < constants.size(); ++i)
    s += fmt::format("{:.12g},{}", constants[i], i % 8 == 7 || i + 1 == constants.size() ? "\n" : " ");
  return s;
}

std::string isotropic_card(const Material& m, const std::string& name) {
  for (const Card& card : cards(m))
    if (card.program == "CalculiX") {
      if (!card.exists)
        refuse(card.text.substr(3, card.text.find('\n') - 3),
               "a law of CalculiX: neo-Hooke, Mooney-Rivlin, Yeoh, Signorini, Ogden, Arruda-Boyce");
      std::string text = card.text;
      const std::string own = "NAME=LANGER";
      return text.replace(text.find(own), own.size(), "NAME=" + name);
    }
  return "";
}

double shear_modulus_of(const Material& m) {
  double mu = 0;
  for (const MatrixTerm& term : m.matrix) mu += shear_modulus(term);
  return mu;
}

class Writer {
 public:
  explicit Writer(const Deck& deck) : deck_(deck), mesh_(deck.mesh) {}

  std::string text() {
    const bool quadratic = mesh_.type == CellType::hex27;
    for (const std::string& line : deck_.words) s_ += "** " + line + "\n";
    if (quadratic) s_ += "** hex27 are C3D20R here: the middles of facets and cells are left out\n";
    if (!deck_.contacts.empty())
      s_ += fmt::format(
          "** spheres are rigid facets with penalty contact: stiffness {:g} times the shear modulus per mm "
          "(PRESSURE-OVERCLOSURE); a higher\n"
          "** one lets less of the sphere into the body. Langer has the exact sphere and lets nothing in.\n",
          usual_stiffness);
    body(quadratic);
    for (std::size_t c = 0; c < deck_.contacts.size(); ++c) contact(deck_.contacts[c], static_cast<int>(c));
    steps();
    return s_;
  }

 private:
  const Deck& deck_;
  const Mesh& mesh_;
  std::string s_, rigid_;
  int next_node_ = 0, next_cell_ = 0;

  void node(int number, const Vec3& X) { s_ += fmt::format("{}, {:.12g}, {:.12g}, {:.12g}\n", number, X[0], X[1], X[2]); }

  void body(bool quadratic) {
    const int per_cell = quadratic ? 20 : 8;
    std::vector<char> used(mesh_.X.size(), 0);
    for (int e = 0; e < mesh_.n_cells(); ++e)
      for (int a = 0; a < per_cell; ++a) used[mesh_.cell(e)[a]] = 1;
    s_ += "*NODE, NSET=BODY\n";
    for (int n = 0; n < mesh_.n_nodes(); ++n)
      if (used[n]) node(n + 1, mesh_.X[n]);
    next_node_ = mesh_.n_nodes() + 1, next_cell_ = mesh_.n_cells() + 1;

    std::vector<std::string> law_of_body(deck_.materials.size());
    std::vector<std::vector<Vec3>> components(deck_.materials.size());
    std::string sections;
    for (std::size_t g = 0; g < deck_.groups.size(); ++g) {
      const FibreGroup& group = deck_.groups[g];
      const Material& m = deck_.materials[group.body];
      const std::string set = fmt::format("CELLS{}", g + 1);
      s_ += fmt::format("*ELEMENT, TYPE={}, ELSET={}\n", quadratic ? "C3D20R" : "C3D8", set);
      for (int e : group.cells) {
        s_ += std::to_string(e + 1);
        for (int a = 0; a < per_cell; ++a) s_ += fmt::format(",{}{}", a == 14 ? "\n" : " ", mesh_.cell(e)[a] + 1);
        s_ += "\n";
      }
      if (group.fibres.empty()) {
        const std::string law = fmt::format("LAW{}", group.body + 1);
        if (law_of_body[group.body].empty()) law_of_body[group.body] = isotropic_card(m, law);
        sections += fmt::format("*SOLID SECTION, ELSET={}, MATERIAL={}\n", set, law);
        continue;
      }
      const FibreFrame frame = fibre_frame(group.fibres);
      const std::string law = fmt::format("ELASTIC_FIBER_{}", group.body + 1);
      if (law_of_body[group.body].empty())
        law_of_body[group.body] = fibre_card(m, frame, law), components[group.body] = frame.in_frame;
      for (std::size_t k = 0; k < frame.in_frame.size(); ++k)
        if ((frame.in_frame[k] - components[group.body][k]).norm() > 1e-6)
          refuse("fibre families whose angle to each other varies", "the same angle everywhere");
      sections +=
          fmt::format("*ORIENTATION, NAME=FIBRES{}, SYSTEM=RECTANGULAR\n{:.12g}, {:.12g}, {:.12g}, {:.12g}, {:.12g}, {:.12g}\n",
                      g + 1, frame.e1[0], frame.e1[1], frame.e1[2], frame.e2[0], frame.e2[1], frame.e2[2]);
      sections += fmt::format("*SOLID SECTION, ELSET={}, MATERIAL={}, ORIENTATION=FIBRES{}\n", set, law, g + 1);
    }
    for (const std::string& law : law_of_body) s_ += law;
    s_ += sections;
    for (const auto& [name, nodes] : mesh_.node_sets) {
      std::vector<int> numbers;
      for (int n : nodes)
        if (used[n]) numbers.push_back(n + 1);
      s_ += fmt::format("*NSET, NSET={}\n{}", name_of(name), list(numbers));
    }
    std::string held;
    for (const HeldSet& h : deck_.held)
      if (h.value == 0) held += fmt::format("{}, {}, {}\n", name_of(h.set), h.axis + 1, h.axis + 1);
    if (!held.empty()) s_ += "*BOUNDARY\n" + held;
  }

  void contact(const DeckContact& c, int number) {
    const std::string name = name_of(c.law.name), slave = fmt::format("SLAVE{}", number + 1),
                      master = fmt::format("MASTER{}", number + 1);
    s_ += fmt::format("*SURFACE, NAME={}, TYPE=ELEMENT\n", slave);
    for (const Facet& f : c.facets) s_ += fmt::format("{}, S{}\n", f.cell + 1, side_of_facet[f.local]);
    const int n = static_cast<int>(c.cap.outer.size()), first = next_node_, first_cell = next_cell_;
    s_ += fmt::format("** {}: rigid facets of {:.3g} mm\n*NODE, NSET=RIGID_{}\n", name, c.cap.side, name);
    for (int i = 0; i < n; ++i) node(first + i, c.cap.inner[i]);
    for (int i = 0; i < n; ++i) node(first + n + i, c.cap.outer[i]);
    s_ += fmt::format("*ELEMENT, TYPE=C3D8, ELSET=RIGID_{}\n", name);
    for (const auto& q : c.cap.facets) {
      s_ += std::to_string(next_cell_++);
      for (int layer : {0, n})
        for (int corner : q) s_ += fmt::format(", {}", first + layer + corner);
      s_ += "\n";
    }
    next_node_ += 2 * n;
    s_ += fmt::format("*SURFACE, NAME={}, TYPE=ELEMENT\n", master);
    for (int e = first_cell; e < next_cell_; ++e) s_ += fmt::format("{}, S2\n", e);
    double mu = 1e300;
    for (const Material& m : deck_.materials) mu = std::min(mu, shear_modulus_of(m));
    s_ += fmt::format("*MATERIAL, NAME=RIGID_{0}\n*ELASTIC\n{1:.6g}, 0.\n*SOLID SECTION, ELSET=RIGID_{0}, MATERIAL=RIGID_{0}\n",
                      name, mu);
    s_ += fmt::format("*SURFACE INTERACTION, NAME=CONTACT{}\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{:.6g}\n",
                      number + 1, usual_stiffness * mu);
    if (c.law.mu > 0) s_ += fmt::format("*FRICTION\n{:.12g}, {:.6g}\n", c.law.mu, 0.1 * usual_stiffness * mu);
    s_ += fmt::format("*CONTACT PAIR, INTERACTION=CONTACT{}, TYPE=SURFACE TO SURFACE\n{}, {}\n", number + 1, slave, master);
  }

  void steps() {
    double before = 0;
    for (double t : deck_.stops) {
      const double takes = t - before;
      s_ += fmt::format("*STEP, NLGEOM, INC=100000\n*STATIC\n{:.6g}, {:.6g}, {:.6g}, {:.6g}\n", std::min(deck_.first, takes),
                        takes, std::min(deck_.smallest, takes), std::min(deck_.largest, takes));
      std::string moved, asked;
      for (const HeldSet& h : deck_.held) {
        if (h.value != 0) moved += fmt::format("{}, {}, {}, {:.12g}\n", h.set, h.axis + 1, h.axis + 1, h.value * t);
      }
      for (const DeckContact& c : deck_.contacts) {
        const Vec3 u = indenter_displacement(c.law, t);
        for (int k = 0; k < 3; ++k) moved += fmt::format("RIGID_{}, {}, {}, {:.12g}\n", c.law.name, k + 1, k + 1, u[k]);
        asked += fmt::format("*NODE PRINT, NSET=RIGID_{}, TOTALS=ONLY\nRF\n*NODE PRINT, NSET={}, FREQUENCY=100000\nU\n",
                             c.law.name, c.set);
      }
      std::vector<std::string> printed;
      for (const HeldSet& h : deck_.held)
        if (std::find(printed.begin(), printed.end(), h.set) == printed.end())
          printed.push_back(h.set), asked += fmt::format("*NODE PRINT, NSET={}, TOTALS=ONLY\nRF\n", h.set);
      s_ += "*BOUNDARY\n" + moved + asked + "*NODE FILE, FREQUENCY=100000\nU\n*EL FILE, FREQUENCY=100000\nS\n*END STEP\n";
      before = t;
    }
  }
};

}  // namespace

std::string calculix_deck(const Deck& deck) { return Writer(deck).text(); }

}  // namespace langer
