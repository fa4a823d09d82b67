// Decks of other programs from a solved scene, one by each file's ending.
#pragma once

#include <string>
#include <vector>

namespace langer {

struct WrittenDeck {
  std::string file, program;          // "CalculiX", "FEBio 4"
  std::vector<std::string> warnings;  // as of DeckText
};
// Throws Failure(config) for another ending, a file that is not ours, or a scene that no deck
// holds; then nothing is written.
std::vector<WrittenDeck> write_decks(const std::string& solution,
                                     const std::vector<std::string>& files);

}  // namespace langer
