// Whether stress and deformation of a measured test point the same way.
//
// A passive specimen takes up energy when it is deformed from rest, so that stress and strain have
// one sign: positive in tension, negative in compression. Presses and rheometers often count
// compression positive. Where only the stress is counted so, the product of stress and strain is
// negative, and the file cannot mean what it says.
#pragma once

#include <string>

#include "identification/fit/test_data.hpp"

namespace langer {

// Throws Failure(input) that names the key which turns the signs. Points below a tenth of the
// largest strain or stress do not count: they hold offsets and noise.
void check_signs(const Test& test, const std::string& file);

// Whether the name of a file or a test says that it is a compression test.
bool names_compression(const std::string& name);

// Whether no point of the test is compressed: neither a stretch below 1 nor a stress below 0.
bool only_tension(const Test& test);

}  // namespace langer
