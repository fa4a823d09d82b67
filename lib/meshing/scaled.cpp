// Coarser and finer versions of a geometry: of all boxes and blocks whose numbers of elements are
// known. Estimates of the discretisation error compare their results.
#include <algorithm>
#include <cmath>

#include "meshing/block.hpp"
#include "meshing/grading.hpp"

namespace langer {

namespace {

// An even number stays even, so that a line keeps passing through the middle. Numbers below 8 are
// too small for that: half of them could only change by large factors.
bool stays_even(int divisions) { return divisions % 2 == 0 && divisions >= 8; }

// A direction with one element keeps it (0 for divided(): left out).
template <class Box>
void lengthen(Box& box, double factor) {
  std::vector<int> n;
  for (int divisions : box.divisions) {
    if (divisions == 1)
      n.push_back(0);
    else if (stays_even(divisions))
      n.push_back(divisions / 2);
    else
      n.push_back(divisions);
  }
  n = divided(n, factor);
  box.instead = box.divisions;
  for (std::size_t i = 0; i < n.size(); ++i) {
    int& number = (*box.instead)[i];
    if (stays_even(box.divisions[i]))
      number = 2 * n[i];
    else if (box.divisions[i] != 1)
      number = n[i];
  }
}

// `factor` multiplies the length of all elements; meshes of a family have a length of their own.
template <class Box>
void scale(Box& box, double factor) {
  if (box.family) {
    box.family->length *= factor;
    return;
  }
  for (int& n : box.divisions) {
    if (n <= 1) continue;
    if (n % 2 == 0)
      n = static_cast<int>(2 * std::max(1L, std::lround(0.5 * n / factor)));
    else
      n = static_cast<int>(std::max(1L, std::lround(n / factor)));
  }
  if (box.centre) box.centre->edge *= factor;
  if (box.top) box.top->edge *= factor;
}

}  // namespace

double* edge_in_contact_radii(Geometry& geometry) {
  if (auto* block = std::get_if<IndentedBlock>(&geometry)) return &block->edge;
  if (auto* disc = std::get_if<IndentedDisc>(&geometry)) return &disc->edge;
  return nullptr;
}

bool has_numbers_of_cells(const Geometry& geometry) {
  return has_edge_in_contact_radii(geometry) || std::holds_alternative<Block>(geometry) ||
         std::holds_alternative<SectionBox>(geometry);
}

std::vector<int> numbers_of_cells(const Geometry& geometry) {
  const auto of = [](const auto& box) {
    const auto n = box.numbers();
    return std::vector<int>(n.begin(), n.end());
  };
  if (const auto* block = std::get_if<Block>(&geometry)) return of(*block);
  if (const auto* block = std::get_if<IndentedBlock>(&geometry)) return of(block->block());
  if (const auto* disc = std::get_if<IndentedDisc>(&geometry)) return of(disc->section());
  return of(std::get<SectionBox>(geometry));
}

void put_in_family(Geometry& geometry, const std::array<std::vector<double>, 3>& breaks) {
  const auto put = [&](auto* with_family) {
    if (!with_family) return;
    with_family->family.emplace();
    with_family->family->breaks = breaks;
  };
  put(std::get_if<Block>(&geometry));
  put(std::get_if<SectionBox>(&geometry));
  put(std::get_if<IndentedBlock>(&geometry));
}

MeshFamily* family_of(Geometry& geometry) {
  const auto of = [](auto* with_family) -> MeshFamily* {
    if (!with_family || !with_family->family) return nullptr;
    return &*with_family->family;
  };
  if (MeshFamily* family = of(std::get_if<Block>(&geometry))) return family;
  if (MeshFamily* family = of(std::get_if<SectionBox>(&geometry))) return family;
  return of(std::get_if<IndentedBlock>(&geometry));
}

void lengthen_cells(Geometry& geometry, double factor) {
  if (auto* block = std::get_if<IndentedBlock>(&geometry)) block->longer = factor;
  if (auto* disc = std::get_if<IndentedDisc>(&geometry)) disc->longer = factor;
  if (auto* block = std::get_if<Block>(&geometry)) lengthen(*block, factor);
  if (auto* box = std::get_if<SectionBox>(&geometry)) lengthen(*box, factor);
}

void scale_cells(Geometry& geometry, double factor) {
  if (double* edge = edge_in_contact_radii(geometry)) *edge *= factor;
  if (auto* block = std::get_if<Block>(&geometry)) scale(*block, factor);
  if (auto* box = std::get_if<SectionBox>(&geometry)) scale(*box, factor);
}

}  // namespace langer
