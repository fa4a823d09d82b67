// Decks of CalculiX; materials: calculix_material. Elements are C3D20R, for hex8 with a node in the
// middle of each edge: CalculiX's own eight-node elements lock near incompressibility (C3D8) or
// have errors of a quarter and more (C3D8R, C3D8I). hex27 lose the nodes in the middle of facets
// and elements. The sphere is a layer of hexahedra all of whose nodes are moved along the path.
#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "export/calculix_material.hpp"
#include "export/export_scene.hpp"
#include "export/fibre_frame.hpp"
#include "mechanics/mesh/raise.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

constexpr int side_of_facet[6] = {6, 4, 3, 5, 1, 2};  // S1 ... S6 by our local facet
// Penalty of contact, relative to the smallest shear modulus per mm.
constexpr double usual_stiffness = 1000;
// Longest increment of a scene with contact and fibres.
constexpr double increment_with_fibres = 0.05;

// The name, if CalculiX can read it.
std::string checked_name(const std::string& name) {
  if (name.size() > 60 || name.find_first_of("\", \n\r*=") != std::string::npos)
    throw Failure(Exit::config, Error{{"CalculiX"},
                                      "",
                                      "the name \"" + name + "\" is not allowed in its deck",
                                      "at most 60 letters without , \" * = and spaces",
                                      ""});
  return name;
}

// The numbers, sixteen to a line.
std::string list(const std::vector<int>& numbers) {
  std::string s;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool ends_line = i % 16 == 15 || i + 1 == numbers.size();
    const char end = ends_line ? '\n' : ' ';
    s += fmt::format("{},{}", numbers[i], end);
  }
  return s;
}

// A hex8 mesh with nodes in the middle of edges (and of facets and elements, which C3D20R do not
// use). A set that has both ends of an edge also has its middle.
Mesh with_middles(const Mesh& mesh) {
  if (mesh.cell().second_order()) return mesh;
  constexpr int ends[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                               {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  Mesh out = raised(mesh, CellType::hex27);
  for (const auto& [name, nodes] : mesh.node_sets) {
    std::vector<char> in(out.X.size(), 0);
    for (int n : nodes) in[n] = 1;
    for (int e = 0; e < out.n_cells(); ++e)
      for (int k = 0; k < 12; ++k) {
        const auto cell = out.cell(e);
        if (in[cell[ends[k][0]]] && in[cell[ends[k][1]]]) in[cell[8 + k]] = 2;
      }
    for (int n = 0; n < out.n_nodes(); ++n)
      if (in[n]) out.node_sets[name].push_back(n);
  }
  return out;
}

// Scenes for which CalculiX is known not to converge.
std::vector<std::string> calculix_warnings(const Deck& deck) {
  std::vector<std::string> list;
  if (const auto stiff = too_stiff_for_contact(deck))
    list.push_back(
        fmt::format("2/d is {:.3g} times the shear modulus: CalculiX's contact was found to stall "
                    "beyond 1000 times; solve "
                    "with d: {:.2g} and export that",
                    stiff->ratio, stiff->d));
  return list;
}

// Writes the deck from top to bottom: notes, body, contacts, steps.
class CalculixWriter {
 public:
  explicit CalculixWriter(const Deck& deck) : deck_(deck), mesh_(with_middles(deck.mesh)) {}

  // The whole deck: comment lines, body, contacts, steps.
  std::string text(const std::vector<std::string>& warnings) {
    for (const std::string& line : deck_.words) s_ += "** " + line + "\n";
    s_ += fmt::format("** {} are C3D20R here, with nodes in the middles of edges only\n",
                      names(deck_.mesh.type)[static_cast<std::size_t>(deck_.mesh.type)]);
    for (const std::string& line : warnings) s_ += "** warning: " + line + "\n";
    if (!deck_.contacts.empty())
      s_ += fmt::format(
          "** spheres are rigid facets with penalty contact: stiffness {:g} times the shear "
          "modulus per mm "
          "(PRESSURE-OVERCLOSURE); a higher\n"
          "** one reduces the penetration. Langer has the exact sphere and no penetration.\n"
          "** RF of the set RIGID_... moves the sphere: it is minus the force on the indenter\n",
          usual_stiffness);
    if (!deck_.pairs.empty())
      s_ += fmt::format(
          "** surfaces touch with penalty contact: stiffness {:g} times the shear modulus per mm; "
          "Langer has no penetration\n",
          usual_stiffness);
    if (fibres_touched())
      s_ += fmt::format(
          "** increments of {:g} at most: ELASTIC_FIBER ends the run if an iteration stretches a "
          "fibre too far, instead of "
          "reducing the increment\n",
          increment_with_fibres);
    body();
    for (const DeckContact& c : deck_.contacts) contact(c);
    for (const DeckPair& p : deck_.pairs) pair(p);
    steps();
    return s_;
  }

 private:
  const Deck& deck_;
  const Mesh mesh_;
  std::string s_;
  int next_node_ = 0, next_cell_ = 0, next_contact_ = 1;

  void node(int number, const Vec3& X) {
    s_ += fmt::format("{}, {:.12g}, {:.12g}, {:.12g}\n", number, X[0], X[1], X[2]);
  }

  static constexpr int per_cell = 20;

  // Nodes, elements with their materials, node sets and supports.
  void body() {
    std::vector<char> used(mesh_.X.size(), 0);
    for (int e = 0; e < mesh_.n_cells(); ++e)
      for (int a = 0; a < per_cell; ++a) used[mesh_.cell(e)[a]] = 1;
    s_ += "*NODE, NSET=BODY\n";
    for (int n = 0; n < mesh_.n_nodes(); ++n)
      if (used[n]) node(n + 1, mesh_.X[n]);
    // Nodes and elements of the spheres are numbered after those of the body.
    next_node_ = mesh_.n_nodes() + 1;
    next_cell_ = mesh_.n_cells() + 1;
    laws();
    for (const auto& [name, nodes] : mesh_.node_sets) {
      std::vector<int> numbers;
      for (int n : nodes)
        if (used[n]) numbers.push_back(n + 1);
      s_ += fmt::format("*NSET, NSET={}\n{}", checked_name(name), list(numbers));
    }
    // Supports hold in all steps, so they are in front of the first one.
    std::string held;
    for (const HeldSet& h : deck_.held)
      if (h.to.value == 0)
        held += fmt::format("{}, {}, {}\n", checked_name(h.set), h.axis + 1, h.axis + 1);
    if (!held.empty()) s_ += "*BOUNDARY\n" + held;
  }

  // Elements in groups of the same material and fibre directions, with their materials and
  // sections. A material has the directions in its own frame, so the angle between families must
  // not vary.
  void laws() {
    std::vector<std::string> law_of_body(deck_.materials.size());
    std::vector<std::vector<Vec3>> components(deck_.materials.size());
    std::string sections;
    for (std::size_t g = 0; g < deck_.groups.size(); ++g) {
      const FibreGroup& group = deck_.groups[g];
      const Material& m = deck_.materials[group.body];
      const std::string set = fmt::format("CELLS{}", g + 1);
      const std::string name = fmt::format("LAW{}", group.body + 1);
      s_ += fmt::format("*ELEMENT, TYPE=C3D20R, ELSET={}\n", set);
      for (int e : group.cells) {
        s_ += std::to_string(e + 1);
        for (int a = 0; a < per_cell; ++a) {
          const char before = a == 14 ? '\n' : ' ';  // 15 nodes fit on a line
          s_ += fmt::format(",{}{}", before, mesh_.cell(e)[a] + 1);
        }
        s_ += "\n";
      }
      std::vector<Vec3> in_frame;
      std::string section =
          fmt::format("*SOLID SECTION, ELSET={}, MATERIAL={}", set, calculix_name(m, name));
      if (!group.fibres.empty()) {
        const FibreFrame frame = fibre_frame(group.fibres);
        in_frame = frame.in_frame;
        sections += fmt::format(
            "*ORIENTATION, NAME=FIBRES{}, SYSTEM=RECTANGULAR\n{:.12g}, {:.12g}, {:.12g}, {:.12g}, "
            "{:.12g}, {:.12g}\n",
            g + 1, frame.e1[0], frame.e1[1], frame.e1[2], frame.e2[0], frame.e2[1], frame.e2[2]);
        section += fmt::format(", ORIENTATION=FIBRES{}", g + 1);
      }
      sections += section + "\n";
      if (law_of_body[group.body].empty()) {
        law_of_body[group.body] = require_text("CalculiX", calculix_material(m, in_frame, name));
        components[group.body] = in_frame;
      }
      for (std::size_t k = 0; k < in_frame.size(); ++k)
        if ((in_frame[k] - components[group.body][k]).norm() > 1e-6)
          require_text("CalculiX", {"", "fibre families whose angle to each other varies",
                                    "the same angle everywhere"});
    }
    for (const std::string& law : law_of_body) s_ += law;
    s_ += sections;
  }

  // The surface of the body, the rigid layer of the sphere with its material, and their contact.
  void contact(const DeckContact& c) {
    const std::string name = checked_name(c.law.name);
    const int number = next_contact_++;
    surface(fmt::format("SLAVE{}", number), c.facets);
    // The layer of hexahedra between the inner and the outer points of the cap.
    const int n = static_cast<int>(c.cap.outer.size());
    const int first = next_node_;
    const int first_cell = next_cell_;
    s_ += fmt::format("** {}: rigid facets of {:.3g} mm\n*NODE, NSET=RIGID_{}\n", name, c.cap.side,
                      name);
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
    s_ += fmt::format("*SURFACE, NAME=MASTER{}, TYPE=ELEMENT\n", number);
    for (int e = first_cell; e < next_cell_; ++e) s_ += fmt::format("{}, S2\n", e);
    // The material of the layer is not stressed, because all its nodes are moved.
    s_ += fmt::format(
        "*MATERIAL, NAME=RIGID_{0}\n*ELASTIC\n{1:.6g}, 0.\n*SOLID SECTION, ELSET=RIGID_{0}, "
        "MATERIAL=RIGID_{0}\n",
        name, softest());
    interaction(number, c.law.mu);
  }

  // Two surfaces of the body: its slave is where Langer's contact law holds.
  void pair(const DeckPair& p) {
    const int number = next_contact_++;
    s_ += "** " + checked_name(p.name) + "\n";
    surface(fmt::format("SLAVE{}", number), p.own);
    surface(fmt::format("MASTER{}", number), p.other);
    interaction(number, p.mu);
  }

  void surface(const std::string& name, const std::vector<Facet>& facets) {
    s_ += fmt::format("*SURFACE, NAME={}, TYPE=ELEMENT\n", name);
    for (const Facet& f : facets)
      s_ += fmt::format("{}, S{}\n", f.cell + 1, side_of_facet[f.local]);
  }

  // The shear modulus to which penalties are relative.
  double softest() const {
    double mu = 1e300;
    for (const Material& m : deck_.materials) mu = std::min(mu, shear_modulus(m));
    return mu;
  }

  // Penalty contact of the surfaces SLAVE and MASTER of this number.
  void interaction(int number, double friction) {
    const double mu = softest();
    s_ += fmt::format(
        "*SURFACE INTERACTION, NAME=CONTACT{}\n*SURFACE BEHAVIOR, "
        "PRESSURE-OVERCLOSURE=LINEAR\n{:.6g}\n",
        number, usual_stiffness * mu);
    if (friction > 0)
      s_ += fmt::format("*FRICTION\n{:.12g}, {:.6g}\n", friction, 0.1 * usual_stiffness * mu);
    s_ += fmt::format(
        "*CONTACT PAIR, INTERACTION=CONTACT{0}, TYPE=SURFACE TO SURFACE\nSLAVE{0}, MASTER{0}\n",
        number);
  }

  bool fibres_touched() const {
    const auto is_isotropic = [](const FibreGroup& group) {
      return group.fibres.empty();
    };
    return deck_.touches() && !std::ranges::all_of(deck_.groups, is_isotropic);
  }

  // One step from stop to stop of the path, with the forces that are compared with Langer's.
  void steps() {
    double most = 1;
    if (fibres_touched()) most = increment_with_fibres;
    double before = 0;
    for (double t : deck_.stops) {
      const double takes = t - before;
      s_ += fmt::format("*STEP, NLGEOM, INC=100000\n*STATIC\n{:.6g}, {:.6g}, {:.6g}, {:.6g}\n",
                        std::min({deck_.first, takes, most}), takes,
                        std::min(deck_.smallest, takes), std::min({deck_.largest, takes, most}));
      // Positions at the end of the step, and the results that are printed.
      std::string moved, asked;
      for (const HeldSet& h : deck_.held) {
        if (h.to.value != 0)
          moved += fmt::format("{}, {}, {}, {:.12g}\n", h.set, h.axis + 1, h.axis + 1, h.to.at(t));
      }
      for (const DeckContact& c : deck_.contacts) {
        const Vec3 u = indenter_displacement(c.law, t);
        for (int k = 0; k < 3; ++k)
          moved += fmt::format("RIGID_{}, {}, {}, {:.12g}\n", c.law.name, k + 1, k + 1, u[k]);
        asked += fmt::format(
            "*NODE PRINT, NSET=RIGID_{}, TOTALS=ONLY\nRF\n*NODE PRINT, NSET={}, "
            "FREQUENCY=100000\nU\n",
            c.law.name, c.set);
      }
      std::vector<std::string> printed;
      for (const HeldSet& h : deck_.held)
        if (std::find(printed.begin(), printed.end(), h.set) == printed.end()) {
          printed.push_back(h.set);
          asked += fmt::format("*NODE PRINT, NSET={}, TOTALS=ONLY\nRF\n", h.set);
        }
      s_ += "*BOUNDARY\n" + moved + asked +
            "*NODE FILE, FREQUENCY=100000\nU\n*EL FILE, FREQUENCY=100000\nS\n*END STEP\n";
      before = t;
    }
  }
};

}  // namespace

DeckText calculix_deck(const Deck& deck) {
  const std::vector<std::string> warnings = calculix_warnings(deck);
  return {CalculixWriter(deck).text(warnings), warnings};
}

}  // namespace langer
