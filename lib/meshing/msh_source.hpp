// The bytes of a .msh file, read one value after another, from a text or from binary data.
//
// A file of Gmsh is a text of sections, "$Nodes" ... "$EndNodes". In a binary file the values
// within some sections are raw bytes, while the lines that begin and end the sections stay text.
// This class hides the difference: integer(), count(), tag() and number() read the next value
// either way.
//
// The file comes from a stranger. Every read checks that the bytes are there, every count is
// compared with the bytes that are left before anything of that size is allocated, and whatever
// does not fit ends with Failure(input), which names the line of a text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace langer {

class MshSource {
 public:
  // `shown_name` is the file's name in messages. The bytes must outlive this object.
  MshSource(std::string_view bytes, const std::string& shown_name);

  bool is_binary = false;

  // Lines: text, in a binary file too.
  std::string_view next_line();        // the next that is not blank, trimmed; empty at the end
  void finish_line();                  // behind what was read of a line must be nothing more
  void end_section(const char* name);  // "$EndNodes" must come next
  void skip_section(std::string_view name);  // up to behind its end, whatever is inside
  std::string quoted_name();                 // the rest of a line: a name between double quotes

  // Values: words of a text or raw bytes. `what` names the value in messages: "a node's tag".
  int integer(const char* what);                // four bytes
  std::int64_t long_integer(const char* what);  // eight bytes
  double number(const char* what);              // finite
  // A tag of a node or an element, from 1 to 2147483647; eight bytes or four.
  std::size_t tag(const char* what, bool is_long);
  // How many items follow. Each takes at least `bytes_each` bytes of a binary file, and
  // `words_each` words of a text.
  std::size_t count(const char* what, std::size_t bytes_each, std::size_t words_each);
  // Values that are words in a binary file too.
  std::int64_t text_integer(const char* what);
  std::size_t text_count(const char* what, std::size_t bytes_each, std::size_t words_each);
  // the same for a number that was read before
  std::size_t checked_count(std::int64_t value, const char* what, std::size_t bytes_each,
                            std::size_t words_each);

  int line() const { return line_; }  // of what was read last; of no use in a binary file
  std::size_t n_bytes() const { return bytes_.size(); }
  [[noreturn]] void refuse(const std::string& found, const std::string& expected = "",
                           const std::string& hint = "") const;

 private:
  std::string_view bytes_;
  std::string shown_name_;
  std::size_t at_ = 0;          // what comes next
  std::size_t word_begin_ = 0;  // of what was read last
  std::size_t line_begin_ = 0;  // of the line at at_
  int next_line_number_ = 1;    // of the line at at_
  int line_ = 1;
  int column_ = 1;
  std::size_t remaining() const { return bytes_.size() - at_; }
  void skip_blanks(bool over_lines);
  std::string_view word(const char* what);
  template <class Value>
  Value raw(const char* what);
  void start_text();
};

}  // namespace langer
