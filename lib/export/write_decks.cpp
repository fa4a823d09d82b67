#include "export/write_decks.hpp"

#include <filesystem>
#include <utility>

#include "core/base/error.hpp"
#include "core/hdf5/replace.hpp"
#include "core/hdf5/seal.hpp"
#include "export/export_scene.hpp"

namespace langer {

std::vector<WrittenDeck> write_decks(const std::string& solution,
                                     const std::vector<std::string>& files) {
  for (const std::string& file : files)
    if (const auto ending = std::filesystem::path(file).extension();
        ending != ".inp" && ending != ".feb")
      throw Failure(Exit::config, Error{{"--export"},
                                        "",
                                        "found \"" + file + "\"",
                                        "a file ending with .inp (CalculiX) or .feb (FEBio 4)",
                                        ""});
  for (const std::string& file : files) require_own_text(file, written_by);
  const Deck deck = deck_of(SolutionReader(solution), solution);
  std::vector<WrittenDeck> written;
  std::vector<std::string> texts;
  for (const std::string& file : files) {
    const bool calculix = std::filesystem::path(file).extension() == ".inp";
    DeckText text = calculix ? calculix_deck(deck) : febio_deck(deck);
    texts.push_back(std::move(text.text));
    written.push_back({file, calculix ? "CalculiX" : "FEBio 4", std::move(text.warnings)});
  }
  for (std::size_t i = 0; i < files.size(); ++i) write_text_file(files[i], texts[i]);
  return written;
}

}  // namespace langer
