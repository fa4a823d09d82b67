// How *INCLUDE of an Abaqus or CalculiX input file reaches other files.
#pragma once

#include <functional>
#include <string>

namespace langer {

// A file that *INCLUDE names: its path as messages show it and its text, or what is wrong with it.
struct InpInclusion {
  std::string path, text, trouble;
};

// (file with the card, what INPUT= says) -> the included file
using InpOpener = std::function<InpInclusion(const std::string&, const std::string&)>;

// Opens plain files in the folder of `main_file` or below. Paths are relative to the file with the
// card.
InpOpener inp_opener(const std::string& main_file);

}  // namespace langer
