// Names of columns in words: u_y_A_half is "displacement u_y, A half"; what is no quantity stays,
// with spaces.
#pragma once

#include <string>

namespace langer::report {

std::string plain_label(const char* label);  // σ_{xx} as it stands in plain text: σxx
std::string in_words(const std::string& column);

}  // namespace langer::report
