#include "meshing/gmsh/packed_model.hpp"

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <unordered_set>

#include "meshing/msh_types.hpp"

namespace langer {

namespace {

class Packer {
 public:
  std::string bytes;

  void add(std::uint64_t value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  }
  void add(const std::string& text) {
    add(text.size());
    bytes += text;
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    static_assert(sizeof(Value) == 8);
    add(values.size());
    bytes.append(reinterpret_cast<const char*>(values.data()), 8 * values.size());
  }
  void add(const std::vector<MshElements>& lists) {
    add(lists.size());
    for (const MshElements& of : lists) {
      add(static_cast<std::uint64_t>(of.type));
      add(of.name);
      add(of.tags);
      add(of.nodes);
    }
  }
};

class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t number() {
    std::uint64_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  int small_number() {
    const std::uint64_t value = number();
    require(value <= 1u << 30);
    return static_cast<int>(value);
  }
  // of a list whose items take at least `bytes_each` bytes
  std::size_t count(std::size_t bytes_each) {
    const std::uint64_t n = number();
    require(n <= bytes_.size() / bytes_each);
    return static_cast<std::size_t>(n);
  }
  std::string text() {
    const std::size_t n = count(1);
    return std::string(take(n));
  }
  template <class Value>
  std::vector<Value> list() {
    static_assert(sizeof(Value) == 8);
    const std::size_t n = count(8);
    std::vector<Value> values(n);
    const std::string_view raw = take(8 * n);
    if (n > 0) std::memcpy(values.data(), raw.data(), raw.size());
    return values;
  }
  // Tags of nodes or elements, as files of gmsh have them.
  std::vector<std::size_t> tags() {
    std::vector<std::size_t> found = list<std::size_t>();
    for (const std::size_t tag : found) require(tag >= 1 && tag <= 2147483647);
    return found;
  }
  std::vector<MshElements> elements(int dim, const std::unordered_set<std::size_t>& known_nodes) {
    std::vector<MshElements> lists(count(32));
    for (MshElements& of : lists) {
      of.type = small_number();
      of.name = text();
      of.tags = tags();
      of.nodes = tags();
      for (const std::size_t node : of.nodes) require(known_nodes.contains(node));
      const MshType* type = find_msh_type(of.type);
      require(type && type->dim == dim);
      require(of.nodes.size() == of.tags.size() * static_cast<std::size_t>(type->n_nodes));
    }
    return lists;
  }
  void require(bool is_right) const {
    if (!is_right) throw std::runtime_error("it sent a mesh whose sizes do not fit together");
  }
  void require_end() const { require(bytes_.empty()); }

 private:
  std::string_view bytes_;

  std::string_view take(std::size_t n) {
    require(n <= bytes_.size());
    const std::string_view taken = bytes_.substr(0, n);
    bytes_.remove_prefix(n);
    return taken;
  }
};

}  // namespace

std::string packed(const MshModel& model) {
  Packer packer;
  packer.add(static_cast<std::uint64_t>(model.has_volumes));
  packer.add(model.node_tags);
  packer.add(model.X);
  packer.add(model.cells);
  packer.add(model.groups.size());
  for (const MshGroup& group : model.groups) {
    packer.add(static_cast<std::uint64_t>(group.dim));
    packer.add(static_cast<std::uint64_t>(group.tag));
    packer.add(group.name);
    packer.add(group.elements);
    packer.add(group.nodes);
  }
  return packer.bytes;
}

MshModel unpacked(std::string_view bytes) {
  Unpacker in(bytes);
  MshModel model;
  model.has_volumes = in.number() != 0;
  model.node_tags = in.tags();
  model.X = in.list<double>();
  in.require(model.X.size() == 3 * model.node_tags.size());
  const std::unordered_set<std::size_t> known(model.node_tags.begin(), model.node_tags.end());
  model.cells = in.elements(3, known);
  const std::size_t n_groups = in.count(40);
  for (std::size_t i = 0; i < n_groups; ++i) {
    MshGroup group;
    group.dim = in.small_number();
    in.require(group.dim <= 3);
    group.tag = in.small_number();
    group.name = in.text();
    group.elements = in.elements(group.dim, known);
    group.nodes = in.list<std::size_t>();
    model.groups.push_back(std::move(group));
  }
  in.require_end();
  return model;
}

}  // namespace langer
