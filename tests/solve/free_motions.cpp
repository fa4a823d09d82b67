// Bodies that their supports do not hold.
#include <doctest/doctest.h>

#include "assembly/dofs.hpp"
#include "solve/free_motions.hpp"
#include "support/indentation.hpp"

using namespace langer;

TEST_CASE("extremes: a body that may spin under a frictionless sphere: it converges, or the free motion is named") {
  Mesh mesh = test::block(test::even(-2, 2, 4), test::even(0, 2, 2), test::even(-2, 2, 4));
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets["y_min"]) held.push_back({3 * i + 1, 0});
  const auto words = [&] { return free_motions(mesh, number_dofs(mesh.n_nodes(), held).dofs); };
  CHECK(words() == "the supports leave the body 3 rigid motions (2 along, 1 about an axis)");
  int middle = -1;
  for (int i : mesh.node_sets["y_min"])
    if (mesh.X[i].norm() < 1e-9) middle = i;
  REQUIRE(middle >= 0);
  held.push_back({3 * middle, 0}), held.push_back({3 * middle + 2, 0});
  CHECK(words() == "the supports leave the body free to turn about the axis (0, 1, 0) through (0, 1, 0) mm");
  held.push_back({3 * (middle + 1) + 2, 0});
  CHECK(words() == "");
  held.clear();
  CHECK(words() == "the supports leave the body 6 rigid motions (3 along, 3 about an axis)");
}
