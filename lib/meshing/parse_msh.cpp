#include "meshing/parse_msh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "meshing/msh_source.hpp"
#include "meshing/msh_types.hpp"

namespace langer {

namespace {

// Sizes in bytes of the values of a binary file.
constexpr std::size_t int_size = 4;
constexpr std::size_t long_size = 8;
constexpr std::size_t real_size = 8;

// Adds one element to the list of its type.
void add_element(std::vector<MshElements>& lists, const MshType& type, std::size_t tag,
                 const std::vector<std::size_t>& nodes, int line) {
  auto list = std::find_if(lists.begin(), lists.end(),
                           [&](const MshElements& of) { return of.type == type.number; });
  if (list == lists.end()) {
    lists.push_back({type.number, type.name, {}, {}, {}});
    list = std::prev(lists.end());
  }
  list->tags.push_back(tag);
  list->nodes.insert(list->nodes.end(), nodes.begin(), nodes.end());
  list->lines.push_back(line);
}

// Reads the sections of a file in their order. Format 1 and 2 have lists of nodes and elements;
// format 4 has blocks of them, one for each entity (point, curve, surface or volume of the
// geometry), and the groups of an entity stand in a section of their own.
//
// The file is not trusted: every count is compared with the bytes that are left before anything is
// allocated, and every number with its range.
class MshParser {
 public:
  MshParser(std::string_view bytes, const std::string& shown_name) : in_(bytes, shown_name) {}

  MshModel parse() {
    while (true) {
      const std::string_view line = in_.next_line();
      if (line.empty()) break;
      read_section(line);
    }
    if (version_ == 0) in_.refuse("no $MeshFormat", "a mesh of Gmsh, which begins with it");
    for (auto& [key, group] : groups_) {
      const auto name = names_.find(key);
      if (name != names_.end()) group.name = name->second;
      model_.groups.push_back(std::move(group));
    }
    return std::move(model_);
  }

 private:
  using GroupKey = std::pair<int, int>;   // dimension and tag
  using EntityKey = std::pair<int, int>;  // likewise

  MshSource in_;
  double version_ = 0;  // of the format; 0: not known yet
  MshModel model_;
  std::unordered_map<std::size_t, std::size_t> place_of_node_;
  bool has_nodes_ = false;
  bool has_elements_ = false;
  std::map<GroupKey, MshGroup> groups_;
  std::map<GroupKey, std::string> names_;
  std::map<EntityKey, std::vector<int>> groups_of_entity_;
  std::size_t n_members_ = 0;  // of all groups together
  std::vector<std::size_t> nodes_of_element_;

  bool is_4_1() const { return version_ == 4.1; }

  // Sections that hold no mesh, such as results, are skipped.
  void read_section(std::string_view line) {
    const std::string_view name = line.substr(1);
    const bool is_section =
        line.front() == '$' && !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
          return std::isalnum(static_cast<unsigned char>(c)) != 0;
        });
    if (!is_section) {
      std::string expected = "a section such as $Nodes";
      if (version_ == 0) expected = "$MeshFormat, with which a mesh of Gmsh begins";
      in_.refuse("this is no section of a mesh of Gmsh", expected);
    }
    if (name == "MeshFormat") return read_format();
    // format 1 had no other beginning
    if (name == "NOD" && version_ == 0) version_ = 1;

    const bool holds_mesh = name == "PhysicalNames" || name == "Entities" ||
                            name == "PartitionedEntities" || name == "Nodes" ||
                            name == "ParametricNodes" || name == "Elements" || name == "NOD" ||
                            name == "ELM";
    if (!holds_mesh) return in_.skip_section(name);
    if (version_ == 0) in_.refuse(fmt::format("${} before $MeshFormat", name));
    in_.finish_line();
    if (name == "PhysicalNames") return read_names();
    if (name == "Entities") return read_entities(false);
    if (name == "PartitionedEntities") return read_entities(true);
    if (name == "Elements" || name == "ELM") return read_elements(std::string(name));
    read_nodes(std::string(name));
  }

  // "4.1 0 8": version, kind (1: binary) and bytes of a real number. A binary file shows its order
  // of bytes by the integer 1.
  void read_format() {
    if (version_ != 0) in_.refuse("$MeshFormat again", "it once");
    in_.finish_line();
    const double version = in_.number("the version of the format");
    const std::int64_t kind = in_.text_integer("the kind of the file");
    if (kind != 0 && kind != 1)
      in_.refuse(fmt::format("found the kind {}", kind), "0 for a text or 1 for binary data");
    const std::int64_t real_bytes = in_.text_integer("the size of a number");
    const bool is_known = (version >= 2 && version < 3) || version == 4 || version == 4.1;
    if (!is_known)
      in_.refuse(fmt::format("found version {:g} of the format", version), "2.2 or 4.1",
                 "gmsh writes it: Mesh.MshFileVersion = 4.1");
    if (real_bytes != static_cast<std::int64_t>(real_size))
      in_.refuse(fmt::format("found numbers of {} bytes", real_bytes), "8 bytes");
    if (kind == 1 && version == 4)
      in_.refuse("binary data in format 4.0", "a text, or format 2.2 or 4.1",
                 "gmsh itself reads 4.0 as text only");
    in_.finish_line();
    version_ = version;
    if (kind == 1) {
      in_.is_binary = true;
      const int one = in_.integer("the number 1 that shows the order of bytes");
      if (one == 1 << 24)
        in_.refuse("written by a machine of the other order of bytes (big endian)", "little endian",
                   "write it as text: Mesh.Binary = 0");
      if (one != 1)
        in_.refuse(fmt::format("found {} where binary data begin", one), "1",
                   "the file is damaged, as by a transfer as text");
    }
    in_.end_section("MeshFormat");
  }

  // Physical names: dimension, number and "name" of each group.
  void read_names() {
    const std::size_t n = in_.text_count("the number of names", 4, 2);
    for (std::size_t i = 0; i < n; ++i) {
      // version 2.0 gave no dimension: such a name belongs to no group
      std::int64_t dim = -1;
      if (version_ > 2.0) {
        dim = in_.text_integer("the dimension of a name");
        if (dim < 0 || dim > 3)
          in_.refuse(fmt::format("found the dimension {}", dim), "0, 1, 2 or 3");
      }
      const int tag = checked_group_tag(in_.text_integer("the number of a physical group"));
      const std::string name = in_.quoted_name();
      if (dim < 0) continue;
      const auto [known, is_new] = names_.try_emplace({static_cast<int>(dim), tag}, name);
      if (!is_new && known->second != name)
        in_.refuse(fmt::format("the physical group {} of dimension {} has two names", tag, dim));
    }
    in_.end_section("PhysicalNames");
  }

  // A negative number turns the entity around: the group is the same.
  int checked_group_tag(std::int64_t tag) const {
    if (std::abs(tag) > std::numeric_limits<int>::max())
      in_.refuse(fmt::format("found the physical group {}", tag), "a number of four bytes");
    return static_cast<int>(std::abs(tag));
  }

  MshGroup& group(int dim, int tag) {
    MshGroup& found = groups_[{dim, tag}];
    found.dim = dim;
    found.tag = tag;
    return found;
  }

  // A small file could name a large entity in very many groups, which would fill the memory.
  void add_members(std::size_t n) {
    n_members_ += n;
    if (n_members_ > in_.n_bytes())
      in_.refuse("the physical groups have more elements than the file has bytes",
                 "elements in few groups each");
  }

  // ---- entities (version 4) ----

  // Entities only matter for the groups that they belong to: places, parts and bounds are skipped.
  void skip_integers(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) in_.integer("an entity's number");
  }

  void read_entities(bool are_parts) {
    if (version_ < 4) in_.refuse("$Entities", "them in format 4 only");
    if (are_parts && !is_4_1())
      in_.refuse("a mesh in parts in format 4.0", "one without parts, or format 4.1");
    if (are_parts) {
      in_.long_integer("the number of parts");
      const std::size_t n = in_.count("the number of ghost entities", 2 * int_size, 2);
      skip_integers(2 * n);
    }
    std::int64_t n_entities[4];
    for (std::int64_t& n : n_entities) n = in_.long_integer("the number of entities");
    for (int dim = 0; dim < 4; ++dim) {
      // a point of format 4.1 has its place, all others a box
      std::size_t n_reals = 6;
      if (dim == 0 && is_4_1()) n_reals = 3;
      const std::size_t n =
          in_.checked_count(n_entities[dim], "the number of entities",
                            int_size + n_reals * real_size + long_size, 2 + n_reals);
      for (std::size_t i = 0; i < n; ++i) read_entity(dim, n_reals, are_parts);
    }
    in_.end_section(are_parts ? "PartitionedEntities" : "Entities");
  }

  void read_entity(int dim, std::size_t n_reals, bool is_part) {
    const int tag = in_.integer("an entity's number");
    if (is_part) {
      skip_integers(2);  // the entity that it is a part of
      skip_integers(in_.count("the number of parts", int_size, 1));
    }
    for (std::size_t i = 0; i < n_reals; ++i) in_.number("an entity's place");
    std::vector<int>& groups = groups_of_entity_[{dim, tag}];
    const std::size_t n_groups = in_.count("the number of physical groups", int_size, 1);
    for (std::size_t i = 0; i < n_groups; ++i) {
      const int of = checked_group_tag(in_.integer("the number of a physical group"));
      if (of == 0 || std::find(groups.begin(), groups.end(), of) != groups.end()) continue;
      groups.push_back(of);
      group(dim, of);
    }
    if (dim > 0) skip_integers(in_.count("the number of bounding entities", int_size, 1));
  }

  // The physical groups of an entity; none if it has not been listed.
  const std::vector<int>& groups_of(int dim, int entity) const {
    static const std::vector<int> none;
    const auto found = groups_of_entity_.find({dim, entity});
    if (found == groups_of_entity_.end()) return none;
    return found->second;
  }

  int checked_dimension(int dim) const {
    if (dim < 0 || dim > 3) in_.refuse(fmt::format("found the dimension {}", dim), "0, 1, 2 or 3");
    return dim;
  }

  // ---- nodes ----

  void read_nodes(const std::string& section) {
    if (has_nodes_) in_.refuse("nodes again", "them once");
    has_nodes_ = true;
    if (version_ >= 4)
      read_nodes_by_entity();
    else
      read_node_list(section == "ParametricNodes");
    in_.end_section(section.c_str());
  }

  void add_node(std::size_t tag) {
    const bool is_new = place_of_node_.try_emplace(tag, model_.node_tags.size()).second;
    if (!is_new) in_.refuse(fmt::format("node {} is there twice", tag));
    model_.node_tags.push_back(tag);
  }

  void add_position() {
    for (int i = 0; i < 3; ++i) model_.X.push_back(in_.number("a coordinate"));
  }

  // Formats 1 and 2: a line for each node.
  void read_node_list(bool are_parametric) {
    const std::size_t bytes_each = int_size + 3 * real_size;
    const std::size_t n = in_.text_count("the number of nodes", bytes_each, 4);
    in_.finish_line();
    place_of_node_.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
      add_node(in_.tag("a node's number", false));
      add_position();
      if (!are_parametric) continue;
      const int dim = checked_dimension(in_.integer("a node's dimension"));
      in_.integer("a node's entity");
      // places on curves and surfaces only
      int n_parameters = dim;
      if (dim == 3) n_parameters = 0;
      for (int k = 0; k < n_parameters; ++k) in_.number("a node's parameter");
    }
  }

  // Format 4: blocks of the nodes of one entity. 4.1 gives all numbers before all places.
  void read_nodes_by_entity() {
    const std::size_t tag_size = is_4_1() ? long_size : int_size;
    const std::size_t node_size = tag_size + 3 * real_size;
    const std::size_t n_blocks =
        in_.count("the number of blocks of nodes", 3 * int_size + long_size, 4);
    const std::size_t n_nodes = in_.count("the number of nodes", node_size, 4);
    if (is_4_1()) skip_range();
    place_of_node_.reserve(n_nodes);
    for (std::size_t b = 0; b < n_blocks; ++b) {
      const auto [dim, entity] = read_block_entity();
      const int is_parametric = in_.integer("whether nodes have parameters");
      if (is_parametric != 0 && is_parametric != 1)
        in_.refuse(fmt::format("found {}", is_parametric),
                   "0 or 1 (whether nodes have parameters)");
      const std::size_t n = in_.count("the number of nodes", node_size, 4);
      const int n_parameters = dim * is_parametric;
      const std::size_t first = model_.node_tags.size();
      for (std::size_t i = 0; i < n; ++i) {
        add_node(in_.tag("a node's number", is_4_1()));
        if (!is_4_1()) add_place(n_parameters);
      }
      if (is_4_1())
        for (std::size_t i = 0; i < n; ++i) add_place(n_parameters);
      if (dim > 0) continue;
      // the nodes of a point of the geometry belong to its groups even without elements
      for (const int tag : groups_of(dim, entity)) {
        add_members(n);
        std::vector<std::size_t>& nodes = group(dim, tag).nodes;
        nodes.insert(nodes.end(), model_.node_tags.begin() + static_cast<std::ptrdiff_t>(first),
                     model_.node_tags.end());
      }
    }
    if (model_.node_tags.size() != n_nodes)
      in_.refuse(fmt::format("found {} nodes in the blocks", model_.node_tags.size()),
                 fmt::format("{}, as the section says", n_nodes));
  }

  void add_place(int n_parameters) {
    add_position();
    for (int k = 0; k < n_parameters; ++k) in_.number("a node's parameter");
  }

  // Format 4.1 gives the range of the numbers, which is not needed.
  void skip_range() {
    in_.long_integer("the least number");
    in_.long_integer("the largest number");
  }

  // dimension and number of a block's entity; 4.0 gives the number first
  std::pair<int, int> read_block_entity() {
    const int first = in_.integer("a block's entity");
    const int second = in_.integer("a block's entity");
    if (is_4_1()) return {checked_dimension(first), second};
    return {checked_dimension(second), first};
  }

  // ---- elements ----

  void read_elements(const std::string& section) {
    if (!has_nodes_) in_.refuse("elements before the nodes", "$Nodes before $Elements");
    if (has_elements_) in_.refuse("elements again", "them once");
    has_elements_ = true;
    if (version_ >= 4)
      read_elements_by_entity();
    else if (in_.is_binary)
      read_binary_element_list();
    else
      read_element_list();
    in_.end_section(section.c_str());
  }

  const MshType& checked_type(std::int64_t number) const {
    const MshType* type = nullptr;
    if (number > 0 && number < 1000) type = find_msh_type(static_cast<int>(number));
    if (!type)
      in_.refuse(fmt::format("found the type {} of elements", number),
                 "4 (tetrahedron of 4 nodes) or 5 (hexahedron of 8 nodes), or their facets");
    return *type;
  }

  // The nodes of the next element, into nodes_of_element_.
  void read_element_nodes(std::size_t element, int n_nodes) {
    nodes_of_element_.clear();
    for (int a = 0; a < n_nodes; ++a) {
      const std::size_t node = in_.tag("an element's node", is_4_1());
      if (!place_of_node_.contains(node))
        in_.refuse(fmt::format("element {} has the node {}, which is not there", element, node));
      nodes_of_element_.push_back(node);
    }
  }

  // Cells go into the list of cells. Elements of a group are kept as the group's faces if they have
  // two or three dimensions, otherwise as its nodes.
  void add_to_model(const MshType& type, std::size_t element, const std::vector<int>& groups) {
    int line = 0;  // of a binary file: none
    if (!in_.is_binary) line = in_.line();
    if (type.dim == 3) add_element(model_.cells, type, element, nodes_of_element_, line);
    for (const int tag : groups) {
      MshGroup& of = group(type.dim, tag);
      if (type.dim >= 2) {
        add_members(1);
        add_element(of.elements, type, element, nodes_of_element_, line);
      } else {
        add_members(nodes_of_element_.size());
        of.nodes.insert(of.nodes.end(), nodes_of_element_.begin(), nodes_of_element_.end());
      }
    }
  }

  // Formats 1 and 2: each element names its group.
  void read_element_list() {
    const std::size_t n = in_.text_count("the number of elements", 1, 4);
    in_.finish_line();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t element = in_.tag("an element's number", false);
      const MshType& type = checked_type(in_.integer("an element's type"));
      std::vector<int> groups;
      if (version_ < 2) {
        groups = groups_of_number(in_.integer("the number of a physical group"));
        in_.integer("an element's entity");
        const int n_nodes = in_.integer("the number of an element's nodes");
        if (n_nodes != type.n_nodes)
          in_.refuse(fmt::format("found {} nodes", n_nodes),
                     fmt::format("{} (\"{}\")", type.n_nodes, type.name));
      } else {
        groups = read_group_of_element(in_.count("the number of an element's tags", 4, 1));
      }
      read_element_nodes(element, type.n_nodes);
      add_to_model(type, element, groups);
    }
  }

  // The binary format 2 gives blocks of elements of one type and one number of tags.
  void read_binary_element_list() {
    std::size_t left = in_.text_count("the number of elements", 2 * int_size, 2);
    in_.finish_line();
    while (left > 0) {
      const MshType& type = checked_type(in_.integer("the type of elements"));
      const int n_in_block = in_.integer("the number of elements");
      const int n_tags = in_.integer("the number of an element's tags");
      const std::size_t tags = in_.checked_count(n_tags, "the number of tags", int_size, 1);
      const std::size_t ints_each = 1 + tags + static_cast<std::size_t>(type.n_nodes);
      const std::size_t n =
          in_.checked_count(n_in_block, "the number of elements", ints_each * int_size, ints_each);
      if (n == 0 || n > left)
        in_.refuse(fmt::format("found a block of {} elements", n),
                   fmt::format("1 to {}, as the section says", left));
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t element = in_.tag("an element's number", false);
        const std::vector<int> groups = read_group_of_element(tags);
        read_element_nodes(element, type.n_nodes);
        add_to_model(type, element, groups);
      }
      left -= n;
    }
  }

  std::vector<int> groups_of_number(std::int64_t number) const {
    const int tag = checked_group_tag(number);
    if (tag == 0) return {};
    return {tag};
  }

  // The first tag is the physical group, 0 for none; entity and parts follow.
  std::vector<int> read_group_of_element(std::size_t n_tags) {
    std::vector<int> groups;
    for (std::size_t k = 0; k < n_tags; ++k) {
      const int tag = in_.integer("an element's tag");
      if (k == 0) groups = groups_of_number(tag);
    }
    return groups;
  }

  // Format 4: blocks of the elements of one type and entity.
  void read_elements_by_entity() {
    const std::size_t tag_size = is_4_1() ? long_size : int_size;
    const std::size_t n_blocks =
        in_.count("the number of blocks of elements", 3 * int_size + long_size, 4);
    const std::size_t n_elements = in_.count("the number of elements", 2 * tag_size, 2);
    if (is_4_1()) skip_range();
    std::size_t found = 0;
    for (std::size_t b = 0; b < n_blocks; ++b) {
      const auto [dim, entity] = read_block_entity();
      const MshType& type = checked_type(in_.integer("the type of elements"));
      if (type.dim != dim)
        in_.refuse(
            fmt::format("found elements \"{}\" in an entity of dimension {}", type.name, dim),
            fmt::format("dimension {}", type.dim));
      const std::size_t words_each = 1 + static_cast<std::size_t>(type.n_nodes);
      const std::size_t n = in_.count("the number of elements", words_each * tag_size, words_each);
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t element = in_.tag("an element's number", is_4_1());
        read_element_nodes(element, type.n_nodes);
        add_to_model(type, element, groups_of(dim, entity));
      }
      found += n;
    }
    if (found != n_elements)
      in_.refuse(fmt::format("found {} elements in the blocks", found),
                 fmt::format("{}, as the section says", n_elements));
  }
};

}  // namespace

MshModel parse_msh(std::string_view bytes, const std::string& shown_name) {
  return MshParser(bytes, shown_name).parse();
}

}  // namespace langer
