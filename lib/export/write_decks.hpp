// Input files of other programs (decks) from a solved scene. The ending of each file names the
// program.
#pragma once

#include <string>
#include <vector>

namespace langer {

// A deck that was written.
struct WrittenDeck {
  std::string file, program;          // "CalculiX", "FEBio 4"
  std::vector<std::string> warnings;  // those of DeckText
};
// Throws Failure(config) for another ending, a file that Langer did not write, or a scene that a
// deck cannot express. Then nothing is written.
std::vector<WrittenDeck> write_decks(const std::string& solution,
                                     const std::vector<std::string>& files);

}  // namespace langer
