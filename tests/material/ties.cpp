// Numbers that follow others: what is written, chains, what is refused.
#include "mechanics/material/ties.hpp"

#include <doctest/doctest.h>

#include "support/laws.hpp"

using namespace langer;

TEST_CASE("ties are read as they are written: sign, factor, offset, blanks") {
  struct Written {
    const char* text;
    const char* of;
    double factor, offset;
    const char* again;
  };
  for (const Written& w :
       {Written{"fibres[0].alpha", "fibres[0].alpha", 1, 0, "fibres[0].alpha"},
        {"-fibres[0].alpha", "fibres[0].alpha", -1, 0, "-fibres[0].alpha"},
        {" - fibres[0].alpha + 90 ", "fibres[0].alpha", -1, 90, "-fibres[0].alpha + 90"},
        {"0.5*fibres[0].hgo.c1", "fibres[0].hgo.c1", 0.5, 0, "0.5 * fibres[0].hgo.c1"},
        {"-2e-1 * matrix.yeoh.a1-3", "matrix.yeoh.a1", -0.2, -3, "-0.2 * matrix.yeoh.a1 - 3"},
        {"+matrix[1].yeoh.a1", "matrix[1].yeoh.a1", 1, 0, "matrix[1].yeoh.a1"}}) {
    CAPTURE(w.text);
    const auto tie = parse_tie("k", w.text);
    REQUIRE(tie);
    CHECK(tie->of == w.of);
    CHECK(tie->factor == w.factor);
    CHECK(tie->offset == w.offset);
    CHECK(tie_text(*tie) == w.again);
    const auto back = parse_tie("k", tie_text(*tie));
    REQUIRE(back);
    CHECK(back->factor == tie->factor);
    CHECK(back->offset == tie->offset);
  }
  for (const char* text : {"", "-", "3", "2 *", "a b*2", "a*2", "a + b", "a + ", "a - -1", "--a",
                           "nan * a", "1e999 * a", "2a", "a+1+1", "a;b", "2 fibres[0].alpha"}) {
    CAPTURE(text);
    CHECK(!parse_tie("k", text));
  }
}

TEST_CASE("chains of ties are followed to their ends, circles are found") {
  const ResolvedTies all = resolved({{"a", "b", -1, 1}, {"b", "c", 2, 3}, {"d", "a", 0.5, 0}});
  CHECK(all.circle.empty());
  REQUIRE(all.ties.size() == 3);
  for (const Tie& tie : all.ties) CHECK(tie.of == "c");
  //   a = -(2 c + 3) + 1,  d = a/2
  CHECK(all.ties[0].factor == -2);
  CHECK(all.ties[0].offset == -2);
  CHECK(all.ties[2].factor == -1);
  CHECK(all.ties[2].offset == -1);
  CHECK(resolved({{"a", "b", 1, 0}, {"b", "c", 1, 0}, {"c", "a", 1, 0}}).circle == "a");
  CHECK(resolved({{"a", "a", 1, 0}}).circle == "a");
  CHECK(resolved({{"e", "a", 1, 0}, {"a", "b", 1, 0}, {"b", "a", 1, 0}}).circle == "e");
}

TEST_CASE("tied numbers of a material follow exactly") {
  Material m = test::stable(30, 1e-6);
  m.fibres.push_back(m.fibres[0]);
  const TiedNumbers tied(m, {{"fibres[1].alpha", "fibres[0].alpha", -1, 0},
                             {"fibres[1].hgo.c1", "fibres[0].hgo.c1", 1, 0}});
  m.fibres[0].alpha_deg = 41.3, std::get<HgoFibre>(m.fibres[0].law).c1 = 0.7;
  tied.follow();
  CHECK(m.fibres[1].alpha_deg == -41.3);
  CHECK(std::get<HgoFibre>(m.fibres[1].law).c1 == 0.7);
  CHECK(std::get<HgoFibre>(m.fibres[1].law).c2 == 0.30);
  CHECK_THROWS_AS(TiedNumbers(m, {{"fibres[2].alpha", "fibres[0].alpha", 1, 0}}), std::logic_error);
}
