#include "meshing/msh_source.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "core/base/traps.hpp"

namespace langer {

// Errors name the line and column of the last word. at_ is the next byte; line_begin_ and
// next_line_number_ follow it, line_ and column_ belong to the word that was read last.
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// A word as a message may show it: not too long, without letters that would disturb a terminal.
std::string shown(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text;
  for (const char c : word.substr(0, longest)) {
    const bool is_printable = c >= ' ' && c <= '~';
    text += is_printable ? c : '?';
  }
  if (word.size() > longest) text += "...";
  return text;
}

}  // namespace

MshSource::MshSource(std::string_view bytes, const std::string& shown_name)
    : bytes_(bytes), shown_name_(shown_name) {}

void MshSource::refuse(const std::string& found, const std::string& expected,
                       const std::string& hint) const {
  Place place{shown_name_};
  if (!is_binary) {
    place.line = line_;
    place.column = column_;
  }
  throw Failure(Exit::input, Error{place, "", found, expected, hint});
}

void MshSource::skip_blanks(bool over_lines) {
  while (at_ < bytes_.size()) {
    const char c = bytes_[at_];
    if (c == '\n' && over_lines) {
      ++at_;
      ++next_line_number_;
      line_begin_ = at_;
    } else if (is_blank(c)) {
      ++at_;
    } else {
      return;
    }
  }
}

// Notes the place of the next word for messages. Long lines have a largest column.
void MshSource::start_text() {
  line_ = next_line_number_;
  column_ = static_cast<int>(std::min<std::size_t>(at_ - line_begin_, 1 << 20)) + 1;
}

std::string_view MshSource::next_line() {
  skip_blanks(true);
  start_text();
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  const std::string_view line = bytes_.substr(at_, end - at_);
  at_ = end;
  return trimmed(line);
}

// The rest of the line has to be empty: a count with something behind it is a damaged file.
void MshSource::finish_line() {
  skip_blanks(false);
  start_text();
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  if (end > at_) {
    const std::string_view rest = bytes_.substr(at_, end - at_);
    refuse(fmt::format("found \"{}\"", shown(trimmed(rest))), "the end of the line");
  }
  if (end == bytes_.size()) return;
  at_ = end + 1;
  ++next_line_number_;
  line_begin_ = at_;
}

void MshSource::end_section(const char* name) {
  const std::string end = fmt::format("$End{}", name);
  std::string_view line = next_line();
  // format 1 writes capitals: $ENDNOD
  const std::string capitals = fmt::format("$END{}", name);
  if (line == end || line == capitals) return;
  if (line.empty()) refuse("the file ends", end);
  refuse(fmt::format("found \"{}\"", shown(line)), end,
         "the number at the beginning of the section must be that of its items");
}

// A section whose end is missing is refused rather than read to the end of the file.
void MshSource::skip_section(std::string_view name) {
  const std::string end = fmt::format("$End{}", name);
  const std::size_t found = bytes_.find(end, at_);
  if (found == std::string_view::npos)
    refuse(fmt::format("the section ${} has no end", shown(name)), shown(end));
  for (std::size_t i = at_; i < found; ++i) {
    if (bytes_[i] != '\n') continue;
    ++next_line_number_;
    line_begin_ = i + 1;
  }
  at_ = found + end.size();
}

// Names appear in messages and files: control characters and overlong names are refused.
std::string MshSource::quoted_name() {
  const char* expected = "a name between double quotes";
  skip_blanks(false);
  start_text();
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  const std::string_view text = trimmed(bytes_.substr(at_, end - at_));
  at_ = end;
  if (text.size() < 2 || text.front() != '"' || text.back() != '"')
    refuse("found " + text_or(shown(text), "no name"), expected);
  const std::string_view name = text.substr(1, text.size() - 2);
  for (const char c : name) {
    const bool is_control = static_cast<unsigned char>(c) < ' ' || c == '\x7f';
    if (is_control || c == '"')
      refuse(fmt::format("found the name {}", shown(text)),
             "a name without quotes and control characters");
  }
  constexpr std::size_t longest = 200;
  if (name.size() > longest)
    refuse(fmt::format("found a name of {} letters", name.size()),
           fmt::format("at most {}", longest));
  return std::string(name);
}

std::string_view MshSource::word(const char* what) {
  skip_blanks(true);
  start_text();
  word_begin_ = at_;
  while (at_ < bytes_.size() && bytes_[at_] != '\n' && !is_blank(bytes_[at_])) ++at_;
  const std::string_view found = bytes_.substr(word_begin_, at_ - word_begin_);
  if (found.empty()) refuse("the file ends", what);
  return found;
}

std::int64_t MshSource::text_integer(const char* what) {
  const std::string_view text = word(what);
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    refuse(fmt::format("found \"{}\" for {}", shown(text), what), "an integer");
  return value;
}

// A value of a binary file, in the order of bytes of this machine (the format section checks it).
template <class Value>
Value MshSource::raw(const char* what) {
  if (remaining() < sizeof(Value))
    refuse(fmt::format("the file ends before {}", what), "", "the file is truncated");
  Value value;
  std::memcpy(&value, bytes_.data() + at_, sizeof value);
  at_ += sizeof value;
  line_begin_ = at_;
  return value;
}

int MshSource::integer(const char* what) {
  if (is_binary) return raw<std::int32_t>(what);
  const std::int64_t value = text_integer(what);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
    refuse(fmt::format("found {} for {}", value, what), "an integer of four bytes");
  return static_cast<int>(value);
}

std::int64_t MshSource::long_integer(const char* what) {
  if (is_binary) return raw<std::int64_t>(what);
  return text_integer(what);
}

double MshSource::number(const char* what) {
  if (is_binary) {
    const double value = raw<double>(what);
    if (!std::isfinite(value)) refuse(fmt::format("{} is not finite", what));
    return value;
  }
  const std::string_view text = word(what);
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_whole = end == digits.data() + digits.size();
  if (error == std::errc::result_out_of_range && is_whole) {
    const NoTraps may_overflow;
    value = std::strtod(std::string(digits).c_str(), nullptr);  // 1e-400 is 0, 1e400 is refused
  } else if (error != std::errc{} || !is_whole)
    refuse(fmt::format("found \"{}\" for {}", shown(text), what), "a number");
  if (!std::isfinite(value))
    refuse(fmt::format("found \"{}\" for {}", shown(text), what), "a finite number");
  return value;
}

std::size_t MshSource::tag(const char* what, bool is_long) {
  std::int64_t value = 0;
  if (is_long)
    value = long_integer(what);
  else
    value = integer(what);
  if (value < 1 || value > std::numeric_limits<std::int32_t>::max())
    refuse(fmt::format("found {} for {}", value, what), "a number from 1 to 2147483647");
  return static_cast<std::size_t>(value);
}

// A count is believed only if the rest of the file can hold that many items: nothing is allocated
// for a number that a damaged file gives.
std::size_t MshSource::checked_count(std::int64_t value, const char* what, std::size_t bytes_each,
                                     std::size_t words_each) {
  // a word of a text takes its letter and a blank; the last one may end the file
  std::size_t least_bytes = 2 * words_each;
  if (is_binary) least_bytes = bytes_each;
  if (value < 0) refuse(fmt::format("found {} for {}", value, what), "0 or more");
  if (static_cast<std::uint64_t>(value) > (remaining() + 1) / least_bytes)
    refuse(fmt::format("found {} for {}, and the rest of the file has {} bytes", value, what,
                       remaining()),
           "as many as the file holds");
  return static_cast<std::size_t>(value);
}

std::size_t MshSource::count(const char* what, std::size_t bytes_each, std::size_t words_each) {
  return checked_count(long_integer(what), what, bytes_each, words_each);
}

std::size_t MshSource::text_count(const char* what, std::size_t bytes_each,
                                  std::size_t words_each) {
  const std::int64_t value = text_integer(what);
  return checked_count(value, what, bytes_each, words_each);
}

}  // namespace langer
