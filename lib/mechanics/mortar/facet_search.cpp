// headers of Boost include others that it has given new names
#define BOOST_ALLOW_DEPRECATED_HEADERS
#include "mechanics/mortar/facet_search.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>
#include <utility>

namespace langer {

namespace {

namespace geometry = boost::geometry;
using Corner3 = geometry::model::point<double, 3, geometry::cs::cartesian>;
using Box3 = geometry::model::box<Corner3>;
using Entry = std::pair<Box3, int>;

Box3 boost_box(const BoundingBox& box) {
  return {Corner3(box.low[0], box.low[1], box.low[2]),
          Corner3(box.high[0], box.high[1], box.high[2])};
}

}  // namespace

struct FacetSearch::Tree {
  geometry::index::rtree<Entry, geometry::index::rstar<16>> boxes;
};

FacetSearch::FacetSearch(const std::vector<BoundingBox>& boxes) : tree_(std::make_unique<Tree>()) {
  std::vector<Entry> entries;
  entries.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    entries.emplace_back(boost_box(boxes[i]), static_cast<int>(i));
  tree_->boxes = decltype(tree_->boxes)(entries);
}

FacetSearch::~FacetSearch() = default;

std::vector<int> FacetSearch::meeting(const BoundingBox& box) const {
  std::vector<Entry> found;
  tree_->boxes.query(geometry::index::intersects(boost_box(box)), std::back_inserter(found));
  std::vector<int> indices;
  for (const Entry& entry : found) indices.push_back(entry.second);
  std::sort(indices.begin(), indices.end());
  return indices;
}

}  // namespace langer
