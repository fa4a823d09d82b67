#include "meshing/inp_model.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <optional>

namespace langer {

namespace {

// An instance copies its part. A small file could otherwise ask for any amount of memory.
constexpr std::size_t most_entries = 40'000'000;

std::size_t members_of(const InpSets& sets) {
  std::size_t n = sets.size();
  for (const auto& [key, set] : sets) n += set.members.size();
  return n;
}

void add_once(std::vector<std::string>& list, const std::string& entry) {
  if (std::find(list.begin(), list.end(), entry) == list.end()) list.push_back(entry);
}

// Plane elements, shells and membranes by their number of nodes: "CPS8R" has 8. Gmsh writes the
// facets of its physical surfaces as plane elements.
std::optional<int> nodes_of_face(const std::string& type) {
  for (const std::string family : {"CPS", "CPE", "CAX", "SFM3D", "M3D", "DS", "S"}) {
    if (!type.starts_with(family) || type.size() <= family.size()) continue;
    const char digit = type[family.size()];
    const std::string rest = type.substr(family.size() + 1);
    const bool known = digit == '3' || digit == '4' || digit == '6' || digit == '8';
    if (known && rest.find_first_not_of("RHIMTS5") == std::string::npos) return digit - '0';
  }
  return std::nullopt;
}

// Reads cards (*NODE, *ELEMENT, ...) and their data lines into scopes: the model, a part or an
// instance. A part has its own numbers and names; an instance copies them and may add more.
class ModelReader {
 public:
  explicit ModelReader(InpScanner& scanner) : scanner_(scanner) {}

  InpModel read() {
    while (auto line = scanner_.next()) {
      if (line->card) {
        end_element();
        begin(*line->card);
      } else {
        read_data(*line);
      }
    }
    end_element();
    place_parts();
    return std::move(model_);
  }

 private:
  enum class Block { model, part, instance };

  InpScanner& scanner_;
  InpModel model_;
  std::map<std::string, InpScope> parts_;          // by name in upper case
  std::map<std::string, std::string> part_names_;  // as the file writes them
  std::set<std::string> used_parts_;
  std::map<std::string, int> instance_at_;  // by name in upper case
  std::size_t entries_ = 0;                 // of all instances
  Block block_ = Block::model;
  std::string part_;      // key of the one that is open
  std::string material_;  // likewise
  InpCard card_;
  std::string type_;  // of the cells, as the file calls it first
  struct OpenElement {
    int n_nodes = 0;                 // that its card expects
    bool is_face = false;            // its card has no cells but faces
    std::vector<long long> numbers;  // its own and those of its nodes, as far as they are read
    Place place;
  };
  OpenElement element_;

  InpScope& scope() {
    if (block_ == Block::part) return parts_.at(part_);
    if (block_ == Block::instance) return model_.instances.back().scope;
    return model_.scope;
  }

  // ---- cards

  // Cards that generate nodes or elements by a rule are refused: leaving them out would silently
  // give another mesh. Cards without a mesh (steps, materials) are noted and left out.
  void begin(const InpCard& card) {
    card_ = card;
    const std::string& word = card.word;
    static const std::set<std::string> made_by_rule{"NGEN",   "NFILL",  "NCOPY", "ELGEN",
                                                    "ELCOPY", "SYSTEM", "NMAP"};
    if (made_by_rule.count(word)) {
      refuse_inp(card.place, "found *" + word, "all nodes and elements written out in this file");
    }
    if (word == "PART") {
      begin_part();
    } else if (word == "INSTANCE") {
      begin_instance();
    } else if (word == "END PART" || word == "END INSTANCE") {
      block_ = Block::model;
    } else if (word == "ELEMENT") {
      begin_elements();
    } else if (word == "NSET") {
      begin_set(scope().node_sets);
    } else if (word == "ELSET") {
      begin_set(scope().element_sets);
    } else if (word == "SURFACE") {
      begin_surface();
    } else if (word == "SOLID SECTION") {
      begin_section();
    } else if (word == "ORIENTATION") {
      begin_orientation();
    } else if (word == "MATERIAL") {
      begin_material();
    } else if (word == "HYPERELASTIC") {
      begin_hyperelastic();
    } else if (word != "NODE") {
      static const std::set<std::string> without_content{"HEADING", "ASSEMBLY", "END ASSEMBLY",
                                                         "PREPRINT"};
      if (!without_content.count(word)) model_.left_out.insert("*" + word);
    }
  }

  void begin_section() {
    const std::string set = upper_case(card_.value("ELSET"));
    add_once(scope().sections, set);
    const std::string orientation = card_.value("ORIENTATION");
    if (!orientation.empty()) scope().oriented[set] = orientation;
    const std::string material = card_.value("MATERIAL");
    if (!material.empty()) scope().material_of[set] = material;
  }

  // A mesh has no material: the text of a note is made of it (inp_material.hpp).
  void begin_material() {
    material_ = upper_case(card_.value("NAME"));
    model_.materials[material_] = {};
  }

  void begin_hyperelastic() {
    const auto found = model_.materials.find(material_);
    if (found == model_.materials.end()) {
      model_.left_out.insert("*HYPERELASTIC");
      card_.word = "";
      return;
    }
    found->second = {};
    found->second.hyperelastic = card_;
  }

  // What is not understood here is no error: only `frames: file` needs it.
  void begin_orientation() {
    InpOrientation orientation;
    orientation.name = card_.value("NAME");
    const std::string system = upper_case(card_.value("SYSTEM"));
    const std::string definition = upper_case(card_.value("DEFINITION"));
    orientation.cylindrical = system == "CYLINDRICAL";
    if (!system.empty() && system != "RECTANGULAR" && system != "CYLINDRICAL") {
      orientation.fault = "SYSTEM=" + system;
    } else if (!definition.empty() && definition != "COORDINATES") {
      orientation.fault = "DEFINITION=" + definition;
    }
    scope().orientations[upper_case(orientation.name)] = orientation;
  }

  void begin_part() {
    const std::string name = card_.value("NAME");
    part_ = upper_case(name);
    if (!parts_.try_emplace(part_).second) {
      refuse_inp(card_.place, "found a second *PART of the name \"" + name + "\"",
                 "parts of different names");
    }
    part_names_[part_] = name;
    block_ = Block::part;
  }

  // An instance begins as a copy of its part.
  void begin_instance() {
    const std::string name = card_.value("NAME");
    const std::string part = upper_case(card_.value("PART"));
    if (name.empty()) refuse_inp(card_.place, "*INSTANCE without a name", "NAME=name");
    if (find_instance(name) != own_scope) {
      refuse_inp(card_.place, "found a second *INSTANCE of the name \"" + name + "\"",
                 "instances of different names");
    }
    const auto found = parts_.find(part);
    if (found == parts_.end()) {
      refuse_inp(card_.place, "there is no *PART \"" + card_.value("PART") + "\" above",
                 "PART=name of a part that is read before its instances");
    }
    entries_ += 1 + found->second.size();
    if (entries_ > most_entries) {
      refuse_inp(card_.place, "all instances together have too many nodes and elements",
                 fmt::format("at most {} nodes, elements and members of sets", most_entries));
    }
    used_parts_.insert(part);
    InpInstance instance;
    instance.name = name;
    instance.place = card_.place;
    instance.scope = found->second;
    instance_at_[upper_case(name)] = static_cast<int>(model_.instances.size());
    model_.instances.push_back(std::move(instance));
    block_ = Block::instance;
  }

  // Cells of one kind only; plane elements mark facets; all others are left out with a note.
  void begin_elements() {
    const std::string type = upper_case(card_.value("TYPE"));
    if (const auto kind = inp_cell(type)) {
      if (model_.kind.theirs && kind->theirs != model_.kind.theirs) {
        refuse_inp(card_.place, fmt::format("found elements {} together with {}", type, type_),
                   "cells of one kind");
      }
      model_.kind = *kind;
      if (type_.empty()) type_ = type;
      element_.n_nodes = static_cast<int>(kind->theirs->order.size());
      element_.is_face = false;
    } else if (type.starts_with("C3D")) {
      refuse_inp(card_.place, "found elements " + type, known_inp_cells());
    } else if (const auto nodes = nodes_of_face(type)) {
      // Gmsh's plane elements only mark facets. A shell has a stiffness, which is lost.
      if (!type.starts_with("CP")) model_.left_out.insert("elements " + type);
      element_.n_nodes = *nodes;
      element_.is_face = true;
    } else {
      model_.left_out.insert("elements " + type);
      card_.word = "";
      return;
    }
    if (const std::string name = card_.value("ELSET"); !name.empty()) {
      const std::string key = add_set(scope().element_sets, name);
      if (!element_.is_face) add_once(scope().cells_by_card, key);
    }
  }

  void begin_set(InpSets& sets) {
    const std::string name = card_.value(card_.word);
    if (name.empty()) {
      refuse_inp(card_.place, "*" + card_.word + " without a name", card_.word + "=name");
    }
    InpSet& set = sets[add_set(sets, name)];
    if (card_.has("INTERNAL")) set.internal = true;
  }

  void begin_surface() {
    const std::string name = card_.value("NAME");
    const std::string type = upper_case(card_.value("TYPE"));
    if (name.empty()) refuse_inp(card_.place, "*SURFACE without a name", "NAME=name");
    if ((!type.empty() && type != "ELEMENT" && type != "NODE") || card_.has("COMBINE")) {
      model_.left_out.insert(fmt::format("surface {}", name));
      card_.word = "";
      return;
    }
    if (type == "NODE") {
      add_set(scope().node_sets, name);
    } else {
      scope().surfaces[upper_case(name)].name = name;
    }
  }

  static std::string add_set(InpSets& sets, const std::string& name) {
    const std::string key = upper_case(name);
    sets.try_emplace(key, InpSet{name, false, {}});
    return key;
  }

  // ---- data lines

  void read_data(const InpLine& line) {
    const std::string& word = card_.word;
    if (word == "NODE") {
      read_node(line);
    } else if (word == "ELEMENT") {
      read_element(line);
    } else if (word == "NSET") {
      read_members(line, line.cells, &InpScope::node_sets, card_.value("NSET"));
    } else if (word == "ELSET") {
      read_members(line, line.cells, &InpScope::element_sets, card_.value("ELSET"));
    } else if (word == "SURFACE") {
      read_surface(line);
    } else if (word == "ORIENTATION") {
      read_orientation(line);
    } else if (word == "HYPERELASTIC") {
      read_hyperelastic(model_.materials.at(material_), line);
    } else if (word == "INSTANCE") {
      read_motion(line);
    }
  }

  // Missing coordinates are 0, as in Abaqus.
  void read_node(const InpLine& line) {
    if (line.cells.size() < 2) {
      refuse_inp(line.place, "found \"" + line.text + "\"", "number, x, y, z");
    }
    const long long id = whole_number(line.cells[0], line.place);
    Vec3 x = Vec3::Zero();
    for (std::size_t k = 0; k < 3 && k + 1 < line.cells.size(); ++k) {
      x[static_cast<Eigen::Index>(k)] = real_number(line.cells[k + 1], line.place);
    }
    if (!scope().nodes.try_emplace(id, x).second) {
      refuse_inp(line.place, fmt::format("node {} is there twice", id));
    }
    if (const std::string name = card_.value("NSET"); !name.empty()) {
      InpSets& sets = scope().node_sets;
      sets[add_set(sets, name)].members.push_back({own_scope, id, id, 1});
    }
  }

  // The nodes of an element may take several lines.
  void read_element(const InpLine& line) {
    if (element_.numbers.empty()) element_.place = line.place;
    for (const std::string& cell : line.cells) {
      if (!cell.empty()) element_.numbers.push_back(whole_number(cell, line.place));
    }
    if (static_cast<int>(element_.numbers.size()) > element_.n_nodes) end_element();
  }

  // Stores the element whose nodes have been read; called at its last node and at the next card.
  void end_element() {
    if (element_.numbers.empty()) return;
    const int found = static_cast<int>(element_.numbers.size()) - 1;
    if (found != element_.n_nodes) {
      refuse_inp(
          element_.place, fmt::format("an element of {} nodes", found),
          fmt::format("{} nodes, on one line or on lines ending with a comma", element_.n_nodes));
    }
    const long long id = element_.numbers[0];
    InpElement element{{element_.numbers.begin() + 1, element_.numbers.end()}, element_.place};
    // of a face only its corners count: 4 of 4 or 8 nodes, 3 of 3 or 6
    if (element_.is_face) element.nodes.resize(element_.n_nodes % 4 == 0 ? 4 : 3);
    if (scope().cells.count(id) || scope().faces.count(id)) {
      refuse_inp(element_.place, fmt::format("element {} is there twice", id));
    }
    if (element_.is_face) {
      scope().faces.emplace(id, std::move(element));
    } else {
      scope().cells.emplace(id, std::move(element));
    }
    if (const std::string name = card_.value("ELSET"); !name.empty()) {
      InpSets& sets = scope().element_sets;
      sets[add_set(sets, name)].members.push_back({own_scope, id, id, 1});
    }
    element_.numbers.clear();
  }

  int find_instance(const std::string& name) const {
    const auto found = instance_at_.find(upper_case(name));
    if (found == instance_at_.end()) return own_scope;
    return found->second;
  }

  // INSTANCE=name of a set of the assembly
  int instance_of_card(const Place& place) const {
    const std::string name = card_.value("INSTANCE");
    if (name.empty() || block_ != Block::model) return own_scope;
    const int instance = find_instance(name);
    if (instance == own_scope) {
      refuse_inp(place, "there is no *INSTANCE \"" + name + "\" above",
                 "an instance that is read before its sets");
    }
    return instance;
  }

  // Numbers, names of other sets of the same kind, or a range.
  void read_members(const InpLine& line, const std::vector<std::string>& cells,
                    InpSets InpScope::*kind, const std::string& name) {
    InpScope& own = scope();
    InpSet& set = (own.*kind)[upper_case(name)];
    const int instance = instance_of_card(line.place);
    if (card_.has("GENERATE")) {
      set.members.push_back(read_range(line, instance));
      return;
    }
    bool from_sets = false;
    for (const std::string& cell : cells) {
      if (cell.empty()) continue;
      if (is_digits(cell)) {
        const long long id = whole_number(cell, line.place);
        set.members.push_back({instance, id, id, 1});
      } else {
        const std::vector<InpMembers> others = members_by_name(cell, kind, instance, line.place);
        set.members.insert(set.members.end(), others.begin(), others.end());
        from_sets = true;
      }
    }
    if (from_sets) {
      // Sets of sets of sets would otherwise grow without bound.
      std::sort(set.members.begin(), set.members.end());
      set.members.erase(std::unique(set.members.begin(), set.members.end()), set.members.end());
    }
  }

  // GENERATE: first, last, step.
  InpMembers read_range(const InpLine& line, int instance) const {
    const std::vector<std::string>& cells = line.cells;
    if (cells.size() < 2) refuse_inp(line.place, "one number", "first, last, step");
    InpMembers range{instance, whole_number(cells[0], line.place),
                     whole_number(cells[1], line.place), 1};
    if (cells.size() > 2 && !cells[2].empty()) range.step = whole_number(cells[2], line.place);
    if (range.step <= 0 || range.first < 0 || range.last < range.first) {
      refuse_inp(line.place, "a range that does not ascend", "first, last, step");
    }
    return range;
  }

  // Members of the set `name`: of this scope, of the instance of the card, or "instance.name". The
  // latter may also be "instance.number".
  std::vector<InpMembers> members_by_name(const std::string& name, InpSets InpScope::*kind,
                                          int instance, const Place& place) {
    const InpSets& own = scope().*kind;
    std::string rest = name;
    if (instance == own_scope && block_ == Block::model) {
      if (const auto found = own.find(upper_case(name)); found != own.end()) {
        return found->second.members;
      }
      for (std::size_t dot = name.find('.'); dot != std::string::npos && instance == own_scope;
           dot = name.find('.', dot + 1)) {
        instance = find_instance(name.substr(0, dot));
        rest = name.substr(dot + 1);
      }
    }
    if (instance == own_scope) {
      const auto found = own.find(upper_case(name));
      if (found == own.end()) refuse_missing_set(name, place);
      return found->second.members;
    }
    if (is_digits(rest)) {
      const long long id = whole_number(rest, place);
      return {{instance, id, id, 1}};
    }
    const InpSets& sets = model_.instances[static_cast<std::size_t>(instance)].scope.*kind;
    const auto found = sets.find(upper_case(rest));
    if (found == sets.end()) refuse_missing_set(name, place);
    std::vector<InpMembers> members = found->second.members;
    for (InpMembers& one : members) one.instance = instance;
    return members;
  }

  [[noreturn]] static void refuse_missing_set(const std::string& name, const Place& place) {
    refuse_inp(place, "there is no set \"" + name + "\" above",
               "numbers, or a set that is read before");
  }

  void read_surface(const InpLine& line) {
    const std::string name = card_.value("NAME");
    if (upper_case(card_.value("TYPE")) == "NODE") {
      read_members(line, {line.cells.at(0)}, &InpScope::node_sets, name);
      return;
    }
    InpSide side{line.cells.at(0), "", line.place};
    if (line.cells.size() > 1) side.side = upper_case(line.cells[1]);
    scope().surfaces[upper_case(name)].sides.push_back(side);
  }

  // Two or three points, and below them the axis and the angle in degrees of a further rotation.
  // Lines below these are directions of fibres, which belong to a material.
  void read_orientation(const InpLine& line) {
    InpOrientation& orientation = scope().orientations.at(upper_case(card_.value("NAME")));
    ++orientation.n_lines;
    if (orientation.n_lines > 2 || !orientation.fault.empty()) return;
    std::vector<double> numbers;
    try {
      for (const std::string& cell : line.cells) numbers.push_back(real_number(cell, line.place));
    } catch (const Failure&) {
      orientation.fault = fmt::format("found \"{}\" in line {}", line.text, line.place.line);
      return;
    }
    if (orientation.n_lines == 2) {
      read_further_rotation(orientation, numbers, line);
      return;
    }
    if (numbers.size() < 6) {
      orientation.fault = fmt::format("{} numbers in line {}", numbers.size(), line.place.line);
      return;
    }
    numbers.resize(9, 0);
    orientation.a = {numbers[0], numbers[1], numbers[2]};
    orientation.b = {numbers[3], numbers[4], numbers[5]};
    orientation.c = {numbers[6], numbers[7], numbers[8]};
  }

  static void read_further_rotation(InpOrientation& orientation, const std::vector<double>& numbers,
                                    const InpLine& line) {
    if (numbers.empty()) return;
    const double axis = numbers[0];
    if (axis != 1 && axis != 2 && axis != 3) {
      orientation.fault = fmt::format("rotation about axis {:g} in line {}", axis, line.place.line);
      return;
    }
    orientation.about = static_cast<int>(axis);
    if (numbers.size() > 1) orientation.angle = numbers[1] * std::numbers::pi / 180;
  }

  // Three numbers translate an instance, seven turn it afterwards: two points of the axis, and the
  // angle in degrees, counter-clockwise seen from the second point.
  void read_motion(const InpLine& line) {
    InpInstance& instance = model_.instances.back();
    std::vector<double> numbers;
    for (const std::string& cell : line.cells) numbers.push_back(real_number(cell, line.place));
    ++instance.n_lines;
    const bool first = instance.n_lines == 1;
    if (numbers.size() > 3 && numbers.size() != 7) {
      refuse_inp(line.place, fmt::format("found {} numbers below *INSTANCE", numbers.size()),
                 "3 numbers of a translation, or 7 of a rotation: two points of the axis and the "
                 "angle in degrees");
    }
    if (numbers.size() <= 3 && first) {
      for (std::size_t k = 0; k < numbers.size(); ++k) {
        instance.translation[static_cast<Eigen::Index>(k)] = numbers[k];
      }
      return;
    }
    if (numbers.size() != 7 || instance.n_lines > 2 || instance.rotation != Mat3::Identity()) {
      refuse_inp(line.place, "found a further line below *INSTANCE",
                 "one line of a translation, and one of a rotation below it");
    }
    const Vec3 a(numbers[0], numbers[1], numbers[2]);
    const Vec3 b(numbers[3], numbers[4], numbers[5]);
    const Vec3 axis = b - a;
    if (!(axis.norm() > 0)) {
      refuse_inp(line.place, "found an axis of rotation through one point", "two different points");
    }
    const double angle = numbers[6] * std::numbers::pi / 180;
    instance.centre = a;
    instance.rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  }

  // Without any instance, each part is an instance of itself where it is.
  void place_parts() {
    const bool none = model_.instances.empty();
    for (auto& [key, part] : parts_) {
      if (none) {
        InpInstance instance;
        instance.name = part_names_.at(key);
        instance.scope = std::move(part);
        model_.instances.push_back(std::move(instance));
      } else if (!used_parts_.count(key)) {
        model_.left_out.insert(fmt::format("part {} without an instance", part_names_.at(key)));
      }
    }
  }
};

}  // namespace

std::size_t InpScope::size() const {
  std::size_t n = nodes.size() + cells.size() + faces.size();
  n += orientations.size() + oriented.size() + material_of.size();
  n += members_of(node_sets) + members_of(element_sets);
  for (const auto& [key, surface] : surfaces) n += 1 + surface.sides.size();
  return n;
}

InpModel read_inp_model(InpScanner& scanner) { return ModelReader(scanner).read(); }

}  // namespace langer
