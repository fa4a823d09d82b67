// The mesh of an Abaqus or CalculiX input file, of which inp_model.hpp holds the content: instances
// are placed, their nodes and cells get our numbers, sets and bodies their names.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/input_file.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/raise.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/select.hpp"
#include "meshing/exchange.hpp"
#include "meshing/inp.hpp"
#include "meshing/inp_model.hpp"

namespace langer {

namespace {

using Numbers = std::map<long long, int>;  // the file's number of a node or cell: ours

// A scope with nodes of its own: the model, or an instance.
struct Placed {
  const InpScope* scope = nullptr;
  const InpInstance* instance = nullptr;  // none: the model
  Numbers node_at, cell_at;

  std::string name() const {
    if (instance) return instance->name;
    return "";
  }
};

// The same cell seen in a mirror: our local node and facet for each of the cell that is turned.
struct Mirror {
  std::vector<int> node, facet;
};

// Hexahedra are mirrored along zeta. In a tetrahedron xi and eta change places.
Mirror mirror_of(const ReferenceCell& cell) {
  const auto image = [&](const Vec3& xi) {
    if (cell.hexahedron()) return Vec3(xi[0], xi[1], -xi[2]);
    return Vec3(xi[1], xi[0], xi[2]);
  };
  Mirror mirror;
  for (const Vec3& xi : cell.node) {
    const auto there = std::find_if(cell.node.begin(), cell.node.end(), [&](const Vec3& other) {
      return (other - image(xi)).norm() < 1e-12;
    });
    mirror.node.push_back(static_cast<int>(there - cell.node.begin()));
  }
  for (const std::vector<int>& facet : cell.facet) {
    std::vector<int> nodes;
    for (int a : facet) nodes.push_back(mirror.node[static_cast<std::size_t>(a)]);
    const auto there =
        std::find_if(cell.facet.begin(), cell.facet.end(), [&](const std::vector<int>& other) {
          return std::is_permutation(other.begin(), other.end(), nodes.begin(), nodes.end());
        });
    mirror.facet.push_back(static_cast<int>(there - cell.facet.begin()));
  }
  return mirror;
}

// Gmsh calls the elements of a volume "Volume7" unless a physical group names them.
bool named_by_gmsh(const std::string& name) {
  const std::string key = upper_case(name);
  return key.starts_with("VOLUME") && is_digits(key.substr(6));
}

class Builder {
 public:
  Builder(const InpModel& model, const std::string& file, std::vector<std::string>& notes)
      : model_(model), file_{file, 0, 0}, notes_(notes) {
    placed_.push_back({&model.scope, nullptr, {}, {}});
    for (const InpInstance& instance : model.instances) {
      placed_.push_back({&instance.scope, &instance, {}, {}});
    }
  }

  Mesh build() {
    bool any = false;
    for (const Placed& one : placed_) any = any || !one.scope->cells.empty();
    if (!any) {
      refuse_inp(file_, "no hexahedra or tetrahedra", "*ELEMENT, TYPE=, " + known_inp_cells());
    }
    add_cells();
    turn_reversed_cells();
    refuse_folded_cells();
    add_bodies();
    add_frames();
    add_surfaces();
    add_face_elements();
    add_node_sets();
    add_facets_of_node_sets();
    add_notes();
    return std::move(mesh_);
  }

 private:
  const InpModel& model_;
  Place file_;
  std::vector<std::string>& notes_;
  std::vector<Placed> placed_;
  Mesh mesh_;
  int n_given_nodes_ = 0;                            // before the new ones between them
  std::vector<std::pair<long long, Place>> origin_;  // of each cell: its number, its line
  std::vector<bool> reversed_;                       // cells that were turned
  Mirror mirror_;                                    // filled where a cell is
  std::map<std::pair<const InpScope*, std::string>, std::string> body_names_;  // of element sets

  // ---- nodes and cells

  // Cells get numbers in the order of the file's scopes and numbers. Cells with corners only, or
  // without middle nodes of faces, are raised to our cells by new nodes.
  void add_cells() {
    std::vector<Vec3> X;
    std::vector<int> connectivity;  // in our order
    const std::vector<int>& order = model_.kind.theirs->order;
    for (Placed& one : placed_) {
      add_nodes_of_cells(one, X);
      for (const auto& [id, cell] : one.scope->cells) {
        one.cell_at[id] = static_cast<int>(origin_.size());
        origin_.emplace_back(id, cell.place);
        const std::size_t begin = connectivity.size();
        connectivity.resize(begin + order.size());
        for (std::size_t a = 0; a < order.size(); ++a) {
          const long long n = cell.nodes[a];
          if (one.node_at.at(n) < 0) {
            refuse_inp(cell.place,
                       fmt::format("element {} has the node {}, which is not there", id, n));
          }
          connectivity[begin + static_cast<std::size_t>(order[a])] = one.node_at.at(n);
        }
      }
    }
    n_given_nodes_ = static_cast<int>(X.size());
    const ReferenceCell& cell = *model_.kind.cell;
    const int n_read = static_cast<int>(order.size());
    if (n_read == cell.n_corners) {
      mesh_ = raised(X, connectivity, cell.type);
    } else if (n_read < cell.n_nodes) {
      mesh_ = raised_with_edges(X, connectivity, cell.type);
    } else {
      mesh_.type = cell.type;
      mesh_.X = std::move(X);
      mesh_.connectivity = std::move(connectivity);
    }
  }

  // Nodes that no cell has are left out.
  static void add_nodes_of_cells(Placed& one, std::vector<Vec3>& X) {
    for (const auto& [id, cell] : one.scope->cells) {
      for (long long n : cell.nodes) one.node_at[n] = -1;
    }
    for (const auto& [id, x] : one.scope->nodes) {
      const auto node = one.node_at.find(id);
      if (node == one.node_at.end()) continue;
      node->second = static_cast<int>(X.size());
      if (one.instance) {
        X.push_back(one.instance->moved(x));
      } else {
        X.push_back(x);
      }
    }
  }

  // ---- orientation

  // A cell whose nodes are numbered the other way round has a negative Jacobian. Its nodes are
  // taken as those of the mirrored cell.
  void turn_reversed_cells() {
    const ReferenceCell& cell = mesh_.cell();
    const auto n_nodes = static_cast<std::size_t>(cell.n_nodes);
    Vec3 middle = Vec3::Zero();
    if (!cell.hexahedron()) middle = Vec3::Constant(0.25);
    reversed_.assign(origin_.size(), false);
    int n_reversed = 0;
    int first = -1;
    for (int e = 0; e < mesh_.n_cells(); ++e) {
      if (!(jacobian(mesh_, e, middle).determinant() < 0)) continue;
      if (n_reversed == 0) {
        mirror_ = mirror_of(cell);
        first = e;
      }
      ++n_reversed;
      reversed_[static_cast<std::size_t>(e)] = true;
      const auto begin = mesh_.connectivity.begin() + static_cast<std::ptrdiff_t>(n_nodes) * e;
      const std::vector<int> before(begin, begin + static_cast<std::ptrdiff_t>(n_nodes));
      for (std::size_t a = 0; a < n_nodes; ++a) {
        begin[static_cast<std::ptrdiff_t>(a)] = before[static_cast<std::size_t>(mirror_.node[a])];
      }
    }
    if (n_reversed == 0) return;
    const auto& [id, place] = origin_[static_cast<std::size_t>(first)];
    notes_.push_back(fmt::format(
        "the nodes of {} of {} elements are numbered the other way round (first: element {}, "
        "{}:{}): they are read as their mirror image",
        n_reversed, mesh_.n_cells(), id, place.file, place.line));
  }

  // A cell that is folded after turning has no sensible mirror image either.
  void refuse_folded_cells() {
    const Quality found = quality(mesh_);
    if (found.least_jacobian > 0) return;
    const auto& [id, place] = origin_.at(static_cast<std::size_t>(std::max(found.at_cell, 0)));
    refuse_inp(place,
               fmt::format("element {} is folded: its Jacobian is {:.3g} at ({:.4g}, {:.4g}, "
                           "{:.4g})",
                           id, found.least_jacobian, found.at[0], found.at[1], found.at[2]),
               "a positive Jacobian everywhere in the element",
               "look at the order of its nodes and at their places in the program that meshed it");
  }

  // ---- names

  // Names of one kind in all scopes. A name that several scopes have is qualified by the instance.
  class Names {
   public:
    void add(const std::string& name) { ++count_[upper_case(name)]; }
    std::string of(const Placed& one, const std::string& name) const {
      const auto found = count_.find(upper_case(name));
      const bool several = found != count_.end() && found->second > 1;
      if (!several || !one.instance) return name;
      return one.name() + "." + name;
    }

   private:
    std::map<std::string, int> count_;
  };

  // Members of a set that are in the mesh, ascending. `at` gives the numbers of one scope.
  std::vector<int> members(const Placed& one, const InpSet& set, Numbers Placed::*at) const {
    std::set<int> found;
    for (const InpMembers& range : set.members) {
      const Placed* of = &one;
      if (range.instance != own_scope) of = &placed_[static_cast<std::size_t>(range.instance) + 1];
      const Numbers& numbers = of->*at;
      auto next = numbers.lower_bound(range.first);
      for (; next != numbers.end() && next->first <= range.last; ++next) {
        if ((next->first - range.first) % range.step == 0) found.insert(next->second);
      }
    }
    return {found.begin(), found.end()};
  }

  // ---- bodies

  // Element sets that are bodies: of *SOLID SECTION, without any those of *ELEMENT. Those that Gmsh
  // names give way to its physical groups, which are further sets that share no element.
  std::vector<std::string> body_sets(const Placed& one) const {
    const InpScope& scope = *one.scope;
    if (!scope.sections.empty()) return scope.sections;
    const bool by_gmsh =
        !scope.cells_by_card.empty() &&
        std::all_of(scope.cells_by_card.begin(), scope.cells_by_card.end(), named_by_gmsh);
    if (!by_gmsh) return scope.cells_by_card;
    std::vector<std::string> groups;
    std::set<int> taken;
    for (const auto& [key, set] : scope.element_sets) {
      const std::vector<std::string>& by_card = scope.cells_by_card;
      if (std::find(by_card.begin(), by_card.end(), key) != by_card.end()) continue;
      const std::vector<int> cells = members(one, set, &Placed::cell_at);
      if (cells.empty()) continue;
      for (int cell : cells) {
        if (!taken.insert(cell).second) return scope.cells_by_card;
      }
      groups.push_back(key);
    }
    if (taken.size() != one.cell_at.size()) return scope.cells_by_card;
    return groups;
  }

  void add_bodies() {
    std::vector<std::vector<std::string>> keys;
    Names names;
    for (const Placed& one : placed_) {
      keys.push_back(body_sets(one));
      for (const std::string& key : keys.back()) {
        const auto set = one.scope->element_sets.find(key);
        if (set == one.scope->element_sets.end()) {
          refuse_inp(file_,
                     "*SOLID SECTION of the element set \"" + key + "\", which is not there");
        }
        names.add(set->second.name);
      }
    }
    mesh_.body.assign(origin_.size(), -1);
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      for (const std::string& key : keys[i]) {
        const InpSet& set = placed_[i].scope->element_sets.at(key);
        const std::string name = names.of(placed_[i], set.name);
        body_names_[{placed_[i].scope, key}] = name;
        add_body(name, members(placed_[i], set, &Placed::cell_at));
      }
    }
    name_cells_without_body();
  }

  void add_body(const std::string& name, const std::vector<int>& cells) {
    const int body = static_cast<int>(mesh_.bodies.size());
    mesh_.bodies.push_back(name);
    for (int cell : cells) {
      int& body_of_cell = mesh_.body[static_cast<std::size_t>(cell)];
      if (body_of_cell >= 0) {
        const auto& [id, place] = origin_[static_cast<std::size_t>(cell)];
        refuse_inp(place,
                   fmt::format("element {} belongs to \"{}\" and to \"{}\"", id,
                               mesh_.bodies[static_cast<std::size_t>(body_of_cell)], name),
                   "one body for each element");
      }
      body_of_cell = body;
    }
  }

  // ---- directions

  // Orientations of sections give their elements a frame. They are optional in a mesh: where one
  // cannot be used, no element gets a frame, and a note says why.
  void add_frames() {
    std::vector<Mat3> frames(origin_.size(), Mat3::Identity());
    std::size_t n_oriented = 0;
    for (const Placed& one : placed_) {
      for (const auto& [set, name] : one.scope->oriented) {
        const auto found = find_orientation(one, name);
        if (!found) {
          notes_.push_back(fmt::format("left out: there is no *ORIENTATION {}", name));
          return;
        }
        const std::vector<int> cells =
            members(one, one.scope->element_sets.at(set), &Placed::cell_at);
        for (int cell : cells) {
          const auto frame = frame_of(*found, middle_of(cell));
          if (!frame) {
            notes_.push_back(
                fmt::format("left out: *ORIENTATION {}, {}", found->name, fault_of(*found)));
            return;
          }
          frames[static_cast<std::size_t>(cell)] = *frame;
        }
        n_oriented += cells.size();
      }
    }
    if (n_oriented == 0) return;
    mesh_.frames = std::move(frames);
    notes_.push_back(fmt::format(
        "{} of {} elements have an *ORIENTATION, in which `frames: file` measures angles",
        n_oriented, mesh_.n_cells()));
  }

  // An orientation of the section's own scope has moved with its instance.
  std::optional<InpOrientation> find_orientation(const Placed& one, const std::string& name) const {
    const std::string key = upper_case(name);
    const auto own = one.scope->orientations.find(key);
    if (own != one.scope->orientations.end()) {
      InpOrientation moved = own->second;
      if (one.instance) {
        for (Vec3* x : {&moved.a, &moved.b, &moved.c}) *x = one.instance->moved(*x);
      }
      return moved;
    }
    const auto common = model_.scope.orientations.find(key);
    if (common != model_.scope.orientations.end()) return common->second;
    return std::nullopt;
  }

  Vec3 middle_of(int cell) const {
    const int n = mesh_.cell().n_nodes;
    Vec3 sum = Vec3::Zero();
    for (int a = 0; a < n; ++a) {
      const int node = mesh_.connectivity[static_cast<std::size_t>(n * cell + a)];
      sum += mesh_.X[static_cast<std::size_t>(node)];
    }
    return sum / n;
  }

  static std::string fault_of(const InpOrientation& orientation) {
    if (!orientation.fault.empty()) return orientation.fault;
    return "whose points give no directions";
  }

  // Axes 1, 2, 3 of the orientation at a place. Angles run from axis 1 to axis 2, ours from e_x to
  // e_z: e_x = 1, e_z = 2, and e_y = -3 is normal to both.
  static std::optional<Mat3> frame_of(const InpOrientation& orientation, const Vec3& place) {
    if (!orientation.fault.empty()) return std::nullopt;
    Vec3 first, third;
    if (orientation.cylindrical) {
      third = orientation.b - orientation.a;
      if (!(third.norm() > 0)) return std::nullopt;
      const Vec3 axis = third.normalized();
      const Vec3 arm = place - orientation.a;
      first = arm - arm.dot(axis) * axis;
    } else {
      first = orientation.a - orientation.c;
      const Vec3 second = orientation.b - orientation.c;
      third = first.cross(second);
      if (!(third.norm() > 1e-12 * first.norm() * second.norm())) return std::nullopt;
    }
    // A difference that is rounding gives no direction.
    const double size = orientation.a.norm() + orientation.c.norm();
    if (!(first.norm() > 1e-12 * size)) return std::nullopt;
    Mat3 axes;
    axes.col(0) = first.normalized();
    axes.col(2) = third.normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    if (orientation.about > 0) {
      const Vec3 axis = axes.col(orientation.about - 1);
      axes = Eigen::AngleAxisd(orientation.angle, axis).toRotationMatrix() * axes;
    }
    Mat3 frame;
    frame.col(0) = axes.col(0);
    frame.col(1) = -axes.col(2);
    frame.col(2) = axes.col(1);
    return frame;
  }

  // ---- elements without a body

  // Cells without a body form one body without a name; those of several instances form one body for
  // each instance, named after it.
  void name_cells_without_body() {
    std::vector<const Placed*> without;
    for (const Placed& one : placed_) {
      const bool any = std::any_of(one.cell_at.begin(), one.cell_at.end(), [&](const auto& cell) {
        return mesh_.body[static_cast<std::size_t>(cell.second)] < 0;
      });
      if (any) without.push_back(&one);
    }
    for (const Placed* one : without) {
      const int body = static_cast<int>(mesh_.bodies.size());
      std::string name;
      if (without.size() > 1) name = one->name();
      mesh_.bodies.push_back(name);
      for (const auto& [id, cell] : one->cell_at) {
        int& body_of_cell = mesh_.body[static_cast<std::size_t>(cell)];
        if (body_of_cell < 0) body_of_cell = body;
      }
    }
  }

  // ---- facets

  // *SURFACE: facets given by cells and sides.
  void add_surfaces() {
    Names names;
    for (const Placed& one : placed_) {
      for (const auto& [key, surface] : one.scope->surfaces) names.add(surface.name);
    }
    for (const Placed& one : placed_) {
      for (const auto& [key, surface] : one.scope->surfaces) {
        std::vector<Facet> facets;
        for (const InpSide& side : surface.sides) {
          for (int cell : cells_of_side(one, side)) facets.push_back(facet_of(side, cell));
        }
        if (!facets.empty()) name_facets(mesh_, names.of(one, surface.name), facets);
      }
    }
  }

  // of "7", "instance.7", "set" or "instance.set"
  std::vector<int> cells_of_side(const Placed& one, const InpSide& side) const {
    const auto found = one.scope->element_sets.find(upper_case(side.what));
    if (found != one.scope->element_sets.end()) {
      return members(one, found->second, &Placed::cell_at);
    }
    if (is_digits(side.what)) return {cell_of_number(one, side.what, side)};
    if (!one.instance) {
      for (const Placed& other : placed_) {
        const std::string prefix = upper_case(other.name() + ".");
        if (!other.instance || !upper_case(side.what).starts_with(prefix)) continue;
        InpSide rest = side;
        rest.what = side.what.substr(prefix.size());
        return cells_of_side(other, rest);
      }
    }
    refuse_inp(side.place, "there is no element set \"" + side.what + "\"");
  }

  static int cell_of_number(const Placed& one, const std::string& number, const InpSide& side) {
    const auto cell = one.cell_at.find(whole_number(number, side.place));
    if (cell == one.cell_at.end()) refuse_inp(side.place, "there is no element " + number);
    return cell->second;
  }

  // S1, S2, ... count the facets of the element as the file numbers its nodes.
  Facet facet_of(const InpSide& side, int cell) const {
    const std::vector<int>& facets = model_.kind.cell->names.abaqus.sides;
    for (std::size_t s = 0; s < facets.size(); ++s) {
      if (side.side != fmt::format("S{}", s + 1)) continue;
      int local = facets[s];
      if (reversed_[static_cast<std::size_t>(cell)]) {
        local = mirror_.facet[static_cast<std::size_t>(local)];
      }
      return {cell, local};
    }
    refuse_inp(side.place, "found the side \"" + side.side + "\"",
               fmt::format("S1 to S{}", facets.size()));
  }

  // Element sets of plane elements are the facets that these lie on.
  void add_face_elements() {
    bool any = false;
    Names names;
    for (const Placed& one : placed_) {
      any = any || !one.scope->faces.empty();
      for (const auto& [key, set] : one.scope->element_sets) names.add(set.name);
    }
    if (!any) return;
    std::map<std::array<int, 4>, Facet> facet_at;     // by corners
    for (int e = mesh_.n_cells() - 1; e >= 0; --e) {  // of two cells that share it the first
      for (int f = 0; f < mesh_.cell().n_facets(); ++f) {
        facet_at[facet_key(mesh_, {e, f})] = {e, f};
      }
    }
    for (Placed& one : placed_) {
      std::vector<Facet> facets;
      Numbers face_at;
      for (const auto& [id, face] : one.scope->faces) {
        const auto found = facet_at.find(key_of_face(one, face));
        face_at[id] = -1;
        if (found == facet_at.end()) continue;
        face_at[id] = static_cast<int>(facets.size());
        facets.push_back(found->second);
      }
      for (const auto& [key, set] : one.scope->element_sets) {
        add_facet_set(names.of(one, set.name), set, face_at, facets);
      }
    }
  }

  static std::array<int, 4> key_of_face(const Placed& one, const InpElement& face) {
    std::array<int, 4> key{-1, -1, -1, -1};
    for (std::size_t k = 0; k < face.nodes.size(); ++k) {
      const auto node = one.node_at.find(face.nodes[k]);
      if (node != one.node_at.end()) key[k] = node->second;
    }
    std::sort(key.begin(), key.end());
    return key;
  }

  void add_facet_set(const std::string& name, const InpSet& set, const Numbers& face_at,
                     const std::vector<Facet>& facets) {
    std::vector<Facet> found;
    int lost = 0;
    for (const InpMembers& range : set.members) {
      if (range.instance != own_scope) continue;
      auto next = face_at.lower_bound(range.first);
      for (; next != face_at.end() && next->first <= range.last; ++next) {
        if ((next->first - range.first) % range.step != 0) continue;
        if (next->second < 0) {
          ++lost;
        } else {
          found.push_back(facets[static_cast<std::size_t>(next->second)]);
        }
      }
    }
    if (lost > 0) {
      notes_.push_back(fmt::format(
          "left out: element set {}, as {} of its plane elements are on no facet of a cell", name,
          lost));
      return;
    }
    if (found.empty() || mesh_.facet_sets.count(name)) return;
    std::sort(found.begin(), found.end(), [](const Facet& a, const Facet& b) {
      return std::pair(a.cell, a.local) < std::pair(b.cell, b.local);
    });
    const auto same = [](const Facet& a, const Facet& b) {
      return a.cell == b.cell && a.local == b.local;
    };
    found.erase(std::unique(found.begin(), found.end(), same), found.end());
    name_facets(mesh_, name, found);
  }

  // ---- nodes

  void add_node_sets() {
    Names names;
    for (const Placed& one : placed_) {
      for (const auto& [key, set] : one.scope->node_sets) names.add(set.name);
    }
    for (const Placed& one : placed_) {
      for (const auto& [key, set] : one.scope->node_sets) {
        const std::vector<int> nodes = members(one, set, &Placed::node_at);
        if (!nodes.empty()) mesh_.node_sets[names.of(one, set.name)] = nodes;
      }
    }
    if (n_given_nodes_ < mesh_.n_nodes()) add_new_middles(mesh_, n_given_nodes_);
  }

  // Facets of the surface whose nodes all lie in a node set are a facet set of its name.
  void add_facets_of_node_sets() {
    std::vector<Facet> outer;
    for (const auto& [name, nodes] : mesh_.node_sets) {
      if (mesh_.facet_sets.count(name)) continue;
      if (static_cast<int>(nodes.size()) < mesh_.cell().facet_corners) continue;
      if (outer.empty()) outer = boundary(mesh_);
      const std::vector<Facet> facets = facets_within(mesh_, outer, nodes);
      if (!facets.empty()) mesh_.facet_sets[name] = facets;
    }
  }

  // ---- what is not used

  // Materials of bodies as text for a solve config; the names of all others are left out.
  void add_materials(std::set<std::string>& left_out) {
    std::set<std::string> used;
    for (const Placed& one : placed_) {
      for (const auto& [set, material] : one.scope->material_of) {
        const auto found = model_.materials.find(upper_case(material));
        if (found == model_.materials.end()) continue;
        used.insert(found->first);
        const MaterialKeys text = material_keys(found->second);
        const auto body_name = body_names_.find({one.scope, set});
        if (body_name == body_names_.end()) continue;
        const std::string body = usable_name(body_name->second);
        if (text.keys.empty()) {
          notes_.push_back(
              fmt::format("left out: the material {} of {}: {}", material, body, text.remark));
          continue;
        }
        std::string keys = fmt::format("material: {{{}}}", text.keys);
        if (mesh_.bodies.size() > 1) keys = fmt::format("materials: {{{}: {{{}}}}}", body, keys);
        std::string note = fmt::format(
            "the material {} of {} for a solve config, with the numbers of the file: {}", material,
            body, keys);
        if (!text.remark.empty()) note += fmt::format("; {}", text.remark);
        notes_.push_back(note);
      }
    }
    for (const auto& [key, material] : model_.materials) {
      if (used.count(key)) continue;
      left_out.insert("*MATERIAL");
      if (!material.hyperelastic.word.empty()) left_out.insert("*HYPERELASTIC");
    }
  }

  void add_notes() {
    std::vector<std::string> others;
    for (const Placed& one : placed_) {
      // Without physical groups Gmsh's own names stay; with them they say nothing more.
      for (const auto& [key, set] : one.scope->element_sets) {
        const bool used = body_names_.count({one.scope, key}) > 0 || set.internal ||
                          mesh_.facet_sets.count(set.name) > 0 || named_by_gmsh(set.name);
        if (!used) others.push_back(set.name);
      }
    }
    if (!others.empty()) {
      notes_.push_back(
          fmt::format("left out, as they are no bodies: element sets {}", fmt::join(others, ", ")));
    }
    std::set<std::string> left_out = model_.left_out;
    add_materials(left_out);
    for (const Placed& one : placed_) {
      const InpScope& scope = *one.scope;
      if (scope.oriented.empty() && !scope.orientations.empty()) left_out.insert("*ORIENTATION");
    }
    if (!left_out.empty()) {
      notes_.push_back(fmt::format("left out, as they are no mesh: {}", fmt::join(left_out, ", ")));
    }
  }
};

Mesh mesh_of(InpScanner& scanner, const std::string& shown_name, std::vector<std::string>& notes) {
  const InpModel model = read_inp_model(scanner);
  return Builder(model, shown_name, notes).build();
}

std::string text_of(const std::string& path) {
  return read_file(path, "a mesh of Abaqus or CalculiX");
}

}  // namespace

Mesh parse_inp(const std::string& text, const std::string& shown_name,
               std::vector<std::string>& notes, const InpOpener& opener) {
  InpScanner scanner(text, shown_name, opener);
  return mesh_of(scanner, shown_name, notes);
}

Mesh parse_inp(const std::string& text, const std::string& shown_name,
               std::vector<std::string>& notes) {
  return parse_inp(text, shown_name, notes, {});
}

Mesh read_inp(const std::string& path, std::vector<std::string>& notes) {
  InpScanner scanner(text_of(path), path, inp_opener(path));
  return mesh_of(scanner, path, notes);
}

std::vector<std::string> included_inp_files(const std::string& path) {
  InpScanner scanner(text_of(path), path, inp_opener(path));
  while (scanner.next()) {
  }
  return scanner.included();
}

}  // namespace langer
