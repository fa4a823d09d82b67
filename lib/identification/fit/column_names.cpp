#include "identification/fit/column_names.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <vector>

#include "core/base/measured_units.hpp"

namespace langer {

namespace {

using Of = ColumnMeaning::Of;
using WordSet = std::set<std::string>;

// The words of headings, in lower case. Letters beyond ASCII are UTF-8.
const WordSet strain_nouns{"strain",
                           "dehnung",
                           "deformation",
                           "d\xC3\xA9"
                           "formation",
                           "\xCE\xB5",
                           "epsilon",
                           "stauchung",
                           "verformung"};
const WordSet stretch_nouns{"stretch", "lambda", "\xCE\xBB", "streckung", "f11", "f22", "f33"};
const WordSet length_nouns{"extension",
                           "elongation",
                           "displacement",
                           "crosshead",
                           "stroke",
                           "travel",
                           "position",
                           "weg",
                           "standardweg",
                           "traversenweg",
                           "verl\xC3\xA4ngerung",
                           "allongement",
                           "d\xC3\xA9placement",
                           "deplacement"};
const WordSet stress_nouns{"stress",       "spannung",      "contrainte",  "\xCF\x83", "sigma",
                           "nennspannung", "druckspannung", "zugspannung", "pk1",      "pk2",
                           "1pk",          "2pk",           "p11",         "p22",      "p33",
                           "s11",          "s22",           "s33"};
const WordSet force_nouns{"force",
                          "load",
                          "kraft",
                          "standardkraft",
                          "pr\xC3\xBC"
                          "fkraft",
                          "zugkraft",
                          "druckkraft",
                          "fx",
                          "fy",
                          "fz"};

// Words that say nothing about the measure and may stand in a heading that is found by its name.
const WordSet neutral_words{"tensile",   "zug",   "axial", "standard", "ratio",
                            "kirchhoff", "piola", "first", "second",   "1st",
                            "2nd",       "pk",    "e11",   "e22",      "e33"};

const WordSet engineering_words{
    "engineering",  "eng",        "engg",        "engr",         "nominal",         "nominale",
    "conventional", "technische", "technischer", "nennspannung", "ing\xC3\xA9nieur"};
const WordSet lagrange_words{"lagrange", "lagrangian", "lagrangien"};
const WordSet green_words{"green"};
const WordSet cauchy_words{"cauchy"};
const WordSet true_words{"true", "wahre", "wahrer", "vraie"};
const WordSet log_words{"log",           "logarithmic", "ln", "hencky", "logarithmische",
                        "logarithmique", "natural"};
const WordSet compression_words{"compression", "compressive", "compressed",    "compress",
                                "stauchung",   "druck",       "druckspannung", "druckkraft"};

bool is_separator(unsigned char c) { return c < 128 && std::isalnum(c) == 0; }

// Dashes and the blank of word processors, in UTF-8, become plain blanks.
std::string with_plain_dashes(std::string text) {
  for (const std::string dash :
       {"\xE2\x80\x90", "\xE2\x80\x91", "\xE2\x80\x93", "\xE2\x80\x94", "\xC2\xA0"}) {
    for (std::size_t at = text.find(dash); at != std::string::npos; at = text.find(dash, at)) {
      text.replace(at, dash.size(), " ");
    }
  }
  return text;
}

// "Piola-Kirchhoff" and "PiolaKirchhoff" are two words alike; "PK1" and "S11" stay one.
std::vector<std::string> words_of(const std::string& heading) {
  const std::string text = with_plain_dashes(heading);
  std::vector<std::string> words;
  std::string word;
  const auto finish = [&] {
    if (!word.empty()) {
      words.push_back(word);
    }
    word.clear();
  };
  unsigned char before = ' ';
  for (const char letter : text) {
    const auto c = static_cast<unsigned char>(letter);
    const bool new_word = std::islower(before) != 0 && c < 128 && std::isupper(c) != 0;
    if (is_separator(c) || new_word) {
      finish();
    }
    if (!is_separator(c)) {
      if (c < 128) {
        word += static_cast<char>(std::tolower(c));
      } else {
        word += letter;
      }
    }
    if (c < 128) {
      before = c;
    } else {
      before = static_cast<unsigned char>(' ');
    }
  }
  finish();
  return words;
}

// The words of a heading, in lower case.
class Words {
 public:
  explicit Words(const std::string& text) : all_(words_of(text)) {}

  bool has(const WordSet& set) const {
    return std::any_of(all_.begin(), all_.end(),
                       [&](const std::string& word) { return set.count(word) > 0; });
  }

  // "PK 1", "Piola-Kirchhoff 2": a digit right behind one of the words
  bool has_followed(const WordSet& set, const std::string& next) const {
    for (std::size_t i = 0; i + 1 < all_.size(); ++i) {
      if (set.count(all_[i]) > 0 && all_[i + 1] == next) {
        return true;
      }
    }
    return false;
  }

  // Whether every word is one of those known here; the last may be the name of an axis or of a
  // specimen, of one character: lambda_x, stretch_1.
  bool understood() const {
    if (all_.empty()) {
      return false;
    }
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const bool axis = i > 0 && all_[i].size() == 1;
      if (!axis && !is_known(all_[i])) {
        return false;
      }
    }
    return true;
  }

 private:
  static bool is_known(const std::string& word) {
    for (const WordSet* set :
         {&strain_nouns, &stretch_nouns, &length_nouns, &stress_nouns, &force_nouns, &neutral_words,
          &engineering_words, &lagrange_words, &green_words, &cauchy_words, &true_words, &log_words,
          &compression_words}) {
      if (set->count(word) > 0) {
        return true;
      }
    }
    return false;
  }

  std::vector<std::string> all_;
};

// Collects the measures that words name; two different ones leave the question open.
template <class Measure>
struct Named {
  std::optional<Measure> measure;
  bool several = false;
  void add(bool named, Measure one) {
    if (!named) {
      return;
    }
    several = several || (measure && *measure != one);
    measure = one;
  }
};

// The stress measure that the words name. First and second Piola-Kirchhoff must be told apart by a
// number.
void name_stress(const Words& words, ColumnMeaning& m) {
  using enum StressMeasure;
  const WordSet piola{"piola", "kirchhoff", "kirchoff", "pk"};
  const bool first = words.has({"first", "1st", "pk1", "1pk", "pki", "erste"}) ||
                     words.has_followed(piola, "1") || words.has_followed(piola, "i") ||
                     words.has_followed({"1"}, "pk");
  const bool second = words.has({"second", "2nd", "pk2", "2pk", "pkii", "zweite"}) ||
                      words.has_followed(piola, "2") || words.has_followed(piola, "ii") ||
                      words.has_followed({"2"}, "pk");
  const bool of_piola = words.has(piola) || words.has({"pk1", "1pk", "pki", "pk2", "2pk", "pkii"});

  Named<StressMeasure> named;
  named.add(of_piola && first, nominal);
  named.add(of_piola && second, second_piola);
  named.add(words.has(engineering_words), nominal);
  named.add(words.has(lagrange_words), nominal);
  named.add(words.has({"p11", "p22", "p33"}), nominal);
  named.add(words.has(cauchy_words) || words.has(true_words), cauchy);
  const bool piola_alone =
      words.has({"piola"}) && !words.has({"kirchhoff", "kirchoff"}) && !first && !second;
  named.add(piola_alone, nominal);

  if (named.several) {
    m.stress_question = "names two measures";
  } else if (named.measure) {
    m.stress = named.measure;
  } else if (of_piola) {
    m.stress_question = "does not say which of the two Piola-Kirchhoff stresses";
  } else if (words.has({"s11", "s22", "s33"})) {
    m.stress_question = "is the second Piola-Kirchhoff stress in textbooks, Cauchy's in Abaqus";
  }
}

// The strain measure that the words name.
void name_strain(const Words& words, ColumnMeaning& m) {
  using enum StrainMeasure;
  if (words.has(stretch_nouns)) {
    m.strain = stretch;
    return;
  }
  Named<StrainMeasure> named;
  named.add(words.has(engineering_words), engineering);
  named.add(words.has(green_words) || words.has(lagrange_words), green_lagrange);
  named.add(words.has(true_words) || words.has(log_words), log);

  if (words.has({"almansi", "euler", "eulerian"})) {
    m.strain_question = "names a measure that is not read here";
  } else if (named.several) {
    m.strain_question = "names two measures";
  } else if (named.measure) {
    m.strain = named.measure;
  } else if (words.has({"e11", "e22", "e33"})) {
    m.strain_question = "is Green's strain in textbooks, another one in finite element programs";
  }
}

// Whether the column is a deformation or a stress, and whether it is a length or a force. More than
// one such noun leaves it open.
void name_quantity(const Words& words, ColumnMeaning& m) {
  const bool elongation = words.has(length_nouns);
  const bool strain = words.has(strain_nouns) || words.has({"e11", "e22", "e33"});
  const bool stretch = words.has(stretch_nouns) || (elongation && words.has({"ratio"}));
  const bool force = words.has(force_nouns);
  const bool stress = words.has(stress_nouns) || words.has({"pk", "piola"});
  const int nouns = static_cast<int>(elongation && !stretch) + static_cast<int>(strain) +
                    static_cast<int>(stretch) + static_cast<int>(force) + static_cast<int>(stress);
  m.compression = words.has(compression_words);
  if (nouns != 1) {
    return;
  }
  if (stress || force) {
    m.noun = Of::stress;
  } else {
    m.noun = Of::deformation;
  }
  m.lengths = elongation && !stretch;
  m.position = m.lengths && words.has({"position"});
  if (stretch) {
    m.strain = StrainMeasure::stretch;
    m.strain_question.clear();
  }
  if (force) {
    m.stress = StressMeasure::nominal;
    m.stress_question.clear();
  }
  if (words.understood()) {
    m.of = m.noun;
  }
}

template <class Unit>
// The unit of this spelling, if it is one of the enumeration.
std::optional<Unit> unit_called(const std::string& name) {
  const auto known = names(Unit{});
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (name == known[i]) {
      return static_cast<Unit>(i);
    }
  }
  return std::nullopt;
}

template <class Unit>
double factor_of_unit(Unit unit) {
  const std::string name = names(unit)[static_cast<std::size_t>(unit)];
  const std::string spelled = name == "fraction" ? "1" : name;
  return measured_unit(spelled).value().factor;
}

// The unit of the heading, or the text of one that is not known.
void name_unit(const std::string& text, ColumnMeaning& m) {
  const auto unit = measured_unit(text);
  if (unit) {
    m.stress_unit = unit_called<StressUnit>(unit->name);
    m.strain_unit = unit_called<StrainUnit>(unit->name);
  }
  if (!m.stress_unit && !m.strain_unit) {
    m.foreign_unit = text;
  }
}

}  // namespace

double factor(StressUnit unit) { return factor_of_unit(unit); }
double factor(StrainUnit unit) { return factor_of_unit(unit); }
double factor(TimeUnit unit) { return factor_of_unit(unit); }

ColumnMeaning column_meaning(const std::string& name, const std::string& unit_below) {
  const Heading heading = split_heading(name);
  ColumnMeaning m;
  name_unit(heading.unit.empty() ? unit_below : heading.unit, m);

  const Words words(heading.words);
  name_stress(words, m);
  name_strain(words, m);
  name_quantity(words, m);

  if (m.stress_unit && is_force(*m.stress_unit) && m.noun == Of::stress) {
    m.stress = StressMeasure::nominal;
    m.stress_question.clear();
  }
  if (!m.foreign_unit.empty()) {
    m.of = Of::unknown;
  }
  return m;
}

}  // namespace langer
