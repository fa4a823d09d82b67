#include "core/tensor/packet.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

using namespace langer;

TEST_CASE(
    "cube roots of packets are those of the library to two units in the last place, near 1 and away from it") {
  for (double around : {1.0, 1e-3, 0.3, 0.985, 1.015, 2.0, 1e6})
    for (int step = -40; step <= 40; ++step) {
      Packet x;
      for (int l = 0; l < Packet::lanes; ++l) x.set(l, around * (1 + 2.4e-4 * step + 1e-6 * l));
      const Packet y = cbrt(x);
      for (int l = 0; l < Packet::lanes; ++l)
        CHECK(std::abs(y[l] / std::cbrt(x[l]) - 1) <= 2 * std::numeric_limits<double>::epsilon());
    }
  CHECK(cbrt(Packet(1.0))[3] == 1);
}
