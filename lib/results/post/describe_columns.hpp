// Every column that a table of curves may have, as `langer describe columns` prints it: name, unit,
// sign and meaning.
#pragma once

#include <string>

namespace langer {

std::string columns_text();

}  // namespace langer
