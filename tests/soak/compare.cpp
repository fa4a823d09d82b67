// langer-compare-h5 a.h5 b.h5 [tolerance] [--data]: exit code 1 where they differ outside
// /provenance; --data: attributes too may differ.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "support/compare_h5.hpp"

int main(int argc, char** argv) {
  double tolerance = 0;
  bool attributes = true;
  for (int i = 3; i < argc; ++i) {
    if (std::string(argv[i]) == "--data")
      attributes = false;
    else
      tolerance = std::atof(argv[i]);
  }
  if (argc < 3) return 2;
  const auto compared = langer::support::compare_h5(argv[1], argv[2], tolerance, attributes);
  for (const auto& d : compared.differences)
    std::printf("%s: %s\n", d.where.c_str(), d.what.c_str());
  std::printf("%zu datasets, largest relative difference %.3g\n", compared.datasets,
              compared.largest);
  return compared.differences.empty() ? 0 : 1;
}
