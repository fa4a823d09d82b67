#include "mechanics/solve/candidate_levels.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace langer {

namespace {

// The smallest gap at a place along the path of an indenter, at even steps of t.
double closest_gap(const RigidContact& contact, const Vec3& X) {
  constexpr int steps = 8;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    const Vec3 c = indenter_displacement(contact, static_cast<double>(i) / steps);
    least = std::min(least, shape_at(contact.shape, X - c).gap);
  }
  return least;
}

constexpr std::size_t lowest = 24;  // candidates of level 0

}  // namespace

CandidateLevels::CandidateLevels(const std::vector<RigidContact>& contacts,
                                 const std::vector<Vec3>& X) {
  struct One {
    double closest;
    int node;
    std::size_t contact, candidate;
  };
  std::vector<One> order;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    level_.emplace_back(contacts[k].nodes.size(), 0);
    for (std::size_t i = 0; i < contacts[k].nodes.size(); ++i) {
      const int node = contacts[k].nodes[i];
      const double closest = closest_gap(contacts[k], X[node]);
      order.push_back({closest, node, k, i});
      closest_.push_back(contacts[k].control ? -std::numeric_limits<double>::infinity() : closest);
    }
  }
  std::sort(order.begin(), order.end(), [](const One& a, const One& b) {
    return std::tie(a.closest, a.node, a.contact) < std::tie(b.closest, b.node, b.contact);
  });
  std::size_t holds = lowest;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == holds) {
      ++all_;
      holds += holds / 2;
    }
    level_[order[i].contact][order[i].candidate] = all_;
  }
}

int CandidateLevels::holding(std::size_t first) const {
  int level = 0;
  for (std::size_t holds = lowest; holds < first && level < all_; holds += holds / 2) ++level;
  return level;
}

std::size_t CandidateLevels::on_the_path(double distance) const {
  return static_cast<std::size_t>(std::count_if(
      closest_.begin(), closest_.end(), [&](double closest) { return closest <= distance; }));
}

}  // namespace langer
