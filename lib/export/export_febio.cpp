// FEBio 4 (.feb, format 4.0): uncoupled materials with the volume term of ours (pressure model "Abaqus": k (J-1)^2/2, k = 2/d);
// fibres as "fiber-exp-pow-uncoupled" of a solid mixture, which is HGO's energy. hex8 are three-field cells there, as mean
// dilatation is here; hex27 are plain displacement cells. The sphere is a rigid body of hexahedra in frictional
// "sliding-elastic" contact.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "base/error.hpp"
#include "mesh/facets.hpp"
#include "export/cards.hpp"
#include "export/export_scene.hpp"

namespace langer {

namespace {

[[noreturn]] void refuse(const std::string& found, const std::string& expected) {
  throw Failure(Exit::config, Error{{"FEBio"}, "material", found, expected, ""});
}

std::string escaped(const std::string& text) {
  std::string s;
  for (char c : text) s += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return s;
}

std::string triple(const Vec3& x) { return fmt::format("{:.16g},{:.16g},{:.16g}", x[0], x[1], x[2]); }

// middles of hex27's facets and cell: ours by its order (-y +x +y -x -z +z, middle)
constexpr int febio_hex27[7] = {22, 21, 23, 20, 24, 25, 26};

// type and parameters of the matrix, without the volume term
struct Law {
  std::string type, body;
};
Law matrix_law(const Material& m) {
  const Material isotropic{m.matrix, {}, m.volume};
  for (const Card& card : cards(isotropic)) {
    if (card.program != "FEBio" || !card.exists) continue;
    // <material id="1" name="langer" type="Ogden"> ... <k>...</k></material>
    const std::size_t type = card.text.find("type=\"", card.text.find("<material")) + 6, open = card.text.find(">\n", type) + 2;
    return {card.text.substr(type, card.text.find('"', type) - type), card.text.substr(open, card.text.find("  <k>") - open)};
  }
  refuse("a matrix that FEBio does not have", "Yeoh, neo-Hooke, Mooney-Rivlin, Ogden, Arruda-Boyce or Gent");
}

std::string material_text(const Material& m, const FibreGroup& group, int id, const std::string& name) {
  const Law matrix = matrix_law(m);
  const std::string volume = fmt::format("<k>{:.16g}</k><pressure_model>2</pressure_model>", m.volume.quadratic.bulk_modulus());
  if (group.fibres.empty())
    return fmt::format("    <material id=\"{}\" name=\"{}\" type=\"{}\">\n{}  {}\n    </material>\n", id, name, matrix.type,
                       matrix.body, volume);
  const FibreFrame frame = fibre_frame(group.fibres);
  std::string s = fmt::format(
      "    <material id=\"{}\" name=\"{}\" type=\"uncoupled solid mixture\">\n      {}\n      <mat_axis "
      "type=\"vector\"><a>{}</a><d>{}</d></mat_axis>\n"
      "      <solid type=\"{}\">\n{}      </solid>\n",
      id, name, volume, triple(frame.e1), triple(frame.e2), matrix.type, matrix.body);
  for (std::size_t k = 0; k < m.fibres.size(); ++k) {
    const Fibre& f = m.fibres[k];
    if (f.kappa != 0) refuse("dispersed fibres", "kappa: 0");
    if (f.tension_switch != FibreSwitch::I4_bar) refuse("fibres with another switch", "switch: I4_bar, which is FEBio's own");
    if (f.hgo.c1 < 0) refuse(fmt::format("c1 = {:g}", f.hgo.c1), "c1 of 0 or more: FEBio refuses fibres (ksi) below 0");
    s += fmt::format(
        "      <solid type=\"fiber-exp-pow-uncoupled\"><alpha>{:.16g}</alpha><beta>2</beta><ksi>{:.16g}</ksi>"
        "<fiber type=\"vector\">{}</fiber></solid>\n",
        f.hgo.c2, f.hgo.c1, triple(frame.in_frame[k]));
  }
  return s + "    </material>\n";
}

class Writer {
 public:
  explicit Writer(const Deck& deck) : deck_(deck), mesh_(deck.mesh) {}

  std::string text() {
    materials();
    body();
    for (std::size_t c = 0; c < deck_.contacts.size(); ++c) contact(deck_.contacts[c], static_cast<int>(c));
    loads();
    std::string s = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    for (const std::string& line : deck_.words) s += "<!-- " + comment(line) + " -->\n";
    if (!deck_.contacts.empty())
      s += "<!-- spheres are rigid facets with penalty contact and augmentation; Langer has the exact sphere -->\n";
    s += "<febio_spec version=\"4.0\">\n  <Module type=\"solid\"/>\n" + control() + "  <Material>\n" + material_ +
         "  </Material>\n  <Mesh>\n" + nodes_ + cells_ + sets_ + "  </Mesh>\n  <MeshDomains>\n" + domains_ +
         "  </MeshDomains>\n";
    if (!boundary_.empty()) s += "  <Boundary>\n" + boundary_ + "  </Boundary>\n";
    if (!rigid_.empty()) s += "  <Rigid>\n" + rigid_ + "  </Rigid>\n";
    if (!contact_.empty()) s += "  <Contact>\n" + contact_ + "  </Contact>\n";
    if (!curves_.empty()) s += "  <LoadData>\n" + curves_ + "  </LoadData>\n";
    return s + output() + "</febio_spec>\n";
  }

 private:
  const Deck& deck_;
  const Mesh& mesh_;
  std::string material_, nodes_, cells_, sets_, domains_, boundary_, rigid_, contact_, curves_, logged_;
  int next_node_ = 0, next_cell_ = 0, next_material_ = 1, next_curve_ = 1;
  std::map<std::string, int> rigid_bodies_;

  static std::string comment(std::string line) {
    for (std::size_t at; (at = line.find("--")) != std::string::npos;) line.replace(at, 2, "-");
    return line;
  }

  std::string control() const {
    return fmt::format(
        "  <Control>\n    <analysis>STATIC</analysis>\n    <time_steps>{}</time_steps>\n    <step_size>{:.6g}</step_size>\n"
        "    <time_stepper "
        "type=\"default\"><max_retries>10</max_retries><opt_iter>15</opt_iter><dtmin>{:.6g}</dtmin><dtmax>{:.6g}</dtmax></"
        "time_stepper>\n"
        "    <solver type=\"solid\"><symmetric_stiffness>{}</symmetric_stiffness><max_refs>30</max_refs></solver>\n  "
        "</Control>\n",
        static_cast<int>(std::ceil(1 / deck_.first - 1e-9)), deck_.first, deck_.smallest, deck_.largest,
        std::any_of(deck_.contacts.begin(), deck_.contacts.end(), [](const DeckContact& c) { return c.law.mu > 0; })
            ? "non-symmetric"
            : "symmetric");
  }

  void materials() {
    for (std::size_t g = 0; g < deck_.groups.size(); ++g)
      material_ +=
          material_text(deck_.materials[deck_.groups[g].body], deck_.groups[g], next_material_++, fmt::format("law{}", g + 1));
  }

  void body() {
    nodes_ += "    <Nodes name=\"body\">\n";
    for (int n = 0; n < mesh_.n_nodes(); ++n)
      nodes_ += fmt::format("      <node id=\"{}\">{}</node>\n", n + 1, triple(mesh_.X[n]));
    nodes_ += "    </Nodes>\n";
    next_node_ = mesh_.n_nodes() + 1, next_cell_ = mesh_.n_cells() + 1;
    const bool quadratic = mesh_.type == CellType::hex27;
    for (std::size_t g = 0; g < deck_.groups.size(); ++g) {
      const std::string name = fmt::format("cells{}", g + 1);
      cells_ += fmt::format("    <Elements type=\"{}\" name=\"{}\">\n", quadratic ? "hex27" : "hex8", name);
      for (int e : deck_.groups[g].cells) {
        cells_ += fmt::format("      <elem id=\"{}\">", e + 1);
        const auto cell = mesh_.cell(e);
        for (std::size_t a = 0; a < cell.size(); ++a)
          cells_ +=
              fmt::format("{}{}", a == 0 ? "" : ",", cell[a < 20 ? a : static_cast<std::size_t>(febio_hex27[a - 20])] + 1);
        cells_ += "</elem>\n";
      }
      cells_ += "    </Elements>\n";
      domains_ += fmt::format("    <SolidDomain name=\"{}\" mat=\"law{}\"/>\n", name, g + 1);
    }
    for (const auto& [name, nodes] : mesh_.node_sets) {
      sets_ += fmt::format("    <NodeSet name=\"{}\">", escaped(name));
      for (std::size_t i = 0; i < nodes.size(); ++i) sets_ += fmt::format("{}{}", i == 0 ? "" : ",", nodes[i] + 1);
      sets_ += "</NodeSet>\n";
    }
  }

  int curve(const std::string& points) {
    curves_ += fmt::format(
        "    <load_controller id=\"{}\" type=\"loadcurve\">\n      "
        "<interpolate>LINEAR</interpolate><extend>CONSTANT</extend>\n      <points>{}</points>\n"
        "    </load_controller>\n",
        next_curve_, points);
    return next_curve_++;
  }

  void loads() {
    std::map<std::string, std::array<int, 3>> fixed;
    int moved = 0;
    for (const HeldSet& h : deck_.held) {
      if (h.value == 0) {
        fixed[h.set][h.axis] = 1;
        continue;
      }
      const int path = curve("<pt>0,0</pt><pt>1,1</pt>");
      boundary_ += fmt::format(
          "    <bc name=\"moved{}\" type=\"prescribed displacement\" node_set=\"{}\"><dof>{}</dof><value "
          "lc=\"{}\">{:.16g}</value><relative>0</relative></bc>\n",
          ++moved, escaped(h.set), "xyz"[h.axis], path, h.value);
    }
    for (const auto& [set, axes] : fixed)
      boundary_ += fmt::format(
          "    <bc name=\"held_{0}\" type=\"zero displacement\" "
          "node_set=\"{0}\"><x_dof>{1}</x_dof><y_dof>{2}</y_dof><z_dof>{3}</z_dof></bc>\n",
          escaped(set), axes[0], axes[1], axes[2]);
  }

  void contact(const DeckContact& c, int number) {
    const std::string name = escaped(c.law.name);
    const int n = static_cast<int>(c.cap.outer.size()), first = next_node_, id = next_material_++;
    const auto& sphere = std::get<Sphere>(c.law.shape);
    material_ += fmt::format(
        "    <material id=\"{}\" name=\"{}\" type=\"rigid "
        "body\"><density>1</density><center_of_mass>{}</center_of_mass></material>\n",
        id, name, triple(vec(sphere.centre)));
    nodes_ += fmt::format("    <Nodes name=\"{}\">\n", name);
    for (int i = 0; i < n; ++i) nodes_ += fmt::format("      <node id=\"{}\">{}</node>\n", first + i, triple(c.cap.inner[i]));
    for (int i = 0; i < n; ++i)
      nodes_ += fmt::format("      <node id=\"{}\">{}</node>\n", first + n + i, triple(c.cap.outer[i]));
    nodes_ += "    </Nodes>\n";
    cells_ += fmt::format("    <Elements type=\"hex8\" name=\"{}\">\n", name);
    std::string facets;
    for (std::size_t q = 0; q < c.cap.facets.size(); ++q) {
      cells_ += fmt::format("      <elem id=\"{}\">", next_cell_++);
      for (int layer : {0, n})
        for (int k = 0; k < 4; ++k)
          cells_ += fmt::format("{}{}", layer == 0 && k == 0 ? "" : ",", first + layer + c.cap.facets[q][k]);
      cells_ += "</elem>\n";
      facets += fmt::format("      <quad4 id=\"{}\">", q + 1);
      for (int k = 0; k < 4; ++k) facets += fmt::format("{}{}", k == 0 ? "" : ",", first + n + c.cap.facets[q][k]);
      facets += "</quad4>\n";
    }
    cells_ += "    </Elements>\n";
    next_node_ += 2 * n;
    domains_ += fmt::format("    <SolidDomain name=\"{0}\" mat=\"{0}\"/>\n", name);
    const char* quad = mesh_.type == CellType::hex27 ? "quad9" : "quad4";
    sets_ += fmt::format("    <Surface name=\"body_of_{}\">\n", name);
    for (std::size_t f = 0; f < c.facets.size(); ++f) {
      sets_ += fmt::format("      <{} id=\"{}\">", quad, f + 1);
      const std::vector<int> nodes = facet_nodes(mesh_, c.facets[f]);
      for (std::size_t k = 0; k < nodes.size(); ++k) sets_ += fmt::format("{}{}", k == 0 ? "" : ",", nodes[k] + 1);
      sets_ += fmt::format("</{}>\n", quad);
    }
    sets_ += fmt::format(
        "    </Surface>\n    <Surface name=\"face_of_{0}\">\n{1}    </Surface>\n    <SurfacePair "
        "name=\"pair_of_{0}\"><primary>body_of_{0}</primary>"
        "<secondary>face_of_{0}</secondary></SurfacePair>\n",
        name, facets);
    contact_ += fmt::format(
        "    <contact name=\"contact_of_{0}\" type=\"sliding-elastic\" surface_pair=\"pair_of_{0}\">\n      "
        "<laugon>AUGLAG</laugon><tolerance>0.02</tolerance>"
        "<penalty>10</penalty><auto_penalty>1</auto_penalty><two_pass>0</two_pass><symmetric_stiffness>{1}</"
        "symmetric_stiffness>"
        "<search_radius>1</search_radius><fric_coeff>{2:.16g}</fric_coeff>\n    </contact>\n",
        name, c.law.mu > 0 ? 0 : 1, c.law.mu);
    rigid_ += fmt::format(
        "    <rigid_bc name=\"turn_of_{0}\" "
        "type=\"rigid_fixed\"><rb>{0}</rb><Rx_dof>0</Rx_dof><Ry_dof>0</Ry_dof><Rz_dof>0</Rz_dof>"
        "<Ru_dof>1</Ru_dof><Rv_dof>1</Rv_dof><Rw_dof>1</Rw_dof></rigid_bc>\n",
        name);
    for (int k = 0; k < 3; ++k) {
      std::string points = "<pt>0,0</pt>";
      for (const Waypoint& w : c.law.motion) points += fmt::format("<pt>{:.16g},{:.16g}</pt>", w.t, w.u_ind[k]);
      rigid_ += fmt::format(
          "    <rigid_bc name=\"path_{1}_of_{0}\" type=\"rigid_displacement\"><rb>{0}</rb><dof>{1}</dof><value "
          "lc=\"{2}\">1</value>"
          "<relative>0</relative></rigid_bc>\n",
          name, "xyz"[k], curve(points));
    }
    logged_ += fmt::format("      <rigid_body_data data=\"Fx;Fy;Fz\" delim=\",\" file=\"{}_force.csv\">{}</rigid_body_data>\n",
                           name, id);
    (void)number;
  }

  std::string output() const {
    return "  <Output>\n    <plotfile type=\"febio\"><var type=\"displacement\"/><var type=\"stress\"/><var type=\"contact "
           "gap\"/></plotfile>\n    <logfile>\n" +
           logged_ + "    </logfile>\n  </Output>\n";
  }
};

}  // namespace

std::string febio_deck(const Deck& deck) { return Writer(deck).text(); }

}  // namespace langer
