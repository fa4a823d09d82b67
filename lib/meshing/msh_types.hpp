// Types of elements of the MSH format, as its manual lists them.
#pragma once

namespace langer {

struct MshType {
  int number;
  const char* name;
  int dim;
  int n_nodes;
};

namespace msh_type {
inline constexpr int triangle = 2;
inline constexpr int quadrangle = 3;
inline constexpr int tetrahedron = 4;
inline constexpr int hexahedron = 5;
inline constexpr int point = 15;
}  // namespace msh_type

const MshType* find_msh_type(int number);  // nullptr: unknown, or without a fixed number of nodes

}  // namespace langer
