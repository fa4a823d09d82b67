// The lines of an Abaqus or CalculiX input file, as keyword cards and data lines.
//
// A card begins with a star: *NSET, NSET=top, GENERATE. Its parameters may continue on the next
// line after a comma. The lines below it, up to the next card, are its data. Lines that begin with
// two stars are comments.
//
// *INCLUDE, INPUT=file puts the lines of another file in the place of the card. The scanner reads
// that file itself, so nobody else sees the card. The file must be a plain file in the folder of
// the main file or below it. Files may include others, 16 deep, but never themselves.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "meshing/inp_inclusion.hpp"

namespace langer {

struct InpCard {
  std::string word;  // upper case, without the star
  std::map<std::string, std::string> parameters;
  Place place;

  std::string value(const std::string& key) const;  // empty: not given
  bool has(const std::string& key) const { return parameters.count(key) > 0; }
};

struct InpLine {
  std::optional<InpCard> card;     // none: a data line
  std::vector<std::string> cells;  // of a data line, without the blanks around each
  std::string text;
  Place place;
};

[[noreturn]] void refuse_inp(const Place& place, const std::string& found,
                             const std::string& expected = "", const std::string& hint = "");

std::string upper_case(std::string text);
bool is_digits(const std::string& text);
long long whole_number(const std::string& text, const Place& place);
double real_number(std::string text, const Place& place);  // an empty one is 0, as in Abaqus

class InpScanner {
 public:
  // without an opener *INCLUDE is refused
  InpScanner(std::string text, const std::string& shown_name, InpOpener opener);

  std::optional<InpLine> next();  // nothing at the end of the main file

  // paths of all included files, each once, in the order of the cards
  const std::vector<std::string>& included() const { return included_; }

 private:
  struct Open {
    std::string path, text;
    std::size_t at = 0;  // of the text
    int line = 0;
  };
  std::vector<Open> open_;  // the main file, and the files that are being included
  InpOpener opener_;
  std::vector<std::string> included_;
  int n_inclusions_ = 0;

  bool read_line(Open& file, std::string& line);
  InpCard read_card(Open& file, std::string line);
  void include(const InpCard& card);
};

}  // namespace langer
