#include "meshing/split_tetrahedra.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>
#include <vector>

#include "meshing/msh_types.hpp"

namespace langer {

namespace {

class Splitter {
 public:
  explicit Splitter(const MshModel& model) : model_(model) {
    result_.node_tags = model.node_tags;
    result_.X = model.X;
    for (std::size_t i = 0; i < model.node_tags.size(); ++i) {
      place_[model.node_tags[i]] = i;
      next_node_ = std::max(next_node_, model.node_tags[i] + 1);
    }
  }

  MshModel split() {
    for (const MshElements& of : model_.cells) result_.cells.push_back(split_elements(of));
    for (const MshGroup& group : model_.groups) {
      MshGroup parts{group.dim, group.tag, group.name, {}, group.nodes};
      for (const MshElements& of : group.elements) parts.elements.push_back(split_elements(of));
      result_.groups.push_back(std::move(parts));
    }
    return std::move(result_);
  }

 private:
  const MshModel& model_;
  MshModel result_;
  std::unordered_map<std::size_t, std::size_t> place_;      // of a node in the lists, by tag
  std::map<std::vector<std::size_t>, std::size_t> middle_;  // of nodes, sorted
  std::size_t next_node_ = 1;

  // The node in the middle of some others, the same for all who share these.
  std::size_t middle(std::vector<std::size_t> nodes) {
    std::sort(nodes.begin(), nodes.end());
    const auto [at, is_new] = middle_.try_emplace(nodes, next_node_);
    if (!is_new) return at->second;
    place_[next_node_] = result_.node_tags.size();
    result_.node_tags.push_back(next_node_);
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = 0;
      for (const std::size_t node : nodes) sum += result_.X[3 * place_.at(node) + i];
      result_.X.push_back(sum / static_cast<double>(nodes.size()));
    }
    return next_node_++;
  }

  MshElements split_elements(const MshElements& of) {
    if (of.type == msh_type::tetrahedron) return split_each(of, 4, msh_type::hexahedron);
    if (of.type == msh_type::triangle) return split_each(of, 3, msh_type::quadrangle);
    return of;
  }

  MshElements split_each(const MshElements& of, std::size_t n_corners, int type) {
    MshElements parts{type, find_msh_type(type)->name, {}, {}, {}};
    for (std::size_t e = 0; e < of.tags.size(); ++e) {
      const std::vector<std::size_t> corners(
          of.nodes.begin() + static_cast<std::ptrdiff_t>(n_corners * e),
          of.nodes.begin() + static_cast<std::ptrdiff_t>(n_corners * (e + 1)));
      for (std::size_t corner = 0; corner < n_corners; ++corner) {
        // tags of the parts of one element follow from its own: the same in every group
        parts.tags.push_back(n_corners * of.tags[e] + corner);
        if (n_corners == 4)
          add_hexahedron(corners, corner, parts.nodes);
        else
          add_quadrangle(corners, corner, parts.nodes);
      }
    }
    return parts;
  }

  // The quarter at corner a. The others are taken in an order that keeps the orientation: seen from
  // a, they run around as b, c, d do seen from the tetrahedron's first corner.
  void add_hexahedron(const std::vector<std::size_t>& t, std::size_t corner,
                      std::vector<std::size_t>& nodes) {
    constexpr std::array<std::array<std::size_t, 4>, 4> even{
        {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}}};
    const std::size_t a = t[even[corner][0]];
    const std::size_t b = t[even[corner][1]];
    const std::size_t c = t[even[corner][2]];
    const std::size_t d = t[even[corner][3]];
    for (const std::size_t node :
         {a, middle({a, b}), middle({a, b, c}), middle({a, c}), middle({a, d}), middle({a, b, d}),
          middle({a, b, c, d}), middle({a, c, d})})
      nodes.push_back(node);
  }

  void add_quadrangle(const std::vector<std::size_t>& t, std::size_t corner,
                      std::vector<std::size_t>& nodes) {
    const std::size_t a = t[corner];
    const std::size_t b = t[(corner + 1) % 3];
    const std::size_t c = t[(corner + 2) % 3];
    for (const std::size_t node : {a, middle({a, b}), middle({a, b, c}), middle({a, c})})
      nodes.push_back(node);
  }
};

}  // namespace

MshModel split_into_hexahedra(const MshModel& model) { return Splitter(model).split(); }

}  // namespace langer
