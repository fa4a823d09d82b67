#include "mechanics/assembly/sparse_tangent.hpp"

#include "mechanics/assembly/folded_cell.hpp"

namespace langer {

SparseTangent::SparseTangent(const BodyModel& body,
                             const std::vector<ElementPackets::Block>& blocks)
    : body_(body),
      pattern_(make_pattern(body.mesh(), body.moving_nodes(), body.dofs(), body.own_cells())) {
  find_first_elements(blocks);
  values_.assign(pattern_.nnz(), 0);
}

void SparseTangent::find_first_elements(const std::vector<ElementPackets::Block>& blocks) {
  const int per_element = pattern_.blocks_per_element;
  overwrites_.assign(body_.own_cells().size() * per_element, 0);
  std::vector<char> reached(pattern_.nnz(), 0);
  for (const ElementPackets::Block& block : blocks) {
    for (int l = 0; l < block.n; ++l) {
      const int e = block.cells[l];
      if (pattern_.scattered(e)) {
        // Entries of such an element go to single positions, which are cleared beforehand.
        for (int k = 0; k < pattern_.slots_per_element; ++k) {
          const int at = pattern_.slots(e)[k];
          if (at < 0 || reached[at]) continue;
          reached[at] = 1;
          cleared_.push_back(at);
        }
        continue;
      }
      for (int k = 0; k < per_element; ++k) {
        const int at = pattern_.blocks(e)[3 * k];
        if (at == Pattern::none) continue;
        // The first entry stands for its block: no element reaches only a part of a block.
        char& first_entry = reached[at >= 0 ? at : Pattern::turned(at)];
        overwrites_[pattern_.number(e) * per_element + k] = !first_entry;
        first_entry = 1;
      }
    }
  }
}

void SparseTangent::begin() {
  for (int position : cleared_) values_[position] = 0;
}

void SparseTangent::add(int e, const PacketElement& element, int lane) {
  if (body_.tied(e)) {
    add_tied(e, element, lane);
  } else {
    add_free(e, element, lane);
  }
}

void SparseTangent::add_free(int e, const PacketElement& element, int lane) {
  if (pattern_.scattered(e)) {
    const int* slot = pattern_.slots(e);
    for (int k = 0; k < pattern_.slots_per_element; ++k) {
      if (slot[k] >= 0) values_[slot[k]] += element.K[k][lane];
    }
    return;
  }

  // Three columns of a block of two nodes, each n entries long from `position` on.
  const auto add_column = [this](int position, bool overwrite, int n, const auto& value) {
    static constexpr double zero[3] = {};
    double* to = &values_[position];
    const double* before = overwrite ? zero : to;
    for (int i = 0; i < n; ++i) to[i] = before[i] + value(i);
  };
  const int* at = pattern_.blocks(e);
  const char* overwrites = &overwrites_[pattern_.number(e) * pattern_.blocks_per_element];
  for (int a = 0; a < body_.n_nodes(); ++a) {
    const Packet* row[3];
    for (int i = 0; i < 3; ++i) row[i] = &element.K[(3 * a + i) * (3 * a + i + 1) / 2];
    for (int b = 0; b <= a; ++b, at += 3, ++overwrites) {
      if (at[0] == Pattern::none) continue;
      if (a == b) {
        for (int j = 0; j < 3; ++j) {
          const auto value = [&](int i) {
            return row[i + j][3 * b + j][lane];
          };
          add_column(at[j], *overwrites, 3 - j, value);
        }
      } else if (at[0] >= 0) {
        for (int j = 0; j < 3; ++j) {
          const auto value = [&](int i) {
            return row[i][3 * b + j][lane];
          };
          add_column(at[j], *overwrites, 3, value);
        }
      } else {
        for (int i = 0; i < 3; ++i) {
          const auto value = [&](int j) {
            return row[i][3 * b + j][lane];
          };
          add_column(Pattern::turned(at[i]), *overwrites, 3, value);
        }
      }
    }
  }
}

// The stiffness of an element with tied nodes.
void SparseTangent::add_tied(int e, const PacketElement& element, int lane) {
  FoldedCell(pattern_, body_.dofs(), e, body_.nodes(e)).add(element, lane, values_);
}

void SparseTangent::add(int e, const MatX& stiffness) {
  FoldedCell(pattern_, body_.dofs(), e, body_.nodes(e)).add(stiffness, values_);
}

void SparseTangent::add(const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) values_[i] += values[i];
}

VecX SparseTangent::times(const VecX& v) const {
  VecX out = VecX::Zero(v.size());
  for (int column = 0; column < pattern_.n; ++column) {
    int at = pattern_.column_start[column];
    double sum = values_[at] * v[column];  // a column starts with its diagonal
    for (++at; at < pattern_.column_start[column + 1]; ++at) {
      out[pattern_.row[at]] += values_[at] * v[column];
      sum += values_[at] * v[pattern_.row[at]];
    }
    out[column] += sum;
  }
  return out;
}

}  // namespace langer
