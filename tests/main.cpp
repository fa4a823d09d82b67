#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "core/base/traps.hpp"

int main(int argc, char** argv) {
  langer::set_traps();
  return doctest::Context(argc, argv).run();
}
