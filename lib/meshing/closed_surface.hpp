// Whether triangles enclose a solid. Every edge of a closed surface belongs to exactly two
// triangles, which run through it in opposite directions if their corners have one orientation. An
// edge of one triangle borders a hole; an edge of three or more belongs to walls inside.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "mechanics/mesh/triangles.hpp"

namespace langer {

using Edge = std::pair<int, int>;  // points, the smaller first

struct EdgeUse {
  int forward = 0;   // triangles that run from the first point to the second
  int backward = 0;  // and the other way
};

// How often, and in which direction, the triangles use each edge.
std::map<Edge, EdgeUse> edges_of(const Triangles& surface);

// Throws Failure(input): how many edges are open, shared by more than two triangles or run through
// twice in one direction, and where they are.
void require_closed(const Triangles& surface, const std::string& shown_name);

// Volume that a closed surface encloses [mm^3], whichever way its normals point.
double enclosed_volume(const Triangles& surface);

}  // namespace langer
