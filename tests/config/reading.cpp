#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "config/sample.hpp"
#include "mechanics/material/material.hpp"
#include "scene/model/solve_config_io.hpp"

using namespace langer;

namespace reading_tests {

using sample::Sample;

namespace {

Sample read(const std::string& text) {
  return read_config<Sample>(parse_yaml(text, "text")).config;
}

std::string failure(const std::string& text) {
  try {
    read(text);
  } catch (const Failure& f) {
    return f.what();
  }
  return "";
}

const std::string full = R"(
flag: true
count: +7
length: 2.5e-1
title: "30"
choice: b
colour: red
part: {from: -1, to: 2}
friction: 0.34
second: {to: 4}
values: [0, 1e-6, .5]
parts: [{to: 1}, {from: 2, to: 3}]
point: [1, -2, 3]
named: {A: {to: 1}, B-2: {to: 2}}
law: {power: {exponent: 3}}
sum: {linear: {slope: -1}, power: {}}
curve: data/a.csv
)";

}  // namespace

TEST_CASE("a config with every kind of member is read") {
  const Sample s = read(full);
  CHECK(s.flag);
  CHECK(s.count == 7);
  CHECK(s.length == 0.25);
  CHECK(s.title == "30");
  CHECK(s.choice == "b");
  CHECK(s.colour == sample::Colour::red);
  CHECK(s.part == sample::Part{-1, 2});
  CHECK(s.friction == 0.34);
  REQUIRE(s.second.has_value());
  CHECK(*s.second == sample::Part{0, 4});
  CHECK(s.values == std::vector<double>{0, 1e-6, 0.5});
  CHECK(s.parts == std::vector<sample::Part>{{0, 1}, {2, 3}});
  CHECK(s.point == std::array<double, 3>{1, -2, 3});
  CHECK(s.named == std::map<std::string, sample::Part>{{"A", {0, 1}}, {"B-2", {0, 2}}});
  CHECK(s.law == std::variant<sample::Linear, sample::Power>{sample::Power{1, 3}});
  REQUIRE(s.sum.size() == 2);
  CHECK(s.sum[0] == std::variant<sample::Linear, sample::Power>{sample::Linear{-1}});
  CHECK(s.sum[1] == std::variant<sample::Linear, sample::Power>{sample::Power{}});
  CHECK(s.curve.path == "data/a.csv");
}

TEST_CASE("a key left out keeps its default, an optional one stays absent") {
  const Sample s = read("part: {to: 1}");
  CHECK(s.count == 3);
  CHECK(s.length == 1.5);
  CHECK(s.colour == sample::Colour::green);
  CHECK_FALSE(s.friction.has_value());
  CHECK_FALSE(s.second.has_value());
  CHECK(s.values.empty());
}

TEST_CASE("a sum may be a list, and then hold the same term twice") {
  const Sample s = read("part: {to: 1}\nsum: [{linear: {slope: 1}}, {linear: {slope: 2}}]");
  REQUIRE(s.sum.size() == 2);
  CHECK(std::get<sample::Linear>(s.sum[1]).slope == 2);
}

TEST_CASE("what is written reads back as the same text, for every kind of member") {
  const std::string once = to_yaml(read(full));
  CHECK(to_yaml(read(once)) == once);
  const std::string listed =
      to_yaml(read("part: {to: 1}\nsum: [{linear: {slope: 1}}, {linear: {slope: 2}}]"));
  CHECK(to_yaml(read(listed)) == listed);
}

TEST_CASE(
    "the order of keys, comments, quotes and the way a number is typed do not change the written text") {
  CHECK(to_yaml(read("part: {from: 0.10, to: 1e0}\ncount: 4 # c\ntitle: abc")) ==
        to_yaml(read("title: 'abc'\ncount: +4\npart:\n  to: 1.0\n  from: 1.0e-1\n")));
  CHECK(to_yaml(read("part: {from: -0.0, to: 1}")) == to_yaml(read("part: {from: 0, to: 1}")));
}

TEST_CASE("written numbers are read back bit for bit") {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    const std::uint64_t bits = random();
    double x = 0;
    if ((bits >> 52 & 0x7ff) == 0x7ff) continue;  // infinite or NaN
    std::memcpy(&x, &bits, sizeof x);
    Tree t = plain_tree(number_text(x));
    double y = 0;
    Findings f;
    read_leaf(t, "", Member{}, y, f);
    CAPTURE(number_text(x));
    CHECK(f.errors.empty());
    CHECK(x == y);
  }
}

TEST_CASE("written texts are read back, whatever they hold") {
  for (const std::string title : {"",           "true",    "null",
                                  "~",          "1e5",     "010",
                                  "a: b",       "- a",     "# no comment",
                                  "say \"so\"", "a\\b",    "two\nlines",
                                  "\ttab",      " space ", "{x}",
                                  "[x]",        "*a",      "&a",
                                  "!t",         "%",       "@",
                                  "`",          "ü",       "yes",
                                  "include",    "<<",      "key: [1, 2"}) {
    Sample s = read("part: {to: 1}");
    s.title = title;
    CAPTURE(to_yaml(s));
    CHECK(read(to_yaml(s)).title == title);
  }
}

TEST_CASE("all errors of a file come at once, by line") {
  const std::string said = failure("count: 0\ncolour: blue\nlenght: 1\n");
  CHECK(said.find("text:1:1: count: found 0; expected a whole number >= 1") != std::string::npos);
  CHECK(said.find("text:2:1: colour: found blue; expected one of red, green") != std::string::npos);
  CHECK(said.find("text:3:1: unknown key \"lenght\"") != std::string::npos);
  CHECK(said.find("did you mean \"length\"?") != std::string::npos);
  CHECK(said.find("part: missing") != std::string::npos);
  CHECK(said.find("count") < said.find("colour"));
  CHECK(said.find("colour") < said.find("lenght"));
}

TEST_CASE("rules between keys are looked at only where the keys themselves are right") {
  CHECK(failure("part: {from: 2, to: 1}")
            .find("text:1:17: part.to: an end before the begin; expected to > from") !=
        std::string::npos);
  const std::string said = failure("part: {from: x, to: -1}");
  CHECK(said.find("part.from: found x") != std::string::npos);
  CHECK(said.find("an end before") == std::string::npos);
}

TEST_CASE("several ranges of a key hold together") {
  CHECK(failure("part: {to: 1}\nfraction: 0")
            .find("fraction: found 0; expected a number > 0 and <= 1") != std::string::npos);
  CHECK(failure("part: {to: 1}\nfraction: 1.5").find("found 1.5") != std::string::npos);
  CHECK(read("part: {to: 1}\nfraction: 1").fraction == 1);
}

TEST_CASE("places are known for errors found later") {
  const auto loaded = read_config<Sample>(
      parse_yaml("count: 2\nparts:\n  - {to: 1}\n  - to: 5\npart: {to: 1}\n", "text"));
  CHECK(loaded.where("parts[1].to").line == 4);
  CHECK(loaded.where("parts[1].to").column == 5);
  CHECK(loaded.where("part.from").line == 5);  // not given: the deepest part that is
  CHECK(loaded.where("count").line == 1);
}

TEST_CASE("a path of an input file is relative to the file it is written in") {
  const auto tree =
      parse_yaml("part: {to: 1}\ncurve: ../data/a.csv", "configs/fit/a.yaml", "configs/fit");
  const Sample s = read_config<Sample>(tree).config;
  CHECK(s.curve.path == "configs/data/a.csv");
  CHECK(to_yaml(s, relative_to("runs/x/fit")).find("curve: ../../../configs/data/a.csv\n") !=
        std::string::npos);
  CHECK(to_yaml(s, file_name).find("curve: a.csv\n") != std::string::npos);
  const auto files = files_named_by(s);
  REQUIRE(files.size() == 1);
  CHECK(files[0].key == "curve");
}

TEST_CASE("included files are merged below the keys beside them") {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("langer_include_" + std::to_string(getpid()));
  fs::create_directories(folder / "deep");
  std::ofstream(folder / "deep/base.yaml")
      << "a: {x: 1, y: 2}\nb: [1, 2]\nfile: {include: leaf.yaml}\n";
  std::ofstream(folder / "deep/leaf.yaml") << "curve: c.csv\n";
  std::ofstream(folder / "top.yaml") << "include: deep/base.yaml\na: {y: 3}\nb: [5]\n";
  const Tree tree = load_yaml((folder / "top.yaml").string());
  CHECK(to_text(tree) == "a:\n  x: 1\n  y: 3\nb: [5]\nfile:\n  curve: c.csv\n");
  CHECK(tree.find("file")->find("curve")->base == (folder / "deep").string());
  CHECK(place_of(tree, "a.x").file == (folder / "deep/base.yaml").string());
  CHECK(place_of(tree, "a.y").file == (folder / "top.yaml").string());
  fs::remove_all(folder);
}

TEST_CASE("null beside an include takes the included key away, at any depth") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("langer_null_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "base.yaml") << "a: {x: 1, y: 2}\nb: [1, 2]\nc: 3\nd: {z: 4}\n";
  std::ofstream(folder / "top.yaml") << "include: base.yaml\nc: null\na: {x: ~}\nb:\nnew: null\n";
  const Tree tree = load_yaml((folder / "top.yaml").string());
  CHECK(to_text(tree) == "a:\n  y: 2\nd:\n  z: 4\nnew: null\n");
  std::ofstream(folder / "over.yaml") << "include: [base.yaml, top.yaml]\nd: null\nc: 5\n";
  CHECK(to_text(load_yaml((folder / "over.yaml").string())) ==
        "a:\n  x: 1\n  y: 2\nb: [1, 2]\nc: 5\nnew: null\n");
  fs::remove_all(folder);
}

TEST_CASE("anchors may be used, and counted") {
  const Tree tree = parse_yaml("a: &a {x: 1}\nb: [*a, *a]\n", "text");
  CHECK(to_text(tree) == "a:\n  x: 1\nb:\n  - x: 1\n  - x: 1\n");
}

TEST_CASE("a value is set at a path, making maps on the way") {
  Tree tree = parse_yaml("contacts: [{on: top}]\nempty:\n", "text");
  set_value(tree, "contacts[0].friction", parse_yaml("0.5", "set"));
  set_value(tree, "empty.a.b", parse_yaml("[1]", "set"));
  set_value(tree, "contacts[0].on", parse_yaml("{deep: 1}", "set"));
  CHECK(to_text(tree) ==
        "contacts:\n  - on:\n      deep: 1\n    friction: 0.5\nempty:\n  a:\n    b: [1]\n");
  for (const char* path : {"contacts[1].on", "contacts.on", "contacts[0].friction.x", "", "a..b",
                           "[0]", "a[", "a[x]", "a.", ".a", "contacts[99999999999]"}) {
    CAPTURE(path);
    CHECK_THROWS_AS(set_value(tree, path, parse_yaml("1", "set")), Failure);
  }
}

TEST_CASE("the reference names key, kind, unit, default, range and meaning of every line") {
  const std::string text = describe<Sample>();
  for (const char* part :
       {"count", "a whole number >= 1; default 3", "a number > 0 in mm; default 1.5",
        "one of red, green; default green", "part", "required", "exactly one of", "linear", "slope",
        "a number in MPa; required", "a number >= 0; optional", "exponent",
        "a whole number >= 1 and <= 9; default 2"}) {
    CAPTURE(part);
    CHECK(text.find(part) != std::string::npos);
  }
}

TEST_CASE("the paper's material is read and written back") {
  const auto again = [](const std::string& text) {
    return to_yaml(read_config<Material>(parse_yaml(text, "text")).config);
  };
  const std::string written = again(
      "matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}\n"
      "fibres: [{hgo: {c1: -0.317, c2: 0.319}, alpha: 30}]\n"
      "volume: {quadratic: {d: 1.0e-6}}\n");
  for (const char* part :
       {"matrix:\n  yeoh:\n    a1: 0.269\n    a2: 0.376\n    a3: 0.415\n",
        "fibres:\n  - hgo:\n      c1: -0.317\n      c2: 0.319\n    alpha: 30\n    switch: I4_bar\n",
        "volume:\n  quadratic:\n    d: 1e-06\n"}) {
    CAPTURE(written);
    CHECK(written.find(part) != std::string::npos);
  }
  CHECK(again(written) == written);
}

TEST_CASE("the law of a family is the one key among its keys that names one") {
  const auto read = [](const std::string& family) {
    return read_config<Material>(parse_yaml("matrix: {neo_hooke: {a1: 0.1}}\nfibres: [" + family +
                                                "]\nvolume: {simo_taylor: {bulk_modulus: 100}}\n",
                                            "law.yaml"))
        .config;
  };
  const Material m = read("{kappa: 0.1, exp_pow: {ksi: 0.3, beta: 2.5}, alpha: 20}");
  CHECK(std::get<ExpPowFibre>(m.fibres[0].law).beta == 2.5);
  CHECK(std::get<ExpPowFibre>(m.fibres[0].law).alpha == 0);
  CHECK(m.fibres[0].alpha_deg == 20);
  CHECK(to_yaml(m).find(
            "  - exp_pow:\n      ksi: 0.3\n      alpha: 0\n      beta: 2.5\n    alpha: 20\n") !=
        std::string::npos);
  CHECK(to_yaml(read_config<Material>(parse_yaml(to_yaml(m), "text")).config) == to_yaml(m));
  CHECK(std::get<PowLinearFibre>(read("{pow_linear: {E: 3, lam0: 1.05}}").fibres[0].law).beta == 2);
  const std::string text = describe<Material>();
  for (const char* part : {"  exp_pow", "one of hgo, exp_pow, pow_linear", "    ksi", "  alpha"})
    CHECK(text.find(part) != std::string::npos);
}

// Any bytes: a tree or a Failure, never a crash or a hang.
TEST_CASE("broken and random texts are refused or read, nothing else") {
  std::mt19937 random(11);
  const std::string letters = "ab:,-[]{}&*!|>'\"%@`#?~\n \t0.1<";
  int read_well = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = i % 2 ? full : "";
    const int edits = 1 + static_cast<int>(random() % 12);
    for (int e = 0; e < edits; ++e) {
      const char c = letters[random() % letters.size()];
      if (i % 2)
        text[random() % text.size()] = c;
      else
        text += c;
    }
    try {
      read(text);
      ++read_well;
    } catch (const Failure& f) {
      CHECK(f.code() == Exit::config);
      CHECK(!f.errors().empty());
    }
  }
  CHECK(read_well > 0);
}

}  // namespace reading_tests
