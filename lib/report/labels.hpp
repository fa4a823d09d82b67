// Names of columns in words: u_y_A_half is "displacement u_y, A half". In a name that begins with
// no known quantity underscores become spaces.
#pragma once

#include <string>

namespace langer::report {

std::string plain_label(const char* label);  // a label in plain text: σ_{xx} is σxx
std::string in_words(const std::string& column);

}  // namespace langer::report
