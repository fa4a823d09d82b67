// Decks of FEBio 4 (.feb, format 4.0); materials: febio_material. hex8 are three-field elements in
// FEBio, like the mean dilatation of Langer; hex27 are plain displacement elements. The sphere is a
// rigid body of hexahedra in "sliding-elastic" contact by penalty. Tolerances, penalty and tangent
// are those with which FEBio 4.11 reproduced Langer's forces. With its defaults (dtol 1e-3, etol
// 1e-2) a nearly incompressible material ends in errors, or far off with a normal termination.
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/xml.hpp"
#include "export/export_scene.hpp"
#include "export/febio_material.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

// The name of a file: letters that are not allowed everywhere become _.
std::string file_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  return name;
}

// Scenes for which FEBio is known to be inaccurate or not to converge.
std::vector<std::string> febio_warnings(const Deck& deck) {
  std::vector<std::string> list;
  if (deck.mesh.cell().second_order())
    list.push_back(
        "hex27 are plain displacement elements in FEBio: its forces were 16 to 18 % too high near "
        "incompressibility; solve "
        "with hex8, which are three-field elements in both programs, and export that");
  if (const auto stiff = too_stiff_for_contact(deck))
    list.push_back(
        fmt::format("2/d is {:.3g} times the shear modulus: FEBio's contact was found to converge "
                    "up to 1000 times; solve "
                    "with d: {:.2g} and export that",
                    stiff->ratio, stiff->d));
  return list;
}

// The parts of the deck refer to each other by name, so each is collected in a text of its own.
// They are put together at the end in the order of the format.
class FebioWriter {
 public:
  explicit FebioWriter(const Deck& deck) : deck_(deck), mesh_(deck.mesh) {}

  // The whole deck. FEBio's format fixes the order of its parts.
  std::string text(const std::vector<std::string>& warnings) {
    materials();
    body();
    for (const DeckContact& c : deck_.contacts) contact(c);
    for (const DeckPair& p : deck_.pairs) pair(p);
    loads();
    std::string s = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    for (const std::string& line : deck_.words) s += "<!-- " + comment(line) + " -->\n";
    if (!deck_.contacts.empty())
      s += "<!-- spheres are rigid facets with penalty contact and a small penetration; Langer has "
           "the exact sphere -->\n"
           "<!-- *_force.csv: Fx;Fy;Fz of the rigid body, which is minus the force on the indenter "
           "-->\n";
    if (!deck_.pairs.empty())
      s +=
          "<!-- surfaces touch with penalty contact and a small penetration; Langer has none -->\n";
    if (!reactions_.empty())
      s += "<!-- *_reaction.csv: Rx;Ry;Rz of each node of a moved set; their sum is the force on "
           "the set -->\n";
    for (const std::string& line : warnings) s += "<!-- warning: " + comment(line) + " -->\n";
    const std::string head = control();
    s += "<febio_spec version=\"4.0\">\n  <Module type=\"solid\"/>\n" + head + "  <Material>\n" +
         material_ + "  </Material>\n  <Mesh>\n" + nodes_ + cells_ + sets_ +
         "  </Mesh>\n  <MeshDomains>\n" + domains_ + "  </MeshDomains>\n";
    if (!boundary_.empty()) s += "  <Boundary>\n" + boundary_ + "  </Boundary>\n";
    if (!rigid_.empty()) s += "  <Rigid>\n" + rigid_ + "  </Rigid>\n";
    if (!contact_.empty()) s += "  <Contact>\n" + contact_ + "  </Contact>\n";
    if (!curves_.empty()) s += "  <LoadData>\n" + curves_ + "  </LoadData>\n";
    return s + output() + "</febio_spec>\n";
  }

 private:
  const Deck& deck_;
  const Mesh& mesh_;
  std::string material_, nodes_, cells_, sets_, domains_, boundary_, rigid_, contact_, curves_,
      logged_, reactions_;
  int next_node_ = 0, next_cell_ = 0, next_material_ = 1, next_curve_ = 1;
  std::map<std::string, int> rigid_bodies_;

  // A line that may be an XML comment, which must not contain "--".
  static std::string comment(std::string line) {
    std::size_t at = line.find("--");
    while (at != std::string::npos) {
      line.replace(at, 2, "-");
      at = line.find("--");
    }
    return line;
  }

  // Numbers of nodes with commas between them.
  static std::string list(const std::vector<int>& numbers) {
    return fmt::format("{}", fmt::join(numbers, ","));
  }

  // Increments are not longer than `largest` and end where the path turns: FEBio meets the points
  // of the load curve of dtmax exactly.
  std::string control() {
    const char* const stiffness = deck_.touches() ? "non-symmetric" : "symmetric";
    const int steps = static_cast<int>(std::ceil(1 / deck_.first - 1e-9));
    std::string stops = fmt::format("<pt>0,{}</pt>", deck_.largest);
    for (double t : deck_.stops) stops += fmt::format("<pt>{},{}</pt>", t, deck_.largest);
    return fmt::format(
        "  <Control>\n    <analysis>STATIC</analysis>\n    <time_steps>{}</time_steps>\n    "
        "<step_size>{}</step_size>\n"
        "    <time_stepper "
        "type=\"default\"><max_retries>10</max_retries><opt_iter>15</opt_iter><dtmin>{}</"
        "dtmin><dtmax lc=\"{}\">1</dtmax></"
        "time_stepper>\n"
        "    <solver "
        "type=\"solid\"><symmetric_stiffness>{}</symmetric_stiffness><max_refs>30</"
        "max_refs><dtol>1e-6</dtol>"
        "<etol>1e-9</etol></solver>\n  </Control>\n",
        steps, 1.0 / steps, deck_.smallest, curve(stops, "STEP"), stiffness);
  }

  // One material for each group of elements, because a material has the directions of its fibres.
  void materials() {
    for (const FibreGroup& group : deck_.groups) {
      const int id = next_material_++;
      material_ += require_text("FEBio", febio_material(deck_.materials[group.body], group.fibres,
                                                        id, fmt::format("law{}", id)));
    }
  }

  // Nodes, elements in their groups, and node sets.
  void body() {
    nodes_ += "    <Nodes name=\"body\">\n";
    for (int n = 0; n < mesh_.n_nodes(); ++n)
      nodes_ += fmt::format("      <node id=\"{}\">{}</node>\n", n + 1, triple(mesh_.X[n]));
    nodes_ += "    </Nodes>\n";
    next_node_ = mesh_.n_nodes() + 1;
    next_cell_ = mesh_.n_cells() + 1;
    const CellNames& type = mesh_.cell().names;
    for (std::size_t g = 0; g < deck_.groups.size(); ++g) {
      const std::string name = fmt::format("cells{}", g + 1);
      cells_ += fmt::format("    <Elements type=\"{}\" name=\"{}\">\n", type.febio, name);
      for (int e : deck_.groups[g].cells) {
        cells_ += fmt::format("      <elem id=\"{}\">", e + 1);
        const auto cell = mesh_.cell(e);
        std::vector<int> nodes;
        for (std::size_t a = 0; a < cell.size(); ++a)
          nodes.push_back(cell[static_cast<std::size_t>(type.febio_order[a])] + 1);
        cells_ += list(nodes) + "</elem>\n";
      }
      cells_ += "    </Elements>\n";
      domains_ += fmt::format("    <SolidDomain name=\"{}\" mat=\"law{}\"/>\n", name, g + 1);
    }
    for (const auto& [name, nodes] : mesh_.node_sets) {
      std::vector<int> numbers;
      for (int node : nodes) numbers.push_back(node + 1);
      sets_ +=
          fmt::format("    <NodeSet name=\"{}\">{}</NodeSet>\n", xml_text(name), list(numbers));
    }
  }

  // Adds a load curve; returns its number.
  int curve(const std::string& points, const char* between = "LINEAR") {
    curves_ += fmt::format(
        "    <load_controller id=\"{}\" type=\"loadcurve\">\n      "
        "<interpolate>{}</interpolate><extend>CONSTANT</extend>\n      <points>{}</points>\n"
        "    </load_controller>\n",
        next_curve_, between, points);
    return next_curve_++;
  }

  // Supports and imposed displacements. The reactions of moved sets are written to files.
  void loads() {
    std::map<std::string, std::array<int, 3>> fixed;
    std::set<std::string> asked;
    // Components with the value 0 are collected: FEBio has one condition for all axes of a set.
    int moved = 0;
    for (const HeldSet& h : deck_.held) {
      if (h.to.value == 0) {
        fixed[h.set][h.axis] = 1;
        continue;
      }
      if (asked.insert(h.set).second)
        reactions_ += fmt::format(
            "      <node_data data=\"Rx;Ry;Rz\" delim=\",\" file=\"{}_reaction.csv\" "
            "node_set=\"{}\"/>\n",
            file_name(h.set), xml_text(h.set));
      std::string points = "<pt>0,0</pt>";
      if (h.to.factor) {
        for (const auto& point : *h.to.factor)
          points += fmt::format("<pt>{:.16g},{:.16g}</pt>", point.t, point.to);
      } else {
        points += "<pt>1,1</pt>";
      }
      const int path = curve(points);
      boundary_ += fmt::format(
          "    <bc name=\"moved{}\" type=\"prescribed displacement\" "
          "node_set=\"{}\"><dof>{}</dof><value "
          "lc=\"{}\">{:.16g}</value><relative>0</relative></bc>\n",
          ++moved, xml_text(h.set), "xyz"[h.axis], path, h.to.value);
    }
    for (const auto& [set, axes] : fixed)
      boundary_ += fmt::format(
          "    <bc name=\"held_{0}\" type=\"zero displacement\" "
          "node_set=\"{0}\"><x_dof>{1}</x_dof><y_dof>{2}</y_dof><z_dof>{3}</z_dof></bc>\n",
          xml_text(set), axes[0], axes[1], axes[2]);
  }

  // The rigid body of a sphere, its contact and its path.
  void contact(const DeckContact& c) {
    const std::string name = xml_text(c.law.name);
    const int id = next_material_++;
    material_ += fmt::format(
        "    <material id=\"{}\" name=\"{}\" type=\"rigid "
        "body\"><density>1</density><center_of_mass>{}</center_of_mass></material>\n",
        id, name, triple(ball_of(c.law.shape)->centre));
    const std::string face = rigid_cells(c, name);
    surface_pair(name, facets(c.facets), face);
    sliding(name, c.law.mu);
    motion(c, name);
    logged_ += fmt::format(
        "      <rigid_body_data data=\"Fx;Fy;Fz\" delim=\",\" "
        "file=\"{}_force.csv\">{}</rigid_body_data>\n",
        file_name(c.law.name), id);
  }

  // Two surfaces of the body.
  void pair(const DeckPair& p) {
    const std::string name = xml_text(p.name);
    surface_pair(name, facets(p.own), facets(p.other));
    sliding(name, p.mu);
  }

  // Penalty contact of a pair of surfaces.
  void sliding(const std::string& name, double friction) {
    contact_ += fmt::format(
        "    <contact name=\"contact_of_{0}\" type=\"sliding-elastic\" "
        "surface_pair=\"pair_of_{0}\">\n      "
        "<laugon>PENALTY</laugon><penalty>100</penalty><auto_penalty>1</auto_penalty><two_pass>0</"
        "two_pass>"
        "<symmetric_stiffness>0</symmetric_stiffness><search_radius>1</"
        "search_radius><fric_coeff>{1}</fric_coeff>\n    "
        "</contact>\n",
        name, friction);
  }

  // Elements between the two layers of the cap of an indenter; returns the facets of the outer
  // layer.
  std::string rigid_cells(const DeckContact& c, const std::string& name) {
    // Inner points first, then outer points.
    const int n = static_cast<int>(c.cap.outer.size());
    const int first = next_node_;
    nodes_ += fmt::format("    <Nodes name=\"{}\">\n", name);
    for (int i = 0; i < n; ++i)
      nodes_ += fmt::format("      <node id=\"{}\">{}</node>\n", first + i, triple(c.cap.inner[i]));
    for (int i = 0; i < n; ++i)
      nodes_ +=
          fmt::format("      <node id=\"{}\">{}</node>\n", first + n + i, triple(c.cap.outer[i]));
    nodes_ += "    </Nodes>\n";
    cells_ += fmt::format("    <Elements type=\"hex8\" name=\"{}\">\n", name);
    std::string facets;
    for (std::size_t q = 0; q < c.cap.facets.size(); ++q) {
      std::vector<int> inner, outer;
      for (int corner : c.cap.facets[q]) {
        inner.push_back(first + corner);
        outer.push_back(first + n + corner);
      }
      cells_ +=
          fmt::format("      <elem id=\"{}\">{},{}</elem>\n", next_cell_, list(inner), list(outer));
      ++next_cell_;
      facets += fmt::format("      <quad4 id=\"{}\">{}</quad4>\n", q + 1, list(outer));
    }
    cells_ += "    </Elements>\n";
    next_node_ += 2 * n;
    domains_ += fmt::format("    <SolidDomain name=\"{0}\" mat=\"{0}\"/>\n", name);
    return facets;
  }

  // Facets of the body, as lines of a surface.
  std::string facets(const std::vector<Facet>& of) const {
    const char* quad = mesh_.cell().names.febio_facet;
    std::string lines;
    for (std::size_t f = 0; f < of.size(); ++f) {
      std::vector<int> numbers;
      for (int node : facet_nodes(mesh_, of[f])) numbers.push_back(node + 1);
      lines += fmt::format("      <{0} id=\"{1}\">{2}</{0}>\n", quad, f + 1, list(numbers));
    }
    return lines;
  }

  // The two surfaces in contact: facets of the body, and what they touch.
  void surface_pair(const std::string& name, const std::string& body, const std::string& face) {
    sets_ += fmt::format(
        "    <Surface name=\"body_of_{0}\">\n{1}    </Surface>\n    <Surface name=\"face_of_{0}\">\n{2}"
        "    </Surface>\n    <SurfacePair name=\"pair_of_{0}\"><primary>body_of_{0}</primary>"
        "<secondary>face_of_{0}</secondary></SurfacePair>\n",
        name, body, face);
  }

  // The indenter does not turn. It moves from waypoint to waypoint.
  void motion(const DeckContact& c, const std::string& name) {
    rigid_ += fmt::format(
        "    <rigid_bc name=\"turn_of_{0}\" "
        "type=\"rigid_fixed\"><rb>{0}</rb><Rx_dof>0</Rx_dof><Ry_dof>0</Ry_dof><Rz_dof>0</Rz_dof>"
        "<Ru_dof>1</Ru_dof><Rv_dof>1</Rv_dof><Rw_dof>1</Rw_dof></rigid_bc>\n",
        name);
    for (int k = 0; k < 3; ++k) {
      std::string points = "<pt>0,0</pt>";
      for (const Waypoint& w : c.law.motion)
        points += fmt::format("<pt>{:.16g},{:.16g}</pt>", w.t, w.to[k]);
      rigid_ += fmt::format(
          "    <rigid_bc name=\"path_{1}_of_{0}\" "
          "type=\"rigid_displacement\"><rb>{0}</rb><dof>{1}</dof><value "
          "lc=\"{2}\">1</value>"
          "<relative>0</relative></rigid_bc>\n",
          name, "xyz"[k], curve(points));
    }
  }

  // The plot file for the viewer, and the files of forces.
  std::string output() const {
    return "  <Output>\n    <plotfile type=\"febio\"><var type=\"displacement\"/><var "
           "type=\"stress\"/><var type=\"contact "
           "gap\"/></plotfile>\n    <logfile>\n" +
           logged_ + reactions_ + "    </logfile>\n  </Output>\n";
  }
};

}  // namespace

DeckText febio_deck(const Deck& deck) {
  const std::vector<std::string> warnings = febio_warnings(deck);
  return {FebioWriter(deck).text(warnings), warnings};
}

}  // namespace langer
