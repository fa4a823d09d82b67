// Which facets may lie opposite of which: boxes around facets in an R-tree (Boost.Geometry). For n
// facets the search costs n log n, a comparison of all pairs n^2.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/mesh/bounding_box.hpp"

namespace langer {

class FacetSearch {
 public:
  explicit FacetSearch(const std::vector<BoundingBox>& boxes);
  ~FacetSearch();
  FacetSearch(const FacetSearch&) = delete;
  FacetSearch& operator=(const FacetSearch&) = delete;

  // indices of the boxes that meet this one, ascending: the same for every order of insertion
  std::vector<int> meeting(const BoundingBox& box) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace langer
