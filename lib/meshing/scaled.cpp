#include <algorithm>
#include <cmath>

#include "meshing/block.hpp"
#include "meshing/grading.hpp"

namespace langer {

namespace {

// An even number stays even, so that a line keeps passing through the middle, unless it is too
// small to be divided by little.
template <class Box>
void lengthen(Box& box, double factor) {
  std::vector<int> n;
  const auto halved = [](int divisions) {
    return divisions % 2 == 0 && divisions >= 8;
  };
  for (int divisions : box.divisions)
    n.push_back(divisions == 1 ? 0 : halved(divisions) ? divisions / 2 : divisions);
  n = divided(n, factor);
  box.instead = box.divisions;
  for (std::size_t i = 0; i < n.size(); ++i)
    (*box.instead)[i] = box.divisions[i] == 1 ? 1 : halved(box.divisions[i]) ? 2 * n[i] : n[i];
}

template <class Box>
void scale(Box& box, double factor) {
  if (box.family) {
    box.family->length *= factor;
    return;
  }
  for (int& n : box.divisions) {
    const bool even = n % 2 == 0;
    if (n > 1)
      n = even ? 2 * std::max(1L, std::lround(0.5 * n / factor))
               : std::max(1L, std::lround(n / factor));
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
    return with_family && with_family->family ? &*with_family->family : nullptr;
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
