// What a power cut may leave of an unfinished solution: pages of zeros or of something else, files
// cut short. A run that goes on from it ends with the bytes of a run that met nothing, or begins
// anew and ends with them as well.
#include <doctest/doctest.h>

#include "results/store/journal.hpp"
#include "results/store/step_journal.hpp"
#include "solution_example.hpp"

using namespace langer;
using example::bytes;
using example::header;
using example::step;
using example::write_bytes;

namespace {

constexpr int n = 9, kept = 6;

struct Unfinished {
  std::string path, part, steps, whole;
  std::string steps_file() const { return path + ".steps"; }
};

Unfinished unfinished(const std::string& name) {
  const std::string folder = example::folder(name), path = folder + "/solution.h5";
  {
    SolutionWriter writer(path, header(true));
    for (int i = 0; i < n; ++i) writer.append(step(i, true));
    writer.finish();
  }
  Unfinished u{path, {}, {}, bytes(path)};
  std::filesystem::remove(path);
  {
    SolutionWriter writer(path, header(true));
    for (int i = 0; i < kept; ++i) writer.append(step(i, true));
  }
  u.part = bytes(path + ".part"), u.steps = bytes(path + ".steps");
  return u;
}

// goes on from these files; how many steps were kept
int continued(const Unfinished& u, const std::string& part, const std::string& steps) {
  std::filesystem::remove(u.path);
  write_bytes(u.path + ".part", part);
  write_bytes(u.path + ".steps", steps);
  int found = 0;
  {
    SolutionWriter writer(u.path, header(true));
    found = writer.n_steps();
    if (found > 0) CHECK(example::same(*writer.resumed(), step(found - 1, true)));
    for (int i = found; i < n; ++i) writer.append(step(i, true));
    writer.finish();
  }
  CHECK(bytes(u.path) == u.whole);
  return found;
}

std::string spoilt(std::string text, std::size_t at, std::size_t length, std::mt19937* random) {
  for (std::size_t i = at; i < std::min(at + length, text.size()); ++i)
    text[i] = random ? static_cast<char>((*random)()) : '\0';
  return text;
}

struct FixedTime {
  FixedTime() { setenv("SOURCE_DATE_EPOCH", "1700000000", 1); }
  ~FixedTime() { unsetenv("SOURCE_DATE_EPOCH"); }
};

}  // namespace

TEST_CASE("any page of an unfinished solution may be zero or random: the result is right") {
  const FixedTime fixed;
  const Unfinished u = unfinished("pages");
  std::mt19937 random(3);
  REQUIRE(u.part.size() > 4 * 4096);
  for (std::size_t at = 0; at < u.part.size(); at += 4096)  // nothing is read from it
    for (std::mt19937* noise : {static_cast<std::mt19937*>(nullptr), &random}) {
      CAPTURE(at);
      CHECK(continued(u, spoilt(u.part, at, 4096, noise), u.steps) == kept);
    }
  int least = kept;
  for (const std::size_t page : {std::size_t{128}, std::size_t{1024}})
    for (std::size_t at = 0; at < u.steps.size(); at += page)
      for (std::mt19937* noise : {static_cast<std::mt19937*>(nullptr), &random}) {
        CAPTURE(page);
        CAPTURE(at);
        const int found = continued(u, u.part, spoilt(u.steps, at, page, noise));
        CHECK(found < kept);
        least = std::min(least, found);
      }
  CHECK(least == 0);
}

TEST_CASE("a journal cut short or with one wrong bit: the steps before are kept, and only they") {
  const FixedTime fixed;
  const Unfinished u = unfinished("cut");
  std::mt19937 random(4);
  int most = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const std::size_t at = random() % u.steps.size();
    CAPTURE(at);
    const int left = continued(u, u.part, u.steps.substr(0, at));
    std::string flipped = u.steps;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << trial % 8));
    const int found = continued(u, u.part, flipped);
    CHECK(found == left);
    CHECK(found < kept);
    most = std::max(most, found);
  }
  CHECK(most > 0);
}

TEST_CASE(
    "two signs turned over, records of another journal, records in another order: none of it passes") {
  const std::string folder = example::folder("journal"), path = folder + "/a.steps";
  const auto records = [](const std::string& file) {
    std::vector<std::string> all;
    Journal journal(file);
    while (auto record = journal.next()) all.push_back(*record);
    return all;
  };
  const std::vector<std::string> written{std::string(64, 'a'), std::string(64, 'b'),
                                         std::string(64, 'c')};
  for (const char* name : {"/a.steps", "/b.steps"}) {
    Journal journal(folder + name);
    for (const std::string& record : written) journal.append(record);
  }
  CHECK(records(path) == written);
  const std::string whole = bytes(path), other = bytes(folder + "/b.steps");
  const std::size_t begin = 25, length = 64 + 16;
  std::string signs = whole;
  signs[begin + 8 + 7] ^= '\x80', signs[begin + 8 + 15] ^= '\x80';
  write_bytes(path, signs);
  CHECK(records(path).empty());
  write_bytes(path, whole.substr(0, begin + length) + other.substr(begin + length));
  CHECK(records(path).size() == 1);
  write_bytes(path, whole.substr(0, begin + length) + whole.substr(begin + 2 * length, length) +
                        whole.substr(begin + length, length));
  CHECK(records(path).size() == 1);
  {  // what is written behind damage stays readable, and the damage is gone
    Journal journal(path);
    while (journal.next()) {
    }
    CHECK_FALSE(journal.at_end());
    journal.append("d");
  }
  CHECK(records(path) == std::vector<std::string>{written[0], "d"});
}

TEST_CASE("steps that another version of langer left are made anew") {
  const Unfinished u = unfinished("other_version");
  const auto kept_of = [&](const std::string& version) {
    // the same records, the version in the first of them replaced, with right checksums
    write_bytes(u.path + ".part", u.part);
    write_bytes(u.steps_file(), u.steps);
    std::vector<std::string> records;
    {
      Journal journal(u.steps_file());
      while (const std::optional<std::string> record = journal.next()) {
        records.push_back(*record);
      }
      const std::size_t at = records.at(0).find(code_version());
      REQUIRE(at != std::string::npos);
      records[0].replace(at, code_version().size(), version);
      journal.clear();
      for (const std::string& record : records) {
        journal.append(record);
      }
    }
    return SolutionWriter(u.path, header(true)).n_steps();
  };
  std::string other = code_version();
  other.back() = other.back() == '1' ? '2' : '1';
  CHECK(kept_of(code_version()) == kept);
  CHECK(kept_of(other) == 0);
}

TEST_CASE("a follower reads each step as it is written, the last ones, and a new beginning") {
  const std::string path = example::folder("follower") + "/solution.h5";
  StepFollower follower(path);
  bool anew = false;
  CHECK(follower.more(anew).empty());
  CHECK(!anew);
  {
    SolutionWriter writer(path, header(true));
    writer.append(step(0, true));
    const std::vector<StepRecord> first = follower.more(anew);
    REQUIRE(first.size() == 1);
    CHECK(anew);
    CHECK(example::same(first[0], step(0, true)));
    CHECK(follower.more(anew).empty());
    CHECK(!anew);
    for (int i = 1; i < 4; ++i) writer.append(step(i, true));
    writer.finish();  // removes the journal
  }
  const std::vector<StepRecord> last = follower.more(anew);
  CHECK(!anew);
  REQUIRE(last.size() == 3);
  CHECK(example::same(last[2], step(3, true)));
  CHECK(follower.more(anew).empty());
  SolutionWriter again(path, header(false));
  again.append(step(0, false));
  CHECK(follower.more(anew).size() == 1);
  CHECK(anew);
}
