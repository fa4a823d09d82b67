#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "report/labels.hpp"
#include "report/packed.hpp"
#include "report/page.hpp"
#include "report/report_symmetry.hpp"
#include "report/sources.hpp"
#include "support/near.hpp"

using namespace langer::report;

TEST_CASE("base64 as RFC 4648 has it") {
  const auto packed = [](const std::string& s) {
    return base64(s.data(), s.size());
  };
  CHECK(packed("") == "");
  CHECK(packed("f") == "Zg==");
  CHECK(packed("fo") == "Zm8=");
  CHECK(packed("foo") == "Zm9v");
  CHECK(packed("foobar") == "Zm9vYmFy");
}

TEST_CASE("a field keeps its ends, its order and what is not a number") {
  const std::vector<double> values{-2, 0.5, 3, std::numeric_limits<double>::quiet_NaN()};
  Span span;
  span.add(values);
  CHECK(span.low == -2);
  CHECK(span.high == 3);
  CHECK(quantised(values, span) == std::vector<std::uint16_t>{0, 32767, 65534, 65535});
  Span same;
  same.add(std::vector<double>{1, 1});
  CHECK(quantised(std::vector<double>{1, 1}, same) == std::vector<std::uint16_t>{0, 0});
}

TEST_CASE(
    "a sweep that is symmetric has no residual and one value turned by 1 percent shows as such") {
  const std::vector<double> angle{0, 30, 60, 90, 120, 150, 180};
  std::vector<double> a, b;
  for (double x : angle) {
    const double c = std::cos(x * std::acos(-1) / 180);
    a.push_back(1 + c * c), b.push_back(1 + 1 - c * c);
  }
  const auto mirror = mirror_residual("u", angle, a);
  REQUIRE(mirror);
  CHECK(mirror->pairs == 3);  // 0 and 180, 30 and 150, 60 and 120
  CHECK(mirror->value < 1e-15);
  const auto swap = swap_residual("u_A", "u_B", angle, a, b);
  REQUIRE(swap);
  CHECK(swap->value < 1e-15);
  a[1] *= 1.01;
  CHECK(mirror_residual("u", angle, a)->value == langer::near(0.01 * 1.75 / 2));
  CHECK(swap_residual("u_A", "u_B", angle, a, b)->value > 0.008);
  CHECK_FALSE(mirror_residual("u", {0, 30, 45}, {1, 2, 3}));
}

TEST_CASE("a number is shown to the digit that its error leaves known") {
  CHECK(rounded(9.497, 1.6) == "9.50");  // 0.152: two digits of an error that begins with 1
  CHECK(rounded(9.511, 8.8) == "9.5");   // 0.84
  CHECK(rounded(9.511, 100) == "10");    // no digit is known; the first one stays
  CHECK(rounded(1234.5, 5) == "1230");   // 62
  CHECK(rounded(-0.0123456, 3) == "-0.0123");
  CHECK(rounded(2, 0) == "2");
  CHECK(rounded(0, 5) == "0");
  CHECK(rounded(3.14159265, std::numeric_limits<double>::quiet_NaN()) == "3.142");
  CHECK(rounded(3.14159265, 1e-9) == "3.14159");  // six digits are enough for a sentence
}

TEST_CASE("columns in words") {
  CHECK(in_words("u_y_A") == "displacement u_y, A");
  CHECK(in_words("von_mises_max") == "greatest von Mises stress");
  CHECK(in_words("sigma_xx") == "Cauchy stress σxx");
  CHECK(in_words("sobol_total_a1") == "sobol total a1");
  CHECK(in_words("t_half") == "t half");
}

TEST_CASE("files are called by the folders that tell them apart") {
  const auto sweep = labelled({"run/alpha_000/post/curves.h5", "run/alpha_030/post/curves.h5"});
  CHECK(sweep[0].label == "alpha = 0");
  CHECK(sweep[1].label == "alpha = 30");
  CHECK(sweep[1].numbered);
  CHECK(labelled({"run/post/curves.h5"})[0].label == "post");
  const auto two = labelled(
      {"run/code_FER/alpha_000/post/curves.h5", "run/code_ANSYS/alpha_060/post/curves.h5"});
  CHECK(two[1].label == "code: ANSYS, alpha = 60");
  CHECK(labelled({"a.h5", "b.h5"})[1].label == "b");
}

TEST_CASE(
    "no text of a config can leave the page's script, and the page asks for nothing from elsewhere") {
  ReportPage page;
  page.title = "a < b & c";
  page.verdicts.push_back({Level::warning, "x", "</script><script>alert(1)</script>"});
  page.tables.push_back(
      {"t", {{"v", "-"}}, {{std::numeric_limits<double>::quiet_NaN()}, {std::string("\"\n\\")}}});
  const std::string text = html(page);
  CHECK(text.find("alert(1)</script>") == std::string::npos);
  CHECK(text.find("<title>a &lt; b &amp; c</title>") != std::string::npos);
  CHECK(text.find("{{") == std::string::npos);
  CHECK(text.find("[[null],[\"\\\"\\n\\\\\"]]") != std::string::npos);
  for (const char* outside : {" src=", "href=\"http", "@import", "url("})
    CHECK(text.find(outside) == std::string::npos);
}
