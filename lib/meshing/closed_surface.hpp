// Whether triangles enclose a solid. Every edge of a closed surface belongs to exactly two
// triangles, which run through it in opposite directions if their corners have one orientation. An
// edge of one triangle borders a hole; an edge of three or more belongs to walls inside.
#pragma once

#include <string>

#include "mechanics/mesh/triangles.hpp"

namespace langer {

// Throws Failure(input): how many edges are open, shared by more than two triangles or run through
// twice in one direction, and where they are.
void require_closed(const Triangles& surface, const std::string& shown_name);

// Volume that a closed surface encloses [mm^3], whichever way its normals point.
double enclosed_volume(const Triangles& surface);

}  // namespace langer
